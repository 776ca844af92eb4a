// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/updated_lagrangian.hpp"
#include "io/document.hpp"
#include "study/gray_plate.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"
#include "study/scene_run.hpp"

namespace sphstab::study {
namespace {

constexpr double epsilon = 0.3;
/// So small that the stress plays no part of its own: strains are below 1e-8, far above rounding.
constexpr double bar_velocity = 1e-8;
constexpr double bar_step = 0.1;
/// Held particles that the bar is clamped by: more than any support.
constexpr int held_particles = 6;
constexpr std::array bar_lengths{20, 40, 80, 160};
constexpr std::array beam_resolutions{8, 12, 16, 24};
/// Enough that the short waves which artificial stress drives in the square lattice (report tension) do not matter in
/// half a period.
constexpr double beam_viscosity = 2.0;
constexpr double beam_courant_number = 0.8;
constexpr double beam_tip_velocity = 1e-3;
/// In periods of the slender beam: half a period of ours and a little more.
constexpr double half_a_period = 0.65;
/// Cut stencils at ends and surfaces make errors in proportion to the spacing; what their extrapolation leaves is of
/// second order, (1/80)² and (1/16)², times a number of order 1.
constexpr double bar_tolerance = 1.6e-4;
constexpr double beam_tolerance = 4e-3;

/// When a displacement passes 0 for the first and the second time, and how long it takes in between.
struct HalfPeriods {
  double first = 0.0;
  double second = 0.0;
};

HalfPeriods half_periods(const std::vector<double>& time, const std::vector<double>& displacement) {
  auto crossings = gray::zero_crossings(time, displacement);
  crossings.resize(2, std::nan(""));
  return {crossings[0], crossings[1] - crossings[0]};
}

/// A chain that is clamped at x = 0 and swings in its lowest mode: as a whole in tension for the first half period, in
/// compression for the second.
struct Bar {
  KernelFamily kernel;
  double h_over_spacing;
  int length;  ///< in spacings
  HalfPeriods without = {}, with = {};

  double tension_factor() const { return std::pow(without.first / with.first, 2); }
  double compression_factor() const { return std::pow(without.second / with.second, 2); }
};

Problem<1> bar_problem(const Bar& bar, double epsilon_of_run) {
  Scheme scheme{.formulation = Formulation::updated_lagrangian};
  if (epsilon_of_run > 0.0) scheme.artificial_stress = ArtificialStress{.epsilon = epsilon_of_run};
  return {.lattice = Lattice<1>(LatticeKind::chain, 1.0),
          .kernel = Kernel<1>(bar.kernel, bar.h_over_spacing),
          .material = Material::from_sound_speed(1.0, 1.0, 0.3),
          .scheme = scheme};
}

HalfPeriods swing(const Bar& bar, double epsilon_of_run) {
  const Problem<1> problem = bar_problem(bar, epsilon_of_run);
  const double length = bar.length;
  const Box<1> held{Vector<1>(-held_particles), Vector<1>(0.0)};
  Placement<1> placement;
  placement.shape = Box<1>{held.from, Vector<1>(length)};
  SceneDescription<1> description{
      .name = "bar", .problem = problem, .materials = {problem.material}, .parts = {{"bar", placement}}};
  description.clamps.push_back({held, Directions<1>::Constant(true)});
  Scene<1> scene = make_scene(description);
  const auto mode = [&](int a) {
    const double x = scene.body.position[a][0];
    return x > 0.0 ? std::sin(0.5 * std::numbers::pi * x / length) : 0.0;
  };
  std::vector<double> time, amplitude;
  for (int a = 0; a < scene.body.size(); ++a) scene.velocity.push_back(Vector<1>(bar_velocity * mode(a)));
  const auto visit = [&](const Snapshot<1>& snapshot) {
    time.push_back(snapshot.time);
    amplitude.push_back(0.0);
    for (int a = 0; a < scene.body.size(); ++a) amplitude.back() += mode(a) * snapshot.displacement[a][0];
  };
  const double duration = 5.0 * length;
  run_scene<1>(
      scene,
      {.time_step = bar_step, .duration = duration, .snapshots = std::lround(duration / bar_step), .visit = visit});
  return half_periods(time, amplitude);
}

double bar_theory(const Bar& bar) {
  return analysis::UpdatedLagrangian<1>(bar_problem(bar, epsilon)).tension_modulus_factor();
}

struct Beam {
  int across;
  HalfPeriods without = {}, with = {};

