// SPDX-License-Identifier: MIT
#include "study/bisection.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

using namespace sphstab;
using solver::GrowthFit;
using solver::Trend;

namespace {

/// A probe that answers with a known growth law, seen only if it is one e-folding in a third of the horizon.
study::GrowthProbe growth_law(const std::function<double(double time_step)>& growth) {
  return [growth](double time_step, long horizon) {
    const double smallest = 3.0 / static_cast<double>(horizon);
    const double rate = growth(time_step);
    return GrowthFit{rate < smallest ? Trend::bounded : Trend::growing, rate, smallest, 0.0, horizon};
  };
}

/// Two eigenvalues meet at −1, as for leapfrog beyond ωΔt = 2, ω = 3.
double square_root_law(double time_step) {
  return time_step < 2.0 / 3.0 ? 0.0 : 2.0 * std::acosh(3.0 * time_step / 2.0);
}

constexpr double tolerance = 1e-6;

}  // namespace

TEST_CASE("bisection finds the exit of a square-root law within its tolerance and run both ends", "[fast]") {
  for (const double start : {0.001, 0.1, 0.66, 0.7, 30.0}) {
    INFO("start " << start);
    const auto found = study::bisect(growth_law(square_root_law), {.start = start, .tolerance = tolerance});
    REQUIRE(found.critical_time_step);
    CHECK(found.low < found.high);
    CHECK(found.high - found.low <= tolerance * found.high);
    CHECK(*found.critical_time_step == Approx(2.0 / 3.0).epsilon(tolerance));
    CHECK(found.low <= 2.0 / 3.0 * (1 + tolerance));
    CHECK(found.high >= 2.0 / 3.0);
  }
}

TEST_CASE("the root of growth squared needs far fewer runs than halving", "[fast]") {
  const auto found = study::bisect(growth_law(square_root_law), {.start = 0.5, .tolerance = tolerance});
  // Scan from 0.5 in steps of 20 %: 2 runs; halving from 20 % to 1e-6 would take 18 more.
  CHECK(found.runs <= 12);
}

TEST_CASE("an eigenvalue that crosses the circle alone is found too, with as long a horizon as its growth needs",
          "[fast]") {
  // e^g solves (e^g − 1)(e^g − 1 + a) = 8δ, as for leapfrog with damping: linear near the limit, a square root beyond.
  for (const double damping : {1e-3, 1e-2, 0.3}) {
    INFO("damping " << damping);
    const study::GrowthProbe probe = [damping](double time_step, long horizon) {
      const double excess = std::max(0.0, 8.0 * (time_step - 1.0)), smallest = 3.0 / static_cast<double>(horizon);
      const double growth = std::log1p(2.0 * excess / (damping + std::sqrt(damping * damping + 4.0 * excess)));
      return GrowthFit{growth < smallest ? Trend::bounded : Trend::growing, growth, smallest, 0.0, horizon};
    };
    const auto found = study::bisect(probe, {.start = 0.3, .tolerance = tolerance});
    REQUIRE(found.critical_time_step);
    CHECK(found.high - found.low <= tolerance * found.high);
    CHECK(*found.critical_time_step == Approx(1.0).epsilon(tolerance));
    CHECK(found.horizon >= study::default_horizon(tolerance));
  }
}

TEST_CASE("an overdamped pair, like a square root very near its limit and linear soon after, is closed", "[fast]") {
  // verlet at cΔt = 4, where λ = 1 + μ with μ² = δ (4μ + z), z = ω²Δt².
  for (const double z : {1.78, 0.16, 0.018, 0.0044}) {
    INFO("z " << z);
    const auto found = study::bisect(growth_law([z](double time_step) {
                                       const double excess = std::max(0.0, time_step - 1.0);
                                       return std::log1p(2.0 * excess + std::sqrt(excess * (4.0 * excess + z)));
                                     }),
                                     {.start = 0.1, .tolerance = tolerance});
    REQUIRE(found.critical_time_step);
    CHECK(found.high - found.low <= tolerance * found.high);
    CHECK(found.low <= 1.0);
    CHECK(found.high >= 1.0);
    CHECK(*found.critical_time_step == Approx(1.0).epsilon(tolerance));
    // Scan: 14. Five runs find out that no law without bend holds; halving from 20 % alone would take 18 more.
    CHECK(found.runs <= 34);
  }
}

