// SPDX-License-Identifier: MIT
#include "analysis/dispersion.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "analysis/in_range.hpp"

namespace sphstab::analysis {
namespace {

/// Imaginary part of k, in units of it, that gives derivatives without a difference: its square is below rounding.
constexpr double imaginary_step = 1e-10;
/// Left and right unit eigenvectors that are nearer to orthogonal belong to branches that meet.
constexpr double least_overlap = 1e-6;
/// Branches this close, relative, meet.
constexpr double same_branch = 1e-9;
/// And these slopes of equal eigenvalues, relative to ∂M/∂k: they are off by that rounding over the overlap.
constexpr double same_slope = 1e-9;

template <int Dim>
using Columns = Eigen::Matrix<std::complex<double>, Dim, Eigen::Dynamic, 0, Dim, Dim>;

/// Orthonormal eigenvectors of an eigenvalue that M has `count` times: the right singular vectors of the smallest
/// singular values of M − λ I.
template <int Dim>
Columns<Dim> eigenvectors(const Tensor<Dim>& M, std::complex<double> eigenvalue, int count) {
  using Complex = std::complex<double>;
  const Tensor<Dim, Complex> shifted = M.template cast<Complex>() - eigenvalue * Tensor<Dim, Complex>::Identity();
  return Eigen::JacobiSVD<Tensor<Dim, Complex>>(shifted, Eigen::ComputeFullV).matrixV().rightCols(count);
}

/// y·M' x / y·x of the right and left eigenvectors x, y of one eigenvalue of M, its derivative along M'; of equal
/// eigenvalues the same for all of them, or nothing where they part.
template <int Dim>
std::optional<std::complex<double>> eigenvalue_slope(const Columns<Dim>& x, const Columns<Dim>& y,
                                                     const Tensor<Dim>& derivative) {
  const auto overlap = (y.transpose() * x).eval();
  const auto singular_values = overlap.jacobiSvd().singularValues();
  if (singular_values[x.cols() - 1] < least_overlap) return std::nullopt;
  const auto slopes = (overlap.inverse() * (y.transpose() * derivative * x)).eval();
  const std::complex<double> slope = slopes.trace() / static_cast<double>(x.cols());
  const auto identity = decltype(slopes)::Identity(x.cols(), x.cols());
  if ((slopes - slope * identity).norm() > same_slope * derivative.norm()) return std::nullopt;
  return slope;
}

/// The branches of a wave whose M and ∂M/∂k_j are given; polarisations are compared with `normal`, that of the fronts.
template <int Dim>
std::array<WaveBranch<Dim>, Dim> branches(const Dynamics<Dim>& dynamics,
                                          const std::array<Tensor<Dim>, Dim>& derivatives,
                                          const Vector<Dim>& wave_vector, const Vector<Dim>& normal) {
  using Complex = std::complex<double>;
  require_in_range(dynamics.M.allFinite());
  const auto omega_squared = dynamics.omega_squared();
  std::array<WaveBranch<Dim>, Dim> waves;
  for (int i = 0; i < Dim; ++i) {
    const Complex value = omega_squared[i], omega = std::sqrt(value);
    const auto same = [&](const Complex& other) { return std::abs(other - value) <= same_branch * std::abs(value); };
    const auto first = std::find_if(omega_squared.begin(), omega_squared.end(), same);
    const int count = static_cast<int>(std::count_if(first, omega_squared.end(), same));
    const Columns<Dim> x = eigenvectors<Dim>(dynamics.M, value, count);
    const Vector<Dim, Complex> polarisation = x.col(i - static_cast<int>(first - omega_squared.begin()));
    waves[i] = {value.imag() != 0.0 ? Branch::coupled : branch_of<Dim>(polarisation, normal),
                value,
                growth_rate_of(value),
                {},
                {}};
    if (omega.real() <= 0.0) continue;
    waves[i].phase_speed = omega.real() / wave_vector.norm();
    const Columns<Dim> y = eigenvectors<Dim>(dynamics.M.transpose(), value, count);
    Vector<Dim> velocity;
    bool one = true;
    for (int j = 0; j < Dim; ++j) {
      const auto slope = eigenvalue_slope<Dim>(x, y, derivatives[j]);
      one = one && slope;
      velocity[j] = (slope.value_or(0.0) / (2.0 * omega)).real();
    }
    if (one) waves[i].group_velocity = velocity;
  }
  return waves;
}

}  // namespace

template <int Dim>
Branch branch_of(const Vector<Dim, std::complex<double>>& polarisation, const Vector<Dim>& wave_vector) {
  const double along = std::abs((wave_vector.transpose() * polarisation).value());
  return 2.0 * along * along >= wave_vector.squaredNorm() * polarisation.squaredNorm() ? Branch::longitudinal
                                                                                       : Branch::transverse;
}

template <int Dim>
LinearWaves<Dim>::LinearWaves(const Problem<Dim>& problem)
    : symbol_(problem), form_(problem, symbol_.consistency()), steps_(problem) {}

template <int Dim>
std::array<WaveBranch<Dim>, Dim> LinearWaves<Dim>::operator()(const Vector<Dim>& wave_vector) const {
  const Vector<Dim> D = symbol_.cleaned(wave_vector);
  const Tensor<Dim> jacobian = symbol_.jacobian(wave_vector), transverse = form_.shear * Tensor<Dim>::Identity();
  require_in_range(D.isZero(0.0) || std::isnormal(form_.transverse(D)));

  const auto wave = [&](Branch branch, const Tensor<Dim>& Q) {
    const Vector<Dim> image = Q * D;
    const double omega_squared = D.isZero(0.0) ? 0.0 : D.dot(image);
    require_in_range(std::isfinite(omega_squared));
    WaveBranch<Dim> result{branch, omega_squared, steps_(omega_squared).continuous_growth_rate(), {}, {}};
    if (omega_squared > 0.0) {
      const double omega = std::sqrt(omega_squared);
      result.phase_speed = omega / wave_vector.norm();
      result.group_velocity = jacobian * image / omega;
    }
    return result;
  };
  std::array<WaveBranch<Dim>, Dim> waves;
  waves.fill(wave(Branch::transverse, transverse));
  waves.back() = wave(Branch::longitudinal, form_.longitudinal());
  std::stable_sort(waves.begin(), waves.end(),
                   [](const auto& a, const auto& b) { return a.omega_squared.real() < b.omega_squared.real(); });
  return waves;
}

template <int Dim>
UpdatedWaves<Dim>::UpdatedWaves(const Problem<Dim>& problem) : scheme_(problem) {
  if (problem.scheme.viscosity)
    throw InvalidInput("viscosity_alpha: there is no dispersion relation with viscosity; matrix and dt take it");
}

template <int Dim>
std::array<WaveBranch<Dim>, Dim> UpdatedWaves<Dim>::operator()(const Vector<Dim>& wave_vector) const {
  using Complex = std::complex<double>;
  std::array<Tensor<Dim>, Dim> derivatives;
  const double step = imaginary_step * scheme_.wave_number_unit();
  for (int j = 0; j < Dim; ++j) {
    Vector<Dim, Complex> k = wave_vector.template cast<Complex>();
    k[j] += Complex(0.0, step);
    derivatives[j] = scheme_(k).dynamical_matrix().imag() / step;
  }
  return branches<Dim>(scheme_(wave_vector).dynamics(), derivatives, wave_vector, wave_vector);
}

template <int Dim>
FiniteStrainWaves<Dim>::FiniteStrainWaves(const Problem<Dim>& problem) : scheme_(problem), steps_(problem) {}

template <int Dim>
std::array<WaveBranch<Dim>, Dim> FiniteStrainWaves<Dim>::operator()(const Vector<Dim>& wave_vector) const {
  auto waves = branches<Dim>(scheme_.dynamics(wave_vector), scheme_.derivatives(wave_vector), wave_vector,
                             scheme_.present_wave_vector(wave_vector));
  for (auto& wave : waves) wave.growth_rate = steps_(wave.omega_squared.real()).continuous_growth_rate();
  return waves;
}

template <int Dim>
DispersionRelation<Dim>::DispersionRelation(const Problem<Dim>& problem)
    : waves_([&]() -> decltype(waves_) {
        switch (problem.scheme.formulation) {
          case Formulation::total_lagrangian_linear:
            return LinearWaves<Dim>(problem);
          case Formulation::total_lagrangian_corotated:
          case Formulation::total_lagrangian_pk1:
            return FiniteStrainWaves<Dim>(problem);
          case Formulation::updated_lagrangian:
            break;
        }
        return UpdatedWaves<Dim>(problem);
      }()) {}

template <int Dim>
std::array<WaveBranch<Dim>, Dim> DispersionRelation<Dim>::operator()(const Vector<Dim>& wave_vector) const {
  return std::visit([&](const auto& waves) { return waves(wave_vector); }, waves_);
}

template class DispersionRelation<1>;
template Branch branch_of(const Vector<1, std::complex<double>>&, const Vector<1>&);
template class DispersionRelation<2>;
template Branch branch_of(const Vector<2, std::complex<double>>&, const Vector<2>&);
template class DispersionRelation<3>;
template Branch branch_of(const Vector<3, std::complex<double>>&, const Vector<3>&);

}  // namespace sphstab::analysis
