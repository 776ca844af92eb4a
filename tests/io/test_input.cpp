// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <string>

#include "io/case_input.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "io/scratch_folder.hpp"
#include "io/toml.hpp"

using namespace sphstab;
using namespace sphstab::io;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

/// The message of the InvalidInput that `action` throws; it must be one line.
template <class Action>
std::string complaint(const Action& action) {
  try {
    action();
  } catch (const InvalidInput& error) {
    const std::string message = error.what();
    CHECK(message.find('\n') == std::string::npos);
    return message;
  }
  return "nothing thrown";
}

std::string toml_complaint(const std::string& text) {
  return complaint([&] { parse_toml(text, "case.toml"); });
}

std::string json_complaint(const std::string& line) {
  return complaint([&] { parse_json_line(line); });
}

}  // namespace

TEST_CASE("a TOML case becomes a document with its keys in the order of the text", "[fast]") {
  const Document document = parse_toml(
      "spacing = 0.1\n"
      "lattice = \"square\"\n"
      "mode = [50, 50]\n"
      "displacement_gradient = [[1e-3, 0.0], [0.0, 2]]\n"
      "check = true\n"
      "[sweep]\n"
      "poisson_ratio = [0.0, 0.3]\n"
      "h_over_spacing = [1.2]\n",
      "case.toml");
  CHECK(document == Document{{"spacing", 0.1},
                             {"lattice", "square"},
                             {"mode", {50, 50}},
                             {"displacement_gradient", {{1e-3, 0.0}, {0.0, 2}}},
                             {"check", true},
                             {"sweep", {{"poisson_ratio", {0.0, 0.3}}, {"h_over_spacing", {1.2}}}}});
  CHECK(
      to_json_line(document) ==
      R"({"spacing":0.1,"lattice":"square","mode":[50,50],"displacement_gradient":[[0.001,0.0],[0.0,2]],"check":true,)"
      R"("sweep":{"poisson_ratio":[0.0,0.3],"h_over_spacing":[1.2]}})");
}

TEST_CASE("broken TOML is named by file, line and column in one line", "[fast]") {
  CHECK_THAT(toml_complaint("spacing = 1\nkernel = \n"), StartsWith("case.toml:2:"));
  CHECK_THAT(toml_complaint("a = 1\na = 2\n"), StartsWith("case.toml:2:"));
  CHECK_THAT(toml_complaint("a = \"open\nb = 1\n"), StartsWith("case.toml:1:"));
  CHECK_THAT(toml_complaint("a = 1 2"), StartsWith("case.toml:1:"));
  CHECK_THAT(toml_complaint("a = \"\xff\""), StartsWith("case.toml:1:"));
}

TEST_CASE("TOML numbers that are not finite and dates are refused where they stand", "[fast]") {
  CHECK(toml_complaint("a = 1\nb = [0.5, nan]") == "case.toml:2:11: the number is not finite");
  CHECK(toml_complaint("a = -inf") == "case.toml:1:5: the number is not finite");
  CHECK(toml_complaint("a = 2020-01-01") == "case.toml:1:5: a date or time has no meaning in a case");
}

TEST_CASE("a TOML file is read and named in what is wrong with it", "[fast]") {
  const ScratchFolder folder;
  write_file(folder / "good.toml", "steps = 3\n");
  write_file(folder / "bad.toml", "steps = = 3\n");
  CHECK(read_toml(folder / "good.toml") == Document{{"steps", 3}});
  CHECK_THAT(complaint([&] { read_toml(folder / "bad.toml"); }), StartsWith((folder / "bad.toml").string() + ":1:"));
  CHECK_THAT(complaint([&] { read_toml(folder / "none.toml"); }), Contains("none.toml: No such file"));
}

TEST_CASE("a JSON line becomes a document with every bit of its numbers", "[fast]") {
  const Document document = parse_json_line(R"({"z":0.1,"a":[1,2.5e-3],"b":{"z":null,"y":"ω"}})");
  CHECK(document.begin().key() == "z");
  CHECK(document["z"].get<double>() == 0.1);
  CHECK(document["a"] == Document{1, 2.5e-3});
  CHECK(document["b"]["y"] == "ω");
}

TEST_CASE("broken JSON is named with its column in one line", "[fast]") {
  CHECK_THAT(json_complaint("{\"a\": 1,}"), StartsWith("invalid JSON: parse error at line 1, column 9: "));
  CHECK_THAT(json_complaint("{\"a\": \"x\ny\"}"), StartsWith("invalid JSON: parse error at line"));
  CHECK_THAT(json_complaint(""), StartsWith("invalid JSON: parse error at line 1, column 1: "));
  CHECK_THAT(json_complaint("{} {}"), StartsWith("invalid JSON: parse error at line 1, column 4: "));
  CHECK_THAT(json_complaint("{\"a\": \"\xff\"}"), StartsWith("invalid JSON: parse error at line 1, column 8: "));
}

TEST_CASE("a JSON key given twice in one object is refused and in two objects is not", "[fast]") {
  CHECK(json_complaint(R"({"a":1,"b":{"c":1,"c":2}})") == "c: given twice");
  CHECK(json_complaint(R"({"a":1,"b":{},"a":2})") == "a: given twice");
  CHECK(parse_json_line(R"({"a":{"c":1},"b":{"c":2},"c":[{"c":3},{"c":4}]})").size() == 3);
}

TEST_CASE("JSON numbers beyond a double, NaN and lines that are no object are refused", "[fast]") {
  CHECK_THAT(json_complaint(R"({"a":1e999})"), Contains("1e999"));
  CHECK_THAT(json_complaint(R"({"a":NaN})"), StartsWith("invalid JSON: "));
  CHECK_THAT(json_complaint(R"({"a":Infinity})"), StartsWith("invalid JSON: "));
  CHECK(json_complaint("[1]") == "array is no JSON object");
  CHECK(json_complaint("3") == "number is no JSON object");
}

TEST_CASE("JSON nested without end is refused before anything walks over it", "[fast]") {
  CHECK(json_complaint("{\"a\":" + std::string(100000, '[')) == "nested deeper than 32");
}

TEST_CASE("the values of a case go to JSON and back, whole numbers without a point", "[fast]") {
  const std::string line =
      R"({"dimension":3,"spacing":0.1,"lattice":"bcc","wave_vector":[1.0,-2.5],"patch":[4,3]})";
  const Document object = parse_json_line(line);
  Case input;
  set_from_json(input, object);
  Document back;
  for (const auto& [key, value] : object.items()) back[key] = to_json(input, find_key(key));
  CHECK(to_json_line(back) == line);
  CHECK(to_json(input, find_key("kernel")) == "cubic-spline");
  CHECK(to_json(input, find_key("noise_seed")) == 1);
  for (const std::string absent : {"smoothing_length", "horizon", "plate", "displacement_gradient", "integrator"})
    CHECK(to_json(input, find_key(absent)).is_null());
}
