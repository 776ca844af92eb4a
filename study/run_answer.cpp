// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "analysis/growth.hpp"
#include "analysis/updated_modes.hpp"
#include "io/document.hpp"
#include "io/particle_output.hpp"
#include "io/scene_input.hpp"
#include "study/answers.hpp"
#include "study/json_values.hpp"
#include "study/p_wave_speed.hpp"
#include "study/particle_pictures.hpp"
#include "study/scene_input.hpp"
#include "study/scene_run.hpp"
#include "study/step_comparison.hpp"

namespace sphstab::study {
namespace {

/// Rows of probes.csv at most: some megabytes a probe.
constexpr long largest_probe_table = 20000;

/// Energy that neither the loads nor the start have given shows that the run has grown.
constexpr double energy_that_shows_growth = 1e3;

/// What theory says of the steps of a scene.
struct StepTheory {
  std::optional<double> critical_time_step;  ///< that the key step_fraction is of
  std::string of;                            ///< what it is the critical step of
  /// ln of the spectral radius of the fastest mode, growth per step; absent: nothing is predicted.
  std::function<double(double time_step)> growth_per_step = nullptr;
  bool grows_by_integrator = false;  ///< whose shorter steps grow more slowly in time
  bool state_grows = false;          ///< that of a total-Lagrangian scheme, at every step
};

template <int Dim>
StepTheory lagrangian_theory(const Scene<Dim>& scene) {
  if (!scene.periodic_cells) return {theory_limit<Dim>(scene.problem, scene.body).critical_time_step, "body spectrum"};
  const auto limit = theory_limit<Dim>(scene.problem, PeriodicPatch<Dim>{*scene.periodic_cells});
  return {.critical_time_step = limit.critical_time_step,
          .of = "periodic patch",
          .state_grows = limit.growth_rate.has_value()};
}

constexpr std::string_view of_the_lattice = "infinite lattice";
constexpr std::string_view of_its_frequencies = "infinite lattice, 2/omega_max (the integrator grows at every step)";
constexpr std::string_view of_growing_state = "infinite lattice, 2/omega_max (the state itself grows)";

/// The step of the infinite lattice of one material; where there is none because every step grows, 2/√(max ω²).
template <int Dim>
StepTheory lattice_theory(const Problem<Dim>& problem) {
  const auto modes = std::make_shared<analysis::UpdatedModes<Dim>>(problem);
  const auto growth = [modes](double time_step) { return std::log(modes->spectral_radius(time_step)); };
  const auto of_frequencies = [&](std::string_view of, bool by_integrator) -> StepTheory {
    const double fastest = analysis::growth_range(problem).omega_squared_max;
    return {fastest > 0.0 ? std::optional(2.0 / std::sqrt(fastest)) : std::nullopt, std::string(of), growth,
            by_integrator};
  };
  return std::visit(
      Overloaded{[&](const analysis::ConditionallyStable<Dim>& stable) -> StepTheory {
                   return {stable.critical_time_step, std::string(of_the_lattice), growth};
                 },
                 [&](const analysis::UnconditionallyStable&) -> StepTheory {
                   return {std::nullopt, std::string(of_the_lattice), growth};
                 },
                 [&](const analysis::NeverStable<Dim>&) { return of_frequencies(of_growing_state, false); },
                 [&](const analysis::WeaklyUnstable<Dim>&) { return of_frequencies(of_its_frequencies, true); }},
      modes->limit());
}

/// Whether theory has to leave the viscosity away.
bool has_no_theory_of_viscosity(const Scheme& scheme) {
  return scheme.viscosity && scheme.viscosity->pairs == ViscousPairs::approaching;
}

/// Of the lattice of the problem, with the material of the body that needs the smallest step.
template <int Dim>
StepTheory updated_theory(const Scene<Dim>& scene) {
  Problem<Dim> problem = scene.problem;
  if (has_no_theory_of_viscosity(problem.scheme)) problem.scheme.viscosity.reset();
  std::vector<StepTheory> theories;
  for (const auto& material : scene.body.materials) {
    problem.material = material;
    theories.push_back(lattice_theory(problem));
  }
  const auto step = [](const StepTheory& theory) {
    return theory.critical_time_step.value_or(std::numeric_limits<double>::infinity());
  };
  StepTheory theory = *std::min_element(theories.begin(), theories.end(),
                                        [&](const auto& left, const auto& right) { return step(left) < step(right); });
  if (scene.body.site.empty()) theory.of += "; these particles are on none";
  theory.growth_per_step = [theories](double time_step) {
    double fastest = 0.0;
    for (const auto& each : theories) fastest = std::max(fastest, each.growth_per_step(time_step));
    return fastest;
  };
  return theory;
}

template <int Dim>
StepTheory step_theory(const Scene<Dim>& scene) {
  switch (scene.problem.scheme.formulation) {
    case Formulation::total_lagrangian_linear:
    case Formulation::total_lagrangian_corotated:
    case Formulation::total_lagrangian_pk1:
      return lagrangian_theory(scene);
    case Formulation::updated_lagrangian:
      return updated_theory(scene);
  }
  return {};
}

double predicted_e_foldings(const StepTheory& theory, double time_step, double duration) {
  return duration / time_step * theory.growth_per_step(time_step);
}

/// A step of at most `time_step` in which theory predicts at most one e-folding over the duration, and not much less.
/// Weak growth in time goes like Δt³ (theory.md §4), where XSPH meets a stress more slowly.
double step_of_one_e_folding(const StepTheory& theory, double time_step, double duration) {
  for (double e_foldings; (e_foldings = predicted_e_foldings(theory, time_step, duration)) > 1.0 &&
                          theory.growth_per_step(time_step) > analysis::negligible_growth_per_step;)
    time_step *= 0.99 / std::cbrt(e_foldings);
  return time_step;
}

/// Whether the step is to follow the limit of the body as it deforms. That of `tl-linear` does not change.
bool is_followed(const Case& input) { return input.word("time_step") == "auto"; }

/// The critical step that a part is taken of.
double required_critical_step(const Scheme& scheme, const StepTheory& theory) {
  if (theory.critical_time_step) return *theory.critical_time_step;
  if (!theory.state_grows) throw InvalidInput("time_step: missing; there is no critical step to take a part of");
  throw InvalidInput(
      fmt::format("time_step: there is no critical step to take a part of: the base state grows at every step{}",
                  is_finite_strain(scheme.formulation) ? " (loss of ellipticity)" : ""));
}

/// `time_step`, or `step_fraction` of the critical step; where neither is given and the integrator grows at every step,
/// no more of it than one e-folding allows.
double chosen_time_step(const Case& input, const Scheme& scheme, const StepTheory& theory, double duration) {
  if (is_followed(input)) return input.required_number("step_fraction") * required_critical_step(scheme, theory);
  if (const auto time_step = input.number("time_step")) {
    if (input.has("step_fraction")) throw InvalidInput("step_fraction: cannot be given with time_step");
    return *time_step;
  }
  const double of_critical = input.required_number("step_fraction") * required_critical_step(scheme, theory);
  if (input.has("step_fraction") || !theory.grows_by_integrator) return of_critical;
  return step_of_one_e_folding(theory, of_critical, duration);
}

/// Linear schemes keep the energy below their critical step, whatever moves in them; runs of finite strain are watched
/// (study/growth_watch.hpp).
bool has_grown(const SceneSummary& summary, bool can_grow, double energy_of_rounding) {
  return can_grow &&
         summary.kinetic_energy + summary.strain_energy >
             energy_that_shows_growth * (std::abs(summary.work) + summary.initial_energy + energy_of_rounding);
}

Json to_json(const SceneSummary& summary) {
  Json values{{"time", summary.time},
              {"steps", summary.steps},
              {"right_hand_sides", summary.right_hand_sides},
              {"largest_displacement", summary.largest_displacement},
              {"largest_velocity", summary.largest_velocity},
              {"largest_von_mises_stress", summary.largest_von_mises_stress},
              {"initial_energy", summary.initial_energy},
              {"kinetic_energy", summary.kinetic_energy},
              {"strain_energy", summary.strain_energy},
              {"work", summary.work},
              {"momentum_drift", number_or_null(summary.momentum_drift)}};
  if (const auto& following = summary.following)
    values["followed"] = {{"smallest_time_step", following->smallest_step},
                          {"largest_time_step", following->largest_step},
                          {"updates", following->work.updates},
                          {"applications", following->work.applications},
                          {"cost_share", following->cost_share}};
  if (summary.list_builds) values["list_builds"] = *summary.list_builds;
  values["lost_particles"] = summary.lost_particles.size();
  return values;
}

Json to_json(const NonFiniteValue& failure) {
  Json values{{"step", failure.step}, {"time", failure.time}, {"particle", failure.particle}, {"field", failure.field}};
  if (failure.term) values["term"] = *failure.term;
  return values;
}

/// The largest ω² about the last state, complex where the forces have no potential, and the step it allows, unless
/// ellipticity is lost.
template <int Dim>
void add_limit_at_end(const Scene<Dim>& scene, const SceneRunResult<Dim>& result, Json& answer) {
  const auto limit = limit_about<Dim>(scene.problem, scene.body, result.last.displacement);
  answer["critical_time_step_at_end"] =
      limit && result.summary.is_elliptic ? number_or_null(limit->critical_time_step) : Json();
  answer["omega_squared_at_end"] = limit ? complex_pair(limit->largest.omega_squared) : Json();
}

/// Of `ul`: a step above the limit of the state at the start, or a state in which a particle is pulled.
template <int Dim>
std::optional<GrowthCause> cause_in_updated_lagrangian(const StepTheory& theory, double time_step,
                                                       const Snapshot<Dim>& last) {
  const bool grows_at_start =
      theory.growth_per_step && theory.growth_per_step(0.5 * time_step) > analysis::negligible_growth_per_step;
  if (theory.critical_time_step && time_step > *theory.critical_time_step && !grows_at_start)
    return GrowthCause::time_step;
  for (const auto& stress : last.stress)
    if (stress.template selfadjointView<Eigen::Lower>().eigenvalues()[Dim - 1] > 0.0) return GrowthCause::tension;
  return std::nullopt;
}

Json to_json(const std::optional<GrowthCause>& cause) { return cause ? name_of(*cause) : "unknown"; }

/// Writes what a run shows into the folder of a request; does nothing without one.
template <int Dim>
class RunFiles {
 public:
  RunFiles(const Body<Dim>& body, io::OutputFolder* folder) : body_(body), folder_(folder) {
    if (folder_ == nullptr) return;
    states_.emplace(folder_->assembly("states.h5"), body);
    folder_->replace_series("snapshot_");
  }

