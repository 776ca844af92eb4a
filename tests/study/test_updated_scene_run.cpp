// SPDX-License-Identifier: MIT
// Runs of scenes with `ul`: what the driver adds to the solver, and the identities that the scheme keeps on bodies.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "model/uniform.hpp"
#include "solver/updated_simulation.hpp"
#include "study/scene_run.hpp"

using namespace sphstab;
using namespace sphstab::study;

namespace {

constexpr double dp = 0.8, c0 = 1.2, time_step = 0.05;
/// 200 steps with an error of 2.2e-16 each, of sums of some tens of particles.
constexpr double rounding = 1e-13;
/// Observed orders differ from the integer by the next term of the error.
constexpr double order_margin = 0.1;

constexpr std::array integrators{Integrator::leapfrog, Integrator::verlet, Integrator::predictor_corrector,
                                 Integrator::predictor_corrector_pec};

Problem<2> updated_problem(Integrator integrator = Integrator::verlet, double density = 1.7) {
  Problem<2> problem{.lattice = {LatticeKind::square, dp},
                     .kernel = {KernelFamily::cubic_spline, 1.3 * dp},
                     .material = Material::from_sound_speed(density, c0, 0.6),
                     .scheme = {},
                     .integrator = integrator};
  problem.scheme.formulation = Formulation::updated_lagrangian;
  return problem;
}

Problem<2> with_all_terms(Problem<2> problem) {
  problem.scheme.artificial_stress = ArtificialStress{.epsilon = 0.3};
  problem.scheme.xsph = Xsph{0.5};
  problem.scheme.viscosity = Viscosity{0.7, 0.1};
  return problem;
}

Scene<2> plate_of(const Problem<2>& problem) {
  Scene<2> scene{"plate", problem, free_plate(problem, LatticeIndex<2>(8, 5)), {{"corner", 39}, {"first", 0}}};
  scene.velocity.assign(scene.body.size(), Vector<2>::Zero());
  return scene;
}

/// The plate with its right half so many times as dense, at the same wave speeds.
Scene<2> plate_of_two(double density_ratio, double shear_modulus, DensityRate rate) {
  auto scene = plate_of(updated_problem());
  scene.problem.material = Material::from_sound_speed(1.7, c0, shear_modulus);
  scene.problem.scheme.density_rate = rate;
  scene.body.materials = {scene.problem.material,
                          Material::from_sound_speed(1.7 * density_ratio, c0, shear_modulus * density_ratio)};
  for (int a = 0; a < scene.body.size(); ++a) scene.body.material[a] = scene.body.site[a][0] < 4 ? 0 : 1;
  return scene;
}

/// Velocities of every component uniform in ±`speed`.
Scene<2> shaken(Scene<2> scene, double speed) {
  std::mt19937_64 generator(3);
  for (auto& v : scene.velocity)
    for (int i = 0; i < 2; ++i) v[i] += speed * uniform_number(generator);
  return scene;
}

/// Its left column is held.
Scene<2> held(Scene<2> scene) {
  scene.body.clamped.assign(scene.body.size(), Directions<2>::Constant(false));
  for (int a = 0; a < scene.body.size(); ++a)
    if (scene.body.site[a][0] == 0) scene.body.clamped[a].setConstant(true);
  return scene;
}

solver::UpdatedState<2> advanced(const Scene<2>& scene, long steps, double dt = time_step) {
  solver::UpdatedSimulation<2> simulation(scene.problem, scene.body, scene.periodic_cells);
  auto state = simulation.base_state();
  state.velocity = scene.velocity;
  REQUIRE(!simulation.advance(state, dt, steps));
  return state;
}

double total_energy(const SceneSummary& summary) { return summary.kinetic_energy + summary.strain_energy; }

}  // namespace

