// SPDX-License-Identifier: MIT
#include "cli/program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <stdexcept>

#include "io/files.hpp"
#include "io/scratch_folder.hpp"

namespace sphstab::cli_test {

Outcome run(const Arguments& arguments, const std::string& input) {
  const ScratchFolder folder;
  const std::string in = folder / "in", out = folder / "out", err = folder / "err";
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
  pid_t process = 0;
  const int failure = posix_spawn(&process, program.c_str(), &streams, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  if (failure != 0) throw std::runtime_error("cannot start " + program);
  int status = 0;
  waitpid(process, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, io::read_file(out), io::read_file(err)};
}

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

}  // namespace sphstab::cli_test
