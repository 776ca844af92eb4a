// SPDX-License-Identifier: MIT
// Every command in every format.
#include <algorithm>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>

#include "cli/program.hpp"
#include "io/files.hpp"
#include "io/scratch_folder.hpp"

using namespace sphstab;
using namespace sphstab::cli_test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

/// A mode at a third of its limit, and a patch that is run in a moment.
const Arguments at_mode{"--wave-vector", "-1.5,0.3", "--time-step", "0.7"};
const Arguments on_patch{"--patch", "4,3", "--tolerance", "1e-4"};

/// Every command that prints a result in a format.
std::vector<Arguments> commands() {
  return {on_case("dt"), on_case("matrix", at_mode), on_case("bisect", on_patch), {"list"}, {"list", "kernels"}};
}

Arguments in_format(Arguments arguments, const std::string& format) {
  arguments.insert(arguments.end(), {"--format", format});
  return arguments;
}

double number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  REQUIRE(error == std::errc());
  REQUIRE(end == text.data() + text.size());
  return value;
}

}  // namespace

TEST_CASE("every command answers in every format, on standard output alone", "[fast]") {
  for (const auto& command : commands())
    for (const std::string format : {"text", "json", "csv", "markdown", "latex"}) {
      INFO(command.front() << " " << format);
      const std::string out = result_of(in_format(command, format)).out;
      REQUIRE(!out.empty());
      CHECK(out.back() == '\n');
      if (format == "json") CHECK(Json::parse(out).is_object());
      if (format == "markdown") CHECK_THAT(out, StartsWith("| ") && Contains("\n|---|"));
      if (format == "latex") CHECK_THAT(out, StartsWith("\\begin{tabular}") && Catch::EndsWith("\\end{tabular}\n"));
      if (format == "csv") {
        const auto lines = lines_of(out);
        REQUIRE(lines.size() > 1);
        for (const auto& line : lines) CHECK(cells_of(line).size() == cells_of(lines.front()).size());
      }
    }
}

TEST_CASE("text is what a command prints without a format", "[fast]") {
  for (const auto& command : commands()) CHECK(result_of(command).out == result_of(in_format(command, "text")).out);
}

TEST_CASE("the tables hold every key of the JSON with every digit of its numbers", "[fast]") {
  for (const auto& command : {on_case("dt"), on_case("matrix", at_mode), on_case("bisect", on_patch)}) {
    INFO(command.front());
    const Json json = result_of(in_format(command, "json")).json();
    const std::string markdown = result_of(in_format(command, "markdown")).out;
    const std::string latex = result_of(in_format(command, "latex")).out;
    const auto csv = lines_of(result_of(in_format(command, "csv")).out);
    REQUIRE(csv.size() == 2);
    const auto header = cells_of(csv[0]), values = cells_of(csv[1]);
    for (const auto& [key, value] : json.items()) {
      INFO(key);
      if (value.is_object()) continue;
      const auto column = std::find(header.begin(), header.end(), key) - header.begin();
      REQUIRE(column < static_cast<long>(header.size()));
      if (!value.is_number()) continue;
      CHECK(number(values[column]) == value.get<double>());
      CHECK_THAT(markdown, Contains("| " + key + " | " + values[column] + " |\n"));
      std::string escaped = key;
      for (std::size_t at = 0; (at = escaped.find('_', at)) != std::string::npos; at += 2) escaped.insert(at, "\\");
      CHECK_THAT(latex, Contains(escaped + " & " + values[column] + " \\\\\n"));
    }
  }
}

TEST_CASE("every text of dt says that it is a bulk value, whatever the verdict", "[fast]") {
  const Arguments squeezed{"--displacement-gradient", "-0.4,0,0,-0.4", "--density-in-momentum", "equation-of-state"};
  const Arguments at_zero_energy{"--wave-vector", "3.141592653589793,0"};
  for (const auto& more :
       {Arguments{}, squeezed, at_zero_energy, Arguments{"--box", "5,5"}, Arguments{"--plane", "stress"},
        Arguments{"--time-step", "3", "--steps", "1000"}, Arguments{"--lattice", "hexagonal", "--damping-rate", "1"}}) {
    const std::string out = result_of(on_case("dt", more)).out;
    CHECK_THAT(out, StartsWith("Bulk value: critical time step of an infinite lattice\n"));
    CHECK_THAT(out, Contains("Note: bulk value of an infinite lattice: free, renormalised edges can need 0.6 of it"));
  }
  CHECK_THAT(result_of(on_case("dt", squeezed)).out, Contains("never stable") && !Contains("critical time step  "));
  CHECK_THAT(result_of(on_case("dt", at_zero_energy)).out,
             Contains("The mode given alone:\n  every time step is stable"));
}

