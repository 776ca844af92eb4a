// SPDX-License-Identifier: MIT
// Whatever is wrong is said in one line that names it, with exit status 2 and nothing on standard output.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "cli/program.hpp"
#include "io/files.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::cli_test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

std::string dt_complaint(const Arguments& more) { return complaint_about(on_case("dt", more)); }

}  // namespace

TEST_CASE("values out of range name key, value and what is allowed", "[fast]") {
  CHECK(dt_complaint({"--spacing", "-1"}) == "spacing: -1 is not above 0");
  CHECK(dt_complaint({"--spacing=0"}) == "spacing: 0 is not above 0");
  CHECK(dt_complaint({"--density", "-3"}) == "density: -3 is not above 0");
  CHECK(dt_complaint({"--damping-rate", "-1"}) == "damping_rate: -1 is not at least 0");
  CHECK(dt_complaint({"--mode", "1,1", "--box", "0,1"}) == "box: 0 is not at least 1");
  CHECK(dt_complaint({"--h-over-spacing", "0.4"}) ==
        "smoothing_length: no neighbour lies strictly inside the support 0.8 (square lattice, spacing 1)");
  const Arguments material{"dt", "--scheme", "tl-linear", "--young-modulus", "1", "--poisson-ratio"};
  const auto ratio = [&](const std::string& value) {
    Arguments arguments = material;
    arguments.push_back(value);
    return complaint_about(arguments);
  };
  CHECK(ratio("0.5") == "poisson_ratio: 0.5 is not below 0.5 (plane strain)");
  CHECK(ratio("0.6") == "poisson_ratio: 0.6 is above 0.5");
  CHECK(ratio("-1") == "poisson_ratio: -1 is not above -1");
}

TEST_CASE("numbers that are none, and lists that are empty or too long, are refused", "[fast]") {
  CHECK(dt_complaint({"--spacing", "nan"}) == "spacing: nan is not a finite number");
  CHECK(dt_complaint({"--spacing", "inf"}) == "spacing: inf is not a finite number");
  CHECK(dt_complaint({"--spacing", "1e999"}) == "spacing: '1e999' is not a number");
  CHECK(dt_complaint({"--spacing", "wide"}) == "spacing: 'wide' is not a number");
  CHECK(dt_complaint({"--spacing", "1,2"}) == "spacing: '1,2' is not a number");
  CHECK(dt_complaint({"--wave-vector", "nan,0"}) == "wave_vector: nan is not a finite number");
  CHECK(dt_complaint({"--wave-vector", ","}) == "wave_vector: '' is not a number");
  CHECK(dt_complaint({"--wave-vector", "1"}) == "wave_vector: has 1 components, but 2 are needed");
  CHECK(dt_complaint({"--wave-vector", "1,2,3"}) == "wave_vector: has 3 components, but 2 are needed");
  CHECK(dt_complaint({"--mode", "1.5,1", "--box", "3,3"}) == "mode: 1.5 is not a whole number");
  CHECK(dt_complaint({"--displacement-gradient", "1,2"}) ==
        "displacement_gradient: has 2 components, but 4 are needed");
}

TEST_CASE("a flag takes exactly one value", "[fast]") {
  CHECK(dt_complaint({"--wave-vector="}) == "--wave-vector: takes exactly one value");
  CHECK(dt_complaint({"--spacing"}) == "--spacing: takes exactly one value");
  CHECK(dt_complaint({"--spacing", "1", "--spacing", "2"}) == "--spacing: takes exactly one value");
}

TEST_CASE("unknown words suggest the nearest that is known", "[fast]") {
  CHECK_THAT(dt_complaint({"--smothing-length", "1"}),
             StartsWith("option: '--smothing-length' is not known; did you mean '--smoothing-length'?"));
  CHECK_THAT(dt_complaint({"--smothing-length=1"}), Contains("did you mean '--smoothing-length'?"));
  CHECK_THAT(dt_complaint({"--kernel", "gausian"}),
             StartsWith("kernel: 'gausian' is not known; did you mean 'gaussian'? Allowed: cubic-spline, "));
  CHECK_THAT(dt_complaint({"--format", "jsn"}), StartsWith("format: 'jsn' is not known; did you mean 'json'?"));
  CHECK_THAT(complaint_about({"bisekt", "--patch", "3,3"}),
             StartsWith("command: 'bisekt' is not known; did you mean 'bisect'? Allowed: dt, "));
  CHECK_THAT(complaint_about({"list", "kernel"}), StartsWith("list: 'kernel' is not known; did you mean 'kernels'?"));
  CHECK_THAT(complaint_about({"list", "--format", "csvv"}), StartsWith("format: 'csvv' is not known"));
  CHECK_THAT(complaint_about({"report", "zhang-plat"}),
             StartsWith("report: 'zhang-plat' is not known; did you mean 'zhang-plate'?"));
  CHECK_THAT(complaint_about({"report", "--chek"}),
             StartsWith("option: '--chek' is not known; did you mean '--check'?"));
  CHECK_THAT(complaint_about(on_case("bisect", {"--wave-vector", "1,0"})), StartsWith("option: '--wave-vector'"));
}

