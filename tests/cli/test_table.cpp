// SPDX-License-Identifier: MIT
// The command table: a sweep is the single commands of its cases, and survives interruption.
#include <algorithm>
#include <catch2/catch.hpp>
#include <charconv>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "cli/program.hpp"
#include "io/files.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::cli_test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

const Arguments kernels_and_h{"--sweep", "kernel=cubic-spline,wendland-c2", "--sweep", "h-over-spacing=1:1.5:3"};

/// The same with a case that fails: no neighbour lies in the support 0.8.
const Arguments with_a_bad_case{"--sweep", "h-over-spacing=1,0.4,1.3"};

Arguments table(Arguments sweep, const Arguments& more = {}) {
  sweep.insert(sweep.end(), more.begin(), more.end());
  return on_case("table", sweep);
}

Json rows_of(const Arguments& arguments) {
  Arguments in_json = arguments;
  in_json.insert(in_json.end(), {"--format", "json"});
  return result_of(in_json).json()["rows"];
}

std::size_t lines_in(const std::filesystem::path& file) {
  return std::filesystem::exists(file) ? lines_of(io::read_file(file)).size() : 0;
}

/// A sweep of 2000 cases, about half a second of work, into a file.
Arguments long_sweep(const std::string& output) {
  return table(
      {"--sweep", "lattice=square,hexagonal", "--sweep", "kernel=cubic-spline,quartic-spline,wendland-c2,wendland-c4",
       "--sweep", "h-over-spacing=0.4:2:250", "--format", "csv"},
      {"--output", output});
}
constexpr int long_sweep_rows = 2000;

/// Lets the long sweep finish some rows, and sends it a signal.
Outcome interrupt(const Arguments& sweep, const std::filesystem::path& journal, int signal) {
  constexpr std::size_t enough_rows = 50;
  const Process process(sweep);
  while (lines_in(journal) < enough_rows) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  process.send(signal);
  return process.wait();
}

/// The number in front of a word in a message.
long count_before(const std::string& message, const std::string& word) {
  const auto end = message.find(" " + word);
  REQUIRE(end != std::string::npos);
  return std::stol(message.substr(message.find_last_of(' ', end - 1) + 1));
}

}  // namespace

TEST_CASE("each row of a table is what the single command says, digit for digit", "[fast]") {
  const Json rows = rows_of(table(kernels_and_h, {"--columns",
                                                  "critical_time_step,bracket,critical_mode,equivalents.DualSPHysics "
                                                  "FlexStruc.factor_at_limit,zero_energy_modes"}));
  REQUIRE(rows.size() == 6);
  int i = 0;
  for (const std::string kernel : {"cubic-spline", "wendland-c2"})
    for (const double h_over_spacing : {1.0, 1.25, 1.5}) {
      const Json& row = rows[i++];
      const Json single = result_of(on_case("dt", {"--kernel", kernel, "--h-over-spacing",
                                                   std::to_string(h_over_spacing), "--format", "json"}))
                              .json();
      CHECK(row ==
            Json{{"kernel", kernel},
                 {"h_over_spacing", h_over_spacing},
                 {"critical_time_step", single["critical_time_step"]},
                 {"bracket", single["bracket"]},
                 {"critical_mode", single["critical_mode"]},
                 {"equivalents.DualSPHysics FlexStruc.factor_at_limit", single["equivalents"][2]["factor_at_limit"]},
                 {"zero_energy_modes", single["zero_energy_modes"]}});
    }
}

TEST_CASE("a table of dt shows step, Courant number, verdict and mode by default", "[fast]") {
  const Json rows = rows_of(table(kernels_and_h));
  const Json single = result_of(on_case("dt", {"--h-over-spacing", "1", "--format", "json"})).json();
  CHECK(rows[0] == Json{{"kernel", "cubic-spline"},
                        {"h_over_spacing", 1.0},
                        {"critical_time_step", single["critical_time_step"]},
                        {"courant_number", single["courant_number"]},
                        {"verdict", "conditionally-stable"},
                        {"critical_mode.branch", single["critical_mode"]["branch"]},
                        {"critical_mode.wave_vector", single["critical_mode"]["wave_vector"]}});
}

