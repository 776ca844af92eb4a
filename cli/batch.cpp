// SPDX-License-Identifier: MIT
#include <array>
#include <fstream>
#include <iostream>

#include "cli/command.hpp"
#include "io/case_input.hpp"
#include "io/document.hpp"
#include "io/json.hpp"

namespace sphstab::cli {
namespace {

/// Members of a line that are no keys of the case: what to answer, what to call it, and the expectation of a reference
/// line, which is passed over so that a file of reference cases can be piped in as it is.
constexpr std::array<const char*, 3> not_keys{"command", "id", "expect"};

const CaseCommand& find_command(const Json& line) {
  if (!line.contains("command") || !line["command"].is_string()) throw InvalidInput("command: missing");
  return find_case_command("command", line["command"].get<std::string>());
}

Json answer_line(Json line, Json& id) {
  if (line.contains("id")) id = line["id"];
  const CaseCommand& command = find_command(line);
  for (const char* name : not_keys) line.erase(name);
  Case input;
  io::set_from_json(input, line);
  return command.answer(input, {});
}

Json answer_text(const std::string& text) {
  Json id;
  try {
    Json result = answer_line(io::parse_json_line(text), id);
    return {{"id", id}, {"ok", true}, {"result", std::move(result)}};
  } catch (const std::exception& error) {
    return {{"id", id}, {"ok", false}, {"error", error.what()}};
  }
}

void answer_all(std::istream& lines) {
  for (std::string text; std::getline(lines, text);)
    if (text.find_first_not_of(" \t\r") != std::string::npos)
      std::cout << io::to_json_line(answer_text(text)) << std::endl;
}

}  // namespace

int run_batch(const std::string& path) {
  if (path.empty()) {
    answer_all(std::cin);
    return ExitStatus::done;
  }
  std::ifstream file(path);
  if (!file) throw InvalidInput("batch: '" + path + "' cannot be read");
  answer_all(file);
  if (file.bad()) throw InvalidInput("batch: '" + path + "' cannot be read");
  return ExitStatus::done;
}

}  // namespace sphstab::cli
