// SPDX-License-Identifier: MIT
#include "study/answers.hpp"

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include "io/case_input.hpp"
#include "tests/analysis/golden.hpp"

using namespace sphstab;
using study::Json;

namespace {

/// A few roundings of the results of functions that are exact but for rounding.
constexpr double rounding = 1e-12;

using Answer = Json (*)(const Case&, const study::Request&);

Case case_of(const Json& keys) {
  Case input;
  io::set_from_json(input, keys);
  return input;
}

Json dt(Json keys) {
  keys.update({{"scheme", "tl-linear"}, {"young_modulus", 2.9}, {"poisson_ratio", 0.31}, {"density", 1.7}});
  return study::time_step_answer(case_of(keys), {});
}

std::complex<double> complex(const Json& pair) { return {pair[0], pair[1]}; }

/// Π (x − λ) by multiplying it out, highest power first, as pairs [re, im].
Json characteristic_polynomial(const Json& eigenvalues) {
  std::vector<std::complex<double>> coefficients{1.0};
  for (const Json& eigenvalue : eigenvalues) {
    coefficients.push_back(0.0);
    for (std::size_t i = coefficients.size() - 1; i > 0; --i)
      coefficients[i] -= complex(eigenvalue) * coefficients[i - 1];
  }
  Json pairs = Json::array();
  for (const auto& c : coefficients) pairs.push_back({c.real(), c.imag()});
  return pairs;
}

/// Every number of `expected` is in `answer` at the same place; other keys of `answer` do not matter.
void check_equal(const Json& answer, const Json& expected, double tolerance) {
  INFO("answer " << answer << " expected " << expected);
  if (expected.is_number()) {
    REQUIRE(answer.is_number());
    CHECK(golden::difference(answer, expected) <= tolerance);
  } else if (expected.is_array()) {
    REQUIRE(answer.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) check_equal(answer[i], expected[i], tolerance);
  } else if (expected.is_object()) {
    for (const auto& [key, value] : expected.items()) {
      REQUIRE(answer.contains(key));
      check_equal(answer[key], value, tolerance);
    }
  } else {
    CHECK(answer == expected);
  }
}

void check_reference(const std::string& command, Answer answer_of, std::size_t lines) {
  const auto references = golden::cases(command);
  REQUIRE(references.size() == lines);
  for (const auto& reference : references) {
    INFO(reference["id"]);
    Json keys = Json::parse(reference.dump()), expect = keys["expect"];
    const double tolerance = keys["tolerance"];
    for (const char* no_key : {"id", "command", "expect", "tolerance"}) keys.erase(no_key);
    Json answer = answer_of(case_of(keys), {});
    if (answer.contains("eigenvalues"))
      answer["characteristic_polynomial"] = characteristic_polynomial(answer["eigenvalues"]);
    if (expect.contains("critical_time_step")) {
      const double ours = answer["critical_time_step"], theirs = expect["critical_time_step"];
      CHECK(std::abs(ours - theirs) <= tolerance * theirs);
      expect.erase("critical_time_step");
    }
    check_equal(answer, expect, tolerance);
  }
}

std::set<std::string> keys_of(const Json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

/// Equibiaxial compression beyond the stability of the continuous equation.
const Json squeezed{{"density_in_momentum", "equation-of-state"}, {"displacement_gradient", {-0.45, 0, 0, -0.45}}};

}  // namespace

TEST_CASE("reference kernels are answered from their keys", "[fast]") {
  check_reference("kernel", study::kernel_answer, 11);
}

TEST_CASE("reference lattice sums are answered from their keys", "[fast]") {
  check_reference("sums", study::sums_answer, 10);
}

TEST_CASE("reference amplification matrices are answered from their keys", "[fast]") {
  check_reference("matrix", study::matrix_answer, 17);
}

TEST_CASE("reference critical time steps are answered from their keys", "[fast]") {
  check_reference("dt", study::time_step_answer, 20);
}

TEST_CASE("dt has every key of the interface that applies to its verdict", "[fast]") {
  const std::set<std::string> always{"critical_time_step",
                                     "bracket",
                                     "verdict",
                                     "bulk_only",
                                     "note",
                                     "symbol_maximum",
                                     "neighbours",
                                     "zero_energy_modes",
                                     "zero_energy_modes_complete"};
  const auto expect_keys = [&always](const Json& answer, std::set<std::string> more) {
    more.insert(always.begin(), always.end());
    CHECK(keys_of(answer) == more);
    CHECK(answer["bulk_only"] == true);
  };
  const std::set<std::string> conditional{"bracket_kind", "critical_mode", "courant_number", "equivalents",
                                          "published_bound"};
  const Json plain = dt({});
  expect_keys(plain, conditional);
  CHECK(plain["verdict"] == "conditionally-stable");
  CHECK(plain["neighbours"] == 20);  // sites within 2.6 of a square lattice
  for (const Json& rule : plain["equivalents"])
    CHECK(keys_of(rule) == std::set<std::string>{"rule", "formula", "factor_at_limit", "default", "default_is_safe"});
  CHECK(keys_of(plain["critical_mode"]) == std::set<std::string>{"wave_vector", "branch", "omega"});
  CHECK(keys_of(plain["published_bound"]) == std::set<std::string>{"source", "value", "holds"});

  auto asked = conditional;
  asked.insert({"spectral_radius_at_time_step", "time_step_for_tolerance", "mode_limit"});
  expect_keys(dt({{"time_step", 0.1}, {"steps", 10}, {"wave_vector", {1, 0}}}), asked);
  auto on_hexagons = conditional;
  on_hexagons.erase("published_bound");  // Eq. 15 is for square lattices
  on_hexagons.insert("box_limit");
  expect_keys(dt({{"lattice", "hexagonal"}, {"box", {4, 4}}}), on_hexagons);

  expect_keys(dt(squeezed), {"growth_rate", "critical_mode", "published_bound"});
  CHECK(dt(squeezed)["verdict"] == "never-stable");
  CHECK(dt(squeezed)["critical_time_step"].is_null());
  CHECK(dt(squeezed)["published_bound"]["holds"] == false);
}

TEST_CASE("Courant number and equivalents are the critical step in their units", "[fast]") {
  const Json answer = dt({{"spacing", 0.37}, {"smoothing_length", 0.5}});
  const double step = answer["critical_time_step"], E = 2.9, nu = 0.31, rho = 1.7;
  const double p_wave_speed = std::sqrt(E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / rho);
  const double bulk_speed = std::sqrt(E / (3 * (1 - 2 * nu)) / rho);
  CHECK(answer["courant_number"].get<double>() == Approx(step * p_wave_speed / 0.37).epsilon(rounding));
  // K + 4G/3 is the p-wave modulus of plane strain, E/(2(1−2ν)) is 3K/2.
  const double expected[] = {step * bulk_speed / 0.5, step * bulk_speed * std::sqrt(1.5) / 0.5,
                             step * p_wave_speed / 0.5, step * p_wave_speed / 0.5};
  REQUIRE(answer["equivalents"].size() == 4);
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(answer["equivalents"][i]["factor_at_limit"].get<double>() == Approx(expected[i]).epsilon(rounding));
}

TEST_CASE("at the tolerable step the spectral radius is one plus the tolerated growth", "[fast]") {
  // Where two eigenvalues meet the radius is 1 + √(8δ) at a step that is δ above the limit, relatively: it answers to
  // roundings of the step 4/growth times.
  constexpr double step_rounding = 2e-15;
  for (const char* integrator : {"leapfrog", "verlet"})
    for (const double damping_rate : {0.0, 0.3})
      for (const bool unstable : {false, true})
        for (const double growth : {1e-4, 0.1}) {
          INFO(integrator << " damping " << damping_rate << " growth " << growth << " unstable " << unstable);
          Json keys{{"integrator", integrator}, {"damping_rate", damping_rate}, {"tolerated_growth_per_step", growth}};
          if (unstable) keys.update(squeezed);
          const Json tolerant = dt(keys);
          const double step = tolerant["time_step_for_tolerance"];
          if (!unstable) CHECK(step > tolerant["critical_time_step"].get<double>());
          keys["time_step"] = step;
          CHECK(dt(keys)["spectral_radius_at_time_step"].get<double>() ==
                Approx(1.0 + growth).epsilon(4.0 * step_rounding / growth));
        }
}

TEST_CASE("so many tolerated steps are a growth by a factor e over them", "[fast]") {
  constexpr double steps = 250;
  Json keys{{"steps", steps}};
  keys["time_step"] = dt(keys)["time_step_for_tolerance"];
  CHECK(std::pow(dt(keys)["spectral_radius_at_time_step"].get<double>(), steps) ==
        Approx(std::numbers::e).epsilon(steps * rounding));  // the power multiplies relative errors
}

TEST_CASE("the spectral radius is one at the critical step, and more above", "[fast]") {
  const double critical = dt({})["critical_time_step"];
  CHECK(dt({{"time_step", 0.999 * critical}})["spectral_radius_at_time_step"] == 1.0);
  CHECK(dt({{"time_step", 1.001 * critical}})["spectral_radius_at_time_step"] > 1.001);
}

TEST_CASE("a mode of a box is Zhang's wave vector", "[fast]") {
  const Json answer = study::matrix_answer(case_of({{"scheme", "tl-linear"},
                                                    {"young_modulus", 1},
                                                    {"poisson_ratio", 0.3},
                                                    {"spacing", 0.5},
                                                    {"mode", {3, 1}},
                                                    {"box", {20, 10}},
                                                    {"time_step", 0.1}}),
                                           {});
  CHECK(answer["wave_vector"][0].get<double>() == Approx(3 * std::numbers::pi / 10).epsilon(rounding));
  CHECK(answer["wave_vector"][1].get<double>() == Approx(std::numbers::pi / 5).epsilon(rounding));
}

TEST_CASE("the limit of a mode is two over its frequency and that of a box the least of its modes", "[fast]") {
  constexpr int M = 5, L = 3;
  double least = std::numeric_limits<double>::infinity();
  for (int m = 1; m <= M; ++m)
    for (int l = 1; l <= L; ++l) {
      const Json limit = dt({{"mode", {m, l}}, {"box", {M, L}}, {"spacing", 0.4}})["mode_limit"];
      if (limit["verdict"] == "unconditionally-stable") continue;  // (M, L) itself
      CHECK(limit["critical_time_step"].get<double>() ==
            Approx(2.0 / limit["critical_mode"]["omega"].get<double>()).epsilon(rounding));
      least = std::min(least, limit["critical_time_step"].get<double>());
    }
  const Json answer = dt({{"box", {M, L}}, {"spacing", 0.4}});
  CHECK(answer["box_limit"]["critical_time_step"] == least);
  CHECK(least > answer["critical_time_step"].get<double>());
}

TEST_CASE("four neighbours have the limit of theory and of the box that holds its mode", "[fast]") {
  // k = (π/2, π/2) / spacing is mode (1, 1) of the 2×2 box, where |D| is largest: Δt² = ρ / (2 (γ + G) (V W')²) with
  // Zhang's γ and G.
  const Json keys{{"neighbours", "nearest"}, {"kernel", "gaussian"}, {"gaussian_cutoff", 7}, {"smoothing_length", 0.7}};
  const double E = 2.9, nu = 0.31, rho = 1.7, G = E / (1 + nu), gamma = nu * G / (1 - 2 * nu);
  const double slope = 2.0 / 0.49 * std::exp(-1.0 / 0.49) / (std::numbers::pi * 0.49);
  Json boxed = keys;
  boxed["box"] = {2, 2};
  const Json answer = dt(boxed);
  CHECK(answer["critical_time_step"].get<double>() ==
        Approx(std::sqrt(rho / (2.0 * (gamma + G))) / slope).epsilon(rounding));
  CHECK(answer["box_limit"]["critical_time_step"].get<double>() ==
        Approx(answer["critical_time_step"].get<double>()).epsilon(rounding));
}

TEST_CASE("the answer of a bisection has every key of the interface", "[fast]") {
  const Json answer = study::bisection_answer(case_of({{"scheme", "tl-linear"},
                                                       {"young_modulus", 1},
                                                       {"poisson_ratio", 0.3},
                                                       {"patch", {3, 4}},
                                                       {"tolerance", 1e-3}}),
                                              {});
  CHECK(keys_of(answer) == std::set<std::string>{"patch", "critical_time_step", "bracket", "theory",
                                                 "relative_difference", "tolerance", "agrees", "bulk_theory",
                                                 "patch_deficit", "horizon", "runs", "steps",
                                                 "smallest_detectable_growth"});
  const double found = answer["critical_time_step"], theory = answer["theory"], bulk = answer["bulk_theory"];
  CHECK(answer["relative_difference"].get<double>() == Approx(std::abs(found - theory) / theory));
  CHECK(answer["patch_deficit"].get<double>() == Approx(theory / bulk - 1.0));
  CHECK(answer["agrees"] == true);
}

namespace {

Json updated_dt(const Json& more = {}) {
  Json keys{{"scheme", "ul"}, {"sound_speed", 1.0}, {"shear_modulus", 0.3}, {"h_over_spacing", 1.0}};
  if (!more.is_null()) keys.update(more);
  return study::time_step_answer(case_of(keys), {});
}

}  // namespace

TEST_CASE("dt of ul has every key of the interface that applies to its verdict", "[fast]") {
  const std::set<std::string> always{"critical_time_step",
                                     "bracket",
                                     "verdict",
                                     "bulk_only",
                                     "note",
                                     "neighbours",
                                     "stressed",
                                     "zero_energy_modes",
                                     "zero_energy_modes_complete"};
  const auto expect_keys = [&always](const Json& answer, const char* verdict, std::set<std::string> more) {
    more.insert(always.begin(), always.end());
    CHECK(keys_of(answer) == more);
    CHECK(answer["verdict"] == verdict);
  };
  const Json leapfrog{{"integrator", "leapfrog"}};
  const std::set<std::string> conditional{"bracket_kind", "critical_mode", "courant_number", "equivalents"};
  expect_keys(updated_dt(leapfrog), "conditionally-stable", conditional);
  CHECK(updated_dt(leapfrog)["bracket_kind"] == "certified");
  const Json viscous{{"viscosity_alpha", 0.5}};
  expect_keys(updated_dt(viscous), "conditionally-stable", conditional);
  CHECK(updated_dt(viscous)["bracket_kind"] == "searched");
  expect_keys(updated_dt(), "weakly-unstable", {"critical_mode", "growth_law"});
  CHECK(keys_of(updated_dt()["growth_law"]) == std::set<std::string>{"coefficient", "exponent"});
  expect_keys(updated_dt({{"time_step", 0.2}, {"steps", 1000}, {"wave_vector", {1, 0}}}), "weakly-unstable",
              {"critical_mode", "growth_law", "spectral_radius_at_time_step", "growth_per_step_at_time_step",
               "time_step_for_tolerance", "mode_limit"});
  expect_keys(updated_dt({{"pressure", -0.05}, {"box", {4, 4}}}), "never-stable",
              {"growth_rate", "critical_mode", "box_limit"});
  CHECK(updated_dt({{"pressure", -0.05}})["stressed"] == true);
  CHECK(updated_dt()["stressed"] == false);
}

TEST_CASE("leapfrog without stress has the limit of the same symbol in the linear scheme", "[fast]") {
  // At zero stress M is that of tl-linear: c0² A Aᵀ + (μ/ρ)(|A|² I + A Aᵀ/3), with K = ρ c0².
  const Json linear = study::time_step_answer(
      case_of({{"scheme", "tl-linear"}, {"bulk_modulus", 1.0}, {"shear_modulus", 0.3}, {"h_over_spacing", 1.0}}), {});
  constexpr double search = 1e-10;  // both maxima are polished until values are right to rounding
  for (const char* integrator : {"leapfrog", "verlet"}) {
    const Json updated = updated_dt({{"integrator", integrator}});
    for (const char* key : {"critical_time_step", "courant_number"})
      CHECK(updated[key].get<double>() == Approx(linear[key].get<double>()).epsilon(search));
    CHECK(updated["zero_energy_modes"] == linear["zero_energy_modes"]);
  }
}

TEST_CASE("the predictor-corrector grows by the law that dt states", "[fast]") {
  // |λ|² = 1 + (ωΔt)⁴/4 at zero stress (theory.md §4): (ωΔt)⁴/8 a step, so that 1e-4 a step is 1 per 10⁴.
  const Json answer = updated_dt({{"time_step", 0.05}});
  const double omega = answer["critical_mode"]["omega"];
  CHECK(answer["growth_law"]["exponent"] == 4);
  constexpr double search = 1e-9;
  CHECK(answer["growth_law"]["coefficient"].get<double>() == Approx(std::pow(omega, 4) / 8.0).epsilon(search));
  const double z = std::pow(omega * 0.05, 2);
  CHECK(answer["spectral_radius_at_time_step"].get<double>() == Approx(std::sqrt(1.0 + z * z / 4.0)).epsilon(rounding));
  CHECK(answer["growth_per_step_at_time_step"].get<double>() ==
        answer["spectral_radius_at_time_step"].get<double>() - 1.0);
  // The tolerated growth is met at the step that is named for it.
  const Json tolerant = updated_dt({{"tolerated_growth_per_step", 1e-3}});
  const double step = tolerant["time_step_for_tolerance"];
  CHECK(std::sqrt(1.0 + std::pow(omega * step, 4) / 4.0) == Approx(1.001).epsilon(1e-9));
}

TEST_CASE("the limit of a mode of ul is two over its frequency, that of a box the least of its modes", "[fast]") {
  constexpr int M = 3, L = 2;
  const Json neutral{{"integrator", "leapfrog"}, {"xsph", 0.5}};
  double least = std::numeric_limits<double>::infinity();
  for (int m = 1; m <= M; ++m)
    for (int l = 1; l <= L; ++l) {
      Json keys = neutral;
      keys.update({{"mode", {m, l}}, {"box", {M, L}}});
      const Json limit = updated_dt(keys)["mode_limit"];
      if (limit["verdict"] == "unconditionally-stable") continue;  // (M, L) itself
      CHECK(limit["critical_time_step"].get<double>() ==
            Approx(2.0 / limit["critical_mode"]["omega"].get<double>()).epsilon(1e-9));
      least = std::min(least, limit["critical_time_step"].get<double>());
    }
  Json keys = neutral;
  keys["box"] = {M, L};
  CHECK(updated_dt(keys)["box_limit"]["critical_time_step"].get<double>() == Approx(least).epsilon(rounding));
}