  void add(const Snapshot<Dim>& snapshot) {
    if (folder_ == nullptr) return;
    std::vector<io::ParticleField> fields{io::vector_field<Dim>("displacement", snapshot.displacement),
                                          io::vector_field<Dim>("velocity", snapshot.velocity),
                                          io::tensor_field<Dim>("stress", snapshot.stress),
                                          io::scalar_field("von_mises_stress", snapshot.von_mises_stress)};
    if (!snapshot.density.empty()) fields.push_back(io::scalar_field("density", snapshot.density));
    states_->add_state(snapshot.time, fields);
    if (body_.size() <= largest_picture && drawable<Dim>(body_, snapshot.displacement))
      folder_->write(fmt::format("snapshot_{:03}.svg", snapshots_), io::render_svg(picture(snapshot)));
    ++snapshots_;
  }

  void finish(const SceneRunResult<Dim>& result, const Json& answer) {
    if (folder_ == nullptr) return;
    states_->finish();
    folder_->write("summary.json", io::write(answer, io::Format::json));
    if (!result.probes.empty()) folder_->write("probes.csv", io::to_csv(probe_table(result)));
  }

 private:
  io::ParticleFigure picture(const Snapshot<Dim>& snapshot) const {
    return {.title = fmt::format("time {:.6g}, step {}", snapshot.time, snapshot.step),
            .x_label = "x",
            .y_label = Dim == 1 ? "" : "y",
            .value_label = "von Mises stress",
            .radius = particle_radius(body_),
            .panels = {particle_panel<Dim>("", body_, snapshot.displacement, 1.0, snapshot.von_mises_stress)},
            .columns = 1};
  }

