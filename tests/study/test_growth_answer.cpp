// SPDX-License-Identifier: MIT
#include "study/growth_answer.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "io/case_input.hpp"
#include "study/answers.hpp"
#include "study/dispersion.hpp"

using namespace sphstab;
using Catch::Matchers::Contains;
using study::Json;

namespace {

/// A few roundings of numbers of order one.
constexpr double rounding = 1e-12;

Case case_of(Json keys) {
  keys.update({{"scheme", "ul"}, {"sound_speed", 1.0}, {"shear_modulus", 0.3}, {"density", 1.0}});
  Case input;
  io::set_from_json(input, keys);
  return input;
}

Json with(Json keys, const Json& more) {
  keys.update(more);
  return keys;
}

Json growth(const Json& keys) { return study::growth_answer(case_of(keys), {}); }

double number(const Json& value) { return value; }

std::set<std::string> keys_of(const Json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

const Json square_in_tension{{"h_over_spacing", 1.0}, {"pressure", -0.05}};
const Json hexagonal_in_tension{{"lattice", "hexagonal"}, {"h_over_spacing", 1.0}, {"pressure", -0.05}};

/// σ_xx = 0.1, σ_yy = 0: P = −0.05 and S = (0.05, −0.05, 0).
const Json uniaxial{{"pressure", -0.05}, {"deviatoric_stress", {0.05, -0.05, 0.0}}, {"artificial_stress_epsilon", 0.3}};

}  // namespace

TEST_CASE("growth has every key of the interface, and those of ul only for ul", "[fast]") {
  const std::set<std::string> always{"verdict",       "growth_rate",       "e_folding_time",   "doubling_time",
                                     "critical_mode", "omega_squared_min", "omega_squared_max"};
  auto updated = always;
  updated.insert({"artificial_stress_epsilon", "tension_modulus_factor", "growth_rate_without_artificial_stress",
                  "stabilising_epsilon", "smallest_stabilising_epsilon", "smallest_tension_modulus_factor"});
  CHECK(keys_of(growth(square_in_tension)) == updated);
  updated.insert("one_sided");
  const Json sides = growth(uniaxial);
  CHECK(keys_of(sides) == updated);
  for (const char* side : {"compression", "tension"})
    CHECK(keys_of(sides["one_sided"][side]) ==
          std::set<std::string>{"growth_rate", "omega_squared_min", "omega_squared_max"});
  Case linear;
  io::set_from_json(linear, {{"scheme", "tl-linear"}, {"young_modulus", 1.0}, {"poisson_ratio", 0.3}});
  CHECK(keys_of(study::growth_answer(linear, {})) == always);
}

TEST_CASE("a rate is told as the times to grow by e and by two, or not at all", "[fast]") {
  const Json unstable = growth(square_in_tension);
  CHECK(unstable["verdict"] == "unstable");
  const double rate = unstable["growth_rate"];
  CHECK(rate * number(unstable["e_folding_time"]) == Approx(1.0).epsilon(rounding));
  CHECK(std::exp(rate * number(unstable["doubling_time"])) == Approx(2.0).epsilon(rounding));
  // A real mode: ω² = −rate².
  CHECK(number(unstable["omega_squared_min"]) == Approx(-rate * rate).epsilon(rounding));
  CHECK(number(unstable["critical_mode"]["omega"]) == rate);
  const Json stable = growth({});
  CHECK(stable["verdict"] == "stable");
  CHECK(stable["growth_rate"] == 0.0);
  CHECK(stable["e_folding_time"].is_null());
  CHECK(stable["doubling_time"].is_null());
}

TEST_CASE("the smallest stabilising epsilon and its price are those of theory", "[fast]") {
  // Isotropic tension on hexagons, h = Δp: the point M needs ε ≥ 0.132; no ε cures squares (theory.md §9).
  const Json hexagons = growth(hexagonal_in_tension);
  REQUIRE(hexagons["stabilising_epsilon"].size() == 1);
  const double smallest = hexagons["smallest_stabilising_epsilon"];
  CHECK(std::abs(smallest - 0.132) < 5e-4);  // as printed
  CHECK(hexagons["stabilising_epsilon"][0][0] == smallest);
  CHECK(hexagons["growth_rate"] == hexagons["growth_rate_without_artificial_stress"]);
  CHECK(hexagons["tension_modulus_factor"] == 1.0);
  // 1 − ε a_n: a_n is the same whatever ε the case has.
  const Json cured = growth(with(hexagonal_in_tension, {{"artificial_stress_epsilon", 0.3}}));
  CHECK(cured["verdict"] == "stable");
  CHECK((1.0 - number(cured["tension_modulus_factor"])) / 0.3 ==
        Approx((1.0 - number(hexagons["smallest_tension_modulus_factor"])) / smallest).epsilon(rounding));
  CHECK(cured["growth_rate_without_artificial_stress"] == hexagons["growth_rate"]);
  CHECK(cured["stabilising_epsilon"] == hexagons["stabilising_epsilon"]);

  const Json squares = growth(square_in_tension);
  CHECK(squares["stabilising_epsilon"].empty());
  CHECK(squares["smallest_stabilising_epsilon"].is_null());
  CHECK(squares["smallest_tension_modulus_factor"].is_null());
}

TEST_CASE("which epsilon stabilises depends on the exponent of the case, with and without artificial stress",
          "[fast]") {
  const Json steeper = with(hexagonal_in_tension, {{"artificial_stress_exponent", 2.0}});
  const Json found = growth(steeper)["stabilising_epsilon"];
  CHECK(found == growth(with(steeper, {{"artificial_stress_epsilon", 0.7}}))["stabilising_epsilon"]);
  CHECK(found != growth(hexagonal_in_tension)["stabilising_epsilon"]);
}

TEST_CASE("beside a principal stress of zero there are two states, one of them that of the key", "[fast]") {
  const Json answer = growth(uniaxial), &sides = answer["one_sided"];
  CHECK(sides["compression"] != sides["tension"]);
  for (const std::string side : {"compression", "tension"}) {
    const Json chosen = growth(with(uniaxial, {{"artificial_stress_zero_side", side}}));
    for (const auto& [key, value] : sides[side].items()) CHECK(chosen[key] == value);
  }
  // A stress a little to either side: the range of ω² moves by as much as the stress times a number of order one.
  constexpr double little = 1e-9, moved = 100.0 * little;
  for (const auto& [side, sign] : {std::pair("tension", 1.0), std::pair("compression", -1.0)}) {
    const Json beside = growth(with(uniaxial, {{"deviatoric_stress", {0.05, -0.05 + sign * little, 0.0}}}));
    CHECK_FALSE(beside.contains("one_sided"));
    CHECK(number(beside["omega_squared_max"]) == Approx(number(sides[side]["omega_squared_max"])).margin(moved));
  }
  CHECK_FALSE(growth(with(uniaxial, {{"artificial_stress_linearisation", "frozen"}})).contains("one_sided"));
}

TEST_CASE("what a table does not ask for is not worked out", "[fast]") {
  const auto asked = [](std::vector<std::string> results) {
    return keys_of(study::growth_answer(case_of(uniaxial), {.results = std::move(results)}));
  };
  for (const char* costly : {"stabilising_epsilon", "one_sided", "growth_rate_without_artificial_stress"}) {
    CHECK(asked({"growth_rate"}).count(costly) == 0);
    CHECK(asked({costly}).count(costly) == 1);
  }
  CHECK(asked({"smallest_tension_modulus_factor"}).count("smallest_tension_modulus_factor") == 1);
}

TEST_CASE("growth of a squeezed tl-linear lattice is that of dt, damping left out", "[fast]") {
  Case input;
  io::set_from_json(input, {{"scheme", "tl-linear"},
                            {"young_modulus", 1.3},
                            {"poisson_ratio", 0.3},
                            {"density_in_momentum", "equation-of-state"},
                            {"displacement_gradient", {-0.45, 0, 0, -0.45}}});
  const double rate = study::growth_answer(input, {})["growth_rate"];
  CHECK(rate == Approx(number(study::time_step_answer(input, {})["growth_rate"])).epsilon(rounding));
  input.set("damping_rate", 0.3);
  CHECK(study::growth_answer(input, {})["growth_rate"] == rate);
}

TEST_CASE("the map shows the growth of dispersion over a zone with its boundary", "[fast]") {
  const Json keys = with(hexagonal_in_tension, {{"spacing", 0.5}});
  const auto figure = std::get<io::MapFigure>(study::growth_figure(case_of(keys)));
  const double rate = growth(keys)["growth_rate"], unit = std::acos(-1.0) / 0.5;
  REQUIRE(figure.values.size() == figure.x.size() * figure.y.size());
  double highest = 0.0;
  std::size_t blank = 0;
  for (const double value : figure.values) {
    blank += std::isnan(value);
    highest = std::fmax(highest, value);
  }
  CHECK(blank > figure.values.size() / 10);
  CHECK(highest <= rate * (1.0 + rounding));
  CHECK(highest > 0.99 * rate);
  for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 3}, {57, 190}, {100, 100}, {199, 20}}) {
    const Json at = with(keys, {{"wave_vector", {unit * figure.x[i], unit * figure.y[j]}}});
    const double expected = study::dispersion_answer(case_of(at), {})["points"][0]["growth_rate"];
    const double shown = figure.values[i + j * figure.x.size()];
    CHECK((std::isnan(shown) ? 0.0 : shown) == Approx(expected).epsilon(rounding));
  }
  // The zone of hexagons: six corners K, 4/3 from Γ in π/Δp, closed.
  REQUIRE(figure.outlines.size() == 1);
  const auto& boundary = figure.outlines[0].points;
  REQUIRE(boundary.size() == 7);
  for (const auto& [x, y] : boundary) CHECK(std::hypot(x, y) == Approx(4.0 / 3.0).epsilon(rounding));
  for (std::size_t i = 1; i < 7; ++i)
    CHECK(std::hypot(boundary[i].first - boundary[i - 1].first, boundary[i].second - boundary[i - 1].second) ==
          Approx(4.0 / 3.0).epsilon(rounding));
  CHECK_THAT(figure.title, Contains("hexagonal") && Contains("P = -0.05"));
  // Viscosity does not count.
  CHECK(std::get<io::MapFigure>(study::growth_figure(case_of(with(keys, {{"viscosity_alpha", 1.0}}))))
            .values[57 + 190 * 201] == figure.values[57 + 190 * 201]);
}