TEST_CASE("every case command can answer a table, with every plain result by default", "[fast]") {
  const auto keys = [](const Json& row) {
    Arguments names;
    for (const auto& [key, value] : row.items()) names.push_back(key);
    return names;
  };
  CHECK(keys(rows_of(table({"--sweep", "time-step=0.1,0.2"}, {"--answer", "matrix", "--wave-vector", "1,0"}))[1]) ==
        Arguments{"time_step", "spectral_radius", "power_bounded"});
  CHECK(keys(rows_of(table({"--sweep", "distance=0.1,0.2"}, {"--answer", "kernel"}))[1]) ==
        Arguments{"distance", "W", "dW", "d2W", "normalisation"});
  CHECK(keys(rows_of(table({"--sweep", "wave-vector=0,1;2,3"}, {"--answer", "sums"}))[1]) ==
        Arguments{"wave_vector", "beta_sum", "neighbours"});
  const Json run = rows_of(
      table({"--sweep", "patch=4,3;3,3"}, {"--answer", "bisect", "--tolerance", "1e-4", "--columns", "agrees,theory"}));
  CHECK(run[0]["patch"] == Json({4, 3}));
  CHECK(run[0]["agrees"] == true);
  CHECK(run[1]["theory"] ==
        result_of(on_case("bisect", {"--patch", "3,3", "--tolerance", "1e-4", "--format", "json"})).json()["theory"]);
}

