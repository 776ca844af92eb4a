// SPDX-License-Identifier: MIT
#include "analysis/updated_modes.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/dispersion.hpp"
#include "analysis/step_matrix.hpp"

namespace sphstab::analysis {
namespace {

constexpr double few_roundings = 8.0 * std::numeric_limits<double>::epsilon();
/// A rate below this part of the frequency of its mode is what an eigensolver makes of a double root 0.
constexpr double solver_noise = 1e-7;
/// A coefficient of growth below this, in units of the largest frequency, is rounding.
constexpr double coefficient_noise = 1e-12;
/// Frequencies this close, relative to the largest, count as equal.
constexpr double same_frequency = 1e-9;
/// Steps looked at before the first exit of one mode is bisected: growth of a mode can end and come back.
constexpr int exit_samples = 8;
/// Where the first exit of a mode, and the search over modes, end; and the width that the search claims.
constexpr double exit_tolerance = 1e-13;
constexpr double search_tolerance = 1e-11;
constexpr double search_width = 1e-9;
constexpr int most_rounds = 40;
/// So far beyond its exit, relative, an eigenvalue is the largest of its mode.
constexpr double beyond_exit = 1e-6;
/// Exits beyond this times that of the stiffest mode are not told apart.
constexpr double cap_margin = 1.1;
/// Rates below this, in units of c_p/Δp, are roundings of zero: nothing moves.
constexpr double no_rate = 1e-12;

/// The block of E that moves (v, f), f = R r + Q q the force of positions and stresses, and any stored rates: what
/// positions and stresses without force add is eigenvalues 1. q and f are in one unit, Q = u I, and E' = T E T⁻¹ with
/// f in place of q has zeros where r would act on it.
template <int Dim>
auto moving_block(const UpdatedWave<Dim>& wave, Integrator integrator, double time_step) {
  const auto motion = reduced_motion(wave);
  auto E = step_matrix(motion, integrator, time_step);
  const Tensor<Dim> force_of_position = motion.of_position / motion.position_unit;
  E.middleRows(2 * Dim, Dim) += force_of_position * E.topRows(Dim);
  const auto size = E.rows() - Dim;
  using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4 * Dim, 4 * Dim>;
  return Block(E.bottomRightCorner(size, size));
}

/// What moves in the eigenvector of a matrix whose eigenvalue has the largest `size`: its first components.
template <int Dim, class Matrix, class Size>
Vector<Dim, std::complex<double>> leading_motion(const Matrix& matrix, const Size& size) {
  const Eigen::EigenSolver<Matrix> solver(matrix);
  int leading = 0;
  for (int i = 1; i < matrix.rows(); ++i)
    if (size(solver.eigenvalues()[i]) > size(solver.eigenvalues()[leading])) leading = i;
  return solver.eigenvectors().col(leading).template head<Dim>();
}

/// The part of each ω² that belongs to `part` of M, xᵀ part y / xᵀ y of its left and right eigenvectors, by the
/// projection on the eigenvector; of equal ω² their mean.
template <int Dim>
Vector<Dim> shares(const Tensor<Dim>& M, const Tensor<Dim>& part, const Vector<Dim>& omega_squared) {
  const double same = same_frequency * omega_squared.cwiseAbs().maxCoeff();
  Vector<Dim> result;
  for (int i = 0; i < Dim; ++i) {
    Tensor<Dim> projection = Tensor<Dim>::Identity();
    int equal = 1;
    for (int j = 0; j < Dim; ++j) {
      if (j == i) continue;
      const double gap = omega_squared[i] - omega_squared[j];
      if (std::abs(gap) <= same)
        ++equal;
      else
        projection = projection * (M - omega_squared[j] * Tensor<Dim>::Identity()) / gap;
    }
    result[i] = (projection * part).trace() / equal;
  }
  return result;
}

bool is_kick(Integrator integrator) { return integrator == Integrator::leapfrog || integrator == Integrator::verlet; }

}  // namespace

template <int Dim>
UpdatedModes<Dim>::UpdatedModes(const Problem<Dim>& problem) : UpdatedModes(problem, ZoneScan<Dim>(problem)) {}

template <int Dim>
UpdatedModes<Dim>::UpdatedModes(const Problem<Dim>& problem, std::vector<Vector<Dim>> wave_vectors)
    : UpdatedModes(problem, ZoneScan<Dim>(std::move(wave_vectors))) {}

template <int Dim>
UpdatedModes<Dim>::UpdatedModes(const Problem<Dim>& problem, ZoneScan<Dim> scan)
    : problem_(problem), scheme_(problem), scan_(std::move(scan)), range_(growth_range(problem, scan_)) {}

template <int Dim>
bool UpdatedModes<Dim>::inviscid_kicks() const {
  return !problem_.scheme.viscosity && is_kick(problem_.integrator);
}

template <int Dim>
double UpdatedModes<Dim>::radius(const Vector<Dim>& wave_vector, double time_step) const {
  const UpdatedWave<Dim> wave = scheme_(wave_vector);
  double radius = 0.0;
  if (!inviscid_kicks()) {
    const auto block = moving_block(wave, problem_.integrator, time_step);
    return Eigen::EigenSolver<std::remove_const_t<decltype(block)>>(block, false).eigenvalues().cwiseAbs().maxCoeff();
  }
  // λ + 1/λ = 2 − z.
  for (const auto omega_squared : squared_frequencies<Dim>(wave.dynamical_matrix(), wave.rounding)) {
    const std::complex<double> z = omega_squared * (time_step * time_step);
    const bool neutral = z.imag() == 0.0 && z.real() >= 0.0 && z.real() <= 4.0;
    const std::complex<double> root = std::sqrt(z * (0.25 * z - 1.0)), mean = 1.0 - 0.5 * z;
    radius = std::max(radius, neutral ? 1.0 : std::max(std::abs(mean + root), std::abs(mean - root)));
  }
  return radius;
}

template <int Dim>
Eigen::Matrix<double, 2 * Dim, 2 * Dim> UpdatedModes<Dim>::generator(const Vector<Dim>& wave_vector) const {
  const UpdatedWave<Dim> wave = scheme_(wave_vector);
  const Tensor<Dim> M = wave.dynamical_matrix();
  const double unit = std::sqrt(M.norm());
  Eigen::Matrix<double, 2 * Dim, 2 * Dim> generator = Eigen::Matrix<double, 2 * Dim, 2 * Dim>::Zero();
  if (unit * unit > wave.rounding)
    generator << Tensor<Dim>::Zero(), unit * Tensor<Dim>::Identity(), -M / unit, wave.of_velocity;
  return generator;
}

template <int Dim>
double UpdatedModes<Dim>::damped_growth(const Vector<Dim>& wave_vector) const {
  const auto matrix = generator(wave_vector);
  const double rate = Eigen::EigenSolver<std::decay_t<decltype(matrix)>>(matrix, false).eigenvalues().real().maxCoeff();
  return rate <= solver_noise * matrix(0, Dim) + few_roundings * matrix.norm() ? 0.0 : rate;
}

template <int Dim>
std::optional<NeverStable<Dim>> UpdatedModes<Dim>::continuous_growth() const {
  if (!problem_.scheme.viscosity) {
    if (range_.growth_rate == 0.0) return std::nullopt;
    return NeverStable<Dim>{range_.growth_rate, range_.fastest};
  }
  const auto fastest = scan_.maximum([&](const Vector<Dim>& k) { return damped_growth(k); });
  if (!(fastest.value > 0.0)) return std::nullopt;
  const Vector<Dim, std::complex<double>> motion =
      leading_motion<Dim>(generator(fastest.wave_vector), [](std::complex<double> rate) { return rate.real(); });
  CriticalMode<Dim> mode = mode_of(fastest.wave_vector, motion);
  mode.omega = fastest.value;
  return NeverStable<Dim>{fastest.value, mode};
}

template <int Dim>
StepLimit<Dim> UpdatedModes<Dim>::frequency_limit() const {
  const double highest = range_.omega_squared_max;
  if (highest == 0.0) return UnconditionallyStable{};
  const int order = problem_.scheme.xsph ? 3 : 2;
  const auto eigenvalues = [&](const Vector<Dim>& k) { return symmetric_range<Dim>(scheme_(k).dynamical_matrix()); };
  const double upper = std::max(highest, scan_.upper_bound(eigenvalues, order, highest));
  const double rounding = few_roundings + scheme_(range_.stiffest.wave_vector).rounding / highest;
  const auto step = [](double omega_squared) { return 2.0 / std::sqrt(omega_squared); };
  return ConditionallyStable<Dim>{
      step(highest), {step(upper) * (1.0 - rounding), step(highest) * (1.0 + rounding)}, range_.stiffest};
}

template <int Dim>
std::optional<WeaklyUnstable<Dim>> UpdatedModes<Dim>::weak_growth() const {
  const bool stressed = problem_.pressure != 0.0 || !problem_.deviatoric_stress.isZero(0.0);
  const bool second_order = stressed && problem_.scheme.xsph;
  const double part = problem_.integrator == Integrator::predictor_corrector ? 0.125 : 0.25;
  const auto coefficient = [&](const Vector<Dim>& k) {
    const UpdatedWave<Dim> wave = scheme_(k);
    const Tensor<Dim> M = wave.dynamical_matrix();
    const Vector<Dim> omega_squared = squared_frequencies<Dim>(M, wave.rounding).real();
    const Vector<Dim> geometric = shares<Dim>(M, wave.geometric_matrix(), omega_squared);
    double largest = 0.0;
    for (int i = 0; i < Dim; ++i) {
      if (omega_squared[i] <= 0.0) continue;
      const double growth = second_order ? 0.25 * (1.0 - 1.0 / wave.smoothing) * geometric[i]
                                         : part * omega_squared[i] * (omega_squared[i] - geometric[i]);
      largest = std::max(largest, growth);
    }
    return largest;
  };
  const int exponent = second_order ? 2 : 4;
  const auto fastest = scan_.maximum(coefficient);
  if (!(fastest.value > coefficient_noise * std::pow(range_.stiffest.omega, exponent))) return std::nullopt;
  return WeaklyUnstable<Dim>{fastest.value, exponent, stiffest_at(fastest.wave_vector)};
}

template <int Dim>
CriticalMode<Dim> UpdatedModes<Dim>::stiffest_at(const Vector<Dim>& wave_vector) const {
  Problem<Dim> inviscid = problem_;
  inviscid.scheme.viscosity.reset();
  const Vector<Dim> k = tidy<Dim>(BrillouinZone<Dim>(problem_.lattice), wave_vector);
  const auto stiffest = DispersionRelation<Dim>(inviscid)(k).back();
  return {k, stiffest.branch, std::sqrt(std::max(stiffest.omega_squared.real(), 0.0))};
}

template <int Dim>
CriticalMode<Dim> UpdatedModes<Dim>::mode_of(const Vector<Dim>& wave_vector,
                                             const Vector<Dim, std::complex<double>>& motion) const {
  const Vector<Dim> k = tidy<Dim>(BrillouinZone<Dim>(problem_.lattice), wave_vector);
  const double omega_squared =
      motion.dot(scheme_(wave_vector).dynamical_matrix() * motion).real() / motion.squaredNorm();
  return {k, branch_of<Dim>(motion, k), std::sqrt(std::max(omega_squared, 0.0))};
}

template <int Dim>
std::optional<double> UpdatedModes<Dim>::exit(const Vector<Dim>& wave_vector, double threshold, double cap) const {
  const auto grows = [&](double time_step) { return radius(wave_vector, time_step) > 1.0 + threshold; };
  double low = 0.0, high = 0.0;
  for (int i = 1; i <= exit_samples && high == 0.0; ++i) {
    const double sample = cap * i / exit_samples;
    (grows(sample) ? high : low) = sample;
  }
  if (high == 0.0) return std::nullopt;
  while (high - low > exit_tolerance * high) {
    const double middle = 0.5 * (low + high);
    (grows(middle) ? high : low) = middle;
  }
  return high;
}

template <int Dim>
std::optional<ZonePoint<Dim>> UpdatedModes<Dim>::first_exit(double threshold) const {
  double fastest_rate = 0.0;
  for (const auto& k : scan_.points()) {
    const UpdatedWave<Dim> wave = scheme_(k);
    fastest_rate = std::max({fastest_rate, std::sqrt(wave.dynamical_matrix().norm()), wave.of_velocity.norm()});
  }
  const Material& material = problem_.material;
  const double rate_unit = std::sqrt(material.p_wave_modulus() / material.density()) / problem_.lattice.spacing();
  if (fastest_rate <= no_rate * rate_unit) return std::nullopt;
  // Every explicit step grows beyond some multiple of the shortest time.
  double cap = 1.0 / fastest_rate;
  std::optional<ZonePoint<Dim>> sampled;
  while (!sampled) {
    cap *= 2.0;
    const auto minus_exit = [&](const Vector<Dim>& k) { return -exit(k, threshold, cap).value_or(cap); };
    if (const auto of_stiffest = exit(range_.stiffest.wave_vector, threshold, cap)) cap = cap_margin * *of_stiffest;
    const auto least = scan_.maximum(minus_exit);
    if (-least.value < cap) sampled = ZonePoint<Dim>{least.wave_vector, -least.value};
  }
  ZonePoint<Dim> first = *sampled;
  for (int round = 0; round < most_rounds; ++round) {
    const double before = first.value;
    const auto fastest = scan_.maximum([&](const Vector<Dim>& k) { return radius(k, before); });
    if (fastest.value > 1.0 + threshold)
      if (const auto step = exit(fastest.wave_vector, threshold, before)) first = {fastest.wave_vector, *step};
    if (first.value > before * (1.0 - search_tolerance)) break;
  }
  return first;
}

template <int Dim>
StepLimit<Dim> UpdatedModes<Dim>::limit() const {
  if (const auto growing = continuous_growth()) return *growing;
  if (inviscid_kicks()) return frequency_limit();
  if (!problem_.scheme.viscosity)
    if (const auto weak = weak_growth()) return *weak;
  const auto first = first_exit(negligible_growth_per_step);
  if (!first) return UnconditionallyStable{};
  const Vector<Dim, std::complex<double>> motion = leading_motion<Dim>(
      moving_block(scheme_(first->wave_vector), problem_.integrator, first->value * (1.0 + beyond_exit)),
      [](std::complex<double> eigenvalue) { return std::abs(eigenvalue); });
  return ConditionallyStable<Dim>{first->value,
                                  {first->value * (1.0 - search_width), first->value * (1.0 + search_width)},
                                  mode_of(first->wave_vector, motion),
                                  BracketKind::searched};
}

template <int Dim>
double UpdatedModes<Dim>::spectral_radius(double time_step) const {
  return std::max(1.0, scan_.maximum([&](const Vector<Dim>& k) { return radius(k, time_step); }).value);
}

template <int Dim>
std::optional<double> UpdatedModes<Dim>::step_for_growth(double growth_per_step) const {
  if (!(growth_per_step >= 0.0))
    throw InvalidInput(fmt::format("tolerated_growth_per_step: {} is negative", growth_per_step));
  if (growth_per_step <= negligible_growth_per_step) {
    const auto found = limit();
    const auto* const stable = std::get_if<ConditionallyStable<Dim>>(&found);
    return stable ? std::optional(stable->critical_time_step) : std::nullopt;
  }
  const auto first = first_exit(growth_per_step);
  return first ? std::optional(first->value) : std::nullopt;
}

template class UpdatedModes<1>;
template class UpdatedModes<2>;
template class UpdatedModes<3>;

}  // namespace sphstab::analysis
