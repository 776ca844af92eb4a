// SPDX-License-Identifier: MIT
#include <map>
#include <numbers>

#include "analysis/spectrum.hpp"
#include "io/scene_input.hpp"
#include "study/answers.hpp"
#include "study/json_values.hpp"
#include "study/scene_input.hpp"
#include "study/step_comparison.hpp"

namespace sphstab::study {
namespace {

constexpr double hertz = 0.5 / std::numbers::pi;  // per angular frequency

constexpr std::string_view kind_name(analysis::BodyModeKind kind) {
  switch (kind) {
    case analysis::BodyModeKind::vibration:
      return "vibration";
    case analysis::BodyModeKind::rigid:
      return "rigid";
    case analysis::BodyModeKind::zero_energy:
      return "zero-energy";
  }
  return "";
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
  if (const auto count = input.number("lowest_modes")) {
    const auto modes = analysis::lowest_modes(scene.problem, scene.body, static_cast<int>(*count));
    std::map<std::string_view, int> found{{"rigid", 0}, {"zero-energy", 0}, {"vibration", 0}};
    answer["frequencies"] = answer["mode_kinds"] = Json::array();
    for (const auto& mode : modes) {
      answer["frequencies"].push_back(mode.omega * hertz);
      answer["mode_kinds"].push_back(kind_name(mode.kind));
      ++found[kind_name(mode.kind)];
    }
    answer["rigid_modes"] = found["rigid"];
    answer["zero_energy_modes"] = found["zero-energy"];
  }
  return answer;
}

}  // namespace

Json spectrum_answer(const Case& input, const Request& request) {
  const Case keys = io::with_scene_keys(input);
  return in_dimension(keys, [&](auto dimension) { return spectrum_answer<dimension()>(keys, request); });
}

}  // namespace sphstab::study
