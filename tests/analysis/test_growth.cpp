// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/growth.hpp"
#include "analysis/updated_lagrangian.hpp"
#include "tests/analysis/golden.hpp"
#include "tests/analysis/problems.hpp"

using namespace sphstab;
using namespace sphstab::analysis;

TEST_CASE("growth over the whole zone agrees with the reference", "[fast]") {
  const auto references = golden::cases("growth", "ul");
  REQUIRE(references.size() == 11);
  for (const auto& reference : references) {
    INFO(reference["id"]);
    const auto found = growth_range(golden::updated_problem(reference));
    const auto& expect = reference["expect"];
    const double tolerance = reference["tolerance"];
    if (!expect.contains("growth_rate")) continue;
    CHECK(golden::difference(found.growth_rate, expect["growth_rate"]) < tolerance);
    CHECK(golden::difference(found.omega_squared_min, expect["omega_squared_min"]) < tolerance);
    CHECK(golden::difference(found.omega_squared_max, expect["omega_squared_max"]) < tolerance);
    UNSCOPED_INFO(found.growth_rate - expect["growth_rate"].get<double>());
  }
}
