// SPDX-License-Identifier: MIT
#include "study/step_comparison.hpp"

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
  switch (choice.boundary) {
    case Boundary::periodic:
      return periodic_patch<Dim>(problem, choice.counts);
    case Boundary::free:
      if (!problem.displacement_gradient.isZero())
        throw InvalidInput("displacement_gradient: a free plate takes none, it would not be in equilibrium");
      return free_plate<Dim>(problem, choice.counts);
  }
  return {};
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
double scan_start(const Problem<Dim>& problem) {
  const double modulus = problem.material.lame(problem.plane).p_wave_modulus();
  const double of_waves = problem.kernel.smoothing_length() * std::sqrt(problem.material.density() / modulus);
  const auto& damping = problem.scheme.damping;
  return start_fraction * (damping ? std::min(of_waves, 1.0 / damping->rate) : of_waves);
}

template <int Dim>
TheoryLimit theory_limit(const Problem<Dim>& problem, const BodyChoice<Dim>& choice) {
  if (choice.boundary == Boundary::free)
    return {.critical_time_step = analysis::body_limit(problem, make_body(problem, choice)).critical_time_step};
  const auto limit = analysis::patch_limit(problem, choice.counts);
  if (const auto* unstable = std::get_if<analysis::NeverStable<Dim>>(&limit))
    return {.growth_rate = unstable->growth_rate};
  return {.critical_time_step = step_of<Dim>(limit)};
}

template <int Dim>
std::optional<double> bulk_step(const Problem<Dim>& problem) {
  return step_of<Dim>(analysis::BulkModes(problem).limit());
}

template <int Dim>
solver::Field<Dim> critical_mode_displacement(const Problem<Dim>& problem, const BodyChoice<Dim>& choice,
                                              const Body<Dim>& body) {
  solver::Field<Dim> displacement(body.size());
  if (choice.boundary == Boundary::free) {
    const Eigen::VectorXd mode = analysis::body_limit(problem, body).displacement;
    for (int a = 0; a < body.size(); ++a) displacement[a] = mode.template segment<Dim>(Dim * a);
    return displacement;
  }
  const auto limit = analysis::patch_limit(problem, choice.counts);
  const auto* stable = std::get_if<analysis::ConditionallyStable<Dim>>(&limit);
  const auto* unstable = std::get_if<analysis::NeverStable<Dim>>(&limit);
  if (stable == nullptr && unstable == nullptr)
    throw InvalidInput("seed: there is no critical mode to start from; use noise");
  const Vector<Dim> k = stable ? stable->mode.wave_vector : unstable->mode.wave_vector;
  const Eigen::EigenSolver<Tensor<Dim>> modes(analysis::dynamical_matrix(problem, k));
  int critical = 0;
  ((stable ? 1.0 : -1.0) * modes.eigenvalues().real()).maxCoeff(&critical);
  // An eighth of a wave off the origin: at a zone boundary a sine would vanish on every particle.
  for (int a = 0; a < body.size(); ++a)
    displacement[a] = modes.eigenvectors().col(critical).real() * std::cos(k.dot(body.position[a]) + std::atan(1.0));
  return displacement;
}

template <int Dim>
StepComparison compare_step(const Problem<Dim>& problem, const BodyChoice<Dim>& choice, const RunOptions& options,
                            const GrowthProbe& probe) {
  const auto body = make_body(problem, choice);
  const auto theory = theory_limit(problem, choice);
  const BisectionOptions search{.start = scan_start(problem),
                                .tolerance = options.tolerance,
                                .horizon = options.horizon,
                                .progress = options.progress};
  const auto our_solver = [&]() -> GrowthProbe {
    if (options.start_from_mode)
      return GrowthRun<Dim>(problem, body, critical_mode_displacement(problem, choice, body));
    return GrowthRun<Dim>(problem, body, options.noise_seed);
  };
  const GrowthProbe run = probe ? probe : our_solver();
  const Bisection found = theory.growth_rate ? run_once(run, search.start, *theory.growth_rate) : bisect(run, search);
  return {found, theory, bulk_step(problem)};
}

template double scan_start(const Problem<1>&);
template TheoryLimit theory_limit(const Problem<1>&, const BodyChoice<1>&);
template std::optional<double> bulk_step(const Problem<1>&);
template solver::Field<1> critical_mode_displacement(const Problem<1>&, const BodyChoice<1>&, const Body<1>&);
template StepComparison compare_step(const Problem<1>&, const BodyChoice<1>&, const RunOptions&, const GrowthProbe&);
template double scan_start(const Problem<2>&);
template TheoryLimit theory_limit(const Problem<2>&, const BodyChoice<2>&);
template std::optional<double> bulk_step(const Problem<2>&);
template solver::Field<2> critical_mode_displacement(const Problem<2>&, const BodyChoice<2>&, const Body<2>&);
template StepComparison compare_step(const Problem<2>&, const BodyChoice<2>&, const RunOptions&, const GrowthProbe&);
template double scan_start(const Problem<3>&);
template TheoryLimit theory_limit(const Problem<3>&, const BodyChoice<3>&);
template std::optional<double> bulk_step(const Problem<3>&);
template solver::Field<3> critical_mode_displacement(const Problem<3>&, const BodyChoice<3>&, const Body<3>&);
template StepComparison compare_step(const Problem<3>&, const BodyChoice<3>&, const RunOptions&, const GrowthProbe&);

}  // namespace sphstab::study
