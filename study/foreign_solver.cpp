// SPDX-License-Identifier: MIT
#include "study/foreign_solver.hpp"

#include <fmt/format.h>
#include <stdio.h>

#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "model/errors.hpp"

namespace sphstab::study {
namespace {

/// No run is judged by fewer amplitudes.
constexpr std::size_t fewest_amplitudes = 12;

std::string replace_all(std::string text, std::string_view what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// Everything that a shell command prints to its standard output.
std::string output_of(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw InvalidInput(fmt::format("command: '{}' cannot be started", command));
  std::string output;
  std::array<char, 4096> buffer;
  for (std::size_t read; (read = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) output.append(buffer.data(), read);
  if (const int status = pclose(pipe); status != 0)
    throw InvalidInput(fmt::format("command: '{}' ended with status {}", command, status));
  return output;
}

std::optional<double> last_number(std::string_view line) {
  const auto begin = line.find_last_of(" \t,", line.find_last_not_of(" \t\r,"));
  std::string_view word = begin == std::string_view::npos ? line : line.substr(begin + 1);
  while (!word.empty() && (word.back() == '\r' || word.back() == ' ')) word.remove_suffix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// ln(amplitude) up to the first that is no finite positive number.
std::vector<double> log_amplitudes(std::string_view output) {
  std::vector<double> logarithms;
  while (!output.empty()) {
    const auto end = output.find('\n');
    const auto amplitude = last_number(output.substr(0, end));
    output.remove_prefix(end == std::string_view::npos ? output.size() : end + 1);
    if (!amplitude) continue;
    if (!(*amplitude > 0.0) || !std::isfinite(*amplitude)) break;
    logarithms.push_back(std::log(*amplitude));
  }
  return logarithms;
}

}  // namespace

GrowthProbe foreign_solver(const std::string& command) {
  return [command](double time_step, long horizon) {
    const std::string run = replace_all(replace_all(command, "{time_step}", fmt::format("{}", time_step)), "{steps}",
                                        fmt::format("{}", horizon));
    const auto amplitudes = log_amplitudes(output_of(run));
    if (amplitudes.size() < fewest_amplitudes)
      throw InvalidInput(fmt::format("command: '{}' printed {} amplitudes, but {} are needed", run, amplitudes.size(),
                                     fewest_amplitudes));
    return solver::judge_growth(amplitudes);
  };
}

}  // namespace sphstab::study