TEST_CASE("dt names a published bound that is not safe", "[fast]") {
  CHECK_THAT(result_of(on_case("dt")).out, Contains("published bound      2.6597827") && Contains("UNSAFE here"));
  CHECK_THAT(result_of(on_case("dt", {"--neighbours", "nearest"})).out,
             Contains("safe here") && !Contains("UNSAFE here"));
}

TEST_CASE("dt explains its limit in ten lines, in text and as a list in JSON", "[fast]") {
  const Json lines = result_of(on_case("dt", {"--explain", "--format", "json"})).json()["explanation"];
  REQUIRE(lines.size() == 10);
  const std::string text = result_of(on_case("dt", {"--explain"})).out;
  for (const Json& line : lines) CHECK_THAT(text, Contains("  " + line.get<std::string>() + "\n"));
  CHECK_FALSE(result_of(on_case("dt", {"--format", "json"})).json().contains("explanation"));
  CHECK_THAT(complaint_about(on_case("matrix", {"--explain"})), Contains("--explain"));
}

TEST_CASE("text shows the numbers of the JSON", "[fast]") {
  // Twelve digits in text.
  constexpr double printed = 1e-11;
  const auto shown = [](const std::string& text, const std::string& name) {
    const auto begin = text.find_first_not_of(' ', text.find("  " + name) + 2 + name.size());
    return number(text.substr(begin, text.find_first_of(" \n", begin) - begin));
  };
  const std::string dt = result_of(on_case("dt")).out, bisect = result_of(on_case("bisect", on_patch)).out;
  const Json dt_json = result_of(in_format(on_case("dt"), "json")).json();
  const Json bisect_json = result_of(in_format(on_case("bisect", on_patch), "json")).json();
  CHECK(shown(dt, "critical time step") == Approx(dt_json["critical_time_step"].get<double>()).epsilon(printed));
  CHECK(shown(bisect, "by running") == Approx(bisect_json["critical_time_step"].get<double>()).epsilon(printed));
  CHECK(shown(bisect, "theory, same body") == Approx(bisect_json["theory"].get<double>()).epsilon(printed));
  CHECK(shown(bisect, "theory, bulk") == Approx(dt_json["critical_time_step"].get<double>()).epsilon(printed));
}

TEST_CASE("a case file and flags say the same, and a flag overrides the file", "[fast]") {
  const ScratchFolder folder;
  const std::string file = folder / "case.toml";
  io::write_file(file,
                 "scheme = \"tl-linear\"\nyoung_modulus = 1\npoisson_ratio = 0.3\nspacing = 2.0\n"
                 "wave_vector = [-1.5, 0.3]\ntime_step = 0.7\n");
  CHECK(result_of({"matrix", "--case", file, "--format", "json"}).out ==
        result_of(
            in_format(on_case("matrix", {"--spacing", "2", "--wave-vector", "-1.5,0.3", "--time-step=0.7"}), "json"))
            .out);
  CHECK(result_of({"matrix", "--spacing", "1", "--case", file, "--format", "json"}).out ==
        result_of(in_format(on_case("matrix", at_mode), "json")).out);
}

TEST_CASE("negative numbers are values of flags, not flags", "[fast]") {
  for (const std::string wave_vector : {"-1.5,0.3", "-.5,-0.3", "-1e-3,0"})
    for (const Arguments& flag : {Arguments{"--wave-vector", wave_vector}, Arguments{"--wave-vector=" + wave_vector}}) {
      Arguments arguments = on_case("matrix", flag);
      arguments.insert(arguments.end(), {"--time-step", "0.1"});
      const Json result = result_of(in_format(arguments, "json")).json();
      CHECK(result["wave_vector"][0].get<double>() == number(wave_vector.substr(0, wave_vector.find(','))));
    }
}

