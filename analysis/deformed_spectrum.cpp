// SPDX-License-Identifier: MIT
#include "analysis/deformed_spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "analysis/arnoldi.hpp"

namespace sphstab::analysis {
namespace {

using Progress = std::function<void(double fraction)>;

/// Of a dense spectrum, relative to the largest modulus: n roundings of an orthogonal reduction of n ≤ 1000 unknowns,
/// times the condition of an eigenvalue.
constexpr double dense_resolution = 1e-11;
/// Of the ends of a larger one: the residual that is asked for, and the condition of an eigenvalue.
constexpr double residual_of_ends = 1e-10, condition = 10.0;

/// Of what leads a motion to the mode that grows fastest: Krylov spaces of the map of so many steps, first and each
/// time more while nothing has been seen to grow, as long as no more particles are moved in all: some ten seconds.
constexpr long first_steps = 100, times_more_steps = 7, most_maps = 60, most_moves = 400'000'000;
constexpr int maps_of_a_space = 30;
/// The step of these maps, over that of the largest ω²; and the residual of an eigenvector of a map.
constexpr double share_of_limit = 0.5, residual_of_map = 1e-9;

/// M^−½ K M^−½ of the unknowns.
template <int Dim>
Eigen::MatrixXd matrix(DeformedBodyOperator<Dim>& body_operator) {
  const auto& unknowns = body_operator.unknowns();
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  Eigen::MatrixXd matrix(n, n);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(body_operator.components()), y = x;
  for (Eigen::Index j = 0; j < n; ++j) {
    x[unknowns[j]] = 1.0;
    body_operator.apply(x, y);
    x[unknowns[j]] = 0.0;
    matrix.col(j) = y(unknowns);
  }
  return matrix;
}

template <int Dim>
std::vector<DeformedMode> all_modes(DeformedBodyOperator<Dim>& body_operator) {
  const Eigen::MatrixXd A = matrix(body_operator);
  const Eigen::EigenSolver<Eigen::MatrixXd> pairs(A);
  const Eigen::VectorXcd values = pairs.eigenvalues();
  const Eigen::MatrixXcd vectors = pairs.eigenvectors();
  const double largest = values.cwiseAbs().maxCoeff();
  std::vector<DeformedMode> modes;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const Eigen::VectorXcd v = vectors.col(i);
    const double residual = (A * v - values[i] * v).norm() / (v.norm() * largest);
    const bool is_real = std::abs(values[i].imag()) <= dense_resolution * largest;
    Eigen::VectorXd shape = Eigen::VectorXd::Zero(body_operator.components());
    shape(body_operator.unknowns()) = v.real();
    modes.push_back({is_real ? values[i].real() : values[i], residual, shape.normalized()});
  }
  std::sort(modes.begin(), modes.end(), [](const DeformedMode& a, const DeformedMode& b) {
    return std::pair(a.omega_squared.real(), a.omega_squared.imag()) <
           std::pair(b.omega_squared.real(), b.omega_squared.imag());
  });
  return modes;
}

/// With a positive imaginary part.
DeformedMode upper_of_pair(DeformedMode mode) {
  mode.omega_squared.imag(std::abs(mode.omega_squared.imag()));
  return mode;
}

/// A mode of complex displacement x, by its Rayleigh quotient.
template <int Dim>
DeformedMode mode_of(DeformedBodyOperator<Dim>& body_operator, Eigen::VectorXcd x, double largest) {
  x.normalize();
  Eigen::VectorXd image_of_real(x.size()), image_of_imaginary(x.size());
  body_operator.apply(x.real(), image_of_real);
  body_operator.apply(x.imag(), image_of_imaginary);
  Eigen::VectorXcd image(x.size());
  image.real() = image_of_real;
  image.imag() = image_of_imaginary;
  const std::complex<double> quotient = x.dot(image);
  return upper_of_pair({quotient, (image - quotient * x).norm() / largest, x.real().normalized()});
}

/// The map of so many steps, velocity first: v' = (1 − cΔt) v − Δt A x, x' = x + Δt v'.
template <int Dim>
LinearOperator linear_steps(DeformedBodyOperator<Dim>& body_operator, double time_step, long steps) {
  const auto n = body_operator.components();
  const auto& damping = body_operator.problem().scheme.damping;
  const double kept = damping ? 1.0 - damping->rate * time_step : 1.0;
  return [&body_operator, n, kept, time_step, steps, image = Eigen::VectorXd(n)](const Eigen::VectorXd& start,
                                                                                 Eigen::VectorXd& end) mutable {
    Eigen::VectorXd v = start.head(n), x = start.tail(n);
    for (long step = 0; step < steps; ++step) {
      body_operator.apply(x, image);
      v = kept * v - time_step * image;
      x += time_step * v;
    }
    end << v, x;
  };
}

/// Looks at modes: `unknown` is what is not known of their ω².
void judge(const std::vector<DeformedMode>& modes, double unknown, double damping_rate, DeformedSpectrum& spectrum) {
  for (const DeformedMode& mode : modes) {
    const std::complex<double> square = mode.omega_squared;
    if (square.imag() < 0.0) continue;  // the other one of its pair is there
    const std::complex<double> moved(square.real() + unknown, std::max(0.0, square.imag() - unknown));
    const double rate = growth_rate_of(square, damping_rate);
    if (!(growth_rate_of(moved, damping_rate) > 0.0)) {
      spectrum.has_damped_pairs |= square.imag() > unknown;
    } else if (rate > spectrum.growth_rate) {
      spectrum.growth_rate = rate;
      spectrum.growing = mode;
    }
  }
}

template <int Dim>
DeformedSpectrum whole(DeformedBodyOperator<Dim>& body_operator, double damping_rate) {
  DeformedSpectrum spectrum{};
  spectrum.all = all_modes(body_operator);
  spectrum.largest = spectrum.all.back();
  spectrum.smallest = upper_of_pair(spectrum.all.front());
  spectrum.applications = static_cast<long>(spectrum.all.size());
  const double unknown = dense_resolution * std::abs(spectrum.largest.omega_squared);
  spectrum.smallest_seen_growth_rate = growth_rate_of(-unknown, damping_rate);
  judge(spectrum.all, unknown, damping_rate, spectrum);
  return spectrum;
}

double unknown_of(const DeformedMode& mode, double largest) {
  return condition * std::max(residual_of_ends, mode.residual) * largest;
}

template <int Dim>
DeformedSpectrum ends(DeformedBodyOperator<Dim>& body_operator, double damping_rate, const Progress& progress) {
  const DeformedLimit limit =
      deformed_limit(body_operator, {.tolerance = residual_of_ends, .leftmost = true, .progress = progress});
  DeformedSpectrum spectrum{};
  spectrum.largest = limit.largest;
  spectrum.smallest = *limit.leftmost;
  spectrum.applications = limit.applications;
  const double largest = std::abs(limit.largest.omega_squared);
  for (const DeformedMode& mode : {spectrum.largest, spectrum.smallest})
    judge({mode}, unknown_of(mode, largest), damping_rate, spectrum);
  spectrum.smallest_seen_growth_rate = growth_rate_of(-unknown_of(spectrum.smallest, largest), damping_rate);
  return spectrum;
}

/// Looks for a mode that grows faster than the ends have shown.
template <int Dim>
void follow_growth(DeformedBodyOperator<Dim>& body_operator, double damping_rate, const Progress& progress,
                   DeformedSpectrum& spectrum) {
  const double largest = std::abs(spectrum.largest.omega_squared);
  const double time_step = share_of_limit * 2.0 / std::sqrt(largest);
  Eigen::VectorXd start(2 * body_operator.components());
  start << body_operator.random_components(1), body_operator.random_components(2);
  long moves = 0;
  for (long steps = first_steps;; steps *= times_more_steps) {
    const long moves_of_map = steps * body_operator.body().size();
    if (moves + most_maps * moves_of_map > most_moves) return;
    const ArnoldiResult found = arnoldi(
        [&, map = linear_steps(body_operator, time_step, steps)](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
          map(x, y);
          moves += moves_of_map;
          spectrum.applications += steps;
          if (progress) progress(static_cast<double>(moves) / most_moves);
        },
        start,
        {.extreme = Extreme::outermost, .dimension = maps_of_a_space, .tolerance = residual_of_map, .most = most_maps});
    const DeformedMode mode = mode_of(body_operator, found.vector.tail(body_operator.components()), largest);
    judge({mode}, unknown_of(mode, largest), damping_rate, spectrum);
    spectrum.smallest_seen_growth_rate = 1.0 / (static_cast<double>(steps) * time_step);
    if (spectrum.growing) return;
  }
}

}  // namespace

