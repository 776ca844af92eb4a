// SPDX-License-Identifier: MIT
#include "analysis/updated_lagrangian.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace sphstab::analysis {
namespace {

/// Roundings that the sums and products behind an entry of M carry, a few a neighbour.
constexpr double roundings = 32.0 * std::numeric_limits<double>::epsilon();
/// A principal stress below this part of the stress is a rounding of zero.
constexpr double few_roundings = 8.0 * std::numeric_limits<double>::epsilon();

template <int Dim>
Tensor<Dim> stress_of(const Problem<Dim>& problem) {
  return problem.deviatoric_stress - problem.pressure * Tensor<Dim>::Identity();
}

template <int Dim>
double density_of(const Problem<Dim>& problem) {
  const double rho0 = problem.material.density();
  return rho0 + problem.pressure * rho0 / problem.material.bulk_modulus();
}

/// Principal axes of σ and what the artificial stress takes of its principal stresses.
template <int Dim>
class PrincipalStress {
 public:
  PrincipalStress(const Tensor<Dim>& stress, ZeroStressSide zero_side) {
    const Eigen::SelfAdjointEigenSolver<Tensor<Dim>> solver(stress);
    axes_ = solver.eigenvectors();
    values_ = solver.eigenvalues();
    const double noise = few_roundings * stress.cwiseAbs().maxCoeff();
    values_ = (values_.array().abs() <= noise).select(0.0, values_);
    const auto is_tensile = [=](double value) {
      return value > 0.0 || (value == 0.0 && zero_side == ZeroStressSide::tension);
    };
    for (int i = 0; i < Dim; ++i) tensile_[i] = is_tensile(values_[i]);
  }

  bool has_zero() const { return (values_.array() == 0.0).any(); }

  /// σ₊.
  Tensor<Dim> positive_part() const { return axes_ * values_.cwiseMax(0.0).asDiagonal() * axes_.transpose(); }

  /// P₊'[δσ].
  Tensor<Dim> positive_part_derivative(const Tensor<Dim>& change) const {
    Tensor<Dim> in_axes = axes_.transpose() * change * axes_;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) in_axes(i, j) *= share(i, j);
    return axes_ * in_axes * axes_.transpose();
  }

 private:
  /// (σ_i₊ − σ_j₊)/(σ_i − σ_j).
  double share(int i, int j) const {
    if (tensile_[i] == tensile_[j]) return tensile_[i] ? 1.0 : 0.0;
    const double tension = std::abs(tensile_[i] ? values_[i] : values_[j]);
    const double compression = std::abs(tensile_[i] ? values_[j] : values_[i]);
    return tension == 0.0 ? 0.0 : tension / (tension + compression);
  }

  Tensor<Dim> axes_;
  Vector<Dim> values_;
  Directions<Dim> tensile_;
};

}  // namespace

template <int Dim>
UpdatedLagrangian<Dim>::UpdatedLagrangian(const Problem<Dim>& problem)
    : sums_(problem.lattice, problem.kernel, problem.neighbour_rule, problem.scheme.artificial_stress,
            problem.scheme.viscosity),
      wave_number_unit_(1.0 / problem.lattice.spacing()),
      epsilon_(problem.scheme.artificial_stress ? problem.scheme.artificial_stress->epsilon : 0.0),
      xsph_(problem.scheme.xsph ? problem.scheme.xsph->epsilon : 0.0),
      shear_modulus_(problem.material.shear_modulus()),
      density_(density_of(problem)),
      stress_(stress_of(problem)),
      deviatoric_(problem.deviatoric_stress),
      artificial_(Tensor<Dim>::Zero()) {
  const double square_of_c0 = problem.material.bulk_modulus() / problem.material.density();
  const double rho = density_, rho_squared = rho * rho;
  if (problem.scheme.viscosity && problem.scheme.viscosity->pairs == ViscousPairs::approaching)
    throw InvalidInput(
        "viscosity_pairs: approaching has no linear theory, a force that acts on one side of rest alone; half of "
        "viscosity_alpha on all pairs damps small waves alike");
  friction_ = problem.scheme.viscosity
                  ? problem.scheme.viscosity->alpha * problem.kernel.smoothing_length() * std::sqrt(square_of_c0)
                  : 0.0;

  std::array<Tensor<Dim>, rates> stress_change;  // ∂σ/∂q
  stress_change[0] = -square_of_c0 * Tensor<Dim>::Identity();
  for (int c = 1; c < rates; ++c)
    stress_change[c] = symmetric_tensor<Dim, double>(Vector<symmetric_size<Dim>>::Unit(c - 1));
  for (int c = 0; c < rates; ++c) stress_by_state_[c] = stress_change[c] / rho_squared;
  stress_by_state_[0] -= 2.0 / (rho * rho_squared) * stress_;

  artificial_by_state_.fill(Tensor<Dim>::Zero());
  largest_geometric_ = 2.0 / rho * stress_.norm() * sums_.largest_B();
  stiffness_ = problem.material.p_wave_modulus() / rho * sums_.largest_A();
  if (!problem.scheme.artificial_stress) return;
  if (!has_weight(problem.kernel, problem.lattice.spacing(), problem.scheme.artificial_stress->weight))
    throw InvalidInput(
        "artificial_stress_weight: kernel-ratio divides by W(spacing), which is 0 with this smoothing "
        "length; distance-ratio does not");
  const PrincipalStress<Dim> principal(stress_, problem.scheme.artificial_stress->zero_side);
  artificial_ = -epsilon_ / rho_squared * principal.positive_part();
  largest_geometric_ += 2.0 * rho * artificial_.norm() * sums_.largest_f();
  if (problem.scheme.artificial_stress->linearisation == ArtificialStressLinearisation::frozen) return;
  for (int c = 0; c < rates; ++c)
    artificial_by_state_[c] = -epsilon_ / rho_squared * principal.positive_part_derivative(stress_change[c]);
  artificial_by_state_[0] -= 2.0 / rho * artificial_;
}

