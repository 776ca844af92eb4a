// SPDX-License-Identifier: MIT
#include "study/sweep.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>

using namespace sphstab;
using namespace sphstab::study;
using Catch::Matchers::StartsWith;
using Strings = std::vector<std::string>;

namespace {

std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  for (const KeyValue& value : parse_swept_key(text).values) numbers.push_back(std::get<double>(value));
  return numbers;
}

Sweep sweep_of(const Strings& texts, const Case& base = {}) {
  std::vector<SweptKey> keys;
  for (const auto& text : texts) keys.push_back(parse_swept_key(text));
  return make_sweep(base, keys);
}

std::string complaint(const Strings& texts, const Case& base = {}) {
  try {
    sweep_of(texts, base);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

/// 60 cases with the spacings 1 … 60.
Sweep sixty() { return sweep_of({"spacing=1:60:60"}); }

Json spacing_of(const Case& input, const Request&) { return {{"length", input.required_number("spacing")}}; }

/// Fails where the spacing is a multiple of 7.
Json fails_at_sevens(const Case& input, const Request& request) {
  const int spacing = static_cast<int>(input.required_number("spacing"));
  if (spacing % 7 == 0) throw InvalidInput("spacing: " + std::to_string(spacing) + " has a seven in it");
  return spacing_of(input, request);
}

/// The table of a single case that has that answer.
Json table_of(const Json& answer, const Strings& columns) {
  const Sweep one = sweep_of({"spacing=3"});
  const Question question{[&](const Case&, const Request&) { return answer; }, columns};
  return table_rows(one, question, run_sweep(one, question));
}

}  // namespace

TEST_CASE("the first key of a sweep runs slowest, the last one fastest", "[fast]") {
  const Sweep sweep = sweep_of({"kernel=gaussian,wendland-c2", "spacing=1,2,3", "steps=10,20"});
  REQUIRE(sweep_size(sweep) == 12);
  const std::vector<std::tuple<std::string, double, double>> by_hand{
      {"gaussian", 1, 10},    {"gaussian", 1, 20},    {"gaussian", 2, 10},    {"gaussian", 2, 20},
      {"gaussian", 3, 10},    {"gaussian", 3, 20},    {"wendland-c2", 1, 10}, {"wendland-c2", 1, 20},
      {"wendland-c2", 2, 10}, {"wendland-c2", 2, 20}, {"wendland-c2", 3, 10}, {"wendland-c2", 3, 20}};
  for (int i = 0; i < 12; ++i) {
    const Case input = case_of(sweep, i);
    CHECK(std::tuple(input.required_word("kernel"), input.required_number("spacing"), input.required_number("steps")) ==
          by_hand[i]);
  }
}

TEST_CASE("the cases of a sweep keep the base and change nothing else", "[fast]") {
  Case base;
  base.set("density", 7.0);
  const Sweep sweep = sweep_of({"wave-vector=1,0;0.5,-2"}, base);
  REQUIRE(sweep_size(sweep) == 2);
  CHECK(case_of(sweep, 1).numbers("wave_vector") == std::vector<double>{0.5, -2.0});
  CHECK(case_of(sweep, 1).number("density") == 7.0);
  CHECK(!case_of(sweep, 1).has("spacing"));
  CHECK(sweep_size(make_sweep(base, {})) == 1);
}

TEST_CASE("low:high:count is count equally spaced numbers with both ends exact", "[fast]") {
  CHECK(numbers_of("h-over-spacing=1:2:5") == std::vector{1.0, 1.25, 1.5, 1.75, 2.0});
  CHECK(numbers_of("dimension=1:3:3") == std::vector{1.0, 2.0, 3.0});
  CHECK(numbers_of("spacing=1,1.3,2e-3") == std::vector{1.0, 1.3, 2e-3});
  for (const int count : {2, 3, 7, 49, 1000}) {
    const auto values = numbers_of("spacing=0.3:0.9:" + std::to_string(count));
    REQUIRE(values.size() == static_cast<std::size_t>(count));
    CHECK(values.front() == 0.3);
    CHECK(values.back() == 0.9);
    // A step is a difference of rounded numbers below 1: two halves of its last place, 2^-53 each, and those of lerp.
    constexpr double roundings = 4e-16;
    for (int i = 1; i < count; ++i) CHECK(std::abs(values[i] - values[i - 1] - 0.6 / (count - 1)) <= roundings);
  }
}

TEST_CASE("a sweep that cannot be meant is refused in one line that names the key", "[fast]") {
  CHECK(complaint({"spacing"}) == "sweep: 'spacing' is not KEY=VALUES");
  CHECK_THAT(complaint({"spacin=1,2"}), StartsWith("key: 'spacin' is not known; did you mean 'spacing'?"));
  CHECK(complaint({"spacing="}) == "spacing: '' is not a number");
  CHECK(complaint({"spacing=1,-2"}) == "spacing: -2 is not above 0");
  CHECK(complaint({"spacing=1,wide"}) == "spacing: 'wide' is not a number");
  CHECK(complaint({"spacing=0:1:3"}) == "spacing: 0 is not above 0");
  CHECK(complaint({"spacing=1:2"}) == "spacing: '1:2' is not low:high:count");
  CHECK(complaint({"spacing=1:2:3:4"}) == "spacing: '1:2:3:4' is not low:high:count");
  CHECK(complaint({"spacing=2:1:3"}) == "spacing: '2:1:3' does not go from a lower to a higher number");
  CHECK(complaint({"spacing=1:inf:3"}) == "spacing: '1:inf:3' does not go from a lower to a higher number");
  for (const std::string count : {"1", "0", "-3", "2.5", "10000001"})
    CHECK(complaint({"spacing=1:2:" + count}) ==
          "spacing: '1:2:" + count + "' has a count that is no whole number from 2 to 10000000");
  CHECK(complaint({"dimension=1:2:3"}) == "dimension: 1.5 is not a whole number");
  CHECK_THAT(complaint({"kernel=gaussian,wendland"}), StartsWith("kernel: 'wendland' is not known"));
  CHECK(complaint({"wave-vector=1,0;1,x"}) == "wave_vector: 'x' is not a number");
  CHECK(complaint({"spacing=1,2", "density=1", "spacing=3"}) == "spacing: is swept twice");
  CHECK(complaint({"spacing=1:2:1000000", "density=1:2:11"}) == "sweep: 1.1e+07 cases are more than 10000000");
  CHECK(complaint({"spacing=1:2:1000000", "density=1:2:10"}).empty());
  Case base;
  base.set("spacing", 1.0);
  CHECK(complaint({"spacing=1,2"}, base) == "spacing: is swept and given a value too");
}

TEST_CASE("a list of a case file is swept as it stands", "[fast]") {
  CHECK(swept_key("spacing", {1, 2.5}).values == std::vector<KeyValue>{1.0, 2.5});
  CHECK(swept_key("kernel", Json::array({"gaussian"})).values == std::vector<KeyValue>{std::string("gaussian")});
  CHECK(swept_key("mode", Json::array({{1, 2}})).values == std::vector<KeyValue>{std::vector{1.0, 2.0}});
  CHECK_THROWS_WITH(swept_key("spacing", 2.0), "spacing: 2.0 is no list of values to sweep");
  CHECK_THROWS_WITH(swept_key("spacing", {true}), "spacing: true is no number, word or list of numbers");
  CHECK_THROWS_WITH(swept_key("spacin", {1}), StartsWith("key: 'spacin' is not known"));
  CHECK_THROWS_WITH(make_sweep({}, {swept_key("spacing", Json::array())}), "spacing: has no values to sweep");
  CHECK_THROWS_WITH(make_sweep({}, {swept_key("spacing", {"wide"})}), "spacing: is not a number");
}

TEST_CASE("a column names a result from left to right", "[fast]") {
  const Json answer{{"step", 0.1},
                    {"bracket", {1, 2.5}},
                    {"mode", {{"branch", "shear"}, {"k", {3, 4}}}},
                    {"rules", Json::array({{{"name", "first"}, {"by", "A. B"}, {"factor", 5}},
                                           {{"name", "version 1.0"}, {"by", "C"}, {"factor", 6}}})},
                    {"nothing", nullptr}};
  for (const auto& [name, value] : std::vector<std::pair<std::string, Json>>{{"step", 0.1},
                                                                             {"bracket", {1, 2.5}},
                                                                             {"bracket.1", 2.5},
                                                                             {"mode.branch", "shear"},
                                                                             {"mode.k.0", 3},
                                                                             {"rules.first.factor", 5},
                                                                             {"rules.A. B.factor", 5},
                                                                             {"rules.version 1.0.factor", 6},
                                                                             {"rules.1.factor", 6},
                                                                             {"nothing", nullptr}})
    CHECK(table_of(answer, {name}) == Json::array({{{"spacing", 3.0}, {name, value}}}));
  for (const std::string name : {"steps", "ste", "step.0", "bracket.2", "mode.", "mode.k.0.0", "rules.B.factor", ""})
    CHECK_THROWS_WITH(table_of(answer, {"step", name}), StartsWith("columns: '" + name + "' is not known"));
  CHECK_THROWS_WITH(table_of(answer, {"rules.first.facto"}),
                    "columns: 'rules.first.facto' is not known; did you mean 'rules.first.factor'? Allowed: step, "
                    "bracket, mode.branch, mode.k, rules.first.name, rules.first.by, rules.first.factor, rules.version "
                    "1.0.name, rules.version 1.0.by, rules.version 1.0.factor, nothing");
}

TEST_CASE("without columns a row has every plain result of any row, null where its own answer has none", "[fast]") {
  const Sweep sweep = sweep_of({"spacing=1,2"});
  const Question question{[](const Case& input, const Request&) {
                            return input.number("spacing") == 1.0 ? Json{{"a", 1}, {"list", {1}}, {"mode", {{"b", 2}}}}
                                                                  : Json{{"word", "w"}, {"a", nullptr}};
                          },
                          {}};
  CHECK(table_rows(sweep, question, run_sweep(sweep, question)) ==
        Json::array(
            {{{"spacing", 1.0}, {"a", 1}, {"word", nullptr}}, {{"spacing", 2.0}, {"a", nullptr}, {"word", "w"}}}));
}

TEST_CASE("a swept key that is a result too has one column", "[fast]") {
  const Sweep sweep = sweep_of({"spacing=1,7"});
  const Question question{[](const Case& input, const Request& request) {
                            fails_at_sevens(input, request);
                            return Json{{"spacing", 1.0}, {"a", 2}};
                          },
                          {}};
  CHECK(table_rows(sweep, question, run_sweep(sweep, question)) ==
        Json::array({{{"spacing", 1.0}, {"a", 2}, {"error", nullptr}},
                     {{"spacing", 7.0}, {"a", nullptr}, {"error", "spacing: 7 has a seven in it"}}}));
}

TEST_CASE("only the results that are shown are asked for", "[fast]") {
  const Sweep sweep = sweep_of({"spacing=3"});
  const auto asked_for = [&](const Strings& columns) {
    Strings results;
    run_sweep(sweep, {[&](const Case&, const Request& request) {
                        results = request.results;
                        return Json::object();
                      },
                      columns});
    return results;
  };
  CHECK(asked_for({"mode.k.0", "step"}) == Strings{"mode", "step"});
  CHECK(asked_for({}).empty());
}

TEST_CASE("a case that fails has its error in its row and stops no other", "[fast]") {
  const Question question{fails_at_sevens, {"length"}};
  const SweepRows done = run_sweep(sixty(), question);
  CHECK(done.answered == 60);
  CHECK(done.errors() == 8);
  const Json table = table_rows(sixty(), question, done);
  for (int i = 1; i <= 60; ++i) {
    Json expected{{"spacing", 1.0 * i}, {"length", 1.0 * i}, {"error", nullptr}};
    if (i % 7 == 0) {
      expected["length"] = nullptr;
      expected["error"] = "spacing: " + std::to_string(i) + " has a seven in it";
    }
    CHECK(table[i - 1] == expected);
  }
}

TEST_CASE("a sweep in which every case fails has the error of the first", "[fast]") {
  const Sweep sevens = sweep_of({"spacing=14,7,21"});
  const Question question{fails_at_sevens, {"length"}};
  CHECK_THROWS_WITH(table_rows(sevens, question, run_sweep(sevens, question)), "spacing: 14 has a seven in it");
}

TEST_CASE("rows do not depend on the number of threads nor on which case ends first", "[fast]") {
  const Question question{[](const Case& input, const Request& request) {
                            const auto spacing = static_cast<int>(input.required_number("spacing"));
                            std::this_thread::sleep_for(std::chrono::microseconds(spacing * 7919 % 1000));
                            return fails_at_sevens(input, request);
                          },
                          {"length"}};
  const SweepRows alone = run_sweep(sixty(), question, {.threads = 1});
  REQUIRE(alone.complete());
  for (const int threads : {2, 3, 16, 100})
    CHECK(run_sweep(sixty(), question, {.threads = threads}).rows == alone.rows);
}

TEST_CASE("a stopped sweep goes on from the rows that it finished, and asks no case twice", "[fast]") {
  std::atomic<int> asked = 0;
  const Question question{[&](const Case& input, const Request& request) {
                            ++asked;
                            return fails_at_sevens(input, request);
                          },
                          {"length"}};
  const SweepRows whole = run_sweep(sixty(), question, {.threads = 1});
  for (const int threads : {1, 4}) {
    asked = 0;
    std::vector<Json> kept;
    const SweepRows first = run_sweep(sixty(), question,
                                      {.threads = threads,
                                       .finished = [&](const Json& row) { kept.push_back(row); },
                                       .stop = [&] { return asked >= 20; }});
    CHECK(!first.complete());
    CHECK(first.answered == static_cast<long>(kept.size()));
    // Those in flight when the twentieth was begun end too, except those whose errors may come from the interruption.
    CHECK(asked <= 20 + threads);
    CHECK(first.answered <= asked);
    CHECK(first.answered >= asked - threads);

    asked = 0;
    std::reverse(kept.begin(), kept.end());
    const SweepRows second = run_sweep(sixty(), question, {.threads = threads, .taken_over = kept});
    CHECK(second.complete());
    CHECK(second.taken_over == first.answered);
    CHECK(second.answered == 60 - first.answered);
    CHECK(asked == second.answered);
    CHECK(second.rows == whole.rows);
  }
}

TEST_CASE("an error while a sweep is stopped is not kept: what stops the sweep may be its cause", "[fast]") {
  bool stop = false;
  const Question question{[&](const Case&, const Request&) -> Json {
                            stop = true;
                            throw std::runtime_error("killed");
                          },
                          {}};
  const SweepRows done = run_sweep(sixty(), question, {.threads = 1, .stop = [&] { return stop; }});
  CHECK(done.answered == 0);
  CHECK(done.errors() == 0);
}

TEST_CASE("a row that cannot be kept ends the sweep", "[fast]") {
  std::atomic<int> asked = 0;
  const Question question{[&](const Case& input, const Request& request) {
                            ++asked;
                            return spacing_of(input, request);
                          },
                          {}};
  const auto full = [](const Json&) { throw InvalidInput("disk full"); };
  CHECK_THROWS_WITH(run_sweep(sixty(), question, {.threads = 2, .finished = full}), "disk full");
  CHECK(asked <= 3);
}

TEST_CASE("the progress of a sweep counts the rows taken over and ends at 1", "[fast]") {
  std::vector<double> shown;
  run_sweep(sweep_of({"spacing=1,2,3,4"}), {spacing_of, {}},
            {.threads = 1,
             .taken_over = {{{"case", 2}, {"results", {{"length", 3.0}}}}},
             .progress = [&](double fraction) { shown.push_back(fraction); }});
  CHECK(shown == std::vector{0.5, 0.75, 1.0});
}

TEST_CASE("a case that stands twice in a journal is one row", "[fast]") {
  const Json row{{"case", 1}, {"results", {{"length", 2.0}}}};
  const SweepRows done = run_sweep(sweep_of({"spacing=1,2,3"}), {spacing_of, {}}, {.taken_over = {row, row}});
  CHECK(done.taken_over == 1);
  CHECK(done.answered == 2);
}
