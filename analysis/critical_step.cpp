// SPDX-License-Identifier: MIT
#include "analysis/critical_step.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/acoustic_form.hpp"
#include "analysis/finite_strain.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/growth.hpp"
#include "analysis/in_range.hpp"
#include "analysis/irreducible_domain.hpp"
#include "analysis/updated_modes.hpp"
#include "analysis/zone_maximum.hpp"
#include "analysis/zone_scan.hpp"
#include "analysis/zone_zeros.hpp"
#include "model/lattice_index.hpp"

namespace sphstab::analysis {
namespace {

/// The roundings of the factors between ω² and Δt.
constexpr double few_roundings = 8.0 * std::numeric_limits<double>::epsilon();
/// Those of the moduli of finite strain.
constexpr double form_rounding = 32.0 * std::numeric_limits<double>::epsilon();
/// The relative width, of ω², that a search over the zone claims.
constexpr double search_width = 2e-9;

/// Where a maximum lies is known to the root of its rounding: components of k below this part of it are zero.
constexpr double smallest_component = 1e-7;

/// Every index from 0 to counts − 1 on each axis.
template <int Dim>
std::vector<LatticeIndex<Dim>> indices_below(std::string_view key, const LatticeIndex<Dim>& counts) {
  if (counts.minCoeff() < 1)
    throw InvalidInput(
        fmt::format("{}: {} has a count below 1", key, fmt::join(counts.data(), counts.data() + Dim, ",")));
  std::vector<LatticeIndex<Dim>> indices;
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), counts.array() - 1, [&](const auto& n) { indices.push_back(n); });
  return indices;
}

/// Components within this of each other, relative to |b|, count as equal when equivalent wave vectors are ordered.
constexpr double same_component = 1e-9;

template <int Dim>
ZoneMaximum<Dim> scaled(ZoneMaximum<Dim> maximum, double factor) {
  for (double* const value : {&maximum.value, &maximum.lower, &maximum.upper}) *value *= factor;
  return maximum;
}

template <int Dim>
FrequencyRange<Dim> linear_range_over(const Problem<Dim>& problem, const std::vector<Vector<Dim>>& wave_vectors) {
  const GradientSymbol<Dim> symbol(problem);
  const AcousticForm<Dim> form(problem, symbol.consistency());
  FrequencyRange<Dim> range;
  range.highest.wave_vector = wave_vectors.front();
  for (const auto& k : wave_vectors) {
    const Vector<Dim> D = symbol.cleaned(k);
    if (D.isZero(0.0)) continue;
    const double relative_error = symbol.series().rounding() / D.norm();
    const auto visit = [&](Branch branch, double omega_squared) {
      const double width = std::abs(omega_squared) * relative_error * (2.0 + relative_error);
      const double least = omega_squared < 0.0 ? omega_squared - width : std::max(omega_squared - width, 0.0);
      const ExtremeMode<Dim> mode{k, branch, omega_squared, least, omega_squared + width};
      if (omega_squared > range.highest.omega_squared) range.highest = mode;
      if (omega_squared < range.lowest.omega_squared) range.lowest = mode;
    };
    visit(Branch::longitudinal, form.longitudinal(D));
    if (Dim > 1) visit(Branch::transverse, form.transverse(D));
  }
  return range;
}

/// The modes of `scan`; brackets hold the rounding alone.
template <int Dim>
FrequencyRange<Dim> finite_strain_range(const Problem<Dim>& problem, const FiniteStrain<Dim>& scheme,
                                        const ZoneScan<Dim>& scan) {
  const GrowthRange<Dim> found = growth_range(problem, scan);
  const auto extreme = [&](const CriticalMode<Dim>& mode, double omega_squared) {
    const double rounding = scheme.dynamics(mode.wave_vector).rounding;
    return ExtremeMode<Dim>{mode.wave_vector, mode.branch, omega_squared, omega_squared - rounding,
                            omega_squared + rounding};
  };
  FrequencyRange<Dim> range;
  range.highest = extreme(found.stiffest, found.omega_squared_max);
  range.highest.lower = std::max(range.highest.lower, 0.0);
  if (found.growth_rate > 0.0) range.lowest = extreme(found.fastest, -found.growth_rate * found.growth_rate);
  return range;
}

