// SPDX-License-Identifier: MIT
// `tl-corotated` and `tl-pk1` as a user meets them.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "cli/program.hpp"
#include "io/files.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::cli_test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Arguments deformed(const std::string& command, const std::string& scheme, const Arguments& more) {
  Arguments arguments{command, "--scheme", scheme, "--young-modulus", "1", "--poisson-ratio", "0.3"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Json answer(const std::string& command, const std::string& scheme, Arguments more) {
  more.insert(more.end(), {"--format", "json"});
  return run(deformed(command, scheme, more)).json();
}

double number(const Json& value) { return value.get<double>(); }

/// A soft beam that falls under gravity from its clamp.
constexpr const char* beam = R"(scheme = "tl-pk1"
young_modulus = 1.0
poisson_ratio = 0.3
gravity = [0.0, -1e-4]
duration = 300.0

[[body]]
shape.box = { from = [0.0, 0.0], to = [12.0, 3.0] }

[[clamp]]
region.box = { from = [0.0, 0.0], to = [2.0, 3.0] }

[[probe]]
name = "end"
position = [12.0, 1.5]
)";

}  // namespace

TEST_CASE("growth tells a loss of ellipticity of the law from growth of the particles", "[fast]") {
  const Json lost = answer("growth", "tl-corotated", {"--deformation-gradient", "0.46,0,0,1"});
  CHECK(lost["verdict"] == "unstable");
  CHECK(lost["ellipticity"]["lost"] == true);
  CHECK(number(lost["ellipticity"]["squared_speed"]) < 0.0);
  const Json kept = answer("growth", "tl-corotated", {"--deformation-gradient", "0.48,0,0,1"});
  CHECK(kept["verdict"] == "stable");
  CHECK(kept["ellipticity"]["lost"] == false);
  const Outcome text = run(deformed("dt", "tl-pk1", {"--deformation-gradient", "0.6,0,0,1"}));
  CHECK(text.status == 0);
  CHECK_THAT(text.out, Contains("never stable") && Contains("LOST, a property of the law and not of the particles"));
}

TEST_CASE("dt follows the stretch and not the rotation", "[fast]") {
  const auto step = [](const std::string& gradient) {
    return number(answer("dt", "tl-corotated", {"--deformation-gradient", gradient})["critical_time_step"]);
  };
  CHECK(step("1.3,0,0,0.9") < 0.98 * step("1,0,0,1"));
  CHECK(step("0,-1,1,0") == Approx(step("1,0,0,1")).epsilon(1e-12));
  CHECK(step("0,-0.9,1.3,0") == Approx(step("1.3,0,0,0.9")).epsilon(1e-12));
}

TEST_CASE("the states of a matrix of finite strain are positions, then velocities", "[fast]") {
  const Json matrix = answer("matrix", "tl-pk1", {"--wave-vector", "1,0.5", "--time-step", "0.1"});
  CHECK(matrix["state"] == Json({"x", "y", "vx", "vy"}));
}

TEST_CASE("a free plate of finite strain takes 0.6 of the step of its lattice", "[fast]") {
  const Json plate = answer("spectrum", "tl-corotated", {"--plate", "8,8"});
  CHECK(number(plate["patch_deficit"]) == Approx(-0.42).margin(0.05));
  CHECK(complaint_about(
            deformed("spectrum", "tl-corotated", {"--plate", "8,8", "--deformation-gradient", "1.1,0,0,1"})) ==
        "deformation_gradient: a free body takes none, it would not be in equilibrium");
}

TEST_CASE("bisection finds the step of a stretched patch", "[fast]") {
  const Json found = answer("bisect", "tl-pk1", {"--deformation-gradient", "1.2,0.1,0,0.95", "--patch", "6,6"});
  CHECK(number(found["relative_difference"]) < 1e-6);
}

TEST_CASE("a run with the step auto says how it was followed", "[fast]") {
  const ScratchFolder folder;
  const auto scene = folder.path() / "beam.toml";
  io::write_file(scene, beam);
  const Json followed = run({"run", "--scene", scene.string(), "--time-step", "auto", "--format", "json"}).json();
  CHECK(followed["unstable"] == false);
  CHECK(followed["followed"]["updates"].get<int>() >= 1);
  CHECK(number(followed["followed"]["smallest_time_step"]) <= number(followed["followed"]["largest_time_step"]));
  CHECK(number(followed["time_step"]) == Approx(0.9 * number(followed["critical_time_step"])));
  CHECK(number(followed["critical_time_step_at_end"]) == Approx(number(followed["critical_time_step"])).epsilon(0.05));
  CHECK(number(followed["omega_squared_at_end"][0]) ==
        Approx(4.0 / std::pow(number(followed["critical_time_step_at_end"]), 2)).epsilon(1e-9));
  const Json half = run({"run", "--scene", scene.string(), "--step-fraction", "0.45", "--format", "json"}).json();
  CHECK(number(half["probes"]["end"]["displacement"][1]) ==
        Approx(number(followed["probes"]["end"]["displacement"][1])).epsilon(0.01));
}

TEST_CASE("a run of finite strain that grows ends with status 3 and its cause, its state saved", "[fast]") {
  const ScratchFolder folder;
  const auto scene = folder.path() / "beam.toml";
  io::write_file(scene, beam);
  const auto output = folder.path() / "out";
  const Outcome grown = run({"run", "--scene", scene.string(), "--step-fraction", "1.1", "--duration", "5000",
                             "--format", "json", "--output", output.string()});
  CHECK(grown.status == 3);
  CHECK(grown.json()["growth"]["cause"] == "time step");
  CHECK(std::filesystem::exists(output / "states.h5"));
  CHECK(std::filesystem::exists(output / "summary.json"));
}

TEST_CASE("what large deformation cannot do is refused by name", "[fast]") {
  CHECK_THAT(complaint_about(deformed("dt", "tl-corotated", {"--elastic-law", "neo-hookean"})),
             StartsWith("elastic_law: neo-hookean: is for the scheme tl-pk1"));
  CHECK_THAT(complaint_about(deformed("dt", "tl-pk1", {"--plane", "stress"})), StartsWith("plane: "));
  CHECK_THAT(complaint_about(deformed("dt", "tl-pk1", {"--deformation-gradient", "1,0,0,-1"})),
             StartsWith("deformation_gradient: its determinant -1 is not above 0"));
  CHECK_THAT(complaint_about(deformed("matrix", "tl-pk1", {"--wave-vector", "1,0", "--time-step", "auto"})),
             StartsWith("time_step: 'auto' is for run"));
  CHECK_THAT(complaint_about(deformed("dt", "tl-pk1", {"--elastic-law", "mooney"})), StartsWith("elastic_law: "));
}
