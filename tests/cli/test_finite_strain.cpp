// SPDX-License-Identifier: MIT
// `tl-corotated` and `tl-pk1` as a user meets them.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "cli/program.hpp"
#include "io/files.hpp"
#include "io/hdf5.hpp"
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

TEST_CASE("growth says that it leaves damping out, and dt has it", "[fast]") {
  const Arguments damped{"--deformation-gradient", "0.4,0,0,1", "--damping-rate", "0.1"};
  const double free = number(answer("growth", "tl-corotated", damped)["growth_rate"]);
  // s² + c s = g²
  const double slowed = number(answer("dt", "tl-corotated", damped)["growth_rate"]);
  CHECK(slowed * slowed + 0.1 * slowed == Approx(free * free).epsilon(1e-9));
  CHECK_THAT(run(deformed("growth", "tl-corotated", damped)).out, Contains("damping_rate left out"));
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
        "deformation_gradient: a body with free surfaces takes none, it would not be in equilibrium");
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

TEST_CASE("a run above the critical step says so, and names it once it has grown, however short", "[fast]") {
  const auto outcome = [](const std::string& fraction, const std::string& format) {
    return run(deformed("run", "tl-pk1",
                        {"--plate", "8,8", "--duration", "40", "--initial-noise", "1e-6", "--step-fraction", fraction,
                         "--format", format}));
  };
  const Outcome above = outcome("1.001", "text");
  CHECK(above.status == 3);
  CHECK_THAT(above.out,
             Contains("the time step is above the critical one") && Contains("cause                time step"));
  CHECK(outcome("1.001", "json").json()["growth"]["cause"] == "time step");
  const Outcome below = outcome("0.999", "text");
  CHECK(below.status == 0);
  CHECK_THAT(below.out, !Contains("WARNING"));
}

TEST_CASE("the energies of a run that explodes are numbers", "[fast]") {
  const Json exploded = answer("run", "tl-pk1",
                               {"--patch", "8,8", "--time-step", "auto", "--step-fraction", "1.5", "--duration", "100",
                                "--initial-noise", "1e-6"});
  CHECK(exploded["growth"]["cause"] == "time step");
  for (const char* energy : {"kinetic_energy", "strain_energy"}) {
    REQUIRE(exploded[energy].is_number());
    CHECK(std::isfinite(number(exploded[energy])));
  }
}

TEST_CASE("a base state beyond the loss of ellipticity has no critical step to take a part of, and is run with any",
          "[fast]") {
  const Arguments patch{"--patch", "8,8", "--deformation-gradient", "0.6,0,0,1", "--duration", "100"};
  for (const Arguments& step : {Arguments{}, {"--time-step", "auto"}}) {
    Arguments arguments = patch;
    arguments.insert(arguments.end(), step.begin(), step.end());
    CHECK(complaint_about(deformed("run", "tl-pk1", arguments)) ==
          "time_step: there is no critical step to take a part of: the base state grows at every step (loss of "
          "ellipticity)");
  }
  Arguments arguments = patch;
  arguments.insert(arguments.end(), {"--time-step", "0.1"});
  const Json run = answer("run", "tl-pk1", arguments);
  CHECK(run["growth"]["cause"] == "loss of ellipticity");
  CHECK(run["growth"]["step"] == 450);
  CHECK(run["critical_time_step_at_end"].is_null());
  CHECK(run["omega_squared_at_end"][0].is_number());
}

TEST_CASE("the spectrum of a deformed patch is that of the waves it admits, which bisection finds", "[fast]") {
  const Arguments patch{"--deformation-gradient", "1.2,0.1,0,0.95", "--patch", "6,5"};
  for (const std::string scheme : {"tl-corotated", "tl-pk1"}) {
    const Json spectrum = answer("spectrum", scheme, patch);
    CHECK(number(spectrum["critical_time_step"]) ==
          Approx(number(answer("bisect", scheme, patch)["theory"])).epsilon(1e-10));
    CHECK(spectrum["verdict"] == "conditionally-stable");
    CHECK(spectrum["whole_spectrum"] == true);
    CHECK(spectrum["bracket"].is_null());
    CHECK(spectrum["growth_rate"] == 0.0);
    CHECK(number(spectrum["omega_squared_max"][0]) == Approx(std::pow(number(spectrum["omega_max"]), 2)));
    CHECK(spectrum["omega_squared_max"][1] == 0.0);
    CHECK(number(spectrum["bulk_theory"]) ==
          number(answer("dt", scheme, {"--deformation-gradient", patch[1]})["critical_time_step"]));
  }
}