double growth_rate_of(std::complex<double> omega_squared, double damping_rate) {
  const double half = 0.5 * damping_rate;
  return std::sqrt(half * half - omega_squared).real() - half;
}

template <int Dim>
DeformedSpectrum deformed_spectrum(DeformedBodyOperator<Dim>& body_operator, const Progress& progress) {
  const auto& damping = body_operator.problem().scheme.damping;
  const double damping_rate = damping ? damping->rate : 0.0;
  const auto unknowns = static_cast<int>(body_operator.unknowns().size());
  DeformedSpectrum spectrum;
  if (unknowns > 0 && unknowns <= most_unknowns_of_whole_spectrum) {
    spectrum = whole(body_operator, damping_rate);
  } else {
    const auto half_of_it = [&](double begin) -> Progress {
      if (!progress) return nullptr;
      return [&progress, begin](double fraction) { progress(begin + 0.5 * fraction); };
    };
    spectrum = ends(body_operator, damping_rate, half_of_it(0.0));
    follow_growth(body_operator, damping_rate, half_of_it(0.5), spectrum);
  }
  spectrum.step_of_largest = step_of_mode(body_operator.problem(), spectrum.largest.omega_squared);
  return spectrum;
}

template DeformedSpectrum deformed_spectrum(DeformedBodyOperator<1>&, const std::function<void(double)>&);
template DeformedSpectrum deformed_spectrum(DeformedBodyOperator<2>&, const std::function<void(double)>&);
template DeformedSpectrum deformed_spectrum(DeformedBodyOperator<3>&, const std::function<void(double)>&);

}  // namespace sphstab::analysis