TEST_CASE("where growth is too slow for the longest run the bracket is as narrow as growth can be seen", "[fast]") {
  const auto found = study::bisect(growth_law([](double time_step) { return 0.01 * (time_step - 1.0); }),
                                   {.start = 0.2, .tolerance = tolerance});
  REQUIRE(found.critical_time_step);
  CHECK(found.low <= 1.0);
  CHECK(found.high >= 1.0);
  // Five e-foldings in 256 default horizons; the ends are this far above and twice as far below.
  const double visible = 5.0 / (256.0 * static_cast<double>(study::default_horizon(tolerance))) / 0.01;
  CHECK(found.high - found.low <= 4.0 * visible);
  CHECK(found.high - found.low >= 2.0 * visible);
}

TEST_CASE("an undecided run counts as growth only if longer ones do not decide", "[fast]") {
  // Just below the limit a slow beat rises for 20000 steps.
  const study::GrowthProbe beating = [](double time_step, long horizon) {
    auto fit = growth_law(square_root_law)(time_step, horizon);
    const bool rises = time_step > 2.0 / 3.0 * (1.0 - 1e-4) && time_step < 2.0 / 3.0 && horizon < 20000;
    if (rises) fit.trend = Trend::undecided;
    return fit;
  };
  const auto found = study::bisect(beating, {.start = 0.5, .tolerance = tolerance});
  REQUIRE(found.critical_time_step);
  CHECK(found.low <= 2.0 / 3.0);
  CHECK(found.high >= 2.0 / 3.0);
}

TEST_CASE("a law that is no square root is bracketed all the same", "[fast]") {
  const auto linear = [](double time_step) { return 40.0 * (time_step - 1.0); };
  const auto found = study::bisect(growth_law(linear), {.start = 0.3, .tolerance = 1e-3, .horizon = 1000000});
  REQUIRE(found.critical_time_step);
  CHECK(found.high - found.low <= 1e-3 * found.high);
  CHECK(found.low <= 1.0 + 1e-6);
  CHECK(found.high >= 1.0);
}

TEST_CASE("whatever the law of growth and the horizon, the bracket holds the root, or there is none", "[fast]") {
  struct Law {
    const char* name;
    double (*growth)(double time_step);
  };
  const Law laws[] = {{"linear, slow", [](double t) { return 0.1 * (t - 1.0); }},
                      {"linear, fast", [](double t) { return 10.0 * (t - 1.0); }},
                      {"quadratic", [](double t) { return t < 1.0 ? 0.0 : (t - 1.0) * (t - 1.0); }},
                      {"square root", [](double t) { return t < 1.0 ? 0.0 : 2.0 * std::acosh(t); }},
                      {"foot", [](double t) { return t < 1.0   ? 0.0
                                                     : t < 2.0 ? 0.002
                                                               : 1.0; }}};
  for (const auto& [name, growth] : laws)
    for (const double width : {1e-3, 1e-6})
      for (const std::optional<long> horizon :
           {std::optional<long>(), std::optional<long>(300), std::optional<long>(3000)}) {
        INFO(name << ", tolerance " << width << ", horizon " << horizon.value_or(0));
        const auto found = study::bisect(growth_law(growth), {.start = 0.2, .tolerance = width, .horizon = horizon});
        if (!found.critical_time_step) continue;
        CHECK(found.low <= *found.critical_time_step);
        CHECK(*found.critical_time_step <= found.high);
        // No run can tell a step at which growth is below what it can see; beyond that the bracket must hold the root.
        CHECK(growth(found.low) <= found.smallest_detectable);
        CHECK(growth(found.high) > 0.0);
      }
}

TEST_CASE("a horizon too short for the tolerance widens the bracket instead of losing the root", "[fast]") {
  // Linear growth of 0.1 (Δt − 1): 3000 steps see 1e-3, which it has at 1.01 only.
  const auto slow = [](double time_step) { return 0.1 * (time_step - 1.0); };
  const auto found = study::bisect(growth_law(slow), {.start = 0.2, .tolerance = tolerance, .horizon = 3000});
  REQUIRE(found.critical_time_step);
  CHECK(found.low <= 1.0);
  CHECK(found.high >= 1.0);
  // x = 2 sinh(g/2) of the fit is g to third order, and g is below 0.02 where it is fitted.
  CHECK(*found.critical_time_step == Approx(1.0).epsilon(1e-4));
}

TEST_CASE("a state that grows at every step has no critical step, however slowly it grows", "[fast]") {
  for (const double rate : {1e-3, 0.1, 3.0}) {
    INFO("rate " << rate);
    const study::GrowthProbe probe = [rate](double time_step, long horizon) {
      const double smallest = 3.0 / static_cast<double>(horizon), growth = rate * time_step;
      return GrowthFit{growth < smallest ? Trend::bounded : Trend::growing, growth, smallest, 0.0, horizon};
    };
    CHECK_FALSE(study::bisect(probe, {.start = 1.0, .tolerance = tolerance}).critical_time_step);
  }
}

