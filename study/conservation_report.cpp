// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "analysis/spectrum.hpp"
#include "io/document.hpp"
#include "solver/total_lagrangian.hpp"
#include "study/beams.hpp"
#include "study/noise.hpp"
#include "study/p_wave_speed.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"
#include "study/scene_run.hpp"

namespace sphstab::study {
namespace {

struct Law {
  std::string_view name;
  Formulation formulation;
  ElasticLaw law;
};
constexpr std::array laws{
    Law{"tl-corotated", Formulation::total_lagrangian_corotated, ElasticLaw::saint_venant_kirchhoff},
    Law{"tl-pk1, Saint Venant–Kirchhoff", Formulation::total_lagrangian_pk1, ElasticLaw::saint_venant_kirchhoff},
    Law{"tl-pk1, neo-Hookean", Formulation::total_lagrangian_pk1, ElasticLaw::neo_hookean}};
constexpr std::array integrators{Integrator::leapfrog, Integrator::verlet};

/// In degrees, about (1, 2, 3) in space.
constexpr std::array angles{1.0, 30.0, 90.0, 180.0, 270.0};
/// A body off its lattice by up to so many spacings.
constexpr double jitter = 0.1;
/// Roundings of sums over up to 60 neighbours.
constexpr double rounding = 1e-12;

/// A free body spins, and its particles are shaken by so much of the wave speed: strains of some percent.
constexpr double spin = 0.01, shake = 0.02;
constexpr long motion_steps = 10000;
constexpr double motion_fraction = 0.5;
/// Of motion_steps sums over all particles.
constexpr double drift_of_rounding = 1e-10;

constexpr double bar_spacing = 4e-3, bar_shear_modulus = 0.5e6;
constexpr int periods = 4;
/// A fraction of the critical step of the bar at rest.
constexpr double below_limit = 0.9, above_limit = 1.01;
/// Per period. F·S and the neo-Hookean law have an energy, which the integrators keep but for what comes and goes; R·S
/// has none, and this bar is strained by a few percent.
constexpr double drift_with_potential = 1e-8, drift_without_potential = 1e-5;

Scheme scheme_of(const Law& law) {
  Scheme scheme;
  scheme.formulation = law.formulation;
  scheme.elastic_law = law.law;
  return scheme;
}

template <int Dim>
Problem<Dim> problem_of(const Law& law, Integrator integrator) {
  return {.lattice = Lattice<Dim>(Dim == 2 ? LatticeKind::square : LatticeKind::cubic, 1.0),
          .kernel = Kernel<Dim>(KernelFamily::wendland_c2, 1.3),
          .material = Material::from_young_modulus(1.0, 1.0, 0.3),
          .scheme = scheme_of(law),
          .integrator = integrator};
}

/// A free body off its lattice.
template <int Dim>
Body<Dim> disordered_body(const Problem<Dim>& problem) {
  auto body = free_plate<Dim>(problem, LatticeIndex<Dim>::Constant(Dim == 2 ? 8 : 4));
  const auto shifts = noise<Dim>(body.size(), 1);
  for (int a = 0; a < body.size(); ++a) body.position[a] += jitter * shifts[a];
  body.pairs = find_pairs(body.position, problem.kernel.support());
  body.site.clear();
  return body;
}

template <int Dim>
Tensor<Dim> turn(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  if constexpr (Dim == 2)
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
  else
    return Eigen::AngleAxisd(angle, Vector<3>(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
}

/// The largest force under rigid rotations, in c_p²/Δp per mass.
template <int Dim>
double force_of_rotation(const Law& law) {
  const auto problem = problem_of<Dim>(law, Integrator::leapfrog);
  const auto body = disordered_body(problem);
  const auto simulation = solver::make_simulation(problem, body);
  solver::Field<Dim> acceleration(body.size());
  double largest = 0.0;
  for (const double angle : angles) {
    solver::State<Dim> state(body.size());
    for (int a = 0; a < body.size(); ++a)
      state.displacement[a] = turn<Dim>(angle) * body.position[a] - body.position[a];
    simulation->accelerations(state, acceleration);
    for (const auto& force : acceleration) largest = std::max(largest, force.norm());
  }
  return largest / std::pow(p_wave_speed(problem), 2);
}

struct Drift {
  double momentum;          ///< over Σ m |v|
  double angular_momentum;  ///< of its own
};

Drift drift_of_motion(const Law& law, Integrator integrator) {
  const auto problem = problem_of<2>(law, integrator);
  const auto body = disordered_body(problem);
  const double speed = p_wave_speed(problem);
  const auto simulation = solver::make_simulation(problem, body);
  solver::State<2> state(body.size());
  const auto shakes = noise<2>(body.size(), 2);
  for (int a = 0; a < body.size(); ++a)
    state.velocity[a] = speed * (spin * Vector<2>(-body.position[a][1], body.position[a][0]) + shake * shakes[a]);
  const auto momentum = [&] {
    Vector<2> sum = Vector<2>::Zero();
    for (int a = 0; a < body.size(); ++a) sum += body.mass(a) * state.velocity[a];
    return sum;
  };
  const auto angular_momentum = [&] {
    double sum = 0.0;
    for (int a = 0; a < body.size(); ++a) {
      const Vector<2> x = body.position[a] + state.displacement[a], &v = state.velocity[a];
      sum += body.mass(a) * (x[0] * v[1] - x[1] * v[0]);
    }
    return sum;
  };
  const Vector<2> p = momentum();
  const double L = angular_momentum();
  double scale = 0.0;
  for (int a = 0; a < body.size(); ++a) scale += body.mass(a) * state.velocity[a].norm();
  simulation->advance(state, motion_fraction * analysis::body_limit(problem, body).critical_time_step, motion_steps);
  return {(momentum() - p).norm() / scale, std::abs(angular_momentum() / L - 1.0)};
}

/// The bar of Turek & Hron as it swings under its weight.
struct Swing {
  double period;                ///< of small vibrations
  double stored;                ///< strain energy after half a period
  std::vector<double> surplus;  ///< energy after each period less the work of the weight, over `stored`
  SceneRunResult<2> above;      ///< at 1.01 of the limit
};

Swing swing_of(const Law& law, Integrator integrator) {
  const auto scene =
      make_scene(beams::bar_scene({bar_shear_modulus, bar_spacing}, {law.name, scheme_of(law), integrator}));
  const double limit = beams::step_of(scene, 1.0);
  const auto run = [&](double fraction, double duration) {
    return run_scene<2>(scene, {.time_step = fraction * limit, .duration = duration});
  };
  Swing swing{};
  swing.period = 2.0 * std::numbers::pi / analysis::lowest_modes(scene.problem, scene.body, 1).front().omega;
  swing.stored = run(below_limit, 0.5 * swing.period).summary.strain_energy;
  for (int n = 1; n <= periods; ++n) {
    const auto summary = run(below_limit, n * swing.period).summary;
    swing.surplus.push_back((summary.kinetic_energy + summary.strain_energy - summary.work) / swing.stored);
  }
  swing.above = run(above_limit, periods * swing.period);
  return swing;
}

struct Findings {
  const Law* law;
  Integrator integrator;
  double rotation_in_plane, rotation_in_space;
  Drift drift;
  Swing swing;

  std::string name() const { return fmt::format("{}, {}", law->name, name_of(integrator)); }
  double drift_per_period() const { return (swing.surplus.back() - swing.surplus.front()) / (periods - 1); }
};

std::vector<Findings> all_findings(const Progress& progress) {
  std::vector<Findings> findings;
  for (const Law& law : laws)
    for (const Integrator integrator : integrators) findings.push_back({&law, integrator, 0.0, 0.0, {}, {}});
  std::vector<std::function<void()>> work;
  for (Findings& found : findings)
    work.push_back([&found] {
      found.rotation_in_plane = force_of_rotation<2>(*found.law);
      found.rotation_in_space = force_of_rotation<3>(*found.law);
      found.drift = drift_of_motion(*found.law, found.integrator);
      found.swing = swing_of(*found.law, found.integrator);
    });
  run_all(work, progress);
  return findings;
}

io::Table balance_table(const std::vector<Findings>& findings) {
  io::Table table{{"scheme", "integrator", "force of a rotation, 2D", "3D", "momentum", "angular momentum"}, {}};
  for (const auto& found : findings)
    table.rows.push_back({std::string(found.law->name), std::string(name_of(found.integrator)),
                          fmt::format("{:.0e}", found.rotation_in_plane),
                          fmt::format("{:.0e}", found.rotation_in_space), fmt::format("{:.0e}", found.drift.momentum),
                          fmt::format("{:.0e}", found.drift.angular_momentum)});
  return table;
}

std::string end_of(const SceneRunResult<2>& run) {
  if (!run.growth) return "not stopped";
  return fmt::format("step {}, {:.3g} s: {}", run.growth->step, run.growth->time,
                     run.growth->cause ? name_of(*run.growth->cause) : "unknown");
}

io::Table energy_table(const std::vector<Findings>& findings) {
  io::Table table{{"scheme", "integrator", "stored, J/m", "period 1", "2", "3", "4", "drift a period",
                   fmt::format("stopped at {:g} of the limit", above_limit)},
                  {}};
  for (const auto& found : findings) {
    std::vector<std::string> row{std::string(found.law->name), std::string(name_of(found.integrator)),
                                 fmt::format("{:.4f}", found.swing.stored)};
    for (const double surplus : found.swing.surplus) row.push_back(fmt::format("{:.1e}", surplus));
    row.push_back(fmt::format("{:.1e}", found.drift_per_period()));
    row.push_back(end_of(found.swing.above));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<std::string> failures_of(const std::vector<Findings>& findings) {
  std::vector<std::string> failures;
  const auto claim = [&](bool holds, const Findings& found, std::string_view what) {
    if (!holds) failures.push_back(fmt::format("{}: {}", found.name(), what));
  };
  for (const auto& found : findings) {
    claim(std::max(found.rotation_in_plane, found.rotation_in_space) < rounding, found, "a rotation makes a force");
    claim(found.drift.momentum < drift_of_rounding, found, "momentum drifts");
    claim(found.drift.angular_momentum < drift_of_rounding, found, "angular momentum drifts");
    const bool has_potential = found.law->formulation == Formulation::total_lagrangian_pk1;
    claim(std::abs(found.drift_per_period()) < (has_potential ? drift_with_potential : drift_without_potential), found,
          "energy drifts");
    claim(found.swing.above.growth && found.swing.above.growth->cause == GrowthCause::time_step, found,
          "above the limit the run is not stopped because of its step");
  }
  return failures;
}

}  // namespace

Report conservation_report(const Progress& progress) {
  const auto findings = all_findings(progress);
  const io::Table balance = balance_table(findings), energy = energy_table(findings);
  Report report;
  report.failures = failures_of(findings);
  report.summary = fmt::format(
      "Free bodies off their lattice by up to {:g} Δp. Rotations by 1°, 30°, 90°, 180° and 270°, in space about "
      "(1, 2, 3): the largest force per\nmass, in c_p²/Δp. A spinning, shaken plate, strained by some percent, over {} "
      "steps of {:g} of the limit: the change of the momentum over Σ m |v|,\nand of the angular momentum over "
      "itself.\n\n{}\nThe bar of Turek & Hron, {:g} mm, swings freely under its weight, at {:g} of the critical step "
      "of the bar at rest: kinetic and strain energy less the work\nof the weight, after each period, over the "
      "energy stored when it hangs lowest. At {:g} of the limit: when the run was stopped, and the cause it "
      "named.\n\n{}",
      jitter, motion_steps, motion_fraction, io::to_markdown(balance), 1e3 * bar_spacing, below_limit, above_limit,
      io::to_markdown(energy));
  report.files = {{"README.md", "# What the schemes of finite strain keep\n\n" + report.summary +
                                    "\nRegenerate with `sphstab report conservation --overwrite`.\n"},
                  {"balance.csv", io::to_csv(balance)},
                  {"energy.csv", io::to_csv(energy)}};
  return report;
}

}  // namespace sphstab::study