TEST_CASE("without a command the help goes to standard error", "[fast]") {
  const Outcome outcome = run({});
  CHECK(outcome.status == 2);
  CHECK(outcome.out == "");
  CHECK_THAT(outcome.err, Contains("bisect") && EndsWith("sphstab: command: missing\n"));
}

TEST_CASE("missing keys are named with what they are", "[fast]") {
  CHECK_THAT(complaint_about({"dt", "--young-modulus", "1", "--poisson-ratio", "0.3"}),
             StartsWith("scheme: missing ("));
  CHECK_THAT(complaint_about({"dt", "--scheme", "tl-linear"}), StartsWith("young_modulus: missing ("));
  CHECK_THAT(complaint_about({"dt", "--scheme", "tl-linear", "--young-modulus", "1"}),
             StartsWith("poisson_ratio: missing ("));
  CHECK_THAT(complaint_about({"dt", "--scheme", "tl-linear", "--bulk-modulus", "1"}),
             StartsWith("shear_modulus: missing ("));
  CHECK(complaint_about(on_case("matrix", {"--time-step", "1"})) == "wave_vector: missing (or mode with box)");
  CHECK_THAT(complaint_about(on_case("matrix", {"--wave-vector", "1,0"})), StartsWith("time_step: missing ("));
  CHECK_THAT(dt_complaint({"--mode", "1,1"}), StartsWith("box: missing ("));
}

TEST_CASE("contradictory keys are refused", "[fast]") {
  CHECK(dt_complaint({"--smoothing-length", "1", "--h-over-spacing", "1"}) ==
        "smoothing_length: cannot be given with h_over_spacing");
  CHECK(dt_complaint({"--wave-vector", "1,2", "--mode", "1,1", "--box", "2,2"}) ==
        "wave_vector: cannot be given with mode");
  CHECK(dt_complaint({"--bulk-modulus", "1", "--shear-modulus", "1"}) ==
        "young_modulus: cannot be given with bulk_modulus");
  CHECK(dt_complaint({"--steps", "10", "--tolerated-growth-per-step", "0.1"}) ==
        "tolerated_growth_per_step: cannot be given with steps");
  CHECK(complaint_about(on_case("bisect", {"--patch", "3,3", "--plate", "3,3"})) ==
        "plate: cannot be given with patch");
}

TEST_CASE("a lattice belongs to a dimension, and plane stress to two", "[fast]") {
  CHECK(dt_complaint({"--dimension", "3", "--lattice", "square"}) == "lattice: square has 2 dimensions, not 3");
  CHECK(dt_complaint({"--lattice", "fcc"}) == "lattice: fcc has 3 dimensions, not 2");
  CHECK(dt_complaint({"--dimension", "1", "--plane", "stress"}) == "plane: stress is for 2 dimensions, not 1");
  CHECK(dt_complaint({"--dimension", "4"}) == "dimension: 4 is not at most 3");
  CHECK(complaint_about(on_case("matrix", {"--dimension", "3", "--wave-vector", "1,2", "--time-step", "0.1"})) ==
        "wave_vector: has 2 components, but 3 are needed");
}

TEST_CASE("bodies and boxes that are too large are refused before anything is made of them", "[fast]") {
  // 65536² is 0 in the arithmetic of an int.
  for (const std::string body : {"plate", "patch"})
    CHECK(complaint_about(on_case("bisect", {"--" + body, "65536,65536"})) ==
          body + ": 65536,65536 multiply to more than 1000000");
  CHECK(dt_complaint({"--box", "65536,65536"}) == "box: 65536,65536 multiply to more than 1000000");
  CHECK_THAT(complaint_about(on_case("bisect", {"--plate", "3,1"})), StartsWith("plate: 1 is not at least 2"));
  CHECK_THAT(complaint_about(on_case("bisect", {"--plate", "3,3", "--lattice", "hexagonal"})),
             StartsWith("plate: a free plate needs the lattice square"));
}

