// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "analysis/spectrum.hpp"
#include "io/document.hpp"
#include "io/particle_output.hpp"
#include "io/scene_input.hpp"
#include "study/answers.hpp"
#include "study/json_values.hpp"
#include "study/particle_pictures.hpp"
#include "study/scene_input.hpp"
#include "study/scene_run.hpp"
#include "study/step_comparison.hpp"

namespace sphstab::study {
namespace {

constexpr double hertz = 0.5 / std::numbers::pi;  // per angular frequency

template <int Dim>
std::vector<Vector<Dim>> to_vectors(const Eigen::VectorXd& components) {
  std::vector<Vector<Dim>> vectors;
  for (Eigen::Index i = 0; i < components.size(); i += Dim) vectors.push_back(components.template segment<Dim>(i));
  return vectors;
}

constexpr int most_modes_in_picture = 12;

/// Mode shapes of a spectrum: states of an HDF5 file with the frequencies as times, and pictures.
template <int Dim>
void write_modes(const Body<Dim>& body, const std::string& file, const std::string& title,
                 const std::vector<std::pair<double, std::vector<Vector<Dim>>>>& modes, io::OutputFolder& folder) {
  io::ParticleFile states(folder.assembly(file + ".h5"), body);
  std::vector<std::pair<std::string, std::vector<Vector<Dim>>>> drawn;
  for (const auto& [frequency, shape] : modes) {
    states.add_state(frequency, {io::vector_field<Dim>("displacement", shape)});
    if (drawn.size() < most_modes_in_picture) drawn.emplace_back(fmt::format("{:.6g} Hz", frequency), shape);
  }
  states.finish();
  if (body.size() <= largest_picture) folder.write(file + ".svg", io::render_svg(mode_figure<Dim>(title, body, drawn)));
}

template <int Dim>
Json spectrum_answer(const Case& input, const Request& request) {
  const auto scene = make_scene<Dim>(input);
  analysis::BodyLimitOptions options{.progress = request.progress};
  if (const auto bound = input.required_word("upper_bound"); bound != "auto")
    options.bound = from_name<analysis::BoundKind>("upper_bound", bound);
  const auto limit = analysis::body_limit(scene.problem, scene.body, options);
  Json answer = body_name(input);
  answer.update({{"particles", scene.body.size()},
                 {"critical_time_step", limit.critical_time_step},
                 {"bracket", {limit.bracket.low, limit.bracket.high}},
                 {"bracket_kind", name_of(limit.bracket_kind)},
                 {"omega_max", limit.omega_max},
                 {"residual", limit.residual},
                 {"applications", limit.applications}});
  if (limit.bracket_kind == analysis::BoundKind::probabilistic)
    answer["failure_probability"] = limit.failure_probability;
  if (!scene.body.site.empty() && scene.body.materials.size() == 1) {
    const auto bulk = bulk_step(scene.problem);
    answer["bulk_theory"] = number_or_null(bulk);
    answer["patch_deficit"] = bulk ? Json(limit.critical_time_step / *bulk - 1.0) : Json();
  }
  using Shapes = std::vector<std::pair<double, std::vector<Vector<Dim>>>>;
  if (request.folder != nullptr)
    write_modes<Dim>(scene.body, "critical_mode", "Mode of the critical time step",
                     Shapes{{limit.omega_max * hertz, to_vectors<Dim>(limit.displacement)}}, *request.folder);
  if (const auto count = input.number("lowest_modes")) {
    Shapes shapes;
    const auto modes = analysis::lowest_modes(scene.problem, scene.body, static_cast<int>(*count));
    std::map<std::string_view, int> found{{"rigid", 0}, {"zero-energy", 0}, {"vibration", 0}};
    answer["frequencies"] = answer["mode_kinds"] = Json::array();
    for (const auto& mode : modes) {
      answer["frequencies"].push_back(mode.omega * hertz);
      answer["mode_kinds"].push_back(name_of(mode.kind));
      ++found[name_of(mode.kind)];
      if (request.folder != nullptr) shapes.emplace_back(mode.omega * hertz, to_vectors<Dim>(mode.displacement));
    }
    if (request.folder != nullptr)
      write_modes<Dim>(scene.body, "lowest_modes", "Lowest modes", shapes, *request.folder);
    answer["rigid_modes"] = found["rigid"];
    answer["zero_energy_modes"] = found["zero-energy"];
  }
  if (request.folder != nullptr) request.folder->write("summary.json", io::write(answer, io::Format::json));
  return answer;
}

/// Rows of probes.csv at most: some megabytes a probe.
constexpr long largest_probe_table = 20000;

/// Beyond the critical step, energy that the loads have not given shows that the run has grown.
constexpr double energy_that_shows_growth = 1e3;

bool has_grown(const SceneSummary& summary, bool above_critical_step) {
  return above_critical_step &&
         summary.kinetic_energy + summary.strain_energy > energy_that_shows_growth * std::abs(summary.work);
}

Json to_json(const SceneSummary& summary) {
  return {{"time", summary.time},
          {"steps", summary.steps},
          {"right_hand_sides", summary.right_hand_sides},
          {"largest_displacement", summary.largest_displacement},
          {"largest_velocity", summary.largest_velocity},
          {"largest_von_mises_stress", summary.largest_von_mises_stress},
          {"kinetic_energy", summary.kinetic_energy},
          {"strain_energy", summary.strain_energy},
          {"work", summary.work},
          {"momentum_drift", number_or_null(summary.momentum_drift)}};
}

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
    states_->add_state(snapshot.time, {io::vector_field<Dim>("displacement", snapshot.state.displacement),
                                       io::vector_field<Dim>("velocity", snapshot.state.velocity),
                                       io::tensor_field<Dim>("stress", snapshot.stress),
                                       io::scalar_field("von_mises_stress", snapshot.von_mises_stress)});
    if (body_.size() <= largest_picture && drawable<Dim>(body_, snapshot.state.displacement))
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
            .panels = {particle_panel<Dim>("", body_, snapshot.state.displacement, 1.0, snapshot.von_mises_stress)},
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
  if (input.has("time_step") && input.has("step_fraction"))
    throw InvalidInput("step_fraction: cannot be given with time_step");
  const auto scene = make_scene<Dim>(input);
  const double duration = input.required_number("duration");
  const double critical = theory_limit<Dim>(scene.problem, scene.body).critical_time_step.value();
  const double time_step = input.number("time_step").value_or(*input.number("step_fraction") * critical);
  RunFiles<Dim> files(scene.body, request.folder);
  SceneRunOptions<Dim> options{.time_step = time_step,
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
  answer.update({{"particles", scene.body.size()}, {"time_step", time_step}, {"critical_time_step", critical}});
  answer.update(to_json(result.summary));
  answer["probes"] = Json::object();
  for (const auto& probe : result.probes)
    if (!probe.displacement.empty())
      answer["probes"][probe.name] = {{"particle", probe.particle},
                                      {"displacement", components<Dim>(probe.displacement.back())},
                                      {"velocity", components<Dim>(probe.velocity.back())},
                                      {"stress", rows<Dim>(probe.stress.back())}};
  if (const auto& failure = result.failure)
    answer["failure"] = {
        {"step", failure->step}, {"time", failure->time}, {"particle", failure->particle}, {"field", failure->field}};
  answer["unstable"] = result.failure || has_grown(result.summary, time_step > critical);
  files.finish(result, answer);
  return answer;
}

}  // namespace

Json spectrum_answer(const Case& input, const Request& request) {
  const Case keys = io::with_scene_keys(input);
  return in_dimension(keys, [&](auto dimension) { return spectrum_answer<dimension()>(keys, request); });
}

Json run_answer(const Case& input, const Request& request) {
  const Case keys = io::with_scene_keys(input);
  return in_dimension(keys, [&](auto dimension) { return run_answer<dimension()>(keys, request); });
}

}  // namespace sphstab::study