TEST_CASE("list knows every topic, and what it lists is accepted", "[fast]") {
  const Json all = result_of({"list", "--format", "json"}).json();
  for (const std::string topic : {"kernels", "lattices", "schemes", "integrators", "keys"}) {
    CHECK(result_of({"list", topic, "--format", "json"}).json()[topic] == all[topic]);
    CHECK(!all[topic].empty());
  }
  for (const Json& kernel : all["kernels"]) result_of(on_case("dt", {"--kernel", kernel["name"]}));
  for (const Json& lattice : all["lattices"])
    if (lattice["name"] != "custom")
      result_of(on_case("dt", {"--dimension", lattice["dimension"].dump(), "--lattice", lattice["name"]}));
  CHECK(all["lattices"].back() == Json{{"name", "custom"}, {"parameters", {"primitive_vectors"}}});
  result_of(on_case("dt", {"--lattice", "custom", "--primitive-vectors", "1,0,0,2", "--h-over-spacing", "1.6"}));
  for (const Json& integrator : all["integrators"])
    result_of({"matrix", "--scheme", "ul", "--sound-speed", "1", "--shear-modulus", "0.3", "--wave-vector", "1,0.5",
               "--time-step", "0.1", "--integrator", integrator["name"]});
}

TEST_CASE("list names the keys that each scheme takes", "[fast]") {
  const auto takes = [schemes = result_of({"list", "schemes", "--format", "json"}).json()["schemes"]](
                         const std::string& scheme, const std::string& key) {
    for (const Json& row : schemes)
      if (row["name"] == scheme) return std::count(row["parameters"].begin(), row["parameters"].end(), key) == 1;
    return false;
  };
  for (const std::string scheme : {"tl-linear", "tl-corotated", "tl-pk1", "ul"}) {
    const bool is_finite = scheme == "tl-corotated" || scheme == "tl-pk1";
    CHECK(takes(scheme, "density"));
    CHECK(takes(scheme, "elastic_law") == is_finite);
    CHECK(takes(scheme, "deformation_gradient") == (is_finite || scheme == "ul"));
    CHECK(takes(scheme, "damping_rate") == (scheme != "ul"));
    CHECK(takes(scheme, "displacement_gradient") == (scheme == "tl-linear"));
    CHECK(takes(scheme, "xsph") == (scheme == "ul"));
  }
}

TEST_CASE("tables of list have a row for each name", "[fast]") {
  const auto lines = lines_of(result_of({"list", "kernels", "--format", "csv"}).out);
  CHECK(lines.size() == 1 + result_of({"list", "kernels", "--format", "json"}).json()["kernels"].size());
  CHECK(lines[0] == "topic,name,support_in_h,W0_h2_in_2d,parameters");
  CHECK_THAT(lines[2], StartsWith("kernels,quartic-spline,2.5,"));
}

TEST_CASE("help and version are results, and help shows the flag of every key with its default", "[fast]") {
  CHECK_THAT(result_of({"--version"}).out, StartsWith("sphstab "));
  const std::string help = result_of({"--help"}).out;
  for (const std::string command : {"dt", "matrix", "bisect", "table", "batch", "list", "report"}) {
    CHECK_THAT(help, Contains("\n  " + command + " "));
    CHECK(!result_of({command, "--help"}).out.empty());
  }
  CHECK_THAT(result_of({"dt", "--help"}).out, Contains("--smoothing-length") && Contains("[cubic-spline]"));
}

TEST_CASE("bisect agrees with the theory of the same patch and plate", "[fast]") {
  for (const Arguments& body : {on_patch, Arguments{"--plate", "4,3", "--tolerance", "1e-4"}}) {
    const Json result = result_of(in_format(on_case("bisect", body), "json")).json();
    CHECK(result["agrees"] == true);
    CHECK(result["relative_difference"].get<double>() <= 1e-4);
    CHECK(result["bracket"][0].get<double>() < result["bracket"][1].get<double>());
    CHECK(result[body[0].substr(2)] == Json({4, 3}));
  }
}