TEST_CASE("a run of ul ends where the solver alone ends, bit by bit, however it is watched", "[fast]") {
  for (const auto integrator : integrators) {
    const auto scene = held(shaken(plate_of(with_all_terms(updated_problem(integrator))), 0.02));
    const auto expected = advanced(scene, 120);
    const solver::UpdatedSimulation<2> simulation(scene.problem, scene.body);
    SceneRunOptions<2> options{.time_step = time_step, .duration = 120 * time_step};
    for (const long snapshots : {0, 1, 7}) {
      options.snapshots = snapshots;
      options.probe_samples = snapshots + 1;
      const auto run = run_scene(scene, options);
      CHECK_FALSE(run.failure);
      CHECK(run.last.step == 120);
      CHECK(run.last.velocity == expected.velocity);
      CHECK(run.last.density == expected.density);
      for (int a = 0; a < scene.body.size(); ++a) {
        CHECK(run.last.displacement[a] == expected.position[a] - scene.body.position[a]);
        CHECK(run.last.stress[a] == simulation.stress(expected, a));
        CHECK(run.last.von_mises_stress[a] == simulation.von_mises_stress(expected, a));
      }
      CHECK(run.probes[0].displacement.back() == run.last.displacement[39]);
      CHECK(run.probes[1].displacement.back().isZero(0.0));
      CHECK(run.summary.lost_particles.empty());
      REQUIRE(run.summary.list_builds);
      CHECK(*run.summary.list_builds >= 1);
    }
  }
}

TEST_CASE("a body of ul that moves as one stays rigid to the last bit", "[fast]") {
  // Powers of two: positions, too, are exact.
  const Vector<2> velocity(0.25, -0.5);
  for (const auto integrator : integrators) {
    auto scene = plate_of(with_all_terms(updated_problem(integrator)));
    for (auto& x : scene.body.position) x = (x / dp).array().round();
    scene.velocity.assign(scene.body.size(), velocity);
    const auto run = run_scene<2>(scene, {.time_step = 0.0625, .duration = 0.0625 * 200});
    for (int a = 0; a < scene.body.size(); ++a) {
      CHECK(run.last.displacement[a] == velocity * 12.5);
      CHECK(run.last.velocity[a] == velocity);
      CHECK(run.last.density[a] == 1.7);
      CHECK(run.last.stress[a].isZero(0.0));
    }
    CHECK(run.summary.strain_energy == 0.0);
    CHECK(run.summary.initial_energy == Approx(run.summary.kinetic_energy).epsilon(rounding));
  }
}

TEST_CASE("momentum of a free body of ul drifts only by rounding, under loads too", "[fast]") {
  for (const auto integrator : integrators) {
    auto scene = shaken(plate_of(with_all_terms(updated_problem(integrator))), 0.02);
    for (auto& v : scene.velocity) v += Vector<2>(0.1, 0.0);
    for (int a = 0; a < scene.body.size(); ++a) scene.body.load.emplace_back(1e-3 * std::sin(a), -2e-3);
    const SceneRunOptions<2> options{.time_step = time_step, .duration = 200 * time_step};
    const auto run = run_scene(scene, options);
    REQUIRE(run.summary.momentum_drift);
    CHECK(*run.summary.momentum_drift < rounding);
    CHECK_FALSE(run_scene(held(scene), options).summary.momentum_drift);
  }
}

TEST_CASE("small vibrations of ul keep kinetic and elastic energy to the order of the step", "[fast]") {
  // Linear in the strains, so that only the integrator is left; the stress out of the plane has its part in it.
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    const auto scene = held(shaken(plate_of(updated_problem(integrator)), 1e-9));
    const auto defect = [&](double dt) {
      const auto summary = run_scene<2>(scene, {.time_step = dt, .duration = 12.0}).summary;
      CHECK(summary.strain_energy > 0.1 * summary.kinetic_energy);
      return std::abs(total_energy(summary) / summary.initial_energy - 1.0);
    };
    // Nothing pushes at the start, so that those of half a step before are those of the start with leapfrog too.
    CHECK(std::abs(std::log2(defect(0.02) / defect(0.01)) - 2.0) < order_margin);
  }
}

TEST_CASE("work of the loads becomes energy of small motion in ul", "[fast]") {
  const auto defect = [&](double dt) {
    auto scene = held(plate_of(updated_problem()));
    scene.body.load.assign(scene.body.size(), Vector<2>(0.0, -1e-9));
    const auto summary = run_scene<2>(scene, {.time_step = dt, .duration = 20.0}).summary;
    CHECK(summary.work > 0.0);
    return std::abs(total_energy(summary) / summary.work - 1.0);
  };
  CHECK(std::abs(std::log2(defect(0.1) / defect(0.05)) - 2.0) < order_margin);
}

