// SPDX-License-Identifier: MIT
// `bisect` of the scheme `ul` as a user runs it: each verdict of theory, and what is refused.
#include <catch2/catch.hpp>

#include "cli/program.hpp"

using namespace sphstab::cli_test;
using Catch::Contains;
using Catch::StartsWith;

namespace {

Arguments bisect_ul(const Arguments& more) {
  Arguments arguments{"bisect", "--scheme", "ul", "--sound-speed", "1", "--shear-modulus", "0.3", "--patch", "5,4"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Json json_of(Arguments arguments) {
  arguments.insert(arguments.end(), {"--format", "json"});
  return result_of(bisect_ul(arguments)).json();
}

}  // namespace

TEST_CASE("bisect of ul finds the step of theory", "[fast]") {
  const Json result = json_of({"--integrator", "leapfrog", "--tolerance", "1e-5"});
  CHECK(result["agrees"] == true);
  CHECK(result["tolerance"] == 1e-5);
  CHECK(result["critical_time_step"].get<double>() == Approx(result["theory"].get<double>()).epsilon(1e-5));
  CHECK_FALSE(result.contains("growth"));
}

TEST_CASE("bisect of ul measures growth where every step grows, in continuous time or by the integrator alone",
          "[fast]") {
  const Json never = json_of({"--pressure=-0.05", "--integrator", "verlet"});
  CHECK(never.contains("theory_growth_rate"));
  const Json weak = json_of({});
  CHECK_FALSE(weak.contains("theory_growth_rate"));
  for (const Json& result : {never, weak}) {
    CHECK(result["agrees"] == true);
    CHECK(result["tolerance"] == 0.005);
    CHECK(result["critical_time_step"].is_null());
    CHECK(result["theory"].is_null());
    const Json& growth = result["growth"];
    CHECK(growth["time_step"].get<double>() > 0.0);
    CHECK(growth["measured"].get<double>() == Approx(growth["theory"].get<double>()).epsilon(0.005));
    CHECK(result["relative_difference"].get<double>() < 0.005);
  }
  const std::string text = result_of(bisect_ul({})).out;
  CHECK_THAT(text,
             Contains("weakly, by its integrator alone") && Contains("growth per step, run") && Contains("agrees"));
  CHECK_THAT(result_of(bisect_ul({"--pressure=-0.05"})).out, Contains("in continuous time, by theory"));
}

TEST_CASE("bisect of ul says where nothing grows", "[fast]") {
  Arguments arguments = bisect_ul({"--integrator", "leapfrog"});
  arguments[8] = "2,2";  // zero-energy modes only
  const std::string text = result_of(arguments).out;
  CHECK_THAT(text, Contains("none found") && Contains("nothing grew up to") && Contains("agrees"));
}

TEST_CASE("bisect of a fluid in ul needs no Poisson's ratio", "[fast]") {
  Arguments fluid = bisect_ul({"--integrator", "leapfrog", "--tolerance", "1e-4", "--format", "json"});
  fluid[6] = "0";
  CHECK(result_of(fluid).json()["agrees"] == true);
}

TEST_CASE("exit status 1 says that growth does not keep to the theory", "[fast]") {
  const std::string of_another_rate = "awk 'BEGIN { for (n = 0; n <= {steps}; ++n) print exp(0.2 * n) }'";
  const Outcome outcome = run(bisect_ul({"--pressure=-0.05", "--command", of_another_rate}));
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.out, Contains("DOES NOT AGREE"));
}

TEST_CASE("bisect of ul refuses what has no theory that a run obeys", "[fast]") {
  CHECK_THAT(complaint_about(bisect_ul({"--pressure=-0.05", "--artificial-stress-epsilon", "0.3",
                                        "--artificial-stress-linearisation", "frozen"})),
             StartsWith("artificial_stress_linearisation: ") && Contains("give exact"));
  CHECK_THAT(complaint_about(bisect_ul({"--artificial-stress-epsilon", "0.3"})),
             StartsWith("artificial_stress_epsilon: a principal stress is 0"));
  CHECK_THAT(complaint_about(bisect_ul({"--pressure=-1e-6", "--artificial-stress-epsilon", "0.3"})),
             StartsWith("artificial_stress_epsilon: a principal stress is 0, or below 1e-05"));
  CHECK_THAT(complaint_about(bisect_ul({"--pressure=-1e-12"})), StartsWith("pressure: a stress of 1e-12"));
  CHECK_THAT(complaint_about(bisect_ul({"--viscosity-alpha", "0.5", "--viscosity-pairs", "approaching"})),
             StartsWith("viscosity_pairs: approaching"));
  Arguments plate = bisect_ul({});
  plate[7] = "--plate";
  CHECK_THAT(complaint_about(plate), StartsWith("scheme: "));
  CHECK_THAT(complaint_about(bisect_ul({"--neighbours", "nearest"})), StartsWith("neighbours: "));
  Arguments cell = bisect_ul({"--integrator", "leapfrog"});
  cell[8] = "1,1";
  CHECK_THAT(complaint_about(cell), StartsWith("patch: one cell"));
}

TEST_CASE("growth agrees on large patches, whose modes are close, and under weak stress, which drives slowly",
          "[fast]") {
  Arguments large = bisect_ul({"--pressure=-0.05", "--integrator", "leapfrog"});
  large[8] = "16,16";
  CHECK(run(large).status == 0);
  CHECK(run(bisect_ul({"--pressure=-1e-6", "--integrator", "leapfrog"})).status == 0);
  CHECK(run({"bisect", "--scene", SPHSTAB_SCENES_FOLDER "/tension-patch.toml"}).status == 0);
}
