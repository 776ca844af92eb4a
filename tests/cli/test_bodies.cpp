// SPDX-License-Identifier: MIT
// `spectrum`, `run` and `bisect` of whole bodies as a user runs them.
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <thread>

#include "cli/program.hpp"
#include "io/files.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::cli_test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

/// Roundings of a few thousand additions.
constexpr double rounding = 1e-11;

/// A plate of 6×4 particles that falls freely, with a probe in a corner.
constexpr const char* falling_plate = R"(scheme = "tl-linear"
density = 2.0
young_modulus = 1.0
poisson_ratio = 0.3
gravity = [0.0, -0.125]

[[body]]
shape.box = { from = [0.0, 0.0], to = [6.0, 4.0] }

[[probe]]
name = "corner"
position = [0.0, 0.0]
)";

/// The scene in a folder of its own, beside which results can be written.
class SceneFolder {
 public:
  explicit SceneFolder(const std::string& text) { io::write_file(scene_, text); }

  std::string scene() const { return scene_.string(); }
  std::filesystem::path output() const { return folder_ / "output"; }
  std::vector<std::string> names() const { return folder_.names(); }

 private:
  ScratchFolder folder_;
  std::filesystem::path scene_ = folder_ / "scene.toml";
};

Arguments on_scene(const std::string& command, const SceneFolder& folder, const Arguments& more = {}) {
  Arguments arguments{command, "--scene", folder.scene()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_CASE("the spectrum of a scene is what bisection on it finds", "[fast]") {
  const SceneFolder folder(falling_plate);
  const Json spectrum = result_of(on_scene("spectrum", folder, {"--format", "json"})).json();
  const Json run = result_of(on_scene("bisect", folder, {"--format", "json"})).json();
  const double critical = spectrum["critical_time_step"];
  CHECK(spectrum["particles"] == 24);
  CHECK(critical == Approx(2.0 / spectrum["omega_max"].get<double>()).epsilon(rounding));
  CHECK(spectrum["bracket"][0].get<double>() <= critical);
  CHECK(critical <= spectrum["bracket"][1].get<double>());
  CHECK(run["critical_time_step"].get<double>() == Approx(critical).epsilon(1e-6));
  CHECK(run["agrees"] == true);
  CHECK(run["scene"] == folder.scene());
}

TEST_CASE("flags given beside a scene replace its keys", "[fast]") {
  const SceneFolder folder(falling_plate);
  const auto critical = [&](const Arguments& more) -> double {
    Arguments arguments = on_scene("spectrum", folder, {"--format", "json"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return result_of(arguments).json()["critical_time_step"];
  };
  // Δt ∝ √(ρ/E), and nothing else of the case depends on either.
  CHECK(critical({"--density", "8"}) == Approx(2.0 * critical({})).epsilon(rounding));
  CHECK(critical({"--young-modulus", "4"}) == Approx(0.5 * critical({})).epsilon(rounding));
}

TEST_CASE("each upper bound that is asked for is named, and its bracket holds the step", "[fast]") {
  const Arguments plate{"--plate", "9,7", "--format", "json", "--upper-bound"};
  double tight = 0.0;
  for (const std::string kind : {"factorisation", "norm-bound", "probabilistic"}) {
    Arguments arguments = plate;
    arguments.push_back(kind);
    const Json spectrum = result_of(on_case("spectrum", arguments)).json();
    CHECK(spectrum["bracket_kind"] == kind);
    CHECK(spectrum.contains("failure_probability") == (kind == "probabilistic"));
    if (tight == 0.0) tight = spectrum["critical_time_step"];
    CHECK(spectrum["bracket"][0].get<double>() <= tight);
    CHECK(tight <= spectrum["bracket"][1].get<double>() * (1.0 + rounding));
  }
  CHECK_THAT(complaint_about(on_case("spectrum", {"--plate", "9,7", "--upper-bound", "guess"})),
             StartsWith("upper_bound: 'guess' is not known"));
}

TEST_CASE("frequencies are in hertz, lowest first, and their shapes are written", "[fast]") {
  const SceneFolder folder(falling_plate);
  // A free bar of 60 spacings: f_n = n c/(2 L) of the vibrations, longer waves than the kernel to a few percent.
  constexpr double of_the_ends = 0.03;
  const Json bar = result_of({"spectrum", "--plate", "60", "--dimension", "1", "--lattice", "chain", "--scheme",
                              "tl-linear", "--young-modulus", "1", "--poisson-ratio", "0", "--lowest-modes", "4",
                              "--output", folder.output().string(), "--format", "json"})
                       .json();
  CHECK(bar["rigid_modes"] == 1);
  CHECK(std::abs(bar["frequencies"][0].get<double>()) < 1e-6);
  std::vector<double> vibrations;
  for (std::size_t i = 0; i < 4; ++i)
    if (bar["mode_kinds"][i] == "vibration") vibrations.push_back(bar["frequencies"][i]);
  REQUIRE(!vibrations.empty());
  CHECK(vibrations.front() == Approx(1.0 / 120.0).epsilon(of_the_ends));
  for (const char* file : {"critical_mode.h5", "critical_mode.xdmf", "critical_mode.svg", "lowest_modes.h5",
                           "lowest_modes.xdmf", "lowest_modes.svg", "summary.json"})
    CHECK(std::filesystem::file_size(folder.output() / file) > 0);
}

TEST_CASE("a run writes its states, probes, pictures and summary, and falls as it should", "[fast]") {
  const SceneFolder folder(falling_plate);
  const Json run = result_of(on_scene("run", folder,
                                      {"--time-step", "0.25", "--duration", "10", "--snapshots", "2", "--output",
                                       folder.output().string(), "--format", "json"}))
                       .json();
  // Leapfrog falls g Δt² n (n + 1)/2 in n steps.
  const double fall = -0.125 * 0.25 * 0.25 * 40 * 41 / 2;
  CHECK(run["steps"] == 40);
  CHECK(run["unstable"] == false);
  CHECK(run["probes"]["corner"]["displacement"][1].get<double>() == Approx(fall).epsilon(rounding));
  const auto probes = lines_of(io::read_file(folder.output() / "probes.csv"));
  CHECK(cells_of(probes.front()) ==
        std::vector<std::string>{"time", "corner displacement x", "corner displacement y", "corner velocity x",
                                 "corner velocity y", "corner stress xx", "corner stress xy", "corner stress yy"});
  CHECK(std::stod(cells_of(probes.back())[2]) == Approx(fall).epsilon(rounding));
  CHECK(Json::parse(io::read_file(folder.output() / "summary.json")) == run);
  for (const char* file : {"states.h5", "states.xdmf", "snapshot_000.svg", "snapshot_002.svg"})
    CHECK(std::filesystem::file_size(folder.output() / file) > 0);
  CHECK_FALSE(std::filesystem::exists(folder.output() / "snapshot_003.svg"));
  CHECK_THAT(complaint_about(on_scene("run", folder, {"--duration", "1", "--output", folder.output().string()})),
             Contains("output"));
}

TEST_CASE("a run beyond the critical step ends with status 3 and says what grew", "[fast]") {
  const SceneFolder folder(std::string(falling_plate) + "\n[[clamp]]\nregion.box = { from = [0, 0], to = [1, 4] }\n");
  const auto outcome = run(
      on_scene("run", folder, {"--step-fraction", "1.2", "--duration", "10000", "--output", folder.output().string()}));
  CHECK(outcome.status == 3);
  CHECK_THAT(outcome.out, Contains("UNSTABLE") && Contains("is no number at step"));
  CHECK(std::filesystem::exists(folder.output() / "states.h5"));
  CHECK(run(on_scene("run", folder, {"--step-fraction", "0.99", "--duration", "1000"})).status == 0);
}

TEST_CASE("a run that grows without reaching infinity ends with status 3 too", "[fast]") {
  const SceneFolder folder(std::string(falling_plate) + "\n[[clamp]]\nregion.box = { from = [0, 0], to = [1, 4] }\n");
  const auto outcome =
      run(on_scene("run", folder, {"--step-fraction", "1.01", "--duration", "600", "--format", "json"}));
  CHECK(outcome.status == 3);
  CHECK(outcome.json()["unstable"] == true);
  CHECK_FALSE(outcome.json().contains("failure"));
}

TEST_CASE("only a body of one material on one lattice is compared with the bulk", "[fast]") {
  const auto spectrum_of = [](const std::string& of_the_body) {
    const std::string steel = "\n[[material]]\nname = \"steel\"\nyoung_modulus = 2.0\npoisson_ratio = 0.3\n";
    const SceneFolder folder(falling_plate + steel + "\n[[body]]\n" + of_the_body);
    return result_of(on_scene("spectrum", folder, {"--format", "json"})).json();
  };
  const std::string beside = "shape.box = { from = [6.0, 0.0], to = [9.0, 4.0] }\n";
  CHECK(spectrum_of(beside).contains("bulk_theory"));
  CHECK_FALSE(spectrum_of(beside + "material = \"steel\"\n").contains("bulk_theory"));
  CHECK_FALSE(spectrum_of(beside + "jitter = 0.1\n").contains("bulk_theory"));
}

TEST_CASE("a run that is cut short keeps the last state that has numbers", "[fast]") {
  const SceneFolder folder(std::string(falling_plate) + "\n[[clamp]]\nregion.box = { from = [0, 0], to = [1, 4] }\n");
  const Json answer = run(on_scene("run", folder,
                                   {"--step-fraction", "1.5", "--duration", "1e5", "--snapshots", "1", "--output",
                                    folder.output().string(), "--format", "json"}))
                          .json();
  CHECK(answer["failure"]["step"] == answer["steps"].get<long>() + 1);
  CHECK_THAT(io::read_file(folder.output() / "states.xdmf"), Contains("states.h5:/states/1/displacement"));
  // The last row of the probes is that state, stress and all.
  const auto last = cells_of(lines_of(io::read_file(folder.output() / "probes.csv")).back());
  const Json& corner = answer["probes"]["corner"];
  REQUIRE(last.size() == 8);
  const double state[] = {answer["time"],         corner["displacement"][0], corner["displacement"][1],
                          corner["velocity"][0],  corner["velocity"][1],     corner["stress"][0][0],
                          corner["stress"][0][1], corner["stress"][1][1]};
  for (int i = 0; i < 8; ++i) CHECK(std::stod(last[i]) == state[i]);
}

TEST_CASE("a plate falls by the gravity of the case, as a scene does", "[fast]") {
  const Arguments fall{"--plate",    "6,4", "--integrator", "verlet", "--time-step", "1",
                       "--duration", "8",   "--format",     "json",   "--gravity"};
  const auto on_plate = [&](const std::string& gravity) {
    Arguments arguments = fall;
    arguments.push_back(gravity);
    return on_case("run", arguments);
  };
  const Json fallen = result_of(on_plate("0,-0.25")).json();
  CHECK(fallen["largest_displacement"].get<double>() == Approx(0.5 * 0.25 * 8 * 8).epsilon(rounding));
  CHECK(fallen["largest_velocity"].get<double>() == Approx(0.25 * 8).epsilon(rounding));
  CHECK(complaint_about(on_plate("0,0,-1")) == "gravity: has 3 components, but 2 are needed");
}

TEST_CASE("a table sweeps over plates and scenes", "[fast]") {
  const SceneFolder folder(falling_plate);
  const Arguments sweep{
      "--sweep", "kernel-normalisation=none,sum", "--columns", "critical_time_step", "--format", "json", "--answer"};
  const auto check = [&](Arguments table, Arguments single, const std::string& command) {
    table.insert(table.end(), sweep.begin(), sweep.end());
    table.push_back(command);
    const Json rows = result_of(table).json()["rows"];
    REQUIRE(rows.size() == 2);
    single.insert(single.end(), {"--format", "json"});
    CHECK(rows[0]["critical_time_step"] == result_of(single).json()["critical_time_step"]);
    CHECK(rows[1]["critical_time_step"] < rows[0]["critical_time_step"]);
  };
  for (const std::string command : {"spectrum", "bisect"}) {
    check(on_case("table", {"--plate", "6,4"}), on_case(command, {"--plate", "6,4"}), command);
    check(on_scene("table", folder), on_scene(command, folder), command);
  }
}

TEST_CASE("a run takes one time step, and as many as can be counted", "[fast]") {
  const SceneFolder folder(falling_plate);
  CHECK(complaint_about(on_scene("run", folder, {"--duration", "1", "--time-step", "1", "--step-fraction", "0.5"})) ==
        "step_fraction: cannot be given with time_step");
  CHECK_THAT(complaint_about(on_scene("run", folder, {"--duration", "1e300"})),
             StartsWith("duration: 1e+300 takes more than"));
}

TEST_CASE("a run over a longer one leaves none of its snapshots, and what else is in the folder", "[fast]") {
  const SceneFolder folder(falling_plate);
  const auto run_with = [&](const char* snapshots) {
    result_of(
        on_scene("run", folder,
                 {"--duration", "10", "--snapshots", snapshots, "--output", folder.output().string(), "--overwrite"}));
  };
  run_with("4");
  io::write_file(folder.output() / "notes.txt", "mine");
  CHECK(std::filesystem::exists(folder.output() / "snapshot_004.svg"));
  run_with("2");
  CHECK(std::filesystem::exists(folder.output() / "snapshot_002.svg"));
  CHECK_FALSE(std::filesystem::exists(folder.output() / "snapshot_003.svg"));
  CHECK(std::filesystem::exists(folder.output() / "notes.txt"));
}

TEST_CASE("an interrupted run leaves nothing behind", "[fast]") {
  const SceneFolder folder(falling_plate);
  const Process process(on_scene("run", folder, {"--duration", "1e8", "--output", folder.output().string()}));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  process.send(SIGINT);
  const auto outcome = process.wait();
  CHECK(outcome.status == 128 + SIGINT);
  CHECK(outcome.err == "sphstab: interrupted, nothing was written\n");
  CHECK(folder.names() == std::vector<std::string>{"scene.toml"});
}

TEST_CASE("what names no body, or two, is refused", "[fast]") {
  const SceneFolder folder(falling_plate);
  CHECK(complaint_about(on_case("spectrum")) == "scene: missing (or plate or patch)");
  CHECK(complaint_about(on_scene("spectrum", folder, {"--plate", "3,3"})) == "plate: cannot be given with scene");
  CHECK_THAT(complaint_about(on_scene("bisect", folder, {"--patch", "3,3"})),
             Catch::EndsWith("patch: cannot be given with bodies"));
  CHECK_THAT(complaint_about({"spectrum", "--scene", "nowhere.toml"}), StartsWith("nowhere.toml"));
  CHECK_THAT(complaint_about(on_scene("run", folder)), StartsWith("duration: missing"));
  CHECK(complaint_about(on_scene("run", folder, {"--duration", "1", "--overwrite"})) == "overwrite: needs --output");
}