TEST_CASE("both density rates give the same small motion, and part in the square of its size", "[fast]") {
  const auto apart = [](double speed) {
    auto scene = shaken(plate_of(with_all_terms(updated_problem())), speed);
    const SceneRunOptions<2> options{.time_step = time_step, .duration = 100 * time_step};
    const auto masses = run_scene(scene, options).last;
    scene.problem.scheme.density_rate = DensityRate::volumes;
    const auto volumes = run_scene(scene, options).last;
    double largest = 0.0;
    for (int a = 0; a < scene.body.size(); ++a)
      largest = std::max(largest, (masses.displacement[a] - volumes.displacement[a]).norm());
    return largest;
  };
  const double order = std::log2(apart(1e-4) / apart(5e-5));
  CHECK(std::abs(order - 2.0) < order_margin);
}

TEST_CASE("two materials of ul run with either density rate, and keep momentum and particles", "[fast]") {
  for (const auto rate : {DensityRate::masses, DensityRate::volumes}) {
    const auto scene = shaken(plate_of_two(4.0, 0.6, rate), 1e-4);
    const auto run = run_scene<2>(scene, {.time_step = time_step, .duration = 200 * time_step});
    CHECK_FALSE(run.failure);
    CHECK(run.summary.lost_particles.empty());
    CHECK(*run.summary.momentum_drift < rounding);
    for (int a = 0; a < scene.body.size(); ++a)
      CHECK(run.last.density[a] == Approx(scene.body.material_of(a).density()).epsilon(1e-2));
  }
}

TEST_CASE("a fluid of two densities keeps its energy with the sum of masses; volumes and solids grow", "[fast]") {
  // (3.8) is the adjoint of the forces (3.1), which take σ/ρ² of either particle. (3.9), and (3.10) with the stress
  // rates of a solid, are not where densities differ: energy grows at a rate that no shorter step changes.
  const auto growth = [](DensityRate rate, double shear_modulus, double dt) {
    const auto scene = shaken(plate_of_two(2.0, shear_modulus, rate), 1e-9);
    const auto summary = run_scene<2>(scene, {.time_step = dt, .duration = 60.0}).summary;
    return total_energy(summary) / summary.initial_energy - 1.0;
  };
  const double coarse = growth(DensityRate::masses, 0.0, 0.04), fine = growth(DensityRate::masses, 0.0, 0.02);
  CHECK(std::abs(std::log2(std::abs(coarse / fine)) - 2.0) < order_margin);
  constexpr double of_the_step = 0.01;  // (ωΔt)² at most
  const auto check_growth = [&](DensityRate rate, double shear_modulus, double least) {
    const double grown = growth(rate, shear_modulus, 0.01);
    CHECK(grown > least);
    CHECK(growth(rate, shear_modulus, 0.02) == Approx(grown).epsilon(of_the_step));
  };
  check_growth(DensityRate::volumes, 0.0, 1000.0);
  check_growth(DensityRate::volumes, 0.6, 100.0);
  check_growth(DensityRate::masses, 0.6, 1.0);
}

TEST_CASE("a patch of ul runs in its box, and displacements are not folded back", "[fast]") {
  auto problem = updated_problem(Integrator::leapfrog);
  problem.pressure = 0.01;
  const LatticeIndex<2> cells(6, 5);
  Scene<2> scene{"patch", problem, periodic_patch(problem, cells), {}};
  scene.periodic_cells = cells;
  scene.velocity.assign(scene.body.size(), Vector<2>(0.5, 0.0));
  const auto run = run_scene<2>(scene, {.time_step = time_step, .duration = 400 * time_step});
  for (const auto& displacement : run.last.displacement)  // more than two boxes
    CHECK((displacement - Vector<2>(10.0, 0.0)).norm() < 400 * rounding);
  // σ = −P at rest, and its energy.
  CHECK(run.last.stress[7](0, 0) == Approx(-0.01).epsilon(rounding));
  const double K = 1.7 * c0 * c0;
  CHECK(run.summary.strain_energy == Approx(30.0 * dp * dp * 0.01 * 0.01 / (2.0 * K)).epsilon(rounding));

  const auto expected = advanced(shaken(scene, 0.01), 50);
  const auto shaken_run = run_scene<2>(shaken(scene, 0.01), {.time_step = time_step, .duration = 50 * time_step});
  CHECK(shaken_run.last.velocity == expected.velocity);
}

