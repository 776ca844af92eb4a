// SPDX-License-Identifier: MIT
// The scheme `ul` as a user meets it: growth, and what other commands say of it.
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

/// `command` on a complete case of ul with `more` behind it.
Arguments updated(const std::string& command, const Arguments& more = {}) {
  Arguments arguments{command, "--scheme",         "ul", "--sound-speed", "1", "--shear-modulus",
                      "0.3",   "--h-over-spacing", "1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::string output(const std::string& command, const Arguments& more) { return result_of(updated(command, more)).out; }

const Arguments hexagonal_in_tension{"--lattice", "hexagonal", "--pressure", "-0.05"};

Arguments joined(Arguments first, const Arguments& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

TEST_CASE("growth says how fast, whether artificial stress removes it, and at what price", "[fast]") {
  const std::string none = output("growth", hexagonal_in_tension);
  CHECK_THAT(none, Contains("unstable: grows by a factor e in") && Contains("doubling in") &&
                       Contains("fastest mode") && Contains("artificial stress    none\n") &&
                       Contains("price of the least"));
  const std::string enough = output("growth", joined(hexagonal_in_tension, {"--artificial-stress-epsilon", "0.3"}));
  CHECK_THAT(enough, Contains("stable: nothing grows") && Contains("epsilon = 0.3 removes the growth of") &&
                         Contains("% extension") && Contains("softest mode"));
  const std::string little = output("growth", joined(hexagonal_in_tension, {"--artificial-stress-epsilon", "0.05"}));
  CHECK_THAT(little, Contains("epsilon = 0.05 does not remove the growth of"));
  CHECK_THAT(output("growth", {"--pressure", "-0.05"}), Contains("stabilising epsilon  none up to 2"));
  CHECK_THAT(output("growth", {}), Contains("none, and none is needed"));
}

TEST_CASE("growth at a principal stress of zero gives both one-sided states", "[fast]") {
  const Arguments switched_on{"--artificial-stress-epsilon", "0.3"};
  CHECK_THAT(output("growth", switched_on), Contains("\n  compression ") && Contains("\n  tension "));
  CHECK_THAT(output("growth", joined(switched_on, {"--pressure", "0.1"})), !Contains("A principal stress is zero"));
}

TEST_CASE("growth answers tl-linear without a word on artificial stress", "[fast]") {
  const Json answer = result_of(on_case("growth", {"--format", "json"})).json();
  CHECK(answer["verdict"] == "stable");
  CHECK_FALSE(answer.contains("stabilising_epsilon"));
  CHECK_FALSE(answer.contains("tension_modulus_factor"));
  CHECK_THAT(result_of(on_case("growth")).out, !Contains("epsilon"));
}

TEST_CASE("a table of growth has the rates, and the epsilons for which it is asked", "[fast]") {
  const Arguments sweep{"--answer", "growth", "--sweep", "pressure=-0.05,0.05", "--format", "csv"};
  const auto lines = lines_of(output("table", sweep));
  REQUIRE(lines.size() == 3);
  CHECK_THAT(lines[0], StartsWith("pressure,growth_rate,verdict,") && !Contains("epsilon"));
  CHECK_THAT(lines[1], Contains("unstable"));
  const auto chosen = lines_of(output("table", joined(sweep, {"--lattice", "hexagonal", "--columns",
                                                              "smallest_stabilising_epsilon,stabilising_epsilon"})));
  REQUIRE(chosen.size() == 3);
  // 0.132 is the edge at M (theory.md §9).
  CHECK(std::abs(std::stod(cells_of(chosen[1])[1]) - 0.132) < 5e-4);
}

TEST_CASE("the map of growth is written in one and two dimensions and refused in three", "[fast]") {
  const ScratchFolder folder;
  const std::string map = folder / "map.svg", curve = folder / "curve.svg", none = folder / "none.svg";
  output("growth", joined(hexagonal_in_tension, {"--figure", map}));
  CHECK_THAT(io::read_file(map), Contains("Growth on the hexagonal lattice") && Contains("first Brillouin zone") &&
                                     Contains("stable") && Contains("P = -0.05"));
  output("growth", {"--dimension", "1", "--pressure", "-0.05", "--figure", curve});
  CHECK_THAT(io::read_file(curve), Contains("Growth on the chain lattice"));
  CHECK_THAT(complaint_about(updated("growth", {"--dimension", "3", "--figure", none})),
             StartsWith("figure: growth is drawn over zones of one and two dimensions, not 3"));
  CHECK_FALSE(std::filesystem::exists(none));
  CHECK_THAT(complaint_about(updated("growth", joined(hexagonal_in_tension, {"--figure", map}))), Contains(map));
}

TEST_CASE("a matrix of fourteen states has columns as wide as their entries", "[fast]") {
  const auto lines = lines_of(output("matrix", {"--wave-vector", "1,0.5", "--time-step", "0.3", "--integrator",
                                                "predictor-corrector-pec", "--deviatoric-stress", "0.1,-0.2,0.3"}));
  REQUIRE(lines.size() == 2 + 1 + 14 + 1 + 14 + 2);
  for (int i = 0; i < 14; ++i) CHECK(lines[3 + i].size() == lines[2].size());
  for (const auto* name : {"x", "vy", "rho", "Sxy", "Fx", "dSxy"}) CHECK_THAT(lines[2], Contains(name));
}

TEST_CASE("waves that are coupled show frequency and growth", "[fast]") {
  // Artificial stress makes a complex pair of isotropic tension (theory.md §3).
  const Arguments flutter{"--lattice", "staggered",     "--pressure",   "-0.05", "--artificial-stress-epsilon",
                          "0.5",       "--wave-vector", "1.2566,3.5604"};
  Arguments wider = updated("dispersion", flutter);
  *(std::find(wider.begin(), wider.end(), "--h-over-spacing") + 1) = "1.2";
  const std::string text = result_of(wider).out;
  CHECK_THAT(text, Contains("coupled") && Contains("0.407") && Contains("-0.0085") && Contains("+0.0085") &&
                       Contains("fastest growth"));
  // Branches that have no fixed kind along the path are numbered.
  CHECK_THAT(output("dispersion", {"--path-points", "12", "--pressure", "-0.05"}), Contains("omega 1"));
}

TEST_CASE("ul has no theory of bodies, and no dispersion with viscosity", "[fast]") {
  CHECK(complaint_about(updated("bisect", {"--plate", "9,9"})) ==
        "scheme: there is no spectrum of a body of ul to compare with; bisect takes a patch of it");
  CHECK(complaint_about(updated("spectrum", {"--plate", "9,9"})) ==
        "scheme: the spectrum of a body is for total-Lagrangian schemes, not ul");
  CHECK(complaint_about(updated("dispersion", {"--viscosity-alpha", "1", "--wave-vector", "1,0"})) ==
        "viscosity_alpha: there is no dispersion relation with viscosity; matrix and dt take it");
}
