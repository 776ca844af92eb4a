// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/growth.hpp"
#include "io/document.hpp"
#include "study/noise.hpp"
#include "study/parallel.hpp"
#include "study/particle_pictures.hpp"
#include "study/report.hpp"
#include "study/scene_run.hpp"

namespace sphstab::study {
namespace {

/// The paper gives neither the pressure nor the shear modulus nor the number of particles.
constexpr int side = 20;
constexpr double pressure = 0.05;
constexpr double shear_modulus = 0.3;
constexpr double xsph = 0.5;
/// Δt c0/h, and the random velocities at the start in c0.
constexpr double courant_number = 0.25;
constexpr double noise_speed = 1e-6;
constexpr long steps = 10000;
/// Distances of neighbours: the square lattice has 4 closer than this, the face-centred one 2 at 1 and 4 at 1.118 Δp.
constexpr double close = 1.28;

Problem<2> array_problem(double h_over_spacing, double alpha, LatticeKind lattice = LatticeKind::square) {
  Scheme scheme{.formulation = Formulation::updated_lagrangian, .xsph = Xsph{xsph}};
  if (alpha > 0.0) scheme.viscosity = Viscosity{alpha, 0.1};
  return {.lattice = Lattice<2>(lattice, 1.0),
          .kernel = Kernel<2>(KernelFamily::cubic_spline, h_over_spacing),
          .material = Material::from_sound_speed(1.0, 1.0, shear_modulus),
          .scheme = scheme,
          .integrator = Integrator::leapfrog,
          .pressure = pressure};
}

/// A compressed array and what has become of it.
struct Array {
  double h_over_spacing;
  double alpha;
  std::vector<Vector<2>> displacement = {};
  double kinetic_energy = 0.0;          ///< a particle
  std::array<int, 12> neighbours = {};  ///< particles by the number of close neighbours