  double factor() const { return std::pow(without.first / with.first, 2); }
};

HalfPeriods swing(const Beam& beam, double epsilon_of_run) {
  const gray::Plate plate{.across = beam.across,
                          .tip_velocity = beam_tip_velocity,
                          .epsilon = epsilon_of_run,
                          .viscosity = beam_viscosity,
                          .courant_number = beam_courant_number};
  const auto run = gray::oscillate(plate, half_a_period);
  return half_periods(run.time, run.deflection);
}

double beam_modulus_factor() {
  const gray::Plate plate{.epsilon = epsilon};
  return analysis::UpdatedLagrangian<2>(gray::plate_scene(plate).problem).tension_modulus_factor();
}

/// Where the half in tension has q times the modulus, the neutral line moves so that both halves carry the same force.
double beam_theory() {
  const double q = beam_modulus_factor();
  return 4.0 * q / std::pow(1.0 + std::sqrt(q), 2);
}

/// Everything that is run.
struct Runs {
  std::vector<Bar> bars;
  std::vector<Beam> beams;
};

/// Two resolutions taken to infinitely many spacings, errors in proportion to the spacing.
double extrapolated(int coarse, double coarse_factor, int fine, double fine_factor) {
  return (fine * fine_factor - coarse * coarse_factor) / (fine - coarse);
}

double beam_limit(const Runs& runs) {
  const Beam &coarse = runs.beams[runs.beams.size() - 2], &fine = runs.beams.back();
  return extrapolated(coarse.across, coarse.factor(), fine.across, fine.factor());
}

/// Of the bar before and this one, which is longer.
double bar_limit(const std::vector<Bar>& bars, std::size_t i) {
  return extrapolated(bars[i - 1].length, bars[i - 1].tension_factor(), bars[i].length, bars[i].tension_factor());
}

Runs run_all_of_them(const Progress& progress) {
  Runs runs;
  for (const auto kernel : {KernelFamily::cubic_spline, KernelFamily::wendland_c2})
    for (const double ratio : {1.0, 1.3})
      for (const int length : bar_lengths) runs.bars.push_back({kernel, ratio, length});
  for (const int across : beam_resolutions) runs.beams.push_back({across});
  std::vector<std::function<void()>> work;
  for (Beam& beam : runs.beams) {
    work.push_back([&beam] { beam.without = swing(beam, 0.0); });
    work.push_back([&beam] { beam.with = swing(beam, epsilon); });
  }
  for (Bar& bar : runs.bars)
    work.push_back([&bar] {
      bar.without = swing(bar, 0.0);
      bar.with = swing(bar, epsilon);
    });
  run_all(work, progress);
  return runs;
}

io::Table bar_table(const Runs& runs) {
  io::Table table{{"kernel", "h/Δp", "length/Δp", "T/2 in tension, ε = 0", "ε = 0.3", "modulus factor measured",
                   "1 − ε a_n", "difference", "factor in compression"},
                  {}};
  for (std::size_t i = 0; i < runs.bars.size(); ++i) {
    const Bar& bar = runs.bars[i];
    const double theory = bar_theory(bar);
    const auto row = [&](std::string length, std::string without, std::string with, double factor,
                         std::string compression) {
      table.rows.push_back({std::string(name_of(bar.kernel)), fmt::format("{}", bar.h_over_spacing), std::move(length),
                            std::move(without), std::move(with), fmt::format("{:.5f}", factor),
                            fmt::format("{:.5f}", theory), fmt::format("{:.1e}", factor / theory - 1.0),
                            std::move(compression)});
    };
    row(fmt::format("{}", bar.length), fmt::format("{:.3f}", bar.without.first), fmt::format("{:.3f}", bar.with.first),
        bar.tension_factor(), fmt::format("{:.5f}", bar.compression_factor()));
    if (bar.length == bar_lengths.back()) row("extrapolated", "", "", bar_limit(runs.bars, i), "");
  }
  return table;
}

io::Table beam_table(const Runs& runs) {
  io::Table table{{"spacings across", "T/2, ε = 0", "ε = 0.3", "stiffness factor measured", "4q/(1+√q)²", "difference"},
                  {}};
  const double theory = beam_theory();
  const auto row = [&](std::string across, std::string without, std::string with, double factor) {
    table.rows.push_back({std::move(across), std::move(without), std::move(with), fmt::format("{:.5f}", factor),
                          fmt::format("{:.5f}", theory), fmt::format("{:.1e}", factor / theory - 1.0)});
  };
  for (const Beam& beam : runs.beams)
    row(fmt::format("{}", beam.across), fmt::format("{:.2f}", beam.without.first),
        fmt::format("{:.2f}", beam.with.first), beam.factor());
  row("extrapolated", "", "", beam_limit(runs));
  return table;
}

std::vector<std::string> failures_of(const Runs& runs) {
  std::vector<std::string> failures;
  for (std::size_t i = 0; i < runs.bars.size(); ++i) {
    const Bar& bar = runs.bars[i];
    if (bar.length != bar_lengths.back()) continue;
    const std::string name = fmt::format("{}, h = {} Δp", name_of(bar.kernel), bar.h_over_spacing);
    if (const double factor = bar_limit(runs.bars, i), theory = bar_theory(bar);
        !(std::abs(factor / theory - 1.0) < bar_tolerance))
      failures.push_back(
          fmt::format("bar, {}: tension keeps {:.5f} of the modulus, theory {:.5f}", name, factor, theory));
    if (!(std::abs(bar.compression_factor() - 1.0) < bar_tolerance))
      failures.push_back(
          fmt::format("bar, {}: compression keeps {:.5f} of the modulus", name, bar.compression_factor()));
  }
  if (const double factor = beam_limit(runs), theory = beam_theory();
      !(std::abs(factor / theory - 1.0) < beam_tolerance))
    failures.push_back(fmt::format("beam: bending keeps {:.5f} of the stiffness, theory {:.5f}", factor, theory));
  return failures;
}

}  // namespace

Report softening_report(const Progress& progress) {
  const Runs runs = run_all_of_them(progress);
  Report report;
  report.failures = failures_of(runs);
  report.summary = fmt::format(
      "Artificial stress with ε = {} pulls only where there is tension, in proportion to it, so that a body in "
      "tension is softer,\nhowever small the tension. Scheme `ul`, `leapfrog`, exact R.\n\n"
      "A bar, clamped at one end, swings in its lowest mode: in tension for the first half period, in compression for "
      "the second.\n(T/2 without / T/2 with artificial stress)² is the factor of its modulus; theory says 1 − ε a_n "
      "in tension and 1 in compression. The\nextrapolated rows take the two longest to infinite length, errors in "
      "proportion to the spacing.\n\n"
      "{}\nThe plate of Gray et al., Sec. 7.1, bends: of its two halves one is in tension. A modulus qE on the side "
      "in tension leaves\n4q/(1+√q)² of the bending stiffness. h = 1.5 Δp, square lattice, μ = 0.22, V_f = {}, α = {} "
      "against the short waves that\nartificial stress drives in the square lattice; q = {:.5f}. The last row takes "
      "the two finest to infinitely many spacings, errors in\nproportion to the spacing: at the surfaces stencils are "
      "cut.\n\n"
      "{}",
      epsilon, io::to_markdown(bar_table(runs)), beam_tip_velocity, beam_viscosity, beam_modulus_factor(),
      io::to_markdown(beam_table(runs)));
  report.files = {{"README.md", "# What artificial stress takes of the stiffness\n\n" + report.summary +
                                    "\nRegenerate with `sphstab report softening --overwrite`.\n"},
                  {"bars.csv", io::to_csv(bar_table(runs))},
                  {"beams.csv", io::to_csv(beam_table(runs))}};
  return report;
}

}  // namespace sphstab::study
