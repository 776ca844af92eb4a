// SPDX-License-Identifier: MIT
#include "analysis/deformed_spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace sphstab::analysis {
namespace {

/// Of a dense spectrum, relative to the largest modulus: n roundings of an orthogonal reduction of n ≤ 1000 unknowns,
/// times the condition of an eigenvalue.
constexpr double dense_resolution = 1e-11;
/// Of the ends of a larger one: the residual that is asked for, and the condition of an eigenvalue.
constexpr double residual_of_ends = 1e-10, condition = 10.0;

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

template <int Dim>
DeformedSpectrum whole(DeformedBodyOperator<Dim>& body_operator) {
  DeformedSpectrum spectrum{};
  spectrum.all = all_modes(body_operator);
  spectrum.largest = spectrum.all.back();
  spectrum.smallest = upper_of_pair(spectrum.all.front());
  spectrum.applications = static_cast<long>(spectrum.all.size());
  return spectrum;
}

template <int Dim>
DeformedSpectrum ends(DeformedBodyOperator<Dim>& body_operator, const std::function<void(double)>& progress) {
  const DeformedLimit limit =
      deformed_limit(body_operator, {.tolerance = residual_of_ends, .leftmost = true, .progress = progress});
  DeformedSpectrum spectrum{};
  spectrum.largest = limit.largest;
  spectrum.smallest = *limit.leftmost;
  spectrum.applications = limit.applications;
  return spectrum;
}

double resolution_of_ends(const DeformedSpectrum& spectrum) {
  return condition * std::max({residual_of_ends, spectrum.largest.residual, spectrum.smallest.residual});
}

/// `resolution`: what is not known of an ω², relative to the largest.
void find_growth(const Scheme& scheme, double resolution, DeformedSpectrum& spectrum) {
  const double damping_rate = scheme.damping ? scheme.damping->rate : 0.0;
  const double unknown = resolution * std::abs(spectrum.largest.omega_squared);
  spectrum.smallest_seen_growth_rate = growth_rate_of(-unknown, damping_rate);
  const auto look_at = [&](const DeformedMode& mode) {
    const std::complex<double> square = mode.omega_squared;
    const std::complex<double> moved(square.real() + unknown, std::max(0.0, square.imag() - unknown));
    const double rate = growth_rate_of(square, damping_rate);
    if (!(growth_rate_of(moved, damping_rate) > 0.0)) {
      spectrum.has_damped_pairs |= square.imag() != 0.0;
    } else if (rate > spectrum.growth_rate) {
      spectrum.growth_rate = rate;
      spectrum.growing = mode;
    }
  };
  look_at(spectrum.largest);
  look_at(spectrum.smallest);
  for (const DeformedMode& mode : spectrum.all)
    if (mode.omega_squared.imag() >= 0.0) look_at(mode);
}

}  // namespace

double growth_rate_of(std::complex<double> omega_squared, double damping_rate) {
  const double half = 0.5 * damping_rate;
  return std::sqrt(half * half - omega_squared).real() - half;
}

template <int Dim>
DeformedSpectrum deformed_spectrum(DeformedBodyOperator<Dim>& body_operator,
                                   const std::function<void(double)>& progress) {
  const auto unknowns = static_cast<int>(body_operator.unknowns().size());
  const bool is_whole = unknowns > 0 && unknowns <= most_unknowns_of_whole_spectrum;
  DeformedSpectrum spectrum = is_whole ? whole(body_operator) : ends(body_operator, progress);
  spectrum.step_of_largest = step_of_mode(body_operator.problem(), spectrum.largest.omega_squared);
  find_growth(body_operator.problem().scheme, is_whole ? dense_resolution : resolution_of_ends(spectrum), spectrum);
  return spectrum;
}

template DeformedSpectrum deformed_spectrum(DeformedBodyOperator<1>&, const std::function<void(double)>&);
template DeformedSpectrum deformed_spectrum(DeformedBodyOperator<2>&, const std::function<void(double)>&);
template DeformedSpectrum deformed_spectrum(DeformedBodyOperator<3>&, const std::function<void(double)>&);

}  // namespace sphstab::analysis
