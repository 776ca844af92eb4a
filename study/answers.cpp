// SPDX-License-Identifier: MIT
#include "study/answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/amplification.hpp"
#include "analysis/critical_step.hpp"
#include "analysis/lattice_sums.hpp"
#include "analysis/updated_modes.hpp"
#include "io/scene_input.hpp"
#include "study/counts.hpp"
#include "study/ellipticity_answer.hpp"
#include "study/foreign_solver.hpp"
#include "study/json_values.hpp"
#include "study/p_wave_speed.hpp"
#include "study/rules_of_thumb.hpp"
#include "study/scene_input.hpp"
#include "study/step_comparison.hpp"

namespace sphstab::study {
namespace {

constexpr const char* bulk_note =
    "bulk value of an infinite lattice: free, renormalised edges can need 0.6 of it and irregular particles 0.85";

/// The verdict with what belongs to it: step and bracket, or growth rate, and the critical mode.
template <int Dim>
Json to_json(const analysis::StepLimit<Dim>& limit) {
  return std::visit(
      Overloaded{
          [](const analysis::ConditionallyStable<Dim>& stable) -> Json {
            return {{"critical_time_step", stable.critical_time_step},
                    {"bracket", {stable.bracket.low, stable.bracket.high}},
                    {"bracket_kind", name_of(stable.bracket_kind)},
                    {"verdict", "conditionally-stable"},
                    {"critical_mode", mode_json<Dim>(stable.mode)}};
          },
          [](const analysis::UnconditionallyStable&) -> Json {
            return {{"critical_time_step", nullptr}, {"bracket", nullptr}, {"verdict", "unconditionally-stable"}};
          },
          [](const analysis::NeverStable<Dim>& unstable) -> Json {
            return {{"critical_time_step", nullptr},
                    {"bracket", nullptr},
                    {"verdict", "never-stable"},
                    {"growth_rate", unstable.growth_rate},
                    {"critical_mode", mode_json<Dim>(unstable.mode)}};
          },
          [](const analysis::WeaklyUnstable<Dim>& weak) -> Json {
            return {{"critical_time_step", nullptr},
                    {"bracket", nullptr},
                    {"verdict", "weakly-unstable"},
                    {"growth_law", {{"coefficient", weak.coefficient}, {"exponent", weak.exponent}}},
                    {"critical_mode", mode_json<Dim>(weak.mode)}};
          }},
      limit);
}

template <int Dim>
Json equivalents(const Problem<Dim>& problem, double critical_time_step) {
  Json rows = Json::array();
  for (const auto& rule : rules_of_thumb(problem.material, problem.kernel.smoothing_length(), Dim)) {
    const double factor = critical_time_step / rule.unit;
    if (!std::isfinite(factor)) continue;  // an infinite bulk modulus leaves no step
    Json row{{"rule", rule.rule}, {"formula", rule.formula}, {"factor_at_limit", factor}};
    row["default"] = number_or_null(rule.default_factor);
    row["default_is_safe"] = rule.default_factor ? Json(*rule.default_factor <= factor) : Json();
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The growth per step that the user accepts: tolerated_growth_per_step, or one e-folding over `steps`.
std::optional<double> tolerated_growth(const Case& input) {
  const auto growth = input.number("tolerated_growth_per_step"), steps = input.number("steps");
  if (growth && steps) throw InvalidInput("tolerated_growth_per_step: cannot be given with steps");
  return steps ? std::expm1(1.0 / *steps) : growth;
}

/// What every scheme answers, from the modes of its infinite lattice.
template <int Dim, class Modes>
Json time_step_answer(const Case& input, const Problem<Dim>& problem, const Modes& modes) {
  Json answer = to_json<Dim>(modes.limit());
  const Json step = answer["critical_time_step"];
  answer["bulk_only"] = true;
  answer["note"] = bulk_note;
  answer["neighbours"] = lattice_neighbours(problem.lattice, problem.kernel.support(), problem.neighbour_rule).size();
  if (step.is_number()) {
    answer["courant_number"] = step.get<double>() * p_wave_speed(problem) / problem.lattice.spacing();
    answer["equivalents"] = equivalents(problem, step);
  }
  if (input.has("wave_vector") || input.has("mode"))
    answer["mode_limit"] = to_json<Dim>(analysis::mode_limit(problem, make_wave_vector<Dim>(input)));
  if (const auto box = make_size<Dim>(input, "box"); box && !input.has("mode"))
    answer["box_limit"] = to_json<Dim>(analysis::paper_limit(problem, *box));
  if (const auto growth = tolerated_growth(input))
    answer["time_step_for_tolerance"] = number_or_null(modes.step_for_growth(*growth));
  if (const auto time_step = input.number("time_step")) {
    const double radius = modes.spectral_radius(*time_step);
    answer["spectral_radius_at_time_step"] = radius;
    if (answer["verdict"] == "weakly-unstable") answer["growth_per_step_at_time_step"] = radius - 1.0;
  }
  return answer;
}

/// What total-Lagrangian schemes have besides: the symbol D, `tl-linear` a published bound, finite strain ellipticity.
template <int Dim>
Json lagrangian_time_step_answer(const Case& input, const Problem<Dim>& problem) {
  const analysis::BulkModes<Dim> modes(problem);
  Json answer = time_step_answer(input, problem, modes);
  answer["symbol_maximum"] = modes.symbol_maximum();
  if (is_finite_strain(problem.scheme.formulation)) answer["ellipticity"] = ellipticity_answer(problem);
  if (const auto bound = analysis::published_bound(problem)) {
    const Json& step = answer["critical_time_step"];
    answer["published_bound"] = {{"source", "Zhang, Hu, Cui & Wang, Eq. 15"},
                                 {"value", *bound},
                                 {"holds", step.is_number() && *bound <= step.get<double>()}};
  }
  return answer;
}

/// What `ul` has besides: whether there is a stress, which makes forces at zero-energy modes too.
template <int Dim>
Json updated_time_step_answer(const Case& input, const Problem<Dim>& problem) {
  Json answer = time_step_answer(input, problem, analysis::UpdatedModes<Dim>(problem));
  answer["stressed"] = problem.pressure != 0.0 || !problem.deviatoric_stress.isZero(0.0);
  return answer;
}

template <int Dim>
Json time_step_answer(const Case& input, const Request& request) {
  const auto problem = make_problem<Dim>(input);
  const bool updated = problem.scheme.formulation == Formulation::updated_lagrangian;
  Json answer = updated ? updated_time_step_answer(input, problem) : lagrangian_time_step_answer(input, problem);
  if (request.wants("zero_energy_modes") || request.wants("zero_energy_modes_complete")) {
    const auto zeros = analysis::zero_energy_modes(problem);
    answer["zero_energy_modes"] = Json::array();
    for (const auto& wave_vector : zeros.wave_vectors)
      answer["zero_energy_modes"].push_back(components<Dim>(wave_vector));
    answer["zero_energy_modes_complete"] = zeros.complete;
  }
  return answer;
}

template <int Dim>
Json matrix_answer(const Case& input) {
  const auto problem = make_problem<Dim>(input);
  const auto wave_vector = make_wave_vector<Dim>(input);
  const double time_step = input.required_number("time_step");
  const auto spectrum = analysis::mode_spectrum(problem, wave_vector, time_step);
  Json eigenvalues = Json::array();
  for (const auto& eigenvalue : spectrum.eigenvalues) eigenvalues.push_back(complex_pair(eigenvalue));
  return {{"wave_vector", components<Dim>(wave_vector)},
          {"time_step", time_step},
          {"state", analysis::state_names(problem)},
          {"amplification_matrix", matrix_rows(analysis::amplification_matrix(problem, wave_vector, time_step))},
          {"eigenvalues", std::move(eigenvalues)},
          {"spectral_radius", spectrum.spectral_radius},
          {"power_bounded", spectrum.power_bounded}};
}

template <int Dim>
constexpr int default_patch_cells = Dim == 3 ? 8 : 16;
/// Below it the runs would take millions of steps and rounding would decide.
constexpr double least_tolerance = 1e-10;

/// What bisect runs, with its problem and the name of it in the result.
template <int Dim>
struct BisectionSubject {
  Problem<Dim> problem;
  BodyChoice<Dim> choice;
  Json name;
};

template <int Dim>
BisectionSubject<Dim> bisection_subject(const Case& input) {
  if (names_body(input)) {
    Scene<Dim> scene = make_scene<Dim>(input);
    if (scene.periodic_cells) return {scene.problem, PeriodicPatch<Dim>{*scene.periodic_cells}, body_name(input)};
    return {scene.problem, std::move(scene.body), body_name(input)};
  }
  const auto cells = make_size<Dim>(input, "patch").value_or(LatticeIndex<Dim>::Constant(default_patch_cells<Dim>));
  return {make_problem<Dim>(input),
          PeriodicPatch<Dim>{cells},
          {{"patch", std::vector<int>(cells.data(), cells.data() + Dim)}}};
}

template <int Dim>
Json bisection_answer(const Case& input, const Request& request) {
  RunOptions options{.start_from_mode = input.required_word("seed") == "mode",
                     .noise_seed = static_cast<unsigned>(input.required_number("noise_seed")),
                     .tolerance = input.required_number("tolerance")};
  if (options.tolerance < least_tolerance)
    throw InvalidInput(fmt::format("tolerance: {:g} is not at least {:g}", options.tolerance, least_tolerance));
  if (const auto horizon = input.number("horizon")) options.horizon = static_cast<long>(*horizon);
  if (request.progress)
    options.progress = [&](double low, double high) {
      request.progress(closed_fraction(low, high, options.tolerance));
    };
  const auto command = input.word("command");
  const auto subject = bisection_subject<Dim>(input);
  const auto found =
      compare_step(subject.problem, subject.choice, options, command ? foreign_solver(*command) : nullptr);
  Json answer = subject.name;
  answer.update({{"critical_time_step", number_or_null(found.run.critical_time_step)},
                 {"bracket", {found.run.low, std::isfinite(found.run.high) ? Json(found.run.high) : Json()}},
                 {"theory", number_or_null(found.theory.critical_time_step)},
                 {"relative_difference", number_or_null(found.relative_difference())},
                 {"tolerance", found.growth ? growth_tolerance : options.tolerance},
                 {"agrees", found.agrees(options.tolerance)},
                 {"bulk_theory", number_or_null(found.bulk_theory)},
                 {"patch_deficit", number_or_null(found.patch_deficit())},
                 {"horizon", found.run.horizon},
                 {"runs", found.run.runs},
                 {"steps", found.run.steps},
                 {"smallest_detectable_growth", found.run.smallest_detectable}});
  if (found.theory.growth_rate) answer["theory_growth_rate"] = *found.theory.growth_rate;
  if (found.growth)
    answer["growth"] = {
        {"time_step", found.growth->time_step}, {"measured", found.growth->measured}, {"theory", found.growth->theory}};
  return answer;
}

template <int Dim>
Json kernel_answer(const Case& input) {
  const auto kernel = make_kernel<Dim>(input);
  const double distance = input.required_number("distance");
  return {{"W", kernel.value(distance)},
          {"dW", kernel.slope(distance)},
          {"d2W", kernel.curvature(distance)},
          {"normalisation", kernel.normalisation()}};
}

template <int Dim>
Json sums_answer(const Case& input) {
  const ArtificialStress weight{.epsilon = 1.0, .exponent = input.required_number("artificial_stress_exponent")};
  const analysis::LatticeSummation<Dim> summation(make_lattice<Dim>(input), make_kernel<Dim>(input),
                                                  neighbour_rule(input), weight, std::nullopt);
  const auto sums = summation(make_wave_vector<Dim>(input));
  return {{"A", components<Dim>(sums.A)},
          {"B", rows<Dim>(sums.B)},
          {"beta_sum", sums.beta_sum},
          {"f", rows<Dim>(sums.f)},
          {"neighbours", summation.neighbours()}};
}

}  // namespace

Json time_step_answer(const Case& input, const Request& request) {
  return in_dimension(input, [&](auto dimension) { return time_step_answer<dimension()>(input, request); });
}

Json matrix_answer(const Case& input, const Request&) {
  return in_dimension(input, [&](auto dimension) { return matrix_answer<dimension()>(input); });
}

Json bisection_answer(const Case& input, const Request& request) {
  const Case keys = io::with_scene_keys(input);
  return in_dimension(keys, [&](auto dimension) { return bisection_answer<dimension()>(keys, request); });
}

Json sums_answer(const Case& input, const Request&) {
  return in_dimension(input, [&](auto dimension) { return sums_answer<dimension()>(input); });
}

Json kernel_answer(const Case& input, const Request&) {
  return in_dimension(input, [&](auto dimension) { return kernel_answer<dimension()>(input); });
}

}  // namespace sphstab::study
