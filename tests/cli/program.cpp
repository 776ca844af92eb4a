// SPDX-License-Identifier: MIT
#include "cli/program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <stdexcept>

#include "io/files.hpp"

namespace sphstab::cli_test {

Process::Process(const Arguments& arguments, const std::string& input) {
  const std::string in = folder_ / "in", out = folder_ / "out", err = folder_ / "err";
  io::write_file(in, input);

  std::string program = SPHSTAB_PROGRAM;
  Arguments copies = arguments;
  std::vector<char*> argv{program.data()};
  for (auto& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_addopen(&streams, STDIN_FILENO, in.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&streams, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&streams, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0600);
  const int failure = posix_spawn(&process_, program.c_str(), &streams, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  if (failure != 0) throw std::runtime_error("cannot start " + program);
}

void Process::send(int signal) const { ::kill(process_, signal); }

Outcome Process::wait() const {
  int status = 0;
  waitpid(process_, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, io::read_file(folder_ / "out"), io::read_file(folder_ / "err")};
}

Outcome run(const Arguments& arguments, const std::string& input) { return Process(arguments, input).wait(); }

Outcome result_of(const Arguments& arguments, const std::string& input) {
  Outcome outcome = run(arguments, input);
  CHECK(outcome.err == "");
  REQUIRE(outcome.status == 0);
  return outcome;
}

std::string complaint_about(const Arguments& arguments) {
  const Outcome outcome = run(arguments);
  CHECK(outcome.status == 2);
  CHECK(outcome.out == "");
  const std::string start = "sphstab: ";
  REQUIRE(outcome.err.starts_with(start));
  REQUIRE(outcome.err.find('\n') == outcome.err.size() - 1);
  return outcome.err.substr(start.size(), outcome.err.size() - start.size() - 1);
}

Arguments on_case(const std::string& command, const Arguments& more) {
  Arguments arguments{command, "--scheme", "tl-linear", "--young-modulus", "1", "--poisson-ratio", "0.3"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines.push_back(text.substr(begin, end - begin));
  return lines;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && line[i + 1] == '"')
        cells.back() += line[++i];
      else
        quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += line[i];
    }
  }
  return cells;
}

}  // namespace sphstab::cli_test