template <int Dim>
template <class Scalar>
UpdatedWave<Dim, Scalar> UpdatedLagrangian<Dim>::wave(const Vector<Dim, Scalar>& wave_vector) const {
  using Square = Tensor<Dim, Scalar>;
  const auto sums = sums_(wave_vector);
  const Vector<Dim, Scalar>& A = sums.A;
  const double rho = density_, mu = shear_modulus_;
  UpdatedWave<Dim, Scalar> wave;
  wave.smoothing = 1.0 - xsph_ * sums.beta_sum;
  wave.of_position = 2.0 / rho * (stress_ * sums.B) + 2.0 * rho * (artificial_ * sums.f);
  wave.of_velocity = friction_ * sums.Gamma;
  for (int c = 0; c < rates; ++c)
    wave.of_state.col(c) = -rho * (stress_by_state_[c] * A + artificial_by_state_[c] * sums.A_phi);

  for (int axis = 0; axis < Dim; ++axis) {
    const Vector<Dim, Scalar> v = Vector<Dim, Scalar>::Unit(axis);
    const Square gradient = A * v.transpose();
    const Square strain = 0.5 * (gradient + gradient.transpose()), w = 0.5 * (gradient.transpose() - gradient);
    const Square stress_rate =
        2.0 * mu * (strain - strain.trace() / 3.0 * Square::Identity()) + w * deviatoric_ - deviatoric_ * w;
    wave.state_rate(0, axis) = wave.smoothing * rho * A[axis];
    wave.state_rate.col(axis).template tail<symmetric_size<Dim>>() =
        -wave.smoothing * symmetric_components<Dim, Scalar>(stress_rate);
  }
  wave.rounding = roundings * std::abs(wave.smoothing) * (largest_geometric_ + stiffness_ * A.norm());
  return wave;
}

template <int Dim>
UpdatedWave<Dim> UpdatedLagrangian<Dim>::operator()(const Vector<Dim>& wave_vector) const {
  return wave(wave_vector);
}

template <int Dim>
UpdatedWave<Dim, std::complex<double>> UpdatedLagrangian<Dim>::operator()(
    const Vector<Dim, std::complex<double>>& wave_vector) const {
  return wave(wave_vector);
}

template <int Dim>
double UpdatedLagrangian<Dim>::tension_modulus_factor() const {
  return epsilon_ == 0.0 ? 1.0 : 1.0 - epsilon_ * sums_.long_wave_weight();
}

template <int Dim>
Tensor<Dim> continuum_matrix(const Problem<Dim>& problem, const Vector<Dim>& k) {
  const Tensor<Dim> unity = Tensor<Dim>::Identity(), along = k * k.transpose(), &S = problem.deviatoric_stress;
  const double square_of_c0 = problem.material.bulk_modulus() / problem.material.density();
  const double rho = density_of(problem), square = k.squaredNorm();
  const Tensor<Dim> of_shear = square * unity + along / 3.0;
  const Tensor<Dim> of_spin = 0.5 * (k.dot(S * k) * unity - along * S - square * S + S * along);
  return square_of_c0 * along + (problem.material.shear_modulus() * of_shear + of_spin) / rho;
}

template <int Dim>
bool has_one_sided_states(const Problem<Dim>& problem) {
  const auto& artificial = problem.scheme.artificial_stress;
  if (!artificial || artificial->linearisation == ArtificialStressLinearisation::frozen) return false;
  return PrincipalStress<Dim>(stress_of(problem), artificial->zero_side).has_zero();
}

template class UpdatedLagrangian<1>;
template Tensor<1> continuum_matrix(const Problem<1>&, const Vector<1>&);
template bool has_one_sided_states(const Problem<1>&);
template class UpdatedLagrangian<2>;
template Tensor<2> continuum_matrix(const Problem<2>&, const Vector<2>&);
template bool has_one_sided_states(const Problem<2>&);
template class UpdatedLagrangian<3>;
template Tensor<3> continuum_matrix(const Problem<3>&, const Vector<3>&);
template bool has_one_sided_states(const Problem<3>&);

}  // namespace sphstab::analysis
