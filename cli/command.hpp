// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/figure.hpp"
#include "model/keys.hpp"
#include "study/answers.hpp"

namespace sphstab::cli {

using study::Json;

/// Exit statuses of the program.
enum ExitStatus : int { done = 0, claim_fails = 1, bad_input = 2, run_unstable = 3, internal_fault = 4 };

/// A command that answers one question about one case.
struct CaseCommand {
  std::string_view name;
  std::string_view summary;
  std::vector<KeyGroup> groups;  ///< whose keys it reads and offers as flags
  Json (*answer)(const Case& input, const study::Request& request);
  std::string (*describe)(const Json& answer);         ///< for people; absent for commands of `batch` alone
  ExitStatus (*status)(const Json& answer) = nullptr;  ///< that the answer means; absent: `done` whatever it is
  /// Lines that lead to the answer, for --explain; absent: the command has no such flag.
  std::vector<std::string> (*explain)(const Case& input) = nullptr;
  std::vector<std::string> columns = {};       ///< that `table` shows unless told others; empty: every plain result
  Json (*rows)(const Json& answer) = nullptr;  ///< the answer as the rows of a table; absent: it has one row
  std::string (*figure)(const Case& input) = nullptr;  ///< the SVG of --figure; absent: there is no such option
  bool has_files = false;                              ///< whether --output makes it write files
};

CaseCommand dt_command();
CaseCommand matrix_command();
CaseCommand dispersion_command();
CaseCommand growth_command();
CaseCommand bisect_command();
CaseCommand spectrum_command();
CaseCommand run_command();

/// Every command that answers a case, those of `batch` alone (`kernel`, `sums`) included.
std::span<const CaseCommand> case_commands();

/// The one of that name. Throws InvalidInput naming `what` was to name it, and those there are.
const CaseCommand& find_case_command(std::string_view what, std::string_view name);

/// `batch`: reads JSON lines from a file or, if `path` is empty, from standard input.
int run_batch(const std::string& path);

/// `list`: names and parameters of what can be named in a case; everything if `topic` is empty.
Json list_answer(const std::string& topic);
std::string describe_list(const Json& answer);
/// The same as one table, a row a name, with the topic in front.
Json list_rows(const Json& answer);

}  // namespace sphstab::cli