/// ω² = factor |D~|² of each branch.
template <int Dim>
FrequencyRange<Dim> isotropic_range(const IsotropicForm& form, const ZoneMaximum<Dim>& of_symbol,
                                    const Vector<Dim>& wave_vector) {
  FrequencyRange<Dim> range;
  const double rounding = form_rounding * std::max(std::abs(form.longitudinal), std::abs(form.transverse));
  const auto visit = [&](Branch branch, double factor) {
    const double width = std::abs(factor) * (of_symbol.upper - of_symbol.lower) + rounding * of_symbol.upper;
    const double omega_squared = factor * of_symbol.value;
    const ExtremeMode<Dim> mode{wave_vector, branch, omega_squared, omega_squared - width, omega_squared + width};
    if (omega_squared > range.highest.omega_squared) range.highest = mode;
    if (factor < -rounding && omega_squared < range.lowest.omega_squared) range.lowest = mode;
  };
  visit(Branch::longitudinal, form.longitudinal);
  if (Dim > 1) visit(Branch::transverse, form.transverse);
  return range;
}

template <int Dim>
StepLimit<Dim> limit_of(const FrequencyRange<Dim>& range, const ModeSteps& step_of) {
  const auto& lowest = range.lowest;
  const auto& highest = range.highest;
  if (lowest.omega_squared < 0.0) {
    const double rate = step_of(lowest.omega_squared).continuous_growth_rate();
    return NeverStable<Dim>{rate, {lowest.wave_vector, lowest.branch, std::sqrt(-lowest.omega_squared)}};
  }
  const auto limit = step_of(highest.omega_squared).limit();
  if (!limit) return UnconditionallyStable{};
  constexpr double everything = std::numeric_limits<double>::infinity();
  const Bracket bracket{*step_of(highest.upper).limit() * (1.0 - few_roundings),
                        step_of(highest.lower).limit().value_or(everything) * (1.0 + few_roundings)};
  require_in_range(0.0 < bracket.low && bracket.low <= *limit && *limit <= bracket.high);
  return ConditionallyStable<Dim>{
      *limit, bracket, {highest.wave_vector, highest.branch, std::sqrt(highest.omega_squared)}, range.kind};
}

/// The limit over these modes.
template <int Dim>
StepLimit<Dim> limit_over(const Problem<Dim>& problem, const std::vector<Vector<Dim>>& wave_vectors) {
  switch (problem.scheme.formulation) {
    case Formulation::total_lagrangian_linear:
      break;
    case Formulation::total_lagrangian_corotated:
    case Formulation::total_lagrangian_pk1:
      return limit_of(finite_strain_range<Dim>(problem, FiniteStrain<Dim>(problem), ZoneScan<Dim>(wave_vectors)),
                      ModeSteps(problem));
    case Formulation::updated_lagrangian:
      return UpdatedModes<Dim>(problem, wave_vectors).limit();
  }
  return limit_of(linear_range_over(problem, wave_vectors), ModeSteps(problem));
}

}  // namespace

template <int Dim>
BulkModes<Dim>::BulkModes(const Problem<Dim>& problem) : steps_(problem) {
  if (is_finite_strain(problem.scheme.formulation))
    find_finite_strain(problem);
  else
    find_linear(problem);
}

template <int Dim>
void BulkModes<Dim>::find_finite_strain(const Problem<Dim>& problem) {
  const FiniteStrain<Dim> scheme(problem);
  const GradientSymbol<Dim>& symbol = scheme.symbol();
  const BrillouinZone<Dim> zone(problem.lattice);
  const Tensor<Dim> metric = scheme.renormalisation().transpose() * scheme.renormalisation();
  const auto of_symbol = zone_maximum<Dim>(symbol.series(), metric, irreducible_domain(zone, symbol, metric));
  symbol_maximum_ = std::sqrt(of_symbol.value);
  require_in_range(std::isfinite(of_symbol.upper * scheme.moduli().norm()));
  if (const auto& form = scheme.isotropic_form()) {
    range_ = isotropic_range<Dim>(*form, of_symbol, tidy<Dim>(zone, symbol.wave_vector(of_symbol.phases)));
    return;
  }
  const ZoneScan<Dim> scan(problem);
  range_ = finite_strain_range(problem, scheme, scan);
  ExtremeMode<Dim>& highest = range_.highest;
  if (problem.scheme.formulation == Formulation::total_lagrangian_pk1) {
    const auto eigenvalues = [&](const Vector<Dim>& k) { return symmetric_range<Dim>(scheme.dynamics(k).M); };
    constexpr int order = 2;  // M is quadratic in D
    highest.upper = std::max(highest.upper, scan.upper_bound(eigenvalues, order, highest.omega_squared));
  } else {
    range_.kind = BracketKind::searched;
    highest.lower *= 1.0 - search_width;
    highest.upper *= 1.0 + search_width;
  }
}

