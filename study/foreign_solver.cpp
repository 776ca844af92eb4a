// SPDX-License-Identifier: MIT
#include "study/foreign_solver.hpp"

#include <fmt/format.h>
#include <stdio.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "model/errors.hpp"

namespace sphstab::study {
namespace {

std::string replace_all(std::string text, std::string_view what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

struct Output {
  std::string text;
  int status;  ///< as waitpid gives it
};

/// Everything that a shell command prints to its standard output.
Output output_of(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw InvalidInput(fmt::format("command: '{}' cannot be started", command));
  Output output{};
  std::array<char, 4096> buffer;
  for (std::size_t read; (read = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    output.text.append(buffer.data(), read);
  output.status = pclose(pipe);
  return output;
}

std::optional<double> last_number(std::string_view line) {
  const auto begin = line.find_last_of(" \t,", line.find_last_not_of(" \t\r,"));
  std::string_view word = begin == std::string_view::npos ? line : line.substr(begin + 1);
  while (!word.empty() && (word.back() == '\r' || word.back() == ' ')) word.remove_suffix(1);
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

struct Amplitudes {
  std::vector<double> logarithms;  ///< up to the first that is no finite positive number
  bool exploded = false;           ///< whether there was one
};

Amplitudes read_amplitudes(std::string_view output) {
  Amplitudes amplitudes;
  while (!output.empty() && !amplitudes.exploded) {
    const auto end = output.find('\n');
    const auto amplitude = last_number(output.substr(0, end));
    output.remove_prefix(end == std::string_view::npos ? output.size() : end + 1);
    if (!amplitude) continue;
    if (*amplitude > 0.0 && std::isfinite(*amplitude))
      amplitudes.logarithms.push_back(std::log(*amplitude));
    else
      amplitudes.exploded = true;
  }
  return amplitudes;
}

}  // namespace

GrowthProbe foreign_solver(const std::string& command) {
  return [command](double time_step, long horizon) {
    const std::string run = replace_all(replace_all(command, "{time_step}", fmt::format("{}", time_step)), "{steps}",
                                        fmt::format("{}", horizon));
    const Output output = output_of(run);
    const auto [logarithms, exploded] = read_amplitudes(output.text);
    const long steps = static_cast<long>(logarithms.size());
    solver::GrowthFit fit{solver::Trend::growing, 0.0, 0.0, 1.0, steps};
    if (steps >= solver::fewest_amplitudes) fit = solver::judge_growth(logarithms);
    if (exploded) fit.trend = solver::Trend::growing;
    // A run that grows may end as it likes; any other must be whole.
    if ((exploded || steps >= solver::fewest_amplitudes) && fit.trend == solver::Trend::growing) return fit;
    if (output.status != 0)
      throw InvalidInput(WIFEXITED(output.status)
                             ? fmt::format("command: '{}' ended with status {}", run, WEXITSTATUS(output.status))
                             : fmt::format("command: '{}' was killed", run));
    const long needed = std::max(horizon, solver::fewest_amplitudes);
    if (steps < needed)
      throw InvalidInput(fmt::format("command: '{}' printed {} amplitudes, but {} are needed", run, steps, needed));
    return fit;
  };
}

}  // namespace sphstab::study