  int with(int count) const { return neighbours[count]; }
};

Scene<2> array_scene(const Problem<2>& problem) {
  const LatticeIndex<2> cells(side, side);
  Scene<2> scene{.name = "array", .problem = problem, .body = periodic_patch(problem, cells), .probes = {}};
  scene.periodic_cells = cells;
  Vector<2> sum = Vector<2>::Zero();
  for (const auto& v : noise<2>(scene.body.size(), 1)) {
    scene.velocity.push_back(noise_speed * v);
    sum += scene.velocity.back();
  }
  for (auto& v : scene.velocity) v -= sum / scene.body.size();  // the array stays where it is
  return scene;
}

/// Apart, by way of the nearest image.
double distance(const Vector<2>& a, const Vector<2>& b) {
  const Vector<2> apart = a - b;
  return (apart.array() - side * (apart / side).array().round()).matrix().norm();
}

void run(Array& array) {
  const Scene<2> scene = array_scene(array_problem(array.h_over_spacing, array.alpha));
  const double time_step = courant_number * array.h_over_spacing;
  const auto result = run_scene(scene, {.time_step = time_step, .duration = time_step * steps});
  array.displacement = result.last.displacement;
  array.kinetic_energy = result.summary.kinetic_energy / scene.body.size();
  std::vector<Vector<2>> position;
  for (int a = 0; a < scene.body.size(); ++a) position.push_back(scene.body.position[a] + array.displacement[a]);
  for (const auto& x : position) {
    const auto is_close = [&](const Vector<2>& y) { return distance(x, y) < close; };
    const auto count = std::count_if(position.begin(), position.end(), is_close) - 1;  // not itself
    ++array.neighbours[std::min<std::size_t>(count, array.neighbours.size() - 1)];
  }
}

/// Inside the box.
io::ParticlePanel panel(std::string title, const Body<2>& body, const std::vector<Vector<2>>& displacement) {
  io::ParticlePanel panel{.title = std::move(title), .positions = {}};
  for (int a = 0; a < body.size(); ++a) {
    const Vector<2> x = body.position[a] + displacement[a];
    const Vector<2> folded = x.array() - side * (x.array() / side).floor();
    panel.positions.emplace_back(folded[0], folded[1]);
  }
  return panel;
}

/// Growth rates of the lattices in this compression.
double growth(double h_over_spacing, LatticeKind lattice) {
  return analysis::growth_range(array_problem(h_over_spacing, 0.0, lattice)).growth_rate;
}

std::vector<std::string> failures_of(const std::vector<Array>& arrays) {
  std::vector<std::string> failures;
  constexpr int all = side * side;
  for (const Array& array : arrays) {
    const std::string name = fmt::format("h = {} Δp, α = {}", array.h_over_spacing, array.alpha);
    if (array.h_over_spacing == 1.0 && array.with(6) != all)
      failures.push_back(fmt::format("{}: {} of {} particles are face-centred", name, array.with(6), all));
    if (array.h_over_spacing > 1.0 && array.with(4) + array.with(6) > all / 2)
      failures.push_back(fmt::format("{}: the array is as regular as with h = Δp", name));
  }
  return failures;
}

}  // namespace

Report gray_array_report(const Progress& progress) {
  std::vector<Array> arrays;
  for (const double alpha : {0.5, 0.0})
    for (const double ratio : {1.0, 1.5}) arrays.push_back({ratio, alpha});
  std::vector<std::function<void()>> work;
  for (Array& array : arrays) work.push_back([&array] { run(array); });
  run_all(work, progress);

  const Body<2> body = array_scene(array_problem(1.0, 0.0)).body;
  io::ParticleFigure figure{
      .title = fmt::format("P = {} ρ0 c0², μ = {}, {} steps", pressure, shear_modulus, steps),
      .x_label = "x / Δp",
      .y_label = "y / Δp",
      .value_label = "",
      .radius = 0.3,
      .panels = {panel("at the start", body, std::vector<Vector<2>>(body.size(), Vector<2>::Zero()))},
      .columns = 3};
  io::Table table{{"h/Δp", "α", "growth rate of the square lattice", "of the face-centred one",
                   "particles with 4 close neighbours", "with 6", "kinetic energy a particle"},
                  {}};
  for (const Array& array : arrays) {
    const std::string title = fmt::format("h = {} Δp, α = {}", array.h_over_spacing, array.alpha);
    figure.panels.push_back(panel(title, body, array.displacement));
    table.rows.push_back({fmt::format("{}", array.h_over_spacing), fmt::format("{}", array.alpha),
                          fmt::format("{:.4f}", growth(array.h_over_spacing, LatticeKind::square)),
                          fmt::format("{:.4f}", growth(array.h_over_spacing, LatticeKind::staggered)),
                          fmt::format("{}", array.with(4)), fmt::format("{}", array.with(6)),
                          fmt::format("{:.1e}", array.kinetic_energy)});
  }
  Report report;
  report.failures = failures_of(arrays);
  report.summary = fmt::format(
      "Fig. 1 and conclusion 4 of Gray, Monaghan & Swift: {0} × {0} particles on the square lattice in a periodic "
      "box, positive pressure,\nno deviatoric stress, after {1} steps of 0.25 h/c0. Not given by the paper: P = {2} "
      "ρ0 c0², μ = {3}, noise of {4} c0, XSPH {5},\nviscosity α. Rates, in c0/Δp, are those of theory (`sphstab "
      "growth`), without viscosity. In the face-centred array a particle has two\nneighbours at Δp and four at 1.118 "
      "Δp.\n\n"
      "{6}\nWith h = Δp and viscosity the square array becomes the face-centred one and rests there, as the paper "
      "says; without, it oscillates\nabout it. Theory says why: in compression the square lattice has a transverse "
      "mode at (π/Δp, 0) that grows, the face-centred one none.\nWith h = 1.5 Δp both grow.\n",
      side, steps, pressure, shear_modulus, noise_speed, xsph, io::to_markdown(table));
  report.files = {{"README.md", "# A compressed array finds a stable lattice, or none\n\n" + report.summary +
                                    "\n![the arrays before and after](array.svg)\n\nRegenerate with `sphstab "
                                    "report gray-array --overwrite`.\n"},
                  {"array.csv", io::to_csv(table)},
                  {"array.svg", io::render_svg(figure)}};
  return report;
}

}  // namespace sphstab::study
