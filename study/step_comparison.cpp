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
#include "study/growth_run.hpp"

namespace sphstab::study {
namespace {

/// No kernel or lattice has its limit below 1.4 h/c_p in bulk (theory.md §6), and normalised edges lower it to 0.6 of
/// that. The limit of damping alone is 2 over its rate.
constexpr double start_fraction = 0.3;

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

/// One run at one step, long enough for growth of that rate: everything grows, or nothing does.
Bisection run_once(const GrowthProbe& run, double time_step, double growth_rate) {
  const auto fit = run(time_step, 3 * horizon_for_growth(growth_rate * time_step));
  const bool grows = fit.trend == solver::Trend::growing;
  return {
      std::nullopt, grows ? 0.0 : time_step, grows ? time_step : std::numeric_limits<double>::infinity(), fit.steps, 1,
      fit.steps,    fit.smallest_detectable};
}

}  // namespace

std::optional<double> StepComparison::relative_difference() const {
  if (!run.critical_time_step || !theory.critical_time_step) return std::nullopt;
  return std::abs(*run.critical_time_step / *theory.critical_time_step - 1.0);
}

std::optional<double> StepComparison::patch_deficit() const {
  if (!theory.critical_time_step || !bulk_theory) return std::nullopt;
  return *theory.critical_time_step / *bulk_theory - 1.0;
}

bool StepComparison::agrees(double tolerance) const {
  if (theory.critical_time_step) return relative_difference() && *relative_difference() <= tolerance;
  return theory.growth_rate ? run.low == 0.0 : !std::isfinite(run.high);
}

template <int Dim>
double scan_start(const Problem<Dim>& problem, const std::vector<Material>& materials) {
  double fastest = 0.0;
  for (const Material& material : materials)
    fastest = std::max(fastest, std::sqrt(material.lame(problem.plane).p_wave_modulus() / material.density()));
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
    return {.growth_rate = unstable->growth_rate};
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
  if (stable == nullptr && unstable == nullptr)
    throw InvalidInput("seed: there is no critical mode to start from; use noise");
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
  require_total_lagrangian(problem.scheme, "bisect");
  if (std::holds_alternative<Body<Dim>>(choice) && !problem.displacement_gradient.isZero())
    throw InvalidInput("displacement_gradient: a body takes none, it would not be in equilibrium");
  const auto body = make_body(problem, choice);
  const auto theory = theory_limit(problem, choice);
  const BisectionOptions search{.start = scan_start(problem, body.materials),
                                .tolerance = options.tolerance,
                                .horizon = options.horizon,
                                .progress = options.progress};
  const auto our_solver = [&]() -> GrowthProbe {
    if (options.start_from_mode) return GrowthRun<Dim>(problem, body, critical_mode_displacement(problem, choice));
    return GrowthRun<Dim>(problem, body, options.noise_seed);
  };
  const GrowthProbe run = probe ? probe : our_solver();
  const Bisection found = theory.growth_rate ? run_once(run, search.start, *theory.growth_rate) : bisect(run, search);
  return {found, theory, bulk_step(problem)};
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
