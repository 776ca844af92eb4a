// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <filesystem>

#include "io/files.hpp"
#include "study/report.hpp"

using namespace sphstab;

namespace {

const std::filesystem::path reports = SPHSTAB_REPORTS_FOLDER;

/// Texts and numbers are the same everywhere; pictures depend on the version of gnuplot.
void check_comes_out_again(std::string_view name) {
  const auto report = study::find_report(name).make(nullptr);
  CHECK(report.failures.empty());
  REQUIRE_FALSE(report.files.empty());
  for (const auto& [file, text] : report.files) {
    INFO(name << "/" << file);
    REQUIRE(std::filesystem::exists(reports / name / file));
    if (std::filesystem::path(file).extension() != ".svg")
      CHECK((io::read_file(reports / name / file) == text));  // without printing both
  }
}

}  // namespace

TEST_CASE("the committed stability tables come out again bit for bit", "[ladder]") {
  check_comes_out_again("stability-tables");
}

TEST_CASE("the committed bands come out again bit for bit", "[ladder]") { check_comes_out_again("bands"); }

TEST_CASE("the committed hard cases come out again bit for bit", "[ladder]") { check_comes_out_again("hard-cases"); }

TEST_CASE("the committed verdicts on Swegle's criterion come out again bit for bit", "[ladder]") {
  check_comes_out_again("swegle");
}

TEST_CASE("the committed windows of artificial stress come out again bit for bit", "[ladder]") {
  check_comes_out_again("tension");
}

TEST_CASE("the committed Case 1 of Zhang comes out again bit for bit", "[ladder]") {
  check_comes_out_again("zhang-case-1");
}

TEST_CASE("the committed Case 2 of Zhang comes out again bit for bit", "[ladder]") {
  check_comes_out_again("zhang-case-2");
}

TEST_CASE("the committed printed numbers of Gray come out again bit for bit", "[ladder]") {
  check_comes_out_again("gray-printed-numbers");
}

TEST_CASE("the committed arrays of Gray come out again bit for bit", "[ladder]") {
  check_comes_out_again("gray-array");
}

TEST_CASE("the committed growth runs come out again bit for bit", "[ladder]") { check_comes_out_again("growth-runs"); }

TEST_CASE("schemes of finite strain keep momentum, angular momentum and energy as their report claims", "[ladder]") {
  CHECK(study::find_report("conservation").make(nullptr).failures.empty());
}