TEST_CASE("a case file holds base and sweep, and flags override both", "[fast]") {
  const ScratchFolder folder;
  const std::string file = folder / "case.toml";
  io::write_file(file,
                 "scheme = \"tl-linear\"\nyoung_modulus = 2\npoisson_ratio = 0.3\n[sweep]\n"
                 "kernel = [\"cubic-spline\", \"wendland-c2\"]\nh_over_spacing = [1, 1.25, 1.5]\n");
  const Arguments from_file{"table", "--case", file, "--young-modulus", "1", "--format", "json"};
  const auto with = [&](const Arguments& more) {
    Arguments arguments = from_file;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  CHECK(result_of(from_file).out == result_of(table(kernels_and_h, {"--format", "json"})).out);
  // A flag takes the place of the same key of the file; another one runs faster than the file's.
  CHECK(result_of(with({"--sweep", "kernel=gaussian", "--sweep", "density=1,2"})).out ==
        result_of(table({"--sweep", "kernel=gaussian", "--sweep", "h_over_spacing=1:1.5:3", "--sweep", "density=1,2"},
                        {"--format", "json"}))
            .out);
  CHECK(complaint_about(with({"--kernel", "gaussian"})) == "kernel: is swept and given a value too");
  CHECK_THAT(complaint_about({"dt", "--case", file}), StartsWith("sweep: is read by table only"));
}

TEST_CASE("tables come in every format, and those for programs with every digit", "[fast]") {
  const Arguments sweep{"--sweep", "h-over-spacing=1,1.3", "--columns", "critical_time_step,verdict"};
  const double step = rows_of(table(sweep))[0]["critical_time_step"];
  const auto out = [&](const std::string& format) { return result_of(table(sweep, {"--format", format})).out; };
  const auto csv = lines_of(out("csv"));
  REQUIRE(csv.size() == 3);
  CHECK(cells_of(csv[0]) == Arguments{"h_over_spacing", "critical_time_step", "verdict"});
  const std::string cell = cells_of(csv[1])[1];
  double parsed = 0.0;
  std::from_chars(cell.data(), cell.data() + cell.size(), parsed);
  CHECK(parsed == step);
  CHECK(cells_of(csv[2])[0] == "1.3");
  CHECK(cells_of(csv[2])[2] == "conditionally-stable");

  CHECK(lines_of(out("text")) == Arguments{"h_over_spacing  critical_time_step  verdict",
                                           "             1           1.6305622  conditionally-stable",
                                           "           1.3           2.0926259  conditionally-stable"});
  CHECK(lines_of(out("markdown")) == Arguments{"| h_over_spacing | critical_time_step | verdict |", "|---:|---:|---|",
                                               "| 1 | 1.6305622 | conditionally-stable |",
                                               "| 1.3 | 2.0926259 | conditionally-stable |"});
  CHECK_THAT(out("latex"),
             StartsWith("\\begin{tabular}{rrl}\n") && Contains("1.3 & 2.0926259 & conditionally-stable \\\\\n"));
}

TEST_CASE("a bad case has its error in its row, the table a warning, and the status is 0", "[fast]") {
  const Outcome outcome = run(table(with_a_bad_case, {"--format", "json"}));
  CHECK(outcome.status == 0);
  CHECK(outcome.err == "sphstab: warning: 1 of 3 cases failed, see the column error\n");
  const Json rows = outcome.json()["rows"];
  CHECK(rows[0]["error"].is_null());
  CHECK(rows[1] ==
        Json{{"h_over_spacing", 0.4},
             {"critical_time_step", nullptr},
             {"courant_number", nullptr},
             {"verdict", nullptr},
             {"critical_mode.branch", nullptr},
             {"critical_mode.wave_vector", nullptr},
             {"error",
              "smoothing_length: no neighbour lies strictly inside the support 0.8 (square lattice, spacing 1)"}});
  CHECK(rows[2]["verdict"] == "conditionally-stable");
  CHECK_THAT(complaint_about(table({"--sweep", "h-over-spacing=0.4,0.3"})),
             EndsWith("support 0.8 (square lattice, spacing 1)"));
}

TEST_CASE("what is wrong with a table is said before the work, in one line", "[fast]") {
  const auto complaint = [](const Arguments& sweep, const Arguments& more = {}) {
    return complaint_about(table(sweep, more));
  };
  CHECK(complaint({}) == "sweep: missing (KEY=VALUES)");
  CHECK_THAT(complaint({"--sweep", "kernl=gaussian"}), StartsWith("key: 'kernl' is not known; did you mean 'kernel'?"));
  CHECK(complaint({"--sweep", "spacing=1,2", "--sweep", "spacing=3"}) == "spacing: is swept twice");
  CHECK(complaint({"--sweep", "spacing=1,2"}, {"--spacing", "1"}) == "spacing: is swept and given a value too");
  CHECK(complaint({"--sweep", "patch=3,3;4,4"}) == "patch: is not read by dt");
  CHECK(complaint({"--sweep", "spacing=1:2:1"}) ==
        "spacing: '1:2:1' has a count that is no whole number from 2 to 10000000");
  CHECK_THAT(complaint(kernels_and_h, {"--answer", "dtt"}),
             StartsWith("answer: 'dtt' is not known; did you mean 'dt'?"));
  CHECK_THAT(complaint(kernels_and_h, {"--format", "xml"}), StartsWith("format: 'xml' is not known"));
  CHECK_THAT(complaint(kernels_and_h, {"--columns", "critical_time_stp"}),
             StartsWith("columns: 'critical_time_stp' is not known; did you mean 'critical_time_step'? Allowed: "));
  CHECK_THAT(complaint(kernels_and_h, {"--columns", "verdict,"}), StartsWith("columns: '' is not known"));
  CHECK_THAT(complaint(kernels_and_h, {"--output", "missing/table.csv"}), EndsWith("missing: no such folder"));
  CHECK(complaint(kernels_and_h, {"--output", ""}) == "output: is empty, not the name of a file");
  CHECK(complaint(kernels_and_h, {"--overwrite"}) == "overwrite: needs --output");
}

TEST_CASE("a table goes to a file whole, and replaces none unasked", "[fast]") {
  const ScratchFolder folder;
  const std::string file = folder / "table.csv";
  const Arguments to_file = table(kernels_and_h, {"--format", "csv", "--output", file});
  const Outcome outcome = run(to_file);
  CHECK(outcome.status == 0);
  CHECK(outcome.out == "");
  CHECK_THAT(outcome.err, StartsWith("sphstab: " + file + ": 6 rows, 0 of them taken over, 0 errors, "));
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK(folder.names() == Arguments{"table.csv"});
  CHECK(io::read_file(file) == result_of(table(kernels_and_h, {"--format", "csv"})).out);

  CHECK(complaint_about(to_file) == file + ": exists already");
  Arguments other = table(with_a_bad_case, {"--format", "csv", "--output", file, "--overwrite"});
  CHECK(run(other).status == 0);
  CHECK(lines_of(io::read_file(file)).size() == 4);
  CHECK(folder.names() == Arguments{"table.csv"});
}

TEST_CASE("a table that cannot be made leaves neither file nor journal", "[fast]") {
  const ScratchFolder folder;
  const std::string file = folder / "table.csv";
  complaint_about(table(kernels_and_h, {"--output", file, "--columns", "stp"}));
  complaint_about(table({"--sweep", "h-over-spacing=0.4,0.3"}, {"--output", file}));
  CHECK(folder.names().empty());
}

TEST_CASE("a sweep that was killed goes on where it was, to the same bytes", "[fast]") {
  const ScratchFolder folder;
  const std::string file = folder / "table.csv", journal = file + ".journal", whole = folder / "whole.csv";
  REQUIRE(run(long_sweep(whole)).status == 0);
  REQUIRE(lines_of(io::read_file(whole)).size() == long_sweep_rows + 1);

  CHECK(interrupt(long_sweep(file), journal, SIGKILL).status == -1);
  const std::string left = io::read_file(journal);
  const long kept = std::count(left.begin(), left.end(), '\n') - 1;
  REQUIRE(kept >= 49);
  REQUIRE(kept < long_sweep_rows);
  CHECK(folder.names() == Arguments{"table.csv.journal", "whole.csv"});

  // The machine goes down in the middle of a line; a block of the disk is lost.
  auto lines = lines_of(left);
  const std::string torn = lines.back().substr(0, lines.back().size() / 2);
  lines.resize(kept);
  lines[20] = std::string(lines[20].size(), '\0');
  std::string damaged;
  for (const auto& line : lines) damaged += line + "\n";
  io::write_file(journal, damaged + torn, io::Existing::replace);

  const Outcome outcome = run(long_sweep(file));
  CHECK(outcome.status == 0);
  CHECK(count_before(outcome.err, "of them taken over") == kept - 2);
  CHECK(io::read_file(file) == io::read_file(whole));
  CHECK(folder.names() == Arguments{"table.csv", "whole.csv"});
}

TEST_CASE("Ctrl-C and a request to end stop a sweep after the rows in flight", "[fast]") {
  for (const int signal : {SIGINT, SIGTERM}) {
    const ScratchFolder folder;
    const std::string file = folder / "table.csv", journal = file + ".journal";
    const Outcome stopped = interrupt(long_sweep(file), journal, signal);
    CHECK(stopped.status == 128 + signal);
    CHECK(lines_of(stopped.err).size() == 1);
    CHECK_THAT(stopped.err, EndsWith(" rows are done; the same command goes on from there\n"));
    const long done = count_before(stopped.err, "of 2000 rows are done");
    CHECK(done == static_cast<long>(lines_in(journal)) - 1);
    CHECK(folder.names() == Arguments{"table.csv.journal"});
    if (signal == SIGTERM) continue;

    const Outcome outcome = run(long_sweep(file));
    CHECK(outcome.status == 0);
    CHECK(count_before(outcome.err, "of them taken over") == done);
    CHECK(lines_of(io::read_file(file)).size() == long_sweep_rows + 1);
  }
}

TEST_CASE("the journal of another sweep is not gone on from", "[fast]") {
  const ScratchFolder folder;
  const std::string file = folder / "table.csv", journal = file + ".journal";
  interrupt(long_sweep(file), journal, SIGKILL);
  const std::string left = io::read_file(journal);
  const Arguments sweep{"--sweep", "h-over-spacing=1,1.3"}, output{"--output", file};
  for (const Arguments& another :
       {table(sweep, output), on_case("table", {"--sweep", "lattice=square", "--output", file})}) {
    CHECK(complaint_about(another) == journal + ": was begun by another run, not by this one");
    CHECK(io::read_file(journal) == left);
  }
  for (const Arguments& change : {Arguments{"--density", "2"}, Arguments{"--columns", "verdict"}}) {
    Arguments another = long_sweep(file);
    another.insert(another.end(), change.begin(), change.end());
    CHECK(complaint_about(another) == journal + ": was begun by another run, not by this one");
  }
  Arguments anew = table(sweep, output);
  anew.push_back("--overwrite");
  const Outcome outcome = run(anew);
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.err, Contains(": 2 rows, 0 of them taken over, 0 errors, "));
  CHECK(folder.names() == Arguments{"table.csv"});
}