template <int Dim>
void BulkModes<Dim>::find_linear(const Problem<Dim>& problem) {
  const GradientSymbol<Dim> symbol(problem);
  const AcousticForm<Dim> form(problem, symbol.consistency());
  const Tensor<Dim> Q = form.longitudinal();
  const Vector<Dim> q = Q.template selfadjointView<Eigen::Lower>().eigenvalues();
  const BrillouinZone<Dim> zone(problem.lattice);
  const auto search = [&](const Tensor<Dim>& of_form) {
    return zone_maximum<Dim>(symbol.series(), of_form, irreducible_domain(zone, symbol, of_form));
  };
  const auto of_symbol = search(Tensor<Dim>::Identity());
  symbol_maximum_ = std::sqrt(of_symbol.value);
  require_in_range(std::isfinite(of_symbol.upper * q.cwiseAbs().maxCoeff()));

  const auto maximum = [&](const Tensor<Dim>& of_form) {
    const bool isotropic = of_form == of_form(0, 0) * Tensor<Dim>::Identity() && of_form(0, 0) > 0.0;
    return isotropic ? scaled(of_symbol, of_form(0, 0)) : search(of_form);
  };
  const auto wave_vector = [&](const ZoneMaximum<Dim>& found) {
    return tidy<Dim>(zone, symbol.wave_vector(found.phases));
  };
  const auto raise = [&](Branch branch, const ZoneMaximum<Dim>& found) {
    const ExtremeMode<Dim> before = range_.highest;
    if (found.value > before.omega_squared) range_.highest = {wave_vector(found), branch, found.value, 0.0, 0.0};
    range_.highest.lower = std::max(before.lower, found.lower);
    range_.highest.upper = std::max(before.upper, found.upper);
  };
  if (q.maxCoeff() >= form.shear) raise(Branch::longitudinal, maximum(Q));
  if (Dim > 1 && q.minCoeff() < form.shear) raise(Branch::transverse, maximum(form.shear * Tensor<Dim>::Identity()));
  if (q.minCoeff() < 0.0)
    if (const auto found = search(-Q); found.lower > 0.0)
      range_.lowest = {wave_vector(found), Branch::longitudinal, -found.value, -found.upper, -found.lower};
}

template <int Dim>
StepLimit<Dim> BulkModes<Dim>::limit() const {
  return limit_of(range_, steps_);
}

template <int Dim>
double BulkModes<Dim>::spectral_radius(double time_step) const {
  return std::max(steps_(range_.lowest.omega_squared).spectral_radius(time_step),
                  steps_(range_.highest.omega_squared).spectral_radius(time_step));
}

template <int Dim>
std::optional<double> BulkModes<Dim>::step_for_growth(double growth_per_step) const {
  if (!(growth_per_step >= 0.0))
    throw InvalidInput(fmt::format("tolerated_growth_per_step: {} is negative", growth_per_step));
  if (range_.lowest.omega_squared < 0.0 && growth_per_step == 0.0) return std::nullopt;
  const auto of_lowest = steps_(range_.lowest.omega_squared).limit(growth_per_step);
  const auto of_highest = steps_(range_.highest.omega_squared).limit(growth_per_step);
  if (of_lowest && of_highest) return std::min(*of_lowest, *of_highest);
  return of_lowest ? of_lowest : of_highest;
}

template <int Dim>
StepLimit<Dim> bulk_limit(const Problem<Dim>& problem) {
  if (problem.scheme.formulation == Formulation::updated_lagrangian) return UpdatedModes<Dim>(problem).limit();
  return BulkModes<Dim>(problem).limit();
}

template <int Dim>
StepLimit<Dim> mode_limit(const Problem<Dim>& problem, const Vector<Dim>& wave_vector) {
  return limit_over<Dim>(problem, {wave_vector});
}

template <int Dim>
StepLimit<Dim> paper_limit(const Problem<Dim>& problem, const LatticeIndex<Dim>& box) {
  std::vector<Vector<Dim>> modes;
  for (const auto& n : indices_below<Dim>("box", box))
    modes.push_back(std::numbers::pi / problem.lattice.spacing() *
                    ((n.array() + 1).template cast<double>() / box.array().template cast<double>()).matrix());
  return limit_over<Dim>(problem, modes);
}

template <int Dim>
std::vector<Vector<Dim>> patch_wave_vectors(const Lattice<Dim>& lattice, const LatticeIndex<Dim>& cells) {
  std::vector<Vector<Dim>> wave_vectors;
  for (const auto& n : indices_below<Dim>("patch", cells))
    wave_vectors.push_back(lattice.reciprocal_vectors() *
                           (n.array().template cast<double>() / cells.array().template cast<double>()).matrix());
  return wave_vectors;
}

