// SPDX-License-Identifier: MIT
#include "cli/text.hpp"

#include <fmt/format.h>

namespace sphstab::cli {

std::string row(std::string_view name, std::string_view content) { return fmt::format("  {:<20} {}\n", name, content); }

std::string numbers(const study::Json& list, int digits) {
  std::string text;
  for (const auto& number : list)
    text += fmt::format("{}{:.{}g}", text.empty() ? "" : ", ", number.get<double>(), digits);
  return text;
}

std::string number_or(const study::Json& number, std::string_view otherwise, int digits) {
  return number.is_null() ? std::string(otherwise) : fmt::format("{:.{}g}", number.get<double>(), digits);
}

std::string complex_number(std::complex<double> value, int digits) {
  if (value.imag() == 0.0) return fmt::format("{:.{}g}", value.real(), digits);
  return fmt::format("{:.{}g}{:+.{}g}i", value.real(), digits, value.imag(), digits);
}

std::complex<double> complex_of(const study::Json& pair) { return {pair[0].get<double>(), pair[1].get<double>()}; }

std::string ellipticity_row(const study::Json& answer) {
  if (!answer.contains("ellipticity")) return "";
  const study::Json& ellipticity = answer["ellipticity"];
  const std::string weakest =
      fmt::format("the slowest wave is along ({}), c^2 = {:.6g}", numbers(ellipticity["weakest_direction"], 4),
                  ellipticity["squared_speed"].get<double>());
  return row("ellipticity", ellipticity["lost"].get<bool>()
                                ? "LOST, a property of the law and not of the particles: " + weakest
                                : "kept: " + weakest);
}

std::string subject(const study::Json& answer) {
  if (answer.contains("scene")) return "the scene " + answer["scene"].get<std::string>();
  const bool plate = answer.contains("plate");
  return fmt::format("a {} of {}", plate ? "free plate" : "periodic patch",
                     numbers(answer[plate ? "plate" : "patch"], 6));
}

}  // namespace sphstab::cli