TEST_CASE("a patch beyond the loss of ellipticity has no critical step, its vibrations have, and the text says so",
          "[fast]") {
  const Arguments lost{"--deformation-gradient", "0.46,0,0,1", "--patch", "12,12"};
  const Json spectrum = answer("spectrum", "tl-corotated", lost);
  CHECK(spectrum["verdict"] == "never-stable");
  CHECK(spectrum["critical_time_step"].is_null());
  CHECK(number(spectrum["critical_time_step_of_largest"]) ==
        Approx(2.0 / std::sqrt(number(spectrum["omega_squared_max"][0]))));
  CHECK(number(spectrum["growth_rate"]) == Approx(std::sqrt(-number(spectrum["omega_squared_min"][0]))));
  CHECK(spectrum["omega_squared_of_growth"] == spectrum["omega_squared_min"]);
  // Of the patch's waves; the fastest of the lattice is between them.
  CHECK(number(spectrum["growth_rate"]) <
        number(answer("dt", "tl-corotated", {"--deformation-gradient", "0.46,0,0,1"})["growth_rate"]));
  Arguments text = deformed("spectrum", "tl-corotated", lost);
  CHECK_THAT(run(text).out,
             Contains("never stable: a mode grows at every time step") && Contains("limit of vibrations"));
}

TEST_CASE("a state of a run has its spectrum: what the run says at its end, modes where the particles are", "[fast]") {
  const ScratchFolder folder;
  const auto scene = (folder.path() / "beam.toml").string(), out = (folder.path() / "out").string(),
             modes = (folder.path() / "modes").string(), states = out + "/states.h5";
  io::write_file(scene, beam);
  const Json end =
      run({"run", "--scene", scene, "--duration", "100", "--snapshots", "4", "--output", out, "--format", "json"})
          .json();
  const auto about = [&](const Arguments& more) {
    Arguments arguments{"spectrum", "--scene", scene, "--state", states};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const Json last = result_of(about({"--lowest-modes", "5", "--output", modes, "--format", "json"})).json();
  CHECK(last["state"]["snapshot"] == 4);
  CHECK(number(last["state"]["time"]) == Approx(100.0).epsilon(0.05));
  CHECK(number(last["critical_time_step_of_largest"]) ==
        Approx(number(end["critical_time_step_at_end"])).epsilon(1e-6));
  CHECK(last["omega_squared"].size() == 5);
  CHECK(last["omega_squared"][0] == last["omega_squared_min"]);
  CHECK(number(last["frequencies"][1]) ==
        Approx(std::sqrt(number(last["omega_squared"][1][0])) / (2.0 * M_PI)).epsilon(1e-12));
  for (const char* file :
       {"critical_mode.h5", "critical_mode.svg", "lowest_modes.h5", "lowest_modes.svg", "summary.json"})
    CHECK(std::filesystem::exists(modes + "/" + file));
  const io::Hdf5Input run_file(states), mode_file(modes + "/critical_mode.h5");
  auto places = run_file.read("/reference/position");
  const auto moved = run_file.read("/states/4/displacement");
  for (std::size_t i = 0; i < places.size(); ++i) places[i] += moved[i];
  CHECK(mode_file.read("/reference/position") == places);
  const Json first = result_of(about({"--snapshot", "0", "--format", "json"})).json();
  CHECK(number(first["critical_time_step"]) ==
        Approx(number(run({"spectrum", "--scene", scene, "--format", "json"}).json()["critical_time_step"]))
            .epsilon(1e-10));
  CHECK_THAT(result_of(about({"--snapshot", "2"})).out, Contains("about its snapshot 2 at time"));
  CHECK(complaint_about(about({"--snapshot", "9"})) == states + ": has no state 9, only 0 to 4");
  CHECK_THAT(complaint_about({"spectrum", "--scene", scene, "--state", scene}), Contains("is no HDF5 file"));
  CHECK_THAT(complaint_about(about({"--spacing", "0.9"})), StartsWith(states + ": "));
  CHECK_THAT(complaint_about(about({"--scheme", "tl-linear"})), StartsWith("state: the spectrum depends on it with"));
  CHECK_THAT(complaint_about(about({"--upper-bound", "norm-bound"})), StartsWith("upper_bound: is of a body at rest"));
  CHECK_THAT(complaint_about({"spectrum", "--scene", scene, "--snapshot", "1"}),
             StartsWith("snapshot: is one of a state"));
}

TEST_CASE("a large deformed patch is told not to have been looked at whole", "[fast]") {
  const Arguments large{"--deformation-gradient", "0.46,0,0,1", "--patch", "24,24"};
  const Json patch = answer("spectrum", "tl-corotated", large);
  CHECK(patch["whole_spectrum"] == false);
  CHECK(patch["verdict"] == "never-stable");
  CHECK(number(patch["growth_rate"]) == Approx(std::sqrt(-number(patch["omega_squared_min"][0]))).epsilon(1e-6));
  Arguments modes = deformed("spectrum", "tl-corotated", large);
  modes.insert(modes.end(), {"--lowest-modes", "3"});
  CHECK(complaint_about(modes) == "lowest_modes: about a deformed state of a body of at most 1000 unknowns, not 1152");
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