TEST_CASE("a case file that is missing or broken is named with what is wrong in it", "[fast]") {
  const ScratchFolder folder;
  const auto with = [&folder](const std::string& text) {
    const std::string file = folder / "case.toml";
    io::write_file(file, text, io::Existing::replace);
    const std::string complaint = complaint_about({"dt", "--case", file});
    return complaint.starts_with(file) ? complaint.substr(file.size()) : complaint;
  };
  CHECK(complaint_about({"dt", "--case", folder / "none.toml"}) ==
        (folder / "none.toml").string() + ": No such file or directory");
  CHECK(complaint_about({"dt", "--case", folder.path()}) == folder.path().string() + ": Is a directory");
  CHECK_THAT(with("spacing = 1\nkernel = \n"), StartsWith(":2:"));
  CHECK_THAT(with("spacing = nan"), StartsWith(":1:11: the number is not finite"));
  CHECK_THAT(with("smothing_length = 1"),
             StartsWith("key: 'smothing_length' is not known; did you mean 'smoothing_length'?"));
  CHECK_THAT(with("kernel = \"gausian\""), StartsWith("kernel: 'gausian' is not known; did you mean 'gaussian'?"));
  CHECK(with("spacing = \"1\"") == "spacing: is not a number");
  CHECK(with("spacing = true") == "spacing: true is no number, word or list of numbers");
  CHECK(with("wave_vector = []\nscheme = \"tl-linear\"\nyoung_modulus = 1\npoisson_ratio = 0.3") ==
        "wave_vector: has 0 components, but 2 are needed");
  CHECK_THAT(with("[material]\nyoung_modulus = 1"), StartsWith("key: 'material' is not known"));
}

TEST_CASE("a report is not written where it cannot be or where it would replace another", "[fast]") {
  const ScratchFolder folder;
  io::write_file(folder / "file", "");
  std::filesystem::create_directories(folder / "reports/zhang-plate");
  io::write_file(folder / "reports/zhang-plate/index.md", "by hand");
  const auto into = [&folder](const std::string& output) {
    return complaint_about({"report", "zhang-plate", "--output", folder / output});
  };
  CHECK(into("reports") == (folder / "reports/zhang-plate").string() + ": exists already and is not empty");
  CHECK(into("file") == (folder / "file").string() + ": is no folder");
  CHECK_THAT(into("file/below"), EndsWith("file/below: no such folder"));
  CHECK_THAT(into("none"), EndsWith("none: no such folder"));
  CHECK(io::read_file(folder / "reports/zhang-plate/index.md") == "by hand");
  CHECK(folder.names().size() == 4);
}

TEST_CASE("what leaves the range of a double, or has nothing to run, is refused in one line", "[fast]") {
  CHECK_THAT(complaint_about(on_case("dt", {"--spacing", "1e-200"})), StartsWith("spacing: 1e-200 makes a cell"));
  CHECK_THAT(complaint_about(on_case("dt", {"--spacing", "1e-120"})), StartsWith("smoothing_length: "));
  CHECK_THAT(complaint_about(on_case("dt", {"--h-over-spacing", "1e10"})), EndsWith("too many neighbours"));
  CHECK_THAT(complaint_about(on_case("dt", {"--spacing", "1e-60", "--density", "1e-200"})),
             StartsWith("spacing, density and moduli: "));
  CHECK_THAT(complaint_about(on_case("dt", {"--time-step", "1e160"})), StartsWith("time_step: 1e+160 is so long"));
  CHECK_THAT(complaint_about(on_case("matrix", {"--wave-vector", "1,1", "--time-step", "1e160"})),
             StartsWith("time_step: 1e+160 is so long"));
  CHECK_THAT(complaint_about(on_case("bisect", {"--tolerance", "1e-15"})),
             StartsWith("tolerance: 1e-15 is not at least"));
  for (const char* patch : {"1,1", "2,2"})
    CHECK_THAT(complaint_about(on_case("bisect", {"--patch", patch})), StartsWith("patch: no perturbation of it"));
}

TEST_CASE("a result that cannot be written is no success", "[fast]") {
  // The device /dev/full takes no byte.
  const std::string program = "'" SPHSTAB_PROGRAM "' ";
  const auto status = [](const std::string& command) { return WEXITSTATUS(std::system(command.c_str())); };
  for (const std::string command : {"list", "--version", "list kernels --format csv"})
    CHECK(status(program + command + " > /dev/full 2> /dev/null") == 2);
  CHECK(status("echo '{}' | " + program + "batch > /dev/full 2> /dev/null") == 2);
  CHECK(status(program + "list > /dev/null") == 0);
}

TEST_CASE("a key of other commands is said to be one, and a number that may be a word names the word", "[fast]") {
  CHECK(complaint_about(on_case("spectrum", {"--plate", "4,3", "--time-step", "auto"})) ==
        "option: '--time-step' is not for spectrum; --help lists its options");
  CHECK(complaint_about(on_case("run", {"--plate", "4,3", "--duration", "1", "--time-step", "automatic"})) ==
        "time_step: 'automatic' is not a number or auto");
  CHECK_THAT(complaint_about(on_case("dt", {"--tine-step", "1"})), Contains("did you mean '--time-step'?"));
}
