// SPDX-License-Identifier: MIT
// `run` of the scheme `ul`, and of periodic patches, as a user meets it.
#include <fmt/format.h>

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

/// Two ways to the same number: roundings, and where a maximum over the zone is polished twice.
constexpr double rounding = 1e-9;

const Arguments updated_keys{"--scheme", "ul", "--sound-speed", "1", "--shear-modulus", "0.3"};

/// `command` on a complete case of ul with `more` behind it, as JSON.
Arguments updated(const std::string& command, const Arguments& more) {
  Arguments arguments{command, "--format", "json"};
  arguments.insert(arguments.end(), updated_keys.begin(), updated_keys.end());
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Json answer(const std::string& command, const Arguments& more) { return run(updated(command, more)).json(); }

/// A run of ten steps on a patch at rest.
Json short_run(Arguments more) {
  more.insert(more.end(), {"--patch", "6,6", "--duration", "1"});
  return answer("run", more);
}

double number(const Json& value) { return value.get<double>(); }

/// A beam of `ul` with a probe.
constexpr const char* beam = R"(scheme = "ul"
integrator = "leapfrog"
sound_speed = 1.0
shear_modulus = 0.3

[[body]]
shape.box = { from = [0.0, 0.0], to = [8.0, 4.0] }

[[probe]]
name = "end"
position = [8.0, 4.0]
)";

/// A run of a scene of this text.
class SceneRun {
 public:
  explicit SceneRun(const std::string& text) { io::write_file(scene_, text); }

