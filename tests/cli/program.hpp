// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/scratch_folder.hpp"

/// The real program, run as a user runs it.
namespace sphstab::cli_test {

using Arguments = std::vector<std::string>;
using Json = nlohmann::ordered_json;

struct Outcome {
  int status;  ///< of the exit; −1 if the program was ended by a signal
  std::string out;
  std::string err;

  Json json() const { return Json::parse(out); }
};

/// `sphstab` while it runs. Its end must be waited for.
class Process {
 public:
  explicit Process(const Arguments& arguments, const std::string& input = "");

  void send(int signal) const;
  Outcome wait() const;

 private:
  ScratchFolder folder_;
  pid_t process_ = 0;
};

/// Runs `sphstab` with these arguments and this standard input.
Outcome run(const Arguments& arguments, const std::string& input = "");

/// The same; the outcome must be a result: status 0, nothing but the result printed.
Outcome result_of(const Arguments& arguments, const std::string& input = "");

/// The same; the outcome must be a refusal: status 2, an empty standard output, and on standard error one line, which
/// is returned without "sphstab: " and its end.
std::string complaint_about(const Arguments& arguments);

/// `command` on a complete case of tl-linear with `more` behind it.
Arguments on_case(const std::string& command, const Arguments& more = {});

/// The lines of a text that ends in a newline, without their ends.
std::vector<std::string> lines_of(const std::string& text);

/// The cells of a line of CSV.
std::vector<std::string> cells_of(const std::string& line);

}  // namespace sphstab::cli_test
