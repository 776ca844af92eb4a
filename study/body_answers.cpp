// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "analysis/deformed_spectrum.hpp"
#include "analysis/spectrum.hpp"
#include "io/document.hpp"
#include "io/particle_input.hpp"
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

/// Modes with the frequencies, Hz, that they are called by.
template <int Dim>
using Shapes = std::vector<std::pair<double, std::vector<Vector<Dim>>>>;

template <int Dim>
std::vector<Vector<Dim>> to_vectors(const Eigen::VectorXd& components) {
  std::vector<Vector<Dim>> vectors;
  for (Eigen::Index i = 0; i < components.size(); i += Dim) vectors.push_back(components.template segment<Dim>(i));
  return vectors;
}

constexpr int most_modes_in_picture = 12;

/// Mode shapes of a spectrum: states of an HDF5 file with the frequencies as times, and pictures.
template <int Dim>
void write_modes(const Body<Dim>& body, const std::string& file, const std::string& title, const Shapes<Dim>& modes,
                 io::OutputFolder& folder) {
  io::ParticleFile states(folder.assembly(file + ".h5"), body);
  std::vector<std::pair<std::string, std::vector<Vector<Dim>>>> drawn;
  for (const auto& [frequency, shape] : modes) {
    states.add_state(frequency, {io::vector_field<Dim>("displacement", shape)});
    if (drawn.size() < most_modes_in_picture) drawn.emplace_back(fmt::format("{:.6g} Hz", frequency), shape);
  }
  states.finish();
  if (body.size() <= largest_picture) folder.write(file + ".svg", io::render_svg(mode_figure<Dim>(title, body, drawn)));
}

/// Beside the step of a body that of the infinite lattice that its particles are on.
template <int Dim>
void add_bulk_theory(const Scene<Dim>& scene, const std::optional<double>& step, Json& answer) {
  if (scene.body.site.empty() || scene.body.materials.size() > 1) return;
  const auto bulk = bulk_step(scene.problem);
  answer["bulk_theory"] = number_or_null(bulk);
  answer["patch_deficit"] = bulk && step ? Json(*step / *bulk - 1.0) : Json();
}

template <int Dim>
void add_lowest_modes(const Scene<Dim>& scene, int count, const Request& request, Json& answer) {
  Shapes<Dim> shapes;
  const auto modes = analysis::lowest_modes(scene.problem, scene.body, count);
  std::map<std::string_view, int> found{{"rigid", 0}, {"zero-energy", 0}, {"vibration", 0}};
  answer["frequencies"] = answer["mode_kinds"] = Json::array();
  for (const auto& mode : modes) {
    answer["frequencies"].push_back(mode.omega * hertz);
    answer["mode_kinds"].push_back(name_of(mode.kind));
    ++found[name_of(mode.kind)];
    if (request.folder != nullptr) shapes.emplace_back(mode.omega * hertz, to_vectors<Dim>(mode.displacement));
  }
  if (request.folder != nullptr) write_modes<Dim>(scene.body, "lowest_modes", "Lowest modes", shapes, *request.folder);
  answer["rigid_modes"] = found["rigid"];
  answer["zero_energy_modes"] = found["zero-energy"];
}

/// About the undeformed body.
template <int Dim>
Json spectrum_at_rest(const Case& input, const Scene<Dim>& scene, const Request& request) {
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
  add_bulk_theory(scene, limit.critical_time_step, answer);
  if (request.folder != nullptr)
    write_modes<Dim>(scene.body, "critical_mode", "Mode of the critical time step",
                     Shapes<Dim>{{limit.omega_max * hertz, to_vectors<Dim>(limit.displacement)}}, *request.folder);
  if (const auto count = input.number("lowest_modes"))
    add_lowest_modes(scene, static_cast<int>(*count), request, answer);
  return answer;
}

/// The state that the spectrum is about: the base state, or one of a run.
template <int Dim>
class StateOfBody {
 public:
  StateOfBody(const Case& input, const Scene<Dim>& scene)
      : input_(input), scene_(scene), body_operator_(scene.problem, scene.body), placed_(scene.body) {
    for (auto& position : placed_.position) position = scene.problem.deformation_gradient * position;
    if (!input.has("state")) return;
    const auto number = input.number("snapshot");
    stored_ = io::read_state<Dim>(*input.word("state"), scene.body,
                                  number ? std::optional(static_cast<int>(*number)) : std::nullopt);
    body_operator_.set_state(analysis::components_of<Dim>(stored_->displacement));
    for (int a = 0; a < placed_.size(); ++a) placed_.position[a] += stored_->displacement[a];
  }

