// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "io/document.hpp"

using namespace sphstab;
using namespace sphstab::io;

namespace {

const Document result = {{"critical_time_step", 0.1},
                         {"bracket", {0.1, 0.25}},
                         {"critical_mode", {{"wave_vector", {3.5, 0.0}}, {"branch", "p, fast"}}},
                         {"eigenvalues", {{1.0, 0.0}, {0.5, -0.5}}},
                         {"growth_rate", nullptr},
                         {"stabilising_epsilon", Document::array()},
                         {"bulk_only", true}};

}  // namespace

TEST_CASE("JSON keeps every bit of a double and the order of the keys", "[fast]") {
  for (const double value : {0.1, 1.0 / 3.0, std::nextafter(1.0, 2.0), 5e-324, 1.7976931348623157e308, -0.0}) {
    const Document document = {{"z", value}, {"a", 1}};
    const Document back = Document::parse(write(document, Format::json));
    CHECK(back.begin().key() == "z");
    CHECK(back["z"].get<double>() == value);
    CHECK(std::signbit(back["z"].get<double>()) == std::signbit(value));
  }
}

TEST_CASE("JSON is indented by two, ends in a newline and has null for what is not finite", "[fast]") {
  CHECK(write({{"a", std::numeric_limits<double>::quiet_NaN()}, {"b", {1, 2.5}}}, Format::json) ==
        "{\n  \"a\": null,\n  \"b\": [\n    1,\n    2.5\n  ]\n}\n");
}

TEST_CASE("a JSON line is one line even where a text has newlines and broken UTF-8", "[fast]") {
  CHECK(to_json_line({{"error", "a\nb\xff"}}) == "{\"error\":\"a\\nb\xef\xbf\xbd\"}");
}

TEST_CASE("CSV of a single object is a header and a row with nested keys dotted", "[fast]") {
  CHECK(write(result, Format::csv) ==
        "critical_time_step,bracket,critical_mode.wave_vector,critical_mode.branch,eigenvalues,growth_rate,"
        "stabilising_epsilon,bulk_only\n"
        "0.1,0.1 0.25,3.5 0.0,\"p, fast\",\"[[1.0,0.0],[0.5,-0.5]]\",,,true\n");
}

TEST_CASE("CSV of many cases has the keys of all of them and empty cells where a case has none", "[fast]") {
  const Document rows = {{{"a", 1}, {"b", "x"}}, {{"a", 2}, {"c", 0.5}}};
  CHECK(write(rows, Format::csv) == "a,b,c\n1,x,\n2,,0.5\n");
}

TEST_CASE("CSV dots every level of nesting and leaves a cell empty for what is not finite", "[fast]") {
  CHECK(write({{"a", {{"b", {{"c", 1}, {"d", std::numeric_limits<double>::infinity()}}}}}}, Format::csv) ==
        "a.b.c,a.b.d\n1,\n");
}

TEST_CASE("CSV quotes separators, quotes and newlines", "[fast]") {
  const Table table{{"k,1"}, {{"say \"h\""}, {"two\nlines"}, {"plain text"}}};
  CHECK(to_csv(table) == "\"k,1\"\n\"say \"\"h\"\"\"\n\"two\nlines\"\nplain text\n");
}

TEST_CASE("CSV keeps every bit of a double", "[fast]") {
  const double value = std::nextafter(1.0 / 3.0, 1.0);
  std::istringstream csv(write({{"value", value}}, Format::csv));
  std::string header, cell;
  std::getline(csv, header);
  std::getline(csv, cell);
  CHECK(std::stod(cell) == value);
}

TEST_CASE("Markdown of a single object has a row for each key", "[fast]") {
  CHECK(write({{"mode", {{"branch", "p|s"}}}, {"steps", 3}}, Format::markdown) ==
        "| key | value |\n|---|---|\n| mode.branch | p\\|s |\n| steps | 3 |\n");
}

TEST_CASE("Markdown and LaTeX of many cases have a row for each case", "[fast]") {
  const Document rows = {{{"a", 1}}, {{"a", 2}}};
  CHECK(write(rows, Format::markdown) == "| a |\n|---:|\n| 1 |\n| 2 |\n");
  CHECK(write(rows, Format::latex) ==
        "\\begin{tabular}{r}\n\\hline\na \\\\\n\\hline\n1 \\\\\n2 \\\\\n\\hline\n\\end{tabular}\n");
}

TEST_CASE("Markdown escapes what would be markup and aligns columns of numbers to the right", "[fast]") {
  const Table table{{"rule", "Δt"}, {{"*a* <b> `c` \\ |", "1e-3"}, {"two\nlines", ""}}};
  CHECK(to_markdown(table) ==
        "| rule | Δt |\n|---|---:|\n| \\*a\\* \\<b> \\`c\\` \\\\ \\| | 1e-3 |\n| two lines |  |\n");
}

TEST_CASE("LaTeX escapes its special characters and needs no package", "[fast]") {
  const Table table{{"sound_speed", "n"}, {{"50 % & {x} $y$ #1 a~b^c \\ <>|", "2"}}};
  CHECK(to_latex(table) ==
        "\\begin{tabular}{lr}\n\\hline\nsound\\_speed & n \\\\\n\\hline\n"
        "50 \\% \\& \\{x\\} \\$y\\$ \\#1 a\\textasciitilde{}b\\textasciicircum{}c \\textbackslash{} "
        "\\textless{}\\textgreater{}\\textbar{} & 2 \\\\\n\\hline\n\\end{tabular}\n");
}

TEST_CASE("chosen columns have their own headers and number formats", "[fast]") {
  const Document rows = {
      result, {{"critical_time_step", 0.25}, {"critical_mode", {{"branch", "s"}}}, {"growth_rate", std::nan("")}}};
  const Table table = select(rows, {{"critical_mode.branch", "branch"},
                                    {"critical_time_step", "limit", "{:.3f}"},
                                    {"growth_rate", "rate", "{:.1e}"},
                                    {"critical_time_step", "exact"}});
  CHECK(table.header == std::vector<std::string>{"branch", "limit", "rate", "exact"});
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0] == std::vector<std::string>{"p, fast", "0.100", "", "0.1"});
  CHECK(table.rows[1] == std::vector<std::string>{"s", "0.250", "", "0.25"});
}

TEST_CASE("a table of all keys has its numbers in one format, those in lists and objects too", "[fast]") {
  const Document rows = {{{"a", 1.0 / 3.0}, {"b", {{"c", {0.125, 2.0 / 3.0}}}}}, {{"d", "word"}, {"a", nullptr}}};
  const Table table = to_table(rows, "{:.3g}");
  CHECK(table.header == std::vector<std::string>{"a", "b.c", "d"});
  CHECK(table.rows == std::vector<std::vector<std::string>>{{"0.333", "0.125 0.667", ""}, {"", "", "word"}});
  CHECK(to_table(rows).rows[0][0] == "0.3333333333333333");
}

TEST_CASE("text has aligned columns, those of numbers to the right, and no space at the end of a line", "[fast]") {
  CHECK(to_text({{"name", "n", "long number"}, {{"a", "1", "-2.5"}, {"longer", "10", ""}}}) ==
        "name     n  long number\n"
        "a        1         -2.5\n"
        "longer  10\n");
}

TEST_CASE("the formats have the names that users write", "[fast]") {
  CHECK(from_name<Format>("format", "latex") == Format::latex);
  CHECK_THROWS_WITH(from_name<Format>("format", "yaml"), Catch::EndsWith("Allowed: json, csv, markdown, latex"));
}
