// SPDX-License-Identifier: MIT
#include "study/step_comparison.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "analysis/spectrum.hpp"
#include "analysis/updated_lagrangian.hpp"
#include "study/growth_run.hpp"
#include "study/p_wave_speed.hpp"
#include "study/patch_wave.hpp"
#include "study/updated_growth_run.hpp"

namespace sphstab::study {
namespace {

/// No kernel or lattice has its limit below 1.4 h/c_p in bulk (theory.md §6), and normalised edges lower it to 0.6 of
/// that. The limit of damping alone is 2 over its rate.
constexpr double start_fraction = 0.3;
/// Where theory says that nothing limits the step of `ul`, it is believed after runs up to this many first steps: at
/// ever longer ones rounding of the forces would tear the patch.
constexpr double farthest_over_start = 100.0;
/// The step at which weak growth shows, in units of 1/ω: half of what the leapfrog bears.
constexpr double weak_growth_step = 1.0;
/// A run that measures growth may last this many horizons of five e-foldings, so that the fastest mode is alone
/// (study/perturbation_run.cpp).
constexpr long growth_horizons = 80;
/// Weaker stresses, in ρ c0², drive so slowly that the rounding of the forces matters; and a principal stress must be
/// out of reach of the departures of a run, where artificial stress has a kink.
constexpr double weakest_stress = 1e-7, weakest_principal_stress = 1e-5;
/// The critical mode is that which grows at this multiple of the limit.
constexpr double beyond_limit = 1.01;

InvalidInput no_critical_mode() { return InvalidInput("seed: there is no critical mode to start from; use noise"); }

template <int Dim>
Body<Dim> make_body(const Problem<Dim>& problem, const BodyChoice<Dim>& choice) {
  if (const auto* patch = std::get_if<PeriodicPatch<Dim>>(&choice)) return periodic_patch(problem, patch->cells);
  return std::get<Body<Dim>>(choice);
}

template <int Dim>
std::optional<double> step_of(const analysis::StepLimit<Dim>& limit) {
  if (const auto* stable = std::get_if<analysis::ConditionallyStable<Dim>>(&limit)) return stable->critical_time_step;
  return std::nullopt;
}

/// Runs twice at one step, the second time from the fastest mode of the first.
StepComparison compare_growth(const GrowthProbe& run, const TheoryLimit& theory, double growth_per_step,
                              std::optional<long> horizon) {
  const double time_step = *theory.growing_step;
  const long steps = horizon.value_or(growth_horizons * horizon_for_growth(growth_per_step));
  const auto first = run(time_step, steps), fit = run(time_step, steps);
  const bool grows = fit.trend == solver::Trend::growing;
  return {.run = {.critical_time_step = std::nullopt,
                  .low = grows ? 0.0 : time_step,
                  .high = grows ? time_step : std::numeric_limits<double>::infinity(),
                  .horizon = steps,
                  .runs = 2,
                  .steps = first.steps + fit.steps,
                  .smallest_detectable = fit.smallest_detectable},
          .theory = theory,
          .bulk_theory = std::nullopt,
          .growth = GrowthComparison{time_step, fit.growth_per_step, growth_per_step}};
}

/// The smallest and the largest |σ_i| of the base state of `ul`, in ρ0 c0².
template <int Dim>
std::pair<double, double> principal_stresses(const Problem<Dim>& problem) {
  const Tensor<Dim> stress = problem.deviatoric_stress - problem.pressure * Tensor<Dim>::Identity();
  const auto size = Eigen::SelfAdjointEigenSolver<Tensor<Dim>>(stress).eigenvalues().cwiseAbs().eval();
  return {size.minCoeff() / problem.material.bulk_modulus(), size.maxCoeff() / problem.material.bulk_modulus()};
}

template <int Dim>
void require_comparable(const Problem<Dim>& problem, const BodyChoice<Dim>& choice) {
  const bool is_body = std::holds_alternative<Body<Dim>>(choice);
  if (is_body && !problem.displacement_gradient.isZero())
    throw InvalidInput("displacement_gradient: a body takes none, it would not be in equilibrium");
  if (problem.scheme.formulation != Formulation::updated_lagrangian) return;
  if (is_body)
    throw InvalidInput("scheme: there is no spectrum of a body of ul to compare with; bisect takes a patch of it");
  const auto& artificial = problem.scheme.artificial_stress;
  const auto [smallest, largest] = principal_stresses(problem);
  if (largest > 0.0 && largest < weakest_stress)
    throw InvalidInput(fmt::format(
        "pressure: a stress of {:.2g} rho c0^2 is so weak that rounding decides how a run grows; give at least {:g}, "
        "or none",
        largest, weakest_stress));
  if (!artificial) return;
  require_running_artificial_stress(problem.scheme);
  if (smallest < weakest_principal_stress)
    throw InvalidInput(
        fmt::format("artificial_stress_epsilon: a principal stress is 0, or below {:g} rho c0^2, so that artificial "
                    "stress switches "
                    "with every wave; a run obeys no linear theory then. Give more stress, or 0",
                    weakest_principal_stress));
}

/// Our own solver, from noise or from the mode that theory calls critical.
template <int Dim>
GrowthProbe our_solver(const Problem<Dim>& problem, const BodyChoice<Dim>& choice, const Body<Dim>& body,
                       const TheoryLimit& theory, const RunOptions& options) {
  if (problem.scheme.formulation != Formulation::updated_lagrangian) {
    if (options.start_from_mode) return GrowthRun<Dim>(problem, body, critical_mode_displacement(problem, choice));
    return GrowthRun<Dim>(problem, body, options.noise_seed);
  }
  const LatticeIndex<Dim> cells = std::get<PeriodicPatch<Dim>>(choice).cells;
  if (!options.start_from_mode) return UpdatedGrowthRun<Dim>(problem, cells, options.noise_seed);
  if (!theory.growing_step && !theory.critical_time_step) throw no_critical_mode();
  const auto wave = fastest_wave<Dim>(
      problem, cells, theory.growing_step.value_or(beyond_limit * theory.critical_time_step.value_or(0.0)));
  return UpdatedGrowthRun<Dim>(problem, cells, departure_of(wave, problem, cells));
}

}  // namespace

std::optional<double> StepComparison::relative_difference() const {
  if (growth) return std::abs(growth->measured / growth->theory - 1.0);
  if (!run.critical_time_step || !theory.critical_time_step) return std::nullopt;
  return std::abs(*run.critical_time_step / *theory.critical_time_step - 1.0);
}

std::optional<double> StepComparison::patch_deficit() const {
  if (!theory.critical_time_step || !bulk_theory) return std::nullopt;
  return *theory.critical_time_step / *bulk_theory - 1.0;
}

bool StepComparison::agrees(double tolerance) const {
  if (growth) return run.low == 0.0 && *relative_difference() <= growth_tolerance;
  if (theory.critical_time_step) return relative_difference() && *relative_difference() <= tolerance;
  return !std::isfinite(run.high);
}

void require_running_artificial_stress(const Scheme& scheme) {
  if (scheme.artificial_stress && scheme.artificial_stress->linearisation == ArtificialStressLinearisation::frozen)
    throw InvalidInput(
        "artificial_stress_linearisation: frozen is for theory alone, in a run artificial stress follows the stress; "
        "give exact");
}

template <int Dim>
double scan_start(const Problem<Dim>& problem, const std::vector<Material>& materials) {
  double fastest = 0.0;
  for (const Material& material : materials) fastest = std::max(fastest, p_wave_speed(problem, material));
  const double of_waves = problem.kernel.smoothing_length() / fastest;
  const auto& damping = problem.scheme.damping;
  return start_fraction * (damping ? std::min(of_waves, 1.0 / damping->rate) : of_waves);
}

template <int Dim>
TheoryLimit theory_limit(const Problem<Dim>& problem, const BodyChoice<Dim>& choice) {
  if (const auto* body = std::get_if<Body<Dim>>(&choice))
    return {.critical_time_step = analysis::body_limit(problem, *body).critical_time_step};
  const auto limit = analysis::patch_limit(problem, std::get<PeriodicPatch<Dim>>(choice).cells);
  if (const auto* unstable = std::get_if<analysis::NeverStable<Dim>>(&limit))
    return {.growth_rate = unstable->growth_rate, .growing_step = scan_start(problem, {problem.material})};
  if (const auto* weak = std::get_if<analysis::WeaklyUnstable<Dim>>(&limit))
    return {.growing_step = weak_growth_step / weak->mode.omega};
  return {.critical_time_step = step_of<Dim>(limit)};
}

template <int Dim>
std::optional<double> bulk_step(const Problem<Dim>& problem) {
  return step_of<Dim>(analysis::bulk_limit(problem));
}

template <int Dim>
solver::Field<Dim> critical_mode_displacement(const Problem<Dim>& problem, const BodyChoice<Dim>& choice) {
  solver::Field<Dim> displacement;
  if (const auto* body = std::get_if<Body<Dim>>(&choice)) {
    const Eigen::VectorXd mode = analysis::body_limit(problem, *body).displacement;
    for (int a = 0; a < body->size(); ++a) displacement.push_back(mode.template segment<Dim>(Dim * a));
    return displacement;
  }
  const auto patch = make_body(problem, choice);
  const auto limit = analysis::patch_limit(problem, std::get<PeriodicPatch<Dim>>(choice).cells);
  const auto* stable = std::get_if<analysis::ConditionallyStable<Dim>>(&limit);
  const auto* unstable = std::get_if<analysis::NeverStable<Dim>>(&limit);
  if (stable == nullptr && unstable == nullptr) throw no_critical_mode();
  const Vector<Dim> k = stable ? stable->mode.wave_vector : unstable->mode.wave_vector;
  const Eigen::EigenSolver<Tensor<Dim>> modes(analysis::dynamical_matrix(problem, k));
  int critical = 0;
  ((stable ? 1.0 : -1.0) * modes.eigenvalues().real()).maxCoeff(&critical);
  // An eighth of a wave off the origin: at a zone boundary a sine would vanish on every particle.
  for (const auto& x : patch.position)
    displacement.push_back(modes.eigenvectors().col(critical).real() * std::cos(k.dot(x) + std::atan(1.0)));
  return displacement;
}

template <int Dim>
StepComparison compare_step(const Problem<Dim>& problem, const BodyChoice<Dim>& choice, const RunOptions& options,
                            const GrowthProbe& probe) {
  require_comparable(problem, choice);
  const auto body = make_body(problem, choice);
  const auto theory = theory_limit(problem, choice);
  const GrowthProbe run = probe ? probe : our_solver(problem, choice, body, theory, options);
  StepComparison found;
  if (theory.growing_step) {
    const double growth = std::log(
        largest_radius(problem, std::get<PeriodicPatch<Dim>>(choice).cells, *theory.growing_step).spectral_radius);
    found = compare_growth(run, theory, growth, options.horizon);
  } else {
    BisectionOptions search{.start = scan_start(problem, body.materials),
                            .tolerance = options.tolerance,
                            .horizon = options.horizon,
                            .progress = options.progress};
    const bool updated = problem.scheme.formulation == Formulation::updated_lagrangian;
    if (updated && !theory.critical_time_step) search.end = farthest_over_start * search.start;
    found.run = bisect(run, search);
    found.theory = theory;
  }
  found.bulk_theory = bulk_step(problem);
  return found;
}

template double scan_start(const Problem<1>&, const std::vector<Material>&);
template TheoryLimit theory_limit(const Problem<1>&, const BodyChoice<1>&);
template std::optional<double> bulk_step(const Problem<1>&);
template solver::Field<1> critical_mode_displacement(const Problem<1>&, const BodyChoice<1>&);
template StepComparison compare_step(const Problem<1>&, const BodyChoice<1>&, const RunOptions&, const GrowthProbe&);
template double scan_start(const Problem<2>&, const std::vector<Material>&);
template TheoryLimit theory_limit(const Problem<2>&, const BodyChoice<2>&);
template std::optional<double> bulk_step(const Problem<2>&);
template solver::Field<2> critical_mode_displacement(const Problem<2>&, const BodyChoice<2>&);
template StepComparison compare_step(const Problem<2>&, const BodyChoice<2>&, const RunOptions&, const GrowthProbe&);
template double scan_start(const Problem<3>&, const std::vector<Material>&);
template TheoryLimit theory_limit(const Problem<3>&, const BodyChoice<3>&);
template std::optional<double> bulk_step(const Problem<3>&);
template solver::Field<3> critical_mode_displacement(const Problem<3>&, const BodyChoice<3>&);
template StepComparison compare_step(const Problem<3>&, const BodyChoice<3>&, const RunOptions&, const GrowthProbe&);

}  // namespace sphstab::study