  static io::Table probe_table(const SceneRunResult<Dim>& result) {
    io::Table table{{"time"}, {}};
    for (const auto& probe : result.probes) {
      for (const char* quantity : {"displacement", "velocity"})
        for (int i = 0; i < Dim; ++i) table.header.push_back(fmt::format("{} {} {}", probe.name, quantity, "xyz"[i]));
      for (int i = 0; i < Dim; ++i)
        for (int j = i; j < Dim; ++j)
          table.header.push_back(fmt::format("{} stress {}{}", probe.name, "xyz"[i], "xyz"[j]));
    }
    for (std::size_t n = 0; n < result.sample_times.size(); ++n) {
      std::vector<std::string> row{fmt::format("{}", result.sample_times[n])};
      for (const auto& probe : result.probes) {
        for (const auto* quantity : {&probe.displacement, &probe.velocity})
          for (int i = 0; i < Dim; ++i) row.push_back(fmt::format("{}", (*quantity)[n][i]));
        for (int i = 0; i < Dim; ++i)
          for (int j = i; j < Dim; ++j) row.push_back(fmt::format("{}", probe.stress[n](i, j)));
      }
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  const Body<Dim>& body_;
  io::OutputFolder* folder_;
  std::optional<io::ParticleFile> states_;
  int snapshots_ = 0;
};

template <int Dim>
Json run_answer(const Case& input, const Request& request) {
  const auto scene = make_scene<Dim>(input);
  require_running_artificial_stress(scene.problem.scheme);
  const double duration = input.required_number("duration");
  const StepTheory theory = step_theory(scene);
  const Scheme& scheme = scene.problem.scheme;
  const double time_step = chosen_time_step(input, scheme, theory, duration);
  RunFiles<Dim> files(scene.body, request.folder);
  const bool follows = is_followed(input) && is_finite_strain(scheme.formulation);
  if (is_followed(input) && !is_total_lagrangian(scheme.formulation))
    throw InvalidInput("time_step: auto is for total-Lagrangian schemes; there is no spectrum of a body of ul");
  SceneRunOptions<Dim> options{.time_step = time_step,
                               .followed_fraction = follows ? input.number("step_fraction") : std::nullopt,
                               .duration = duration,
                               .snapshots = static_cast<long>(*input.number("snapshots")),
                               .probe_samples = largest_probe_table,
                               .visit = [&](const Snapshot<Dim>& snapshot) { files.add(snapshot); }};
  if (request.progress)
    options.progress = [&](long step, long steps) {
      request.progress(static_cast<double>(step) / static_cast<double>(steps));
    };
  const auto result = run_scene(scene, options);
  Json answer = body_name(input);
  answer.update({{"particles", scene.body.size()},
                 {"time_step", time_step},
                 {"critical_time_step", number_or_null(theory.critical_time_step)},
                 {"critical_time_step_of", theory.of}});
  if (has_no_theory_of_viscosity(scheme)) answer["note"] = "theory is that without viscosity";
  if (theory.growth_per_step) {
    const double e_foldings = predicted_e_foldings(theory, time_step, duration);
    if (e_foldings > 1.0) answer["predicted_growth_e_foldings"] = e_foldings;
  }
  answer.update(to_json(result.summary));
  answer["probes"] = Json::object();
  for (const auto& probe : result.probes)
    if (!probe.displacement.empty())
      answer["probes"][probe.name] = {{"particle", probe.particle},
                                      {"displacement", components<Dim>(probe.displacement.back())},
                                      {"velocity", components<Dim>(probe.velocity.back())},
                                      {"stress", rows<Dim>(probe.stress.back())}};
  if (result.failure) answer["failure"] = to_json(*result.failure);
  const bool linear = scheme.formulation == Formulation::total_lagrangian_linear;
  const bool can_grow = linear ? !theory.critical_time_step || time_step > *theory.critical_time_step
                               : !is_finite_strain(scheme.formulation);
  answer["unstable"] = result.failure || result.growth ||
                       has_grown(result.summary, can_grow, energy_of_rounding(scene)) ||
                       !result.summary.lost_particles.empty();
  if (is_finite_strain(scheme.formulation)) add_limit_at_end(scene, result, answer);
  if (const auto& growth = result.growth)
    answer["growth"] = {{"step", growth->step}, {"time", growth->time}, {"cause", to_json(growth->cause)}};
  else if (answer["unstable"].get<bool>() && !is_total_lagrangian(scheme.formulation))
    answer["growth"] = {{"cause", to_json(cause_in_updated_lagrangian(theory, time_step, result.last))}};
  files.finish(result, answer);
  return answer;
}

}  // namespace

Json run_answer(const Case& input, const Request& request) {
  const Case keys = io::with_scene_keys(input);
  return in_dimension(keys, [&](auto dimension) { return run_answer<dimension()>(keys, request); });
}

}  // namespace sphstab::study