TEST_CASE("progress of a search is a fraction, also before it has two ends", "[fast]") {
  CHECK(study::closed_fraction(0.0, 1.0, 1e-6) == 0.0);
  CHECK(study::closed_fraction(1.0, std::numeric_limits<double>::infinity(), 1e-6) == 0.0);
  CHECK(study::closed_fraction(1.0 - 1e-3, 1.0, 1e-6) == Approx(0.5));
  CHECK(study::closed_fraction(1.0, 1.0, 1e-6) == 1.0);
}

TEST_CASE("growth that the short scan overlooks is found by the full horizon", "[fast]") {
  // 0.005 a step between 0.5 and 1: 200 steps of the scan see 3/200 = 0.015 and more only.
  const auto foot = [](double time_step) { return time_step < 0.5 ? 0.0 : time_step < 1.0 ? 0.005 : 1.0; };
  const auto found = study::bisect(growth_law(foot), {.start = 0.1, .tolerance = 1e-4, .horizon = 3000});
  REQUIRE(found.critical_time_step);
  CHECK(*found.critical_time_step == Approx(0.5).epsilon(1e-4));
}

TEST_CASE("the first exit is reported where a second stable window follows", "[fast]") {
  const auto window = [](double time_step) {
    return time_step < 1.0 || (time_step > 2.0 && time_step < 3.0) ? 0.0 : 0.5;
  };
  const auto found = study::bisect(growth_law(window), {.start = 0.2, .tolerance = 1e-4});
  REQUIRE(found.critical_time_step);
  CHECK(*found.critical_time_step == Approx(1.0).epsilon(1e-4));
}

TEST_CASE("the scan reaches every limit that is a number, in few runs", "[fast]") {
  for (const double limit : {1e4, 1e6, 1e12, 1e24, 1e100, 1e300}) {
    INFO("limit " << limit);
    const auto growth = [limit](double time_step) {
      return time_step < limit ? 0.0 : 2.0 * std::acosh(std::min(time_step / limit, 10.0));
    };
    const auto found = study::bisect(growth_law(growth), {.start = 1.0, .tolerance = tolerance});
    REQUIRE(found.critical_time_step);
    CHECK(found.high - found.low <= tolerance * found.high);
    CHECK(*found.critical_time_step == Approx(limit).epsilon(tolerance));
    // 50 steps of 20 %; the n-th stride after them is (n + 1) steps long, the last is gone through once more; then what
    // any bracket of 20 % takes.
    const double steps = std::log(limit) / std::log(1.2), strides = std::sqrt(2.0 * std::max(0.0, steps - 50.0));
    CHECK(found.runs <= 50 + 2.0 * strides + 18);
  }
}

TEST_CASE("the first exit of a long stride is reported, not the one where the stride ends", "[fast]") {
  // In steps of 20 % from the start: bounded at 70, growing at 77, where the stride ends, and in a window before.
  const auto window = [](double time_step) {
    const double steps = std::log(time_step) / std::log(1.2);
    return steps < 71.5 || (steps > 72.5 && steps < 74.5) ? 0.0 : 0.5;
  };
  const auto found = study::bisect(growth_law(window), {.start = 1.0, .tolerance = 1e-4});
  REQUIRE(found.critical_time_step);
  CHECK(*found.critical_time_step == Approx(std::pow(1.2, 71.5)).epsilon(1e-4));
}

TEST_CASE("no critical step is made up where everything or nothing grows", "[fast]") {
  const auto always = study::bisect(growth_law([](double) { return 1.0; }), {.start = 1.0});
  CHECK_FALSE(always.critical_time_step);
  CHECK(always.low == 0.0);
  const auto never = study::bisect(growth_law([](double) { return 0.0; }), {.start = 1.0});
  CHECK_FALSE(never.critical_time_step);
  CHECK(std::isinf(never.high));
}

TEST_CASE("runs and steps are counted", "[fast]") {
  std::vector<long> horizons;
  const study::GrowthProbe counting = [&](double time_step, long horizon) {
    horizons.push_back(horizon);
    return growth_law(square_root_law)(time_step, horizon);
  };
  const auto found = study::bisect(counting, {.start = 0.5, .tolerance = tolerance});
  CHECK(found.runs == static_cast<int>(horizons.size()));
  long steps = 0;
  for (const long horizon : horizons) steps += horizon;
  CHECK(found.steps == steps);
  CHECK(found.horizon == horizons.back());
}
