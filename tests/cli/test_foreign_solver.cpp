// SPDX-License-Identifier: MIT
// `bisect --command` with a foreign program: one undamped oscillator, ω = 3, stepped by leapfrog; its limit is 2/ω.
#include <catch2/catch.hpp>
#include <cmath>

#include "cli/program.hpp"
#include "io/files.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::cli_test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

constexpr double tolerance = 1e-6;

/// Prints a line without number, then step, amplitude and an empty last column for every step.
constexpr const char* oscillator = R"(awk -v dt={time_step} -v steps={steps} 'BEGIN {
  print "a foreign solver";
  v = 0; x = 1;
  for (n = 0; n <= steps; ++n) { printf "%d, %.17g\n", n, sqrt(9 * x * x + v * v); v -= 9 * dt * x; x += dt * v }
}')";

/// The bisection of this command beside the theory of a patch whose limit is 2/ω.
Arguments beside_equal_theory(const std::string& command) {
  // The limit scales with √(ρ/E): with E = 1 it is `unit`, so that E = (ω unit / 2)² gives 2/ω.
  const Json unit = result_of(on_case("bisect", {"--patch", "4,4", "--tolerance", "1e-2", "--format", "json"})).json();
  const double young_modulus = std::pow(1.5 * unit["theory"].get<double>(), 2);
  return {"bisect",
          "--scheme",
          "tl-linear",
          "--young-modulus",
          Json(young_modulus).dump(),
          "--poisson-ratio",
          "0.3",
          "--patch",
          "4,4",
          "--command",
          command,
          "--format",
          "json"};
}

Outcome beside_other_theory(const std::string& command) {
  return run(on_case("bisect", {"--patch", "4,4", "--command", command, "--format", "json"}));
}

}  // namespace

TEST_CASE("the critical step of a foreign solver is found", "[fast]") {
  const Json result = result_of(beside_equal_theory(oscillator)).json();
  CHECK(result["critical_time_step"].get<double>() == Approx(2.0 / 3.0).epsilon(tolerance));
  CHECK(result["bracket"][0].get<double>() <= 2.0 / 3.0 * (1.0 + tolerance));
  CHECK(result["bracket"][1].get<double>() >= 2.0 / 3.0);
  CHECK(result["agrees"] == true);
}

TEST_CASE("exit status 1 says that a foreign solver does not keep to the theory", "[fast]") {
  const Outcome outcome = beside_other_theory(oscillator);
  CHECK(outcome.status == 1);
  CHECK(outcome.err == "");
  CHECK(outcome.json()["agrees"] == false);
  CHECK(outcome.json()["critical_time_step"].get<double>() == Approx(2.0 / 3.0).epsilon(tolerance));
  const Outcome text = run(on_case("bisect", {"--patch", "4,4", "--command", oscillator}));
  CHECK(text.status == 1);
  CHECK_THAT(text.out, Contains("DOES NOT AGREE"));
}

TEST_CASE("a foreign solver whose run explodes may stop early, print inf and fail", "[fast]") {
  // Grows at every step: no critical step, and the claim of theory does not hold.
  const auto result =
      run(on_case("bisect", {"--patch", "4,4", "--format", "json", "--command", "echo 1; echo inf; exit 1"}));
  CHECK(result.status == 1);
  CHECK(result.json()["critical_time_step"].is_null());
  CHECK(result.json()["bracket"][0] == 0.0);
}

TEST_CASE("a foreign solver that fails or prints too little is named", "[fast]") {
  const auto complaint = [](const std::string& command) {
    return complaint_about(on_case("bisect", {"--patch", "4,4", "--command", command}));
  };
  CHECK_THAT(complaint("exit 3"), StartsWith("command: 'exit 3' ended with status 3"));
  CHECK(complaint("true") == "command: 'true' printed 0 amplitudes, but 200 are needed");
  CHECK(complaint("echo 1; echo 2") == "command: 'echo 1; echo 2' printed 2 amplitudes, but 200 are needed");
  // Twenty steps without growth are no evidence for two hundred.
  CHECK_THAT(complaint("yes 1 | head -n 20"), Catch::EndsWith("printed 20 amplitudes, but 200 are needed"));
}
