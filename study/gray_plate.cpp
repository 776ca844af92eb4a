// SPDX-License-Identifier: MIT
#include "study/gray_plate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/critical_step.hpp"
#include "study/beam_theory.hpp"
#include "study/bonds.hpp"
#include "study/p_wave_speed.hpp"
#include "study/scene_run.hpp"

namespace sphstab::study::gray {
namespace {

constexpr double h_over_spacing = 1.5;
constexpr double xsph = 0.5;
constexpr double viscosity_eta = 0.1;
/// Looks for parted pairs in a run.
constexpr long looks = 400;
/// Tensions at which the growth rate is computed; in between it is interpolated.
constexpr int growth_points = 8;

Material material(double shear_modulus) { return Material::from_sound_speed(1.0, 1.0, shear_modulus); }

Problem<2> problem_of(const Plate& plate) {
  Scheme scheme{.formulation = Formulation::updated_lagrangian, .xsph = Xsph{xsph}};
  if (plate.epsilon > 0.0) scheme.artificial_stress = ArtificialStress{.epsilon = plate.epsilon};
  if (plate.viscosity > 0.0) scheme.viscosity = Viscosity{plate.viscosity, viscosity_eta, plate.viscous_pairs};
  return {.lattice = Lattice<2>(LatticeKind::square, plate.spacing()),
          .kernel = Kernel<2>(KernelFamily::cubic_spline, h_over_spacing * plate.spacing()),
          .material = material(plate.shear_modulus),
          .scheme = scheme,
          .integrator = plate.integrator};
}

/// Growth rate of the fastest mode in a tension along x, 1 / time; 0 where none grows.
double growth_rate(const Plate& plate, double tension) {
  const auto limit = analysis::bulk_limit(problem_in_tension(plate, tension));
  const auto* unstable = std::get_if<analysis::NeverStable<2>>(&limit);
  return unstable ? unstable->growth_rate : 0.0;
}

/// ∫ γ(σ) dt over a history of tensions at equal intervals, from growth rates at a few tensions up to the largest.
double e_foldings(const Plate& plate, const std::vector<double>& tension, double interval) {
  const double largest = *std::max_element(tension.begin(), tension.end());
  if (!(largest > 0.0)) return 0.0;
  std::vector<double> rates{0.0};
  for (int i = 1; i <= growth_points; ++i) rates.push_back(growth_rate(plate, largest * i / growth_points));
  double sum = 0.0;
  for (const double sigma : tension) {
    if (!(sigma > 0.0)) continue;
    const double place = sigma / largest * growth_points;
    const int i = std::min(static_cast<int>(place), growth_points - 1);
    sum += std::lerp(rates[i], rates[i + 1], place - i) * interval;
  }
  return sum;
}

/// What the deflection of the tip says: when it crosses 0, and how far it goes in between.
void read_oscillation(Oscillation& run) {
  const auto crossings = zero_crossings(run.time, run.deflection);
  std::vector<double> largest(crossings.size() + 1, 0.0);  // before the first, between them, and after the last
  for (std::size_t n = 0; n < run.time.size(); ++n) {
    const auto passed = std::upper_bound(crossings.begin(), crossings.end(), run.time[n]) - crossings.begin();
    largest[passed] = std::max(largest[passed], std::abs(run.deflection[n]));
  }
  if (crossings.size() >= 2) run.period = crossings[1];
  // The way back from the second largest deflection must have begun.
  if (largest.size() >= 3 && std::abs(run.deflection.back()) < largest[2]) run.decay = 1.0 - largest[2] / largest[0];
}

}  // namespace

std::vector<double> zero_crossings(const std::vector<double>& time, const std::vector<double>& y) {
  std::vector<double> crossings;
  for (std::size_t n = 1; n < time.size(); ++n)
    if (y[n - 1] * y[n] < 0.0) crossings.push_back(std::lerp(time[n - 1], time[n], y[n - 1] / (y[n - 1] - y[n])));
  return crossings;
}

double Plate::time_step() const { return courant_number * spacing() / p_wave_speed(problem_of(*this)); }

SceneDescription<2> plate_scene(const Plate& plate) {
  const Problem<2> problem = problem_of(plate);
  const double surface = 0.5 * plate.height, layer = clamp_layers * problem.lattice.spacing();
  const Box<2> above{{-clamp_length, surface}, {0.0, surface + layer}},
      below{{-clamp_length, -surface - layer}, {0.0, -surface}};
  SceneDescription<2> scene{.name = "gray-plate", .problem = problem, .materials = {problem.material}, .parts = {}};
  const auto add = [&](const std::string& name, const Box<2>& box) {
    Placement<2> placement;
    placement.shape = box;
    scene.parts.push_back({name, placement});
  };
  add("plate", {{-clamp_length, -surface}, {plate_length, surface}});
  add("layer above", above);
  add("layer below", below);
  for (const Box<2>& layer_region : {above, below})
    scene.clamps.push_back({layer_region, Directions<2>::Constant(true)});
  scene.velocities.push_back(
      {Box<2>{{0.0, -surface}, {plate_length, surface}}, CantileverMode{0.0, plate_length, plate.tip_velocity}});
  scene.probes = {{"tip", {plate_length, 0.0}}, {"top", {0.0, surface}}, {"bottom", {0.0, -surface}}};
  return scene;
}

double slender_period(double height, double shear_modulus) {
  const Beam beam{plate_length, height, material(shear_modulus), Plane::strain, BeamEnds::clamped_free};
  return 1.0 / euler_bernoulli_frequency(beam, 1);
}

Problem<2> problem_in_tension(const Plate& plate, double tension) {
  Problem<2> problem = problem_of(plate);
  problem.pressure = -(1.0 + problem.material.poisson_ratio()) * tension / 3.0;
  problem.deviatoric_stress = Vector<2>(tension + problem.pressure, problem.pressure).asDiagonal();
  if (plate.viscous_pairs == ViscousPairs::approaching) {  // damps small waves half as fast (theory.md §8)
    problem.scheme.viscosity->alpha *= 0.5;
    problem.scheme.viscosity->pairs = ViscousPairs::all;
  }
  return problem;
}

Oscillation oscillate(const Plate& plate, double periods, int images,
                      const std::function<void(double fraction)>& progress) {
  const Scene<2> scene = make_scene(plate_scene(plate));
  const Bonds bonds(scene);
  Oscillation run{};
  std::optional<std::pair<double, Bond>> first_parted;
  const long every = images > 1 ? looks / (images - 1) : looks + 1;
  long look = 0;
  SceneRunOptions<2> options{.time_step = plate.time_step(),
                             .duration = periods * slender_period(plate.height - plate.spacing(), plate.shear_modulus),
                             .snapshots = looks};
  options.visit = [&](const Snapshot<2>& snapshot) {
    if (const auto bond = first_parted ? std::nullopt : bonds.first_parted(snapshot.displacement, parted))
      first_parted = {snapshot.time, *bond};
    if (images > 0 && look++ % every == 0) {
      run.images.push_back({snapshot.time, snapshot.displacement, {}});
      for (const auto& stress : snapshot.stress) run.images.back().stress.push_back(stress(0, 0));
    }
  };
  if (progress)
    options.progress = [&](long step, long steps) { progress(static_cast<double>(step) / static_cast<double>(steps)); };
  const auto result = run_scene(scene, options);
  run.failed = result.failure.has_value();
  run.lost_particles = static_cast<int>(result.summary.lost_particles.size());
  run.time = result.sample_times;
  for (const auto& displacement : result.probes[0].displacement) run.deflection.push_back(displacement[1]);
  read_oscillation(run);
  if (first_parted) {
    std::vector<double> tension;
    for (std::size_t n = 0; n < run.time.size() && run.time[n] <= first_parted->first; ++n)
      tension.push_back(std::max(result.probes[1].stress[n](0, 0), result.probes[2].stress[n](0, 0)));
    const auto& [a, b] = first_parted->second;
    run.parting = {first_parted->first, 0.5 * (scene.body.position[a] + scene.body.position[b]),
                   *std::max_element(tension.begin(), tension.end()), e_foldings(plate, tension, plate.time_step())};
  }
  return run;
}

}  // namespace sphstab::study::gray
