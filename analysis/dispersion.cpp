// SPDX-License-Identifier: MIT
#include "analysis/dispersion.hpp"

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

/// A unit vector of the null space of M − λ I: the right singular vector of the smallest singular value.
template <int Dim>
Vector<Dim, std::complex<double>> eigenvector(const Tensor<Dim>& M, std::complex<double> eigenvalue) {
  using Complex = std::complex<double>;
  const Tensor<Dim, Complex> shifted = M.template cast<Complex>() - eigenvalue * Tensor<Dim, Complex>::Identity();
  return Eigen::JacobiSVD<Tensor<Dim, Complex>>(shifted, Eigen::ComputeFullV).matrixV().col(Dim - 1);
}

template <int Dim>
bool is_multiple(const Vector<Dim, std::complex<double>>& values, int i) {
  for (int j = 0; j < Dim; ++j)
    if (j != i && std::abs(values[j] - values[i]) <= same_branch * std::abs(values[i])) return true;
  return false;
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
  const UpdatedWave<Dim> wave = scheme_(wave_vector);
  const Tensor<Dim> M = wave.dynamical_matrix();
  require_in_range(M.allFinite());
  const auto omega_squared = squared_frequencies<Dim>(M, wave.rounding);

  std::array<Tensor<Dim>, Dim> derivative;  // ∂M/∂k_j
  const double step = imaginary_step * scheme_.wave_number_unit();
  for (int j = 0; j < Dim; ++j) {
    Vector<Dim, Complex> k = wave_vector.template cast<Complex>();
    k[j] += Complex(0.0, step);
    derivative[j] = scheme_(k).dynamical_matrix().imag() / step;
  }
  std::array<WaveBranch<Dim>, Dim> waves;
  for (int i = 0; i < Dim; ++i) {
    const Complex value = omega_squared[i], omega = std::sqrt(value);
    const auto x = eigenvector<Dim>(M, value), y = eigenvector<Dim>(M.transpose(), value);
    waves[i] = {
        value.imag() != 0.0 ? Branch::coupled : branch_of<Dim>(x, wave_vector), value, growth_rate_of(value), {}, {}};
    if (omega.real() <= 0.0) continue;
    waves[i].phase_speed = omega.real() / wave_vector.norm();
    const Complex overlap = (y.transpose() * x).value();
    if (std::abs(overlap) < least_overlap || is_multiple<Dim>(omega_squared, i)) continue;
    Vector<Dim> velocity;
    for (int j = 0; j < Dim; ++j)
      velocity[j] = ((y.transpose() * derivative[j] * x).value() / (2.0 * omega * overlap)).real();
    waves[i].group_velocity = velocity;
  }
  return waves;
}

template <int Dim>
DispersionRelation<Dim>::DispersionRelation(const Problem<Dim>& problem)
    : waves_([&]() -> std::variant<LinearWaves<Dim>, UpdatedWaves<Dim>> {
        switch (problem.scheme.formulation) {
          case Formulation::total_lagrangian_linear:
            return LinearWaves<Dim>(problem);
          case Formulation::total_lagrangian_corotated:
          case Formulation::total_lagrangian_pk1:
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
