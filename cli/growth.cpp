// SPDX-License-Identifier: MIT

#include <fmt/format.h>

#include "cli/command.hpp"
#include "cli/text.hpp"
#include "study/growth_answer.hpp"

namespace sphstab::cli {
namespace {

std::string number(const Json& value, int digits = 6) { return number_or(value, "-", digits); }

std::string verdict(const Json& answer) {
  if (answer["verdict"] == "stable") return "stable: nothing grows";
  return fmt::format("unstable: grows by a factor e in {}, doubling in {}", number(answer["e_folding_time"]),
                     number(answer["doubling_time"]));
}

std::string intervals(const Json& list) {
  std::string text;
  for (const Json& interval : list)
    text += fmt::format("{}{} to {}", text.empty() ? "" : ", ", number(interval[0], 4), number(interval[1], 4));
  return text;
}

/// Whether the present ε removes what grows without it.
std::string effect(const Json& answer) {
  const double epsilon = answer["artificial_stress_epsilon"], without = answer["growth_rate_without_artificial_stress"];
  const bool grows = answer["growth_rate"].get<double>() > 0.0;
  if (epsilon == 0.0) return grows ? "none" : "none, and none is needed";
  if (without == 0.0) return fmt::format("epsilon = {:g} {}", epsilon, grows ? "makes it grow" : "is not needed");
  return fmt::format("epsilon = {:g} {} the growth of {:.6g} there is without it", epsilon,
                     grows ? "does not remove" : "removes", without);
}

std::string price(double factor) {
  if (factor <= 0.0) return "long waves in tension lose all their modulus: they are unstable themselves";
  return fmt::format("long waves in tension keep {:.4g} of their modulus, {:+.3g} % extension", factor,
                     100.0 * (1.0 / factor - 1.0));
}

std::string describe_cure(const Json& answer) {
  std::string text = row("artificial stress", effect(answer));
  if (answer["artificial_stress_epsilon"] != 0.0) text += row("its price", price(answer["tension_modulus_factor"]));
  if (answer["stabilising_epsilon"].empty()) return text + row("stabilising epsilon", "none up to 2");
  text += row("stabilising epsilon", intervals(answer["stabilising_epsilon"]));
  if (const double smallest = answer["smallest_stabilising_epsilon"]; smallest > 0.0)
    text += row("price of the least", price(answer["smallest_tension_modulus_factor"]));
  return text;
}

std::string describe_sides(const Json& sides) {
  std::string text = "\nA principal stress is zero, where artificial stress has a kink; the two states beside it:\n";
  for (const auto& [side, range] : sides.items())
    text += row(side, fmt::format("growth rate {}, omega^2 from {} to {}", number(range["growth_rate"]),
                                  number(range["omega_squared_min"]), number(range["omega_squared_max"])));
  return text;
}

std::string describe(const Json& answer) {
  const Json& mode = answer["critical_mode"];
  const bool stable = answer["verdict"] == "stable";
  std::string text = "Growth of the base state in continuous time, over the whole Brillouin zone\n";
  text += row("verdict", verdict(answer));
  if (!stable) text += row("growth rate", fmt::format("{:.8g} per time", answer["growth_rate"].get<double>()));
  text += row(stable ? "softest mode" : "fastest mode",
              fmt::format("k = ({}), {}", numbers(mode["wave_vector"], 6), mode["branch"].get<std::string>()));
  text += row("omega^2", fmt::format("from {:.8g} to {:.8g}", answer["omega_squared_min"].get<double>(),
                                     answer["omega_squared_max"].get<double>()));
  if (answer.contains("note")) text += row("note", answer["note"].get<std::string>());
  text += ellipticity_row(answer);
  if (answer.contains("stabilising_epsilon")) text += describe_cure(answer);
  if (answer.contains("one_sided")) text += describe_sides(answer["one_sided"]);
  return text;
}

std::string figure(const Case& input) {
  return std::visit([](const auto& drawing) { return io::render_svg(drawing); }, study::growth_figure(input));
}

}  // namespace

CaseCommand growth_command() {
  return {.name = "growth",
          .summary = "the fastest growth of a stressed state, which artificial stress removes it, and at what price",
          .groups = {KeyGroup::discretisation, KeyGroup::material, KeyGroup::scheme, KeyGroup::artificial_stress},
          .answer = study::growth_answer,
          .describe = describe,
          .columns = {"growth_rate", "verdict", "critical_mode.branch", "critical_mode.wave_vector",
                      "omega_squared_min", "omega_squared_max"},
          .figure = figure};
}

}  // namespace sphstab::cli
