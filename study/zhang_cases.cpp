// SPDX-License-Identifier: MIT
#include "study/zhang_cases.hpp"

namespace sphstab::study::zhang {
namespace {

SceneDescription<2> scene_of_one_part(const std::string& name, const Problem<2>& problem,
                                      const Placement<2>& placement) {
  return {.name = name,
          .problem = problem,
          .materials = {problem.material},
          .parts = {ScenePart<2>{.name = name, .placement = placement}}};
}

}  // namespace

Problem<2> problem(double smoothing_length, KernelNormalisation normalisation, Plane plane, double spacing) {
  Problem<2> problem{.lattice = Lattice<2>(LatticeKind::square, spacing),
                     .kernel = Kernel<2>(KernelFamily::gaussian, smoothing_length, gaussian_cutoff),
                     .material = material(),
                     .plane = plane};
  problem.scheme.kernel_normalisation = normalisation;
  return problem;
}

SceneDescription<2> stretched_plate(const Problem<2>& problem, double load) {
  const Placement<2> placement{.shape = Box<2>{{0.0, 0.0}, {side, side}}};
  SceneDescription<2> scene = scene_of_one_part("plate", problem, placement);
  Tensor<2> gradient = Tensor<2>::Zero();
  gradient(0, 1) = load * load_gradient;
  const double column = problem.lattice.spacing();
  const Vector<2> top_left(0.0, side);
  scene.tractions = {
      {Box<2>{{0.0, 0.0}, {column, side}}, AffineField<2>{Vector<2>::Zero(), gradient, top_left}},
      {Box<2>{{side - column, 0.0}, {side, side}}, AffineField<2>{Vector<2>::Zero(), -gradient, top_left}}};
  return scene;
}

SceneDescription<2> sheared_annulus(const Problem<2>& problem, int rings, int sectors) {
  const Vector<2> centre = Vector<2>::Zero();
  const double ring = (outer_radius - inner_radius) / rings;
  const Placement<2> placement{.shape = Annulus<2>{centre, inner_radius, outer_radius},
                               .arrangement = PolarArrangement{rings, sectors}};
  SceneDescription<2> scene = scene_of_one_part("annulus", problem, placement);
  const auto shear_at = [&](double radius, double stress) {
    return CentredTraction<2>{.centre = centre, .shear = stress, .at_radius = radius};
  };
  scene.tractions = {{Annulus<2>{centre, inner_radius, inner_radius + ring},
                      shear_at(inner_radius, -shear_load / (inner_radius * inner_radius))},
                     {Annulus<2>{centre, outer_radius - ring, outer_radius},
                      shear_at(outer_radius, shear_load / (outer_radius * outer_radius))}};
  return scene;
}

StretchedPlate plate_theory(const Problem<2>& problem, double load) {
  return {.length = side,
          .height = side,
          .load_gradient = load * load_gradient,
          .material = problem.material,
          .plane = problem.plane};
}

ShearedAnnulus annulus_theory(const Problem<2>& problem) {
  return {.shear_load = shear_load, .material = problem.material};
}

}  // namespace sphstab::study::zhang
