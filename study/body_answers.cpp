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

}  // namespace

Json spectrum_answer(const Case& input, const Request& request) {
  const Case keys = io::with_scene_keys(input);
  return in_dimension(keys, [&](auto dimension) { return spectrum_answer<dimension()>(keys, request); });
}

}  // namespace sphstab::study