TEST_CASE("growth in one dimension is a curve over half the zone", "[fast]") {
  const Json keys{{"dimension", 1}, {"pressure", -0.05}, {"h_over_spacing", 1.0}, {"spacing", 0.5}};
  const auto figure = std::get<io::LineFigure>(study::growth_figure(case_of(keys)));
  const auto& points = figure.curves.at(0).points;
  CHECK(points.front() == std::pair(0.0, 0.0));
  CHECK(points.back().first == Approx(1.0).epsilon(rounding));
  // At k = π/Δp ω² = −(2σ/ρ) B with B = 4 Δp W''(Δp) (theory.md §7); W'' = (2/3h³)(3/2) at q = 1; ρ = 1 + P.
  const double spacing = 0.5, curvature = 1.0 / std::pow(spacing, 3);
  CHECK(points.back().second == Approx(std::sqrt(2.0 * 0.05 / 0.95 * 4.0 * spacing * curvature)).epsilon(rounding));
  CHECK_THROWS_WITH(study::growth_figure(case_of({{"dimension", 3}})),
                    Catch::StartsWith("figure: growth is drawn over zones of one and two dimensions, not 3"));
}

TEST_CASE("without a weight at the spacing there is growth, and no epsilon to ask for", "[fast]") {
  // Neighbours at half the spacing, the support between the two.
  const Json answer = growth({{"lattice", "custom"},
                              {"primitive_vectors", {0.5, 0.0, 0.0, 0.5}},
                              {"h_over_spacing", 0.45},
                              {"pressure", -0.02}});
  CHECK(answer["growth_rate"].get<double>() > 0.0);
  CHECK_FALSE(answer.contains("stabilising_epsilon"));
}