template <int Dim>
StepLimit<Dim> patch_limit(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  return limit_over<Dim>(problem, patch_wave_vectors<Dim>(problem.lattice, cells));
}

template <int Dim>
std::optional<double> published_bound(const Problem<Dim>& problem) {
  const double slope = std::abs(problem.kernel.slope(problem.lattice.spacing()));
  if (problem.scheme.formulation != Formulation::total_lagrangian_linear ||
      problem.lattice.kind() != LatticeKind::square || slope == 0.0)
    return std::nullopt;
  const LameConstants lame = problem.material.lame(problem.plane);
  const double zhang_G = 2.0 * lame.shear_modulus, rho = problem.material.density();
  return std::sqrt(rho / (2.0 * lame.lambda + 3.0 * zhang_G)) / (problem.lattice.cell_volume() * slope);
}

template <int Dim>
ZeroEnergyModes<Dim> zero_energy_modes(const Problem<Dim>& problem) {
  const GradientSymbol<Dim> symbol(problem);
  const BrillouinZone<Dim> zone(problem.lattice);
  const auto zeros = zone_zeros(symbol.series(), irreducible_domain<Dim>(zone, symbol, Tensor<Dim>::Identity()));
  ZeroEnergyModes<Dim> modes{{}, zeros.complete};
  for (const auto& phases : zeros.phases) modes.wave_vectors.push_back(tidy<Dim>(zone, symbol.wave_vector(phases)));
  const double tolerance = same_component * problem.lattice.reciprocal_vectors().norm();
  std::sort(modes.wave_vectors.begin(), modes.wave_vectors.end(),
            [&](const Vector<Dim>& left, const Vector<Dim>& right) {
              double difference = left.norm() - right.norm();
              for (int axis = 0; axis < Dim && std::abs(difference) <= tolerance; ++axis)
                difference = left[axis] - right[axis];
              return difference < 0.0;
            });
  return modes;
}

template <int Dim>
Vector<Dim> tidy(const BrillouinZone<Dim>& zone, const Vector<Dim>& wave_vector) {
  const Vector<Dim> k = zone.in_first_zone(wave_vector);
  return (k.array().abs() > smallest_component * k.norm()).select(k, 0.0);
}

template class BulkModes<1>;
template StepLimit<1> bulk_limit(const Problem<1>&);
template StepLimit<1> mode_limit(const Problem<1>&, const Vector<1>&);
template StepLimit<1> paper_limit(const Problem<1>&, const LatticeIndex<1>&);
template std::vector<Vector<1>> patch_wave_vectors(const Lattice<1>&, const LatticeIndex<1>&);
template StepLimit<1> patch_limit(const Problem<1>&, const LatticeIndex<1>&);
template std::optional<double> published_bound(const Problem<1>&);
template ZeroEnergyModes<1> zero_energy_modes(const Problem<1>&);
template Vector<1> tidy(const BrillouinZone<1>&, const Vector<1>&);
template class BulkModes<2>;
template StepLimit<2> bulk_limit(const Problem<2>&);
template StepLimit<2> mode_limit(const Problem<2>&, const Vector<2>&);
template StepLimit<2> paper_limit(const Problem<2>&, const LatticeIndex<2>&);
template std::vector<Vector<2>> patch_wave_vectors(const Lattice<2>&, const LatticeIndex<2>&);
template StepLimit<2> patch_limit(const Problem<2>&, const LatticeIndex<2>&);
template std::optional<double> published_bound(const Problem<2>&);
template ZeroEnergyModes<2> zero_energy_modes(const Problem<2>&);
template Vector<2> tidy(const BrillouinZone<2>&, const Vector<2>&);
template class BulkModes<3>;
template StepLimit<3> bulk_limit(const Problem<3>&);
template StepLimit<3> mode_limit(const Problem<3>&, const Vector<3>&);
template StepLimit<3> paper_limit(const Problem<3>&, const LatticeIndex<3>&);
template std::vector<Vector<3>> patch_wave_vectors(const Lattice<3>&, const LatticeIndex<3>&);
template StepLimit<3> patch_limit(const Problem<3>&, const LatticeIndex<3>&);
template std::optional<double> published_bound(const Problem<3>&);
template ZeroEnergyModes<3> zero_energy_modes(const Problem<3>&);
template Vector<3> tidy(const BrillouinZone<3>&, const Vector<3>&);

}  // namespace sphstab::analysis
