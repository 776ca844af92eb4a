// SPDX-License-Identifier: MIT
#include "study/beams.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "analysis/spectrum.hpp"
#include "study/bonds.hpp"
#include "study/relaxation.hpp"
#include "study/step_comparison.hpp"

namespace sphstab::study::beams {
namespace {

/// Of the paper: the kernel, h and the terms of its CCBWAT-SPH.
constexpr KernelFamily kernel = KernelFamily::sinc_5;
constexpr double h_over_spacing = 1.2;
constexpr ArtificialStress artificial_stress{.epsilon = 0.3, .exponent = 6.0};
constexpr Viscosity viscosity{.alpha = 1.0, .eta = 0.1, .pairs = ViscousPairs::approaching};

/// Columns of held particles: more than the support of 2.4 spacings.
constexpr double held_columns = 3.0;

constexpr double cylinder_radius = 0.05, bar_height = 0.02, bar_density = 1000.0, bar_poisson_ratio = 0.4,
                 bar_gravity = 2.0;

/// Particles that a point is read from, in spacings.
constexpr double reading_radius = 2.3;

/// Of the critical step, relative: no bound is proven, which would take longer than the run.
constexpr double step_tolerance = 1e-6;

/// Of `ul`, whose limit falls in compression: at a half a beam under 3 % of it breaks, at a quarter and less none does.
constexpr double updated_fraction = 0.25;
constexpr long most_resting_steps = 3'000'000;

Problem<2> problem_of(double spacing, const Material& material, const Method& method) {
  return {.lattice = Lattice<2>(LatticeKind::square, spacing),
          .kernel = Kernel<2>(kernel, h_over_spacing * spacing),
          .material = material,
          .scheme = method.scheme,
          .integrator = method.integrator};
}

SceneDescription<2> scene_of(const char* name, const Problem<2>& problem) {
  return {.name = name, .problem = problem, .materials = {problem.material}, .parts = {}};
}

void add_box(SceneDescription<2>& scene, const Box<2>& box) {
  Placement<2> placement;
  placement.shape = box;
  scene.parts.push_back({"beam", placement});
}

}  // namespace

std::vector<Method> methods() {
  const auto method = [](std::string_view name, Formulation formulation) {
    Scheme scheme;
    scheme.formulation = formulation;
    return Method{name, scheme, Integrator::leapfrog};
  };
  Method with_stress = method("ul, artificial stress", Formulation::updated_lagrangian);
  with_stress.scheme.artificial_stress = artificial_stress;
  with_stress.scheme.viscosity = viscosity;
  return {method("tl-corotated", Formulation::total_lagrangian_corotated),
          method("tl-pk1", Formulation::total_lagrangian_pk1), method("ul", Formulation::updated_lagrangian),
          with_stress};
}

Beam cantilever(double force, double spacing) {
  return {.height = 0.02, .young_modulus = 20e6, .force_x = 0.0, .force_y = -force, .spacing = spacing};
}

Beam truss(double force, double spacing) {
  return {.height = 0.05, .young_modulus = 2e6, .force_x = force, .force_y = 0.0, .spacing = spacing};
}

SceneDescription<2> beam_scene(const Beam& beam, const Method& method) {
  const auto material = Material::from_young_modulus(beam_density, beam.young_modulus, beam.poisson_ratio);
  auto scene = scene_of("beam", problem_of(beam.spacing, material, method));
  const auto columns = [&](double from, double to) { return Box<2>{{from, 0.0}, {to, beam.height}}; };
  const auto push = [&](const Box<2>& region, double x, double y) {
    scene.tractions.push_back({region, TotalForce<2>{{x, y}}});
  };
  push(columns(beam.length - beam.spacing, beam.length), beam.force_x, beam.force_y);
  if (beam.support == Support::clamp) {
    const double held = held_columns * beam.spacing;
    add_box(scene, columns(-held, beam.length));
    scene.clamps = {{columns(-held, 0.0), Directions<2>::Constant(true)}};
  } else {
    add_box(scene, columns(-beam.length, beam.length));
    push(columns(-beam.length, beam.spacing - beam.length), -beam.force_x, beam.force_y);
    push(columns(-beam.spacing, beam.spacing), 0.0, -2.0 * beam.force_y);
  }
  return scene;
}

SceneDescription<2> bar_scene(const Bar& bar, const Method& method) {
  const double nu = bar_poisson_ratio;
  const auto material = Material::from_young_modulus(bar_density, 2.0 * bar.shear_modulus * (1.0 + nu), nu);
  auto scene = scene_of("turek-hron", problem_of(bar.spacing, material, method));
  const Vector<2> centre{0.2, bar_end[1]};
  // From as many whole cells before the end as reach into the cylinder by the support.
  const double into = cylinder_radius - held_columns * bar.spacing - bar.spacing;
  const double length = std::ceil((bar_end[0] - centre[0] - into) / bar.spacing) * bar.spacing;
  add_box(scene, {{bar_end[0] - length, bar_end[1] - 0.5 * bar_height}, {bar_end[0], bar_end[1] + 0.5 * bar_height}});
  scene.clamps = {{Ball<2>{centre, cylinder_radius}, Directions<2>::Constant(true)}};
  scene.gravity = {0.0, -bar_gravity};
  return scene;
}

Vector<2> PointReading::operator()(const std::vector<Vector<2>>& displacement) const {
  Vector<2> sum = Vector<2>::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) sum += weights[i] * displacement[particles[i]];
  return sum;
}

