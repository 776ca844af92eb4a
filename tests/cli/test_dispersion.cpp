// SPDX-License-Identifier: MIT
// `dispersion` as a user runs it: its text, its tables and its figure.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "cli/program.hpp"
#include "io/files.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::cli_test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

std::string complaint(const Arguments& more) { return complaint_about(on_case("dispersion", more)); }
std::string output(const Arguments& more) { return result_of(on_case("dispersion", more)).out; }

long lines_in(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

const Arguments squeezed{"--displacement-gradient", "-0.4,0,0,-0.4", "--density-in-momentum", "equation-of-state"};

Arguments joined(Arguments first, const Arguments& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

TEST_CASE("nonsense asked of dispersion is refused in one line", "[fast]") {
  CHECK(complaint({"--wave-vector", "1,0", "--grid", "3,3"}) == "wave_vector: cannot be given with grid");
  CHECK(complaint({"--grid", "3,3", "--path", "G-X"}) == "grid: cannot be given with path");
  CHECK(complaint({"--grid", "0,3"}) == "grid: 0 is not at least 1");
  CHECK(complaint({"--grid", "2000,2000"}) == "grid: 2000,2000 multiply to more than 200000");
  CHECK(complaint({"--path-points", "1e9"}) == "path_points: 1000000000 is more than 200000");
  CHECK(complaint({"--figure", ""}) == "figure: '' does not end on .svg");
  CHECK(complaint({"--figure", "bands.png"}) == "figure: 'bands.png' does not end on .svg");
  CHECK(complaint({"--overwrite"}) == "overwrite: needs --figure");
  CHECK(complaint({"--path-points", "2"}) == "path_points: 2 is not at least 4, the labelled points of the path");
  CHECK_THAT(complaint({"--path", "G-Q"}), StartsWith("path: "));
  CHECK_THAT(complaint({"--time-step", "1"}), StartsWith("option: '--time-step' is not for dispersion"));
  CHECK_THAT(complaint_about(on_case("dt", {"--figure", "x.svg"})), StartsWith("option: '--figure' is not known"));
}

TEST_CASE("one wave vector gives a table of its branches, a path a line a point", "[fast]") {
  CHECK_THAT(output({"--wave-vector", "1,0.5"}), StartsWith("Waves at k = (1, 0.5)") && Contains("\n  transverse ") &&
                                                     Contains("\n  longitudinal ") && !Contains("growth"));
  const std::string at_rest = output({"--path-points", "12"});
  CHECK(lines_in(at_rest) == 3 + 12);
  CHECK_THAT(at_rest, Contains("\n  Γ ") && Contains("\n  M ") && !Contains("fastest growth"));
  const std::string growing = output(joined(squeezed, {"--path-points", "12"}));
  CHECK_THAT(growing, Contains("fastest growth"));
  CHECK(lines_in(growing) == 3 + 12 + 2);
}

TEST_CASE("tables of dispersion have a row a point and no nested cells", "[fast]") {
  for (const Arguments& where :
       {Arguments{"--path-points", "9"}, Arguments{"--grid", "3,3"}, Arguments{"--wave-vector", "1,0"}})
    for (const std::string format : {"csv", "markdown", "latex"}) {
      const std::string table = output(joined(where, {"--format", format}));
      const long points = where[0] == "--wave-vector" ? 1 : 9;
      CHECK(lines_in(table) == points + (format == "csv" ? 1 : format == "markdown" ? 2 : 6));
      CHECK_THAT(table, !Contains("[") && Contains(format == "latex" ? "omega\\_squared\\_1" : "omega_squared_1"));
    }
}

TEST_CASE("a band figure is written once, and over only when told", "[fast]") {
  const ScratchFolder folder;
  const std::string file = folder / "bands.svg";
  const Arguments arguments{"--path-points", "20", "--figure", file};
  CHECK(output(arguments) == output({"--path-points", "20"}));
  const std::string figure = io::read_file(file);
  CHECK_THAT(figure, Contains("<svg") && Contains("square lattice") && Contains("longitudinal"));
  CHECK_THAT(complaint(arguments), Contains(file));
  CHECK(io::read_file(file) == figure);
  output(joined(joined(arguments, {"--overwrite"}), {"--lattice", "hexagonal"}));
  CHECK_THAT(io::read_file(file), Contains("hexagonal lattice"));
}

TEST_CASE("a figure of a grid or of one wave vector is refused, and nothing is written", "[fast]") {
  const ScratchFolder folder;
  const std::string file = folder / "bands.svg";
  CHECK(complaint({"--grid", "3,3", "--figure", file}) ==
        "figure: shows the bands along a path, and cannot be given with grid");
  CHECK(complaint({"--wave-vector", "1,0", "--figure", file}) ==
        "figure: shows the bands along a path, and cannot be given with wave_vector");
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("batch answers dispersion too", "[fast]") {
  const std::string line =
      R"({"command": "dispersion", "scheme": "tl-linear", "young_modulus": 1, "poisson_ratio": 0.3, "grid": [2, 3]})";
  const Json answer = Json::parse(result_of({"batch"}, line + "\n").out);
  CHECK(answer["ok"] == true);
  CHECK(answer["result"]["points"].size() == 6);
}
