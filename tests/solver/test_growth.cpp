// SPDX-License-Identifier: MIT
#include "solver/growth.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

using namespace sphstab::solver;

namespace {

GrowthFit judge(int steps, const std::function<double(double)>& amplitude) {
  std::vector<double> log_amplitude;
  for (int n = 0; n <= steps; ++n) log_amplitude.push_back(std::log(std::abs(amplitude(n))));
  return judge_growth(log_amplitude);
}

constexpr int steps = 3000;
/// The least-squares slope of an exact exponential is exact up to rounding of the logarithms, 1e-16 · steps / slope.
constexpr double fit_tolerance = 1e-10;

}  // namespace

TEST_CASE("exponential growth is measured exactly", "[fast]") {
  const auto fit = judge(steps, [](double n) { return 1e-8 * std::exp(0.002 * n); });
  CHECK(fit.trend == Trend::growing);
  CHECK(fit.growth_per_step == Approx(0.002).epsilon(fit_tolerance));
  CHECK(fit.steps == steps);
}

TEST_CASE("growth too slow for the run counts as bounded, and the smallest detectable growth says so", "[fast]") {
  const auto slow = [](double n) { return std::exp(5e-4 * n); };
  const auto short_run = judge(steps, slow);
  CHECK(short_run.trend == Trend::bounded);
  CHECK(short_run.smallest_detectable > 5e-4);
  CHECK(judge(4 * steps, slow).trend == Trend::growing);
}

TEST_CASE("linear drift of a defective mode is never growth, whatever it starts from", "[fast]") {
  for (const double start : {0.0, 1e-6, 1e-3, 1.0, 100.0, -700.3})
    for (const double rate : {1e-3, 1.0})
      CHECK(judge(steps, [=](double n) { return start + rate * (n + 0.5); }).trend != Trend::growing);
}

TEST_CASE("beating below the limit is no growth at any phase and period", "[fast]") {
  for (double angle = 1e-5; angle < 1.0; angle *= 1.7)
    for (double phase = 0.05; phase < 3.1; phase += 0.25) {
      INFO("angle " << angle << " phase " << phase);
      // The energy of a beat never vanishes: other modes and the velocity carry some.
      const auto fit = judge(steps, [=](double n) { return 1e-3 + std::abs(std::sin(angle * n + phase)); });
      CHECK(fit.trend != Trend::growing);
    }
}

TEST_CASE("growth that has only begun to show is undecided, not bounded", "[fast]") {
  const auto late = judge(steps, [](double n) { return 1.0 + 1e-9 * std::exp(0.01 * n); });
  CHECK(late.trend == Trend::undecided);
}