TEST_CASE("a run of ul that loses its numbers stops at the step and keeps the state before", "[fast]") {
  for (const auto integrator : integrators) {
    auto scene = shaken(plate_of(updated_problem(integrator)), 0.3);
    constexpr double unstable = 2.5;
    const auto run = run_scene<2>(scene, {.time_step = unstable, .duration = 1e4, .snapshots = 2});
    REQUIRE(run.failure);
    CHECK(run.summary.steps == run.failure->step - 1);
    CHECK(run.failure->time == Approx(static_cast<double>(run.failure->step) * unstable));
    REQUIRE(run.failure->term);
    const auto last = advanced(scene, run.summary.steps, unstable);
    CHECK(run.last.velocity == last.velocity);
    CHECK(run.last.density == last.density);
    auto next = last;
    solver::UpdatedSimulation<2> simulation(scene.problem, scene.body);
    const auto lost = simulation.advance(next, unstable);
    const auto broken = simulation.broken_term(last, unstable);
    REQUIRE(lost);
    REQUIRE(broken);
    CHECK(run.failure->particle == broken->particle);
    CHECK(*run.failure->term == name_of(broken->term));
    CHECK(std::isfinite(total_energy(run.summary)));
    CHECK(*std::min_element(run.last.density.begin(), run.last.density.end()) > 0.0);
  }
}

TEST_CASE("a load of ul that is no number fails in the first step, by the momentum sum", "[fast]") {
  auto scene = plate_of(updated_problem(Integrator::leapfrog));
  scene.body.load.assign(scene.body.size(), Vector<2>::Zero());
  scene.body.load[7][1] = std::numeric_limits<double>::infinity();
  const auto run = run_scene<2>(scene, {.time_step = time_step, .duration = 1.0});
  REQUIRE(run.failure);
  CHECK(run.failure->step == 1);
  CHECK(run.failure->particle == 7);
  CHECK(run.failure->field == "velocity");
  CHECK(*run.failure->term == "momentum sum");
  CHECK(run.summary.steps == 0);
}

TEST_CASE("numbers of ul beyond the largest fail by the term that makes them", "[fast]") {
  auto scene = plate_of(updated_problem(Integrator::leapfrog));
  // On all alike, so that nothing but velocities grows: by 4e99 a step of 1e-102.
  scene.body.load.assign(scene.body.size(), Vector<2>(4e201, 0.0));
  const auto run = run_scene<2>(scene, {.time_step = 1e-102, .duration = 1e-101});
  REQUIRE(run.failure);
  CHECK(run.failure->step == 3);
  CHECK(run.failure->field == "velocity");
  CHECK(*run.failure->term == "momentum sum");
  CHECK(run.summary.largest_velocity == Approx(8e99));
  CHECK(std::isfinite(run.summary.kinetic_energy));
}

TEST_CASE("particles that a run of ul leaves alone are counted", "[fast]") {
  auto scene = plate_of(updated_problem(Integrator::leapfrog));
  scene.velocity[39] = {50.0, 40.0};
  const auto run = run_scene<2>(scene, {.time_step = 0.01, .duration = 1.0});
  CHECK_FALSE(run.failure);
  CHECK(run.summary.lost_particles == std::vector<int>{39});
  CHECK(run.last.displacement.size() == 40);
}

TEST_CASE("tl-linear starts with the velocities of its scene", "[fast]") {
  auto problem = updated_problem();
  problem.scheme.formulation = Formulation::total_lagrangian_linear;
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet})
    for (const bool damped : {false, true}) {
      problem.integrator = integrator;
      problem.scheme.damping.reset();
      if (damped) problem.scheme.damping = Damping{0.04};
      auto scene = shaken(plate_of(problem), 1e-3);
      for (auto& v : scene.velocity) v += Vector<2>(0.5, 0.25);
      const SceneRunOptions<2> options{.time_step = time_step, .duration = 200 * time_step};
      const auto run = run_scene(scene, options);
      CHECK(*run.summary.momentum_drift < rounding);
      double energy = 0.0;
      for (int a = 0; a < scene.body.size(); ++a) energy += 0.5 * scene.body.mass(a) * scene.velocity[a].squaredNorm();
      CHECK(run.summary.initial_energy == Approx(energy).epsilon(rounding));
      CHECK(held(scene).body.clamped[0].all());
      CHECK(run_scene(held(scene), options).probes[1].velocity.front().isZero(0.0));
      if (!damped && integrator == Integrator::verlet)
        CHECK(total_energy(run.summary) == Approx(energy).epsilon(time_step * time_step));
    }
}