  Outcome operator()(const Arguments& more) const {
    Arguments arguments{"run", "--scene", scene_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  std::filesystem::path output() const { return folder_ / "output"; }

 private:
  ScratchFolder folder_;
  std::filesystem::path scene_ = folder_ / "scene.toml";
};

}  // namespace

TEST_CASE("the step of a run of ul is a part of the lattice's critical one", "[fast]") {
  const Json leapfrog = short_run({"--integrator", "leapfrog", "--step-fraction", "0.5"});
  CHECK(number(leapfrog["critical_time_step"]) ==
        Approx(number(answer("dt", {"--integrator", "leapfrog"})["critical_time_step"])).epsilon(rounding));
  CHECK(number(leapfrog["time_step"]) == 0.5 * number(leapfrog["critical_time_step"]));
  CHECK(leapfrog["critical_time_step_of"] == "infinite lattice");
  CHECK_FALSE(leapfrog.contains("predicted_growth_e_foldings"));

  const Json corrected = short_run({});
  CHECK(number(corrected["critical_time_step"]) ==
        Approx(2.0 / std::sqrt(number(answer("growth", {})["omega_squared_max"]))).epsilon(rounding));
  CHECK(corrected["critical_time_step_of"] == "infinite lattice, 2/omega_max (the integrator grows at every step)");

  const Json tension = short_run({"--integrator", "leapfrog", "--pressure", "-0.05"});
  CHECK(tension["critical_time_step_of"] == "infinite lattice, 2/omega_max (the state itself grows)");
  CHECK_THAT(complaint_about(
                 updated("run", {"--patch", "6,6", "--duration", "1", "--time-step", "1", "--step-fraction", "1"})),
             StartsWith("step_fraction: cannot be given"));
}

TEST_CASE("a run of ul predicts its growth from the spectral radius at its step, and warns", "[fast]") {
  const Arguments keys{"--patch", "6,6", "--duration", "200", "--time-step", "0.5", "--initial-noise", "1e-9"};
  const Json grown = answer("run", keys);
  const double radius = number(answer("dt", {"--time-step", "0.5"})["spectral_radius_at_time_step"]);
  CHECK(number(grown["predicted_growth_e_foldings"]) == Approx(400.0 * std::log(radius)).epsilon(rounding));
  CHECK(grown["unstable"] == false);

  Arguments text{"run"};
  text.insert(text.end(), updated_keys.begin(), updated_keys.end());
  text.insert(text.end(), {"--patch", "6,6", "--duration", "100", "--initial-noise", "1e-9", "--step-fraction", "0.9"});
  const auto outcome = run(text);
  CHECK(outcome.status == 3);
  CHECK_THAT(outcome.out, StartsWith("Run of a periodic patch of 6, 6: 36 particles\n") &&
                              Contains("WARNING              at this step theory predicts") && Contains("UNSTABLE"));
}

TEST_CASE("without a step given, an integrator that grows at every step takes one of at most one e-folding", "[fast]") {
  for (const char* duration : {"100", "1000"}) {
    const Json run = answer("run", {"--patch", "6,6", "--duration", duration, "--initial-noise", "1e-9"});
    const double time_step = number(run["time_step"]);
    CHECK(time_step < 0.9 * number(run["critical_time_step"]));
    const Json theory = answer("dt", {"--time-step", fmt::format("{}", time_step)});
    const double e_foldings =
        std::stod(duration) / time_step * std::log(number(theory["spectral_radius_at_time_step"]));
    CHECK(e_foldings <= 1.0);
    CHECK(e_foldings > 0.9);  // 1 % of the step are 3 % of the growth
    CHECK_FALSE(run.contains("predicted_growth_e_foldings"));
    CHECK(run["unstable"] == false);
  }
}

TEST_CASE("viscosity on approach alone runs with the theory of none, which it says", "[fast]") {
  const Json none = short_run({"--integrator", "leapfrog"});
  const Json approaching =
      short_run({"--integrator", "leapfrog", "--viscosity-alpha", "1", "--viscosity-pairs", "approaching"});
  CHECK(approaching["critical_time_step"] == none["critical_time_step"]);
  CHECK(approaching["note"] == "theory is that without viscosity");
  CHECK_FALSE(none.contains("note"));
  const Json all = short_run({"--integrator", "leapfrog", "--viscosity-alpha", "1"});
  CHECK(number(all["critical_time_step"]) < number(none["critical_time_step"]));
}

TEST_CASE("bodies of several materials take the smallest step of their lattices, irregular ones say so", "[fast]") {
  // Twice the stiffness of everything is half the squared step.
  const std::string stiff =
      "\n[[material]]\nname = \"stiff\"\nbulk_modulus = 2.0\nshear_modulus = 0.6\n\n[[body]]\n"
      "shape.box = { from = [8.0, 0.0], to = [12.0, 4.0] }\nmaterial = \"stiff\"\n";
  const auto of = [](const std::string& text) {
    return SceneRun(text)({"--duration", "1", "--format", "json"}).json();
  };
  const Json one = of(beam), two = of(beam + stiff), jittered = of(beam + stiff + "jitter = 0.1\n");
  CHECK(number(two["critical_time_step"]) ==
        Approx(number(one["critical_time_step"]) / std::sqrt(2.0)).epsilon(rounding));
  CHECK(one["critical_time_step_of"] == "infinite lattice");
  CHECK(jittered["critical_time_step_of"] == "infinite lattice; these particles are on none");
}

TEST_CASE("a run of a free body of ul writes densities, keeps every particle, and answers by probe", "[fast]") {
  const SceneRun scene(beam);
  const auto outcome = scene({"--duration", "20", "--snapshots", "2", "--initial-noise", "1e-3", "--format", "json",
                              "--output", scene.output().string()});
  CHECK(outcome.status == 0);
  const Json run = outcome.json();
  CHECK(run["particles"] == 32);
  CHECK(run["lost_particles"] == 0);
  CHECK(run["list_builds"] >= 1);
  CHECK(std::abs(number(run["momentum_drift"])) < 1e-12);
  CHECK(run["probes"]["end"]["particle"] == 31);
  // Noise of a thousandth of c_p = √1.4 in every component of 32 particles of mass 1.
  CHECK(number(run["initial_energy"]) == Approx(0.5 * 64 * 1.4e-6 / 3.0).epsilon(0.3));
  for (const char* field : {"density", "displacement", "von_mises_stress"})
    CHECK_THAT(io::read_file(scene.output() / "states.xdmf"), Contains(std::string("states.h5:/states/2/") + field));
  CHECK(std::filesystem::file_size(scene.output() / "snapshot_002.svg") > 0);
}

TEST_CASE("a run of ul that fails names particle, step and term, and keeps what came before", "[fast]") {
  const SceneRun scene(beam);
  const Arguments unstable{"--duration", "1e4", "--time-step", "5", "--initial-noise", "0.3"};
  const auto outcome = scene(unstable);
  CHECK(outcome.status == 3);
  CHECK_THAT(outcome.out, Contains("UNSTABLE") && Contains("is no ") && Contains("number at step") &&
                              Contains("the first term to break"));
  CHECK_THAT(outcome.out, !Contains("nan") && !Contains("inf "));
  Arguments stored = unstable;
  stored.insert(stored.end(), {"--format", "json", "--output", scene.output().string()});
  const Json answer = scene(stored).json();
  CHECK(answer["failure"]["step"] == answer["steps"].get<long>() + 1);
  CHECK(answer["failure"]["term"].is_string());
  for (const char* key : {"kinetic_energy", "strain_energy", "largest_velocity"}) CHECK(answer[key].is_number());
  CHECK(Json::parse(io::read_file(scene.output() / "summary.json")) == answer);
}

TEST_CASE("a particle that leaves all others ends a run of ul with status 3", "[fast]") {
  const SceneRun scene(std::string(beam) +
                       "\n[[velocity]]\nregion.box = { from = [7.0, 3.0], to = [8.0, 4.0] }\n"
                       "velocity = [50.0, 40.0]\n");
  const auto outcome = scene({"--duration", "1", "--time-step", "0.01"});
  CHECK(outcome.status == 3);
  CHECK_THAT(outcome.out, Contains("UNSTABLE             particles that have lost all their neighbours: 1"));
}

TEST_CASE("a periodic patch of tl-linear runs at the step of its own wave vectors", "[fast]") {
  const Json run =
      result_of(on_case("run", {"--patch", "5,4", "--duration", "50", "--initial-noise", "1e-3", "--format", "json"}))
          .json();
  const Json bisected = result_of(on_case("bisect", {"--patch", "5,4", "--format", "json"})).json();
  CHECK(run["critical_time_step"] == bisected["theory"]);
  CHECK(run["critical_time_step_of"] == "periodic patch");
  CHECK(run["unstable"] == false);
  CHECK(run["lost_particles"] == 0);
  CHECK_FALSE(run.contains("list_builds"));
  CHECK(number(run["kinetic_energy"]) + number(run["strain_energy"]) < 10.0 * number(run["initial_energy"]));
}

TEST_CASE("a body of ul with free surfaces is refused a stress, and so are two bodies or none", "[fast]") {
  CHECK_THAT(complaint_about(updated("run", {"--plate", "6,6", "--duration", "1", "--pressure", "0.1"})),
             StartsWith("pressure: a body with free surfaces is in no equilibrium"));
  CHECK(complaint_about(updated("run", {"--duration", "1"})) == "scene: missing (or plate or patch)");
  CHECK(complaint_about(updated("run", {"--plate", "6,6", "--patch", "6,6", "--duration", "1"})) ==
        "plate: cannot be given with patch");
}
