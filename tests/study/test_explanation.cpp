// SPDX-License-Identifier: MIT
#include "study/explanation.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "io/case_input.hpp"
#include "study/answers.hpp"

using namespace sphstab;
using Catch::Matchers::Contains;
using study::Json;

namespace {

Case case_of(Json keys) {
  Case input;
  keys.update({{"scheme", "tl-linear"}, {"young_modulus", 1.3}, {"poisson_ratio", 0.3}});
  io::set_from_json(input, keys);
  return input;
}

double limit(const Json& keys) {
  return study::time_step_answer(case_of(keys), {.results = {"critical_time_step"}})["critical_time_step"];
}

}  // namespace

TEST_CASE("the explanation of four neighbours has the numbers of Zhang's closed form", "[fast]") {
  // h = 0.6: the support 1.2 holds the four neighbours alone. W'(1) = σ/h · (−¾)(2 − 1/h)², σ = 10/(7πh²), so that
  // max |D| = 2√2 |W'(1)| = 0.49621 at (π/2, π/2), a wave of 2√2 = 2.828 spacings; c_p² = (γ + G)/ρ = 1.75.
  const auto lines = study::explain_time_step(case_of({{"h_over_spacing", 0.6}}));
  REQUIRE(lines.size() == 10);
  CHECK_THAT(lines[1], Contains("p-wave speed 1.3229, s-wave speed 0.70711"));
  CHECK_THAT(lines[2], Contains("4 on the square lattice, from 1 to 1 away"));
  CHECK_THAT(lines[3], Contains("|D| <= 0.496206 "));
  CHECK_THAT(lines[4], Contains("k = (1.5708, 1.5708), longitudinal, 2.828 spacings"));
  CHECK_THAT(lines[5], Contains("a1 ▇▄▁▄▇▄▁▄▇▄▁▄▇   a2 ▇▄▁▄▇"));
  CHECK_THAT(lines[7], Contains("leapfrog") && Contains("omega dt <= 2"));
  CHECK_THAT(lines[8], Contains("dt = 2 / omega"));
  // Every smoother kernel of this h hardly feels its neighbours: no advice.
  CHECK_THAT(lines[9], !Contains("wendland"));
}

TEST_CASE("the change that raises the limit most does so when it is made", "[fast]") {
  const auto lines = study::explain_time_step(case_of({{"h_over_spacing", 1.0}}));
  // Its first change is a kernel or an h; both gains are stated in whole percents.
  const Json plain{{"h_over_spacing", 1.0}}, longer{{"h_over_spacing", 1.25}};
  CHECK_THAT(lines.back(),
             Contains(fmt::format("h = 1.25 spacings {:+.0f} %", 100.0 * (limit(longer) / limit(plain) - 1.0))));
  double best = 0.0;
  std::string name;
  for (const auto& kernel : find_key("kernel").words)
    if (const double found = limit({{"h_over_spacing", 1.0}, {"kernel", kernel}}); found > best)
      best = found, name = kernel;
  CHECK_THAT(lines.back(), Contains(fmt::format("kernel {} {:+.0f} %", name, 100.0 * (best / limit(plain) - 1.0))));
}

TEST_CASE("the explanation covers one and three dimensions, damping, and states that no step saves", "[fast]") {
  const auto chain =
      study::explain_time_step(case_of({{"dimension", 1}, {"h_over_spacing", 0.9}, {"damping_rate", 0.5}}));
  REQUIRE(chain.size() == 10);
  CHECK_THAT(chain[2], Contains("2 on the chain lattice"));
  CHECK_THAT(chain[4], Contains("k = (1.5708), longitudinal, 4 spacings"));
  CHECK_THAT(chain[7], Contains("damping rate 0.5") && !Contains("= 2 "));
  // Beyond cΔt = 4 verlet multiplies every velocity by (1 − cΔt/2)² > 1.
  const auto overdamped = study::explain_time_step(case_of({{"integrator", "verlet"}, {"damping_rate", 30.0}}));
  CHECK_THAT(overdamped[7], Contains("rate x dt = 4"));
  CHECK_THAT(overdamped[8], Contains("dt = 4 / 30 = 0.13333333"));
  const auto cubic = study::explain_time_step(case_of({{"dimension", 3}, {"h_over_spacing", 0.6}}));
  REQUIRE(cubic.size() == 10);
  CHECK_THAT(cubic[5], Contains("a3 ▇▄▁▄"));
  const auto compressed = study::explain_time_step(
      case_of({{"density_in_momentum", "equation-of-state"}, {"displacement_gradient", {-0.4, 0.0, 0.0, -0.4}}}));
  CHECK_THAT(compressed.back(), Contains("no time step is stable"));
}

TEST_CASE("the explanation of ul leads to its limit, its weak growth or its instability", "[fast]") {
  const auto explain = [](const Json& more) {
    Json keys{{"scheme", "ul"}, {"sound_speed", 1.0}, {"shear_modulus", 0.3}, {"h_over_spacing", 1.0}};
    keys.update(more);
    Case input;
    io::set_from_json(input, keys);
    return study::explain_time_step(input);
  };
  // c_p² = 1 + 4/3 · 0.3, c_s² = 0.3.
  const auto neutral = explain({{"integrator", "leapfrog"}});
  REQUIRE(neutral.size() == 10);
  CHECK_THAT(neutral[0], Contains("ul: a wave r exp(ik.x)"));
  CHECK_THAT(neutral[1], Contains("p-wave speed 1.1832, s-wave speed 0.54772"));
  CHECK_THAT(neutral[3], Contains("State") && Contains("no stress"));
  CHECK_THAT(neutral[7], Contains("leapfrog") && Contains("omega dt <= 2"));
  CHECK_THAT(neutral[8], Contains("dt = 2 / omega"));

  const auto weak = explain(Json::object());
  REQUIRE(weak.size() == 10);
  CHECK_THAT(weak[7], Contains("predictor-corrector"));
  CHECK_THAT(weak[8], Contains("dt^4") && Contains("a factor e in 10000 steps"));
  // leapfrog's limit is offered as the way out: that of the line above.
  const auto step_in = [](const std::string& line, const std::string& before) {
    return std::stod(line.substr(line.find(before) + before.size()));
  };
  constexpr double printed_digits = 1e-4;
  CHECK_THAT(weak[9], Contains("leapfrog"));
  CHECK(step_in(weak[9], "dt = ") == Approx(step_in(neutral[8], "omega = ")).epsilon(printed_digits));

  const auto unstable = explain({{"pressure", -0.05}, {"artificial_stress_epsilon", 0.02}});
  CHECK_THAT(unstable[3], Contains("pressure -0.05") && Contains("epsilon = 0.02"));
  CHECK_THAT(unstable.back(), Contains("no time step is stable") && Contains("sphstab growth"));

  const auto viscous = explain({{"viscosity_alpha", 0.7}});
  REQUIRE(viscous.size() == 10);
  CHECK_THAT(viscous[7], Contains("viscosity alpha = 0.7") && Contains("the unit circle"));
}