PointReading reading_at(const Scene<2>& scene, const Vector<2>& point) {
  const double radius = reading_radius * scene.problem.lattice.spacing();
  PointReading reading;
  for (int a = 0; a < scene.body.size(); ++a)
    if ((scene.body.position[a] - point).norm() < radius) reading.particles.push_back(a);
  if (reading.particles.size() < 3) throw InvalidInput("position: fewer than three particles are near it");
  Eigen::MatrixX3d terms(reading.particles.size(), 3);
  for (std::size_t i = 0; i < reading.particles.size(); ++i)
    terms.row(i) << 1.0, ((scene.body.position[reading.particles[i]] - point) / radius).transpose();
  const Eigen::VectorXd weights = (terms.transpose() * terms).ldlt().solve(terms.transpose()).row(0);
  reading.weights.assign(weights.begin(), weights.end());
  return reading;
}

double step_of(const Scene<2>& scene, double fraction) {
  if (is_total_lagrangian(scene.problem.scheme.formulation))
    return fraction * analysis::body_limit(scene.problem, scene.body,
                                           {.bound = analysis::BoundKind::norm_bound, .tolerance = step_tolerance})
                          .critical_time_step;
  Problem<2> problem = scene.problem;
  if (problem.scheme.viscosity) problem.scheme.viscosity->pairs = ViscousPairs::all;  // has a theory, and a lower limit
  return fraction * *bulk_step(problem);
}

Rest rest_of(const Scene<2>& scene, double tolerance, double fraction) {
  const bool updated = !is_total_lagrangian(scene.problem.scheme.formulation);
  const double time_step = step_of(scene, updated ? std::min(fraction, updated_fraction) : fraction);
  const Bonds bonds(scene);
  Rest rest{.converged = false, .displacement = {}, .steps = 0, .time_step = time_step, .is_broken = false};
  const auto found = relax<2>(scene.problem, scene.body,
                              {.time_step = time_step, .tolerance = tolerance, .largest_steps = most_resting_steps},
                              [&](const std::vector<Vector<2>>& displacement) {
                                return rest.is_broken = bonds.first_parted(displacement, broken_gap).has_value();
                              });
  rest.converged = found.converged;
  rest.displacement = found.displacement;
  rest.steps = found.steps;
  return rest;
}

}  // namespace sphstab::study::beams
