// SPDX-License-Identifier: MIT
#include "study/gray_plate.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/critical_step.hpp"
#include "io/scene_input.hpp"

using namespace sphstab;
using namespace sphstab::study::gray;

namespace {

/// Numbers of the file are decimal, those of the code sums and quotients of decimals: a few roundings of 20.
constexpr double rounding = 1e-13;
/// A unit of the last digit in errata.md G16.
constexpr double printed_period = 0.1;
/// A linear elastic plate has one period; deflections of a hundredth of the height bend it at the second order.
constexpr double proportion = 1e-3;

void check_against_file(const Plate& plate, const std::string& name) {
  INFO(name);
  Case input;
  input.set("scene", std::string(SPHSTAB_SCENES_FOLDER "/") + name);
  const auto file = io::read_scene<2>(io::with_scene_keys(input));
  const auto scene = make_scene(plate_scene(plate));
  REQUIRE(scene.body.size() == file.body.size());
  for (int a = 0; a < scene.body.size(); ++a) {
    CHECK((scene.body.position[a] - file.body.position[a]).norm() < rounding);
    CHECK((scene.body.clamped[a] == file.body.clamped[a]).all());
    CHECK((scene.velocity[a] - file.velocity[a]).norm() < rounding);
  }
  CHECK(scene.probes[0].particle == file.probes[0].particle);
  const Scheme &ours = scene.problem.scheme, &theirs = file.problem.scheme;
  CHECK(ours.artificial_stress->epsilon == theirs.artificial_stress->epsilon);
  CHECK(ours.artificial_stress->exponent == theirs.artificial_stress->exponent);
  CHECK(ours.xsph->epsilon == theirs.xsph->epsilon);
  CHECK(ours.viscosity->alpha == theirs.viscosity->alpha);
  CHECK(ours.viscosity->eta == theirs.viscosity->eta);
  CHECK(scene.problem.integrator == file.problem.integrator);
  CHECK(scene.problem.kernel.smoothing_length() == Approx(file.problem.kernel.smoothing_length()).epsilon(rounding));
  CHECK(scene.problem.material.shear_modulus() == file.problem.material.shear_modulus());
}

}  // namespace

TEST_CASE("the plates of Gray et al. are those of the scene files", "[fast]") {
  check_against_file({}, "gray-plate.toml");
  check_against_file({.height = 1.0, .across = 10}, "gray-thin-plate.toml");
}

TEST_CASE("Eq. 7.1 of Gray et al. has the periods of their tables where H is the distance of the outer rows",
          "[fast]") {
  struct Printed {
    double height, shear_modulus, period;
  };
  for (const auto& row :
       {Printed{1.9, 0.22, 1525.0}, Printed{1.9, 0.30, 1342.2}, Printed{1.9, 0.60, 1030.3}, Printed{0.9, 0.22, 3219.5},
        Printed{0.9, 0.30, 2833.4}, Printed{0.9, 0.60, 2175.1}, Printed{2.0, 0.22, 1448.8}, Printed{1.0, 0.60, 1957.6}})
    CHECK(slender_period(row.height, row.shear_modulus) == Approx(row.period).margin(printed_period));
}

TEST_CASE("tension along x in plane strain: nothing along y, nu times it along z", "[fast]") {
  const auto problem = problem_in_tension({.shear_modulus = 0.3}, 0.02);
  const Tensor<2> stress = problem.deviatoric_stress - problem.pressure * Tensor<2>::Identity();
  CHECK(stress(0, 0) == Approx(0.02).epsilon(rounding));
  CHECK(std::abs(stress(1, 1)) < 0.02 * rounding);
  CHECK(stress(0, 1) == 0.0);
  const double out_of_plane = -problem.pressure - problem.deviatoric_stress.trace();
  CHECK(out_of_plane == Approx(problem.material.poisson_ratio() * 0.02).epsilon(rounding));
}

TEST_CASE("a coarse plate swings with one period whatever its deflection, loses what viscosity takes, and stays whole",
          "[ladder]") {
  const auto swing = [](double tip_velocity, double viscosity) {
    return oscillate({.across = 8, .tip_velocity = tip_velocity, .viscosity = viscosity, .courant_number = 0.8}, 1.7);
  };
  const auto small = swing(1e-4, 1.0), twice = swing(2e-4, 1.0), tough = swing(1e-4, 2.0);
  REQUIRE(small.period);
  REQUIRE(twice.period);
  CHECK(*twice.period == Approx(*small.period).epsilon(proportion));
  CHECK(!small.parting);
  CHECK(small.lost_particles == 0);
  CHECK(!small.failed);
  // Cut stencils and the soft clamp make it slower than a slender beam of its height, by a spacing or two in eight.
  CHECK(*small.period > slender_period(2.0, 0.22));
  CHECK(*small.period < slender_period(2.0 * (1.0 - 2.0 / 8.0), 0.22));
  REQUIRE(small.decay);
  REQUIRE(tough.decay);
  CHECK(*small.decay > 0.0);
  CHECK(*tough.decay > *small.decay);
  const auto [lowest, highest] = std::minmax_element(small.deflection.begin(), small.deflection.end());
  CHECK(*small.decay > 1.0 + *lowest / *highest);  // half a period later less is lost
  CHECK(*small.decay < 3.0 * (1.0 + *lowest / *highest));
}

TEST_CASE("without artificial stress a plate that swings far parts where it is clamped", "[ladder]") {
  const Plate plate{.across = 10, .shear_modulus = 0.6, .tip_velocity = 0.05, .epsilon = 0.0};
  const auto run = oscillate(plate, 1.0, 3);
  REQUIRE(run.parting);
  CHECK(!run.period);
  CHECK(run.parting->place[0] < 2.0);  // of 20
  CHECK(run.parting->tension > 0.0);
  // The tension rises with the deflection from nothing: its history has fewer e-foldings than its largest value would
  // have made all the time, more than that would have made in the last quarter.
  const auto limit = analysis::bulk_limit(problem_in_tension(plate, run.parting->tension));
  const double most = std::get<analysis::NeverStable<2>>(limit).growth_rate * run.parting->time;
  CHECK(run.parting->e_foldings < most);
  CHECK(run.parting->e_foldings > 0.25 * most);
  CHECK(run.images.size() == 3);
  CHECK(run.images[0].stress.size() == run.images[0].displacement.size());
}