  Json spectrum(const Request& request) {
    const auto count = input_.number("lowest_modes");
    if (const auto unknowns = body_operator_.unknowns().size();
        count && unknowns > analysis::most_unknowns_of_whole_spectrum)
      throw InvalidInput(fmt::format("lowest_modes: about a deformed state of a body of at most {} unknowns, not {}",
                                     analysis::most_unknowns_of_whole_spectrum, unknowns));
    const auto spectrum = analysis::deformed_spectrum(body_operator_, request.progress);
    Json answer = body_name(input_);
    answer["particles"] = placed_.size();
    if (stored_) answer["state"] = {{"snapshot", stored_->number}, {"time", stored_->time}};
    add_ends(spectrum, answer);
    add_bulk_theory(scene_, spectrum.step_of_largest, answer);
    write("critical_mode", "Mode of the largest frequency", {spectrum.largest}, request);
    if (spectrum.growing)
      write("growing_mode", fmt::format("Mode that grows fastest, {:.6g} per time", spectrum.growth_rate),
            {*spectrum.growing}, request);
    if (count) {
      const auto end = spectrum.all.begin() + std::min<long>(static_cast<long>(*count), std::ssize(spectrum.all));
      const std::vector<analysis::DeformedMode> lowest(spectrum.all.begin(), end);
      answer["omega_squared"] = answer["frequencies"] = Json::array();
      for (const auto& mode : lowest) {
        answer["omega_squared"].push_back(complex_pair(mode.omega_squared));
        answer["frequencies"].push_back(frequency_of(mode));
      }
      write("lowest_modes", "Lowest modes", lowest, request);
    }
    return answer;
  }

 private:
  /// Whether no mode can have been missed that grows faster than what is resolved: a symmetric operator has no ω² but
  /// real ones, between its ends, and so has R·S about a uniform state (analysis/tangent_moduli.hpp).
  bool is_all_said(const analysis::DeformedSpectrum& spectrum) const {
    const bool is_symmetric = scene_.problem.scheme.formulation == Formulation::total_lagrangian_pk1;
    return !spectrum.has_damped_pairs && (!spectrum.all.empty() || is_symmetric || !stored_);
  }

  void add_ends(const analysis::DeformedSpectrum& spectrum, Json& answer) const {
    const auto& step = spectrum.step_of_largest;
    const auto& growing = spectrum.growing;
    answer.update({{"verdict", growing                 ? "never-stable"
                               : is_all_said(spectrum) ? "conditionally-stable"
                                                       : "undecided"},
                   {"critical_time_step", growing ? Json() : number_or_null(step)},
                   {"critical_time_step_of_largest", number_or_null(step)},
                   {"growth_rate", spectrum.growth_rate},
                   {"smallest_detectable_growth_rate", spectrum.smallest_seen_growth_rate},
                   {"omega_squared_of_growth", growing ? complex_pair(growing->omega_squared) : Json()},
                   {"bracket", Json()},
                   {"omega_max", step ? Json(std::sqrt(spectrum.largest.omega_squared.real())) : Json()},
                   {"omega_squared_max", complex_pair(spectrum.largest.omega_squared)},
                   {"omega_squared_min", complex_pair(spectrum.smallest.omega_squared)},
                   {"residual", std::max(spectrum.largest.residual, spectrum.smallest.residual)},
                   {"applications", spectrum.applications},
                   {"whole_spectrum", !spectrum.all.empty()}});
  }

  static double frequency_of(const analysis::DeformedMode& mode) {
    return std::sqrt(mode.omega_squared).real() * hertz;
  }

  void write(const std::string& file, const std::string& title, const std::vector<analysis::DeformedMode>& modes,
             const Request& request) const {
    if (request.folder == nullptr) return;
    Shapes<Dim> shapes;
    for (const auto& mode : modes)
      shapes.emplace_back(frequency_of(mode), to_vectors<Dim>(body_operator_.displacement(mode.vector)));
    write_modes<Dim>(placed_, file, title, shapes, *request.folder);
  }

  const Case& input_;
  const Scene<Dim>& scene_;
  analysis::DeformedBodyOperator<Dim> body_operator_;
  Body<Dim> placed_;  ///< with its particles where they are in this state
  std::optional<io::ParticleState<Dim>> stored_;
};

/// Whether the spectrum is about a deformed state, of which nothing proves that no frequency is larger.
template <int Dim>
bool is_deformed(const Case& input, const Scene<Dim>& scene) {
  if (!input.has("state")) {
    if (input.has("snapshot")) throw InvalidInput("snapshot: is one of a state, which is missing");
    return scene.problem.deformation_gradient != Tensor<Dim>::Identity();
  }
  if (!is_finite_strain(scene.problem.scheme.formulation))
    throw InvalidInput("state: the spectrum depends on it with the schemes tl-corotated and tl-pk1 only");
  return true;
}

template <int Dim>
Json spectrum_answer(const Case& input, const Request& request) {
  const auto scene = make_scene<Dim>(input);
  const bool about_deformed = is_deformed(input, scene);
  if (about_deformed && input.required_word("upper_bound") != "auto")
    throw InvalidInput("upper_bound: is of a body at rest; about a deformed state there is none");
  const Json answer =
      about_deformed ? StateOfBody<Dim>(input, scene).spectrum(request) : spectrum_at_rest(input, scene, request);
  if (request.folder != nullptr) request.folder->write("summary.json", io::write(answer, io::Format::json));
  return answer;
}

}  // namespace

Json spectrum_answer(const Case& input, const Request& request) {
  const Case keys = io::with_scene_keys(input);
  return in_dimension(keys, [&](auto dimension) { return spectrum_answer<dimension()>(keys, request); });
}

}  // namespace sphstab::study
