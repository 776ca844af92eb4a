// SPDX-License-Identifier: MIT
#include "ladder/cases.hpp"

#include <fmt/format.h>

namespace sphstab::ladder {
namespace {

constexpr double spacing = 0.37, density = 1.7, young_modulus = 2.9, poisson_ratio = 0.31;

Tensor<2> base_gradient() {
  Tensor<2> H;
  H << 0.06, -0.03, 0.05, -0.09;
  return H;
}

}  // namespace

Problem<2> basic_problem(LatticeKind lattice, KernelFamily kernel, double h_over_spacing) {
  return {.lattice = Lattice<2>(lattice, spacing),
          .kernel = Kernel<2>(kernel, h_over_spacing * spacing),
          .material = Material::from_young_modulus(density, young_modulus, poisson_ratio)};
}

std::vector<NamedProblem> every_variant() {
  constexpr double h_over_spacing = 1.27;
  std::vector<NamedProblem> variants;
  for (const auto& [lattice, lattice_name] : Names<LatticeKind>::table) {
    for (const auto& [kernel, kernel_name] : Names<KernelFamily>::table)
      variants.push_back(
          {fmt::format("{} {}", kernel_name, lattice_name), basic_problem(lattice, kernel, h_over_spacing)});
    const auto add = [&variants, kind = lattice, name = lattice_name](std::string_view what, auto change) {
      Problem<2> problem = basic_problem(kind, KernelFamily::cubic_spline, h_over_spacing);
      change(problem);
      variants.push_back({fmt::format("{} {}", what, name), problem});
    };
    add("plane stress", [](auto& p) { p.plane = Plane::stress; });
    add("nearest neighbours", [](auto& p) { p.neighbour_rule = NeighbourRule::nearest; });
    add("normalised", [](auto& p) { p.scheme.kernel_normalisation = KernelNormalisation::sum; });
    add("damped", [](auto& p) { p.scheme.damping = Damping{0.4}; });
    add("frozen density on a base state", [](auto& p) { p.displacement_gradient = base_gradient(); });
    for (const Plane plane : {Plane::strain, Plane::stress})
      add(fmt::format("density of Eq. 6 on a base state, plane {}", name_of(plane)), [plane](auto& p) {
        p.plane = plane;
        p.displacement_gradient = base_gradient();
        p.scheme.momentum_density = MomentumDensity::equation_of_state;
      });
    // Where compression softens the longitudinal branch below the transverse one, but not yet to an instability.
    add("strong compression", [](auto& p) {
      p.displacement_gradient = -0.3 * Tensor<2>::Identity();
      p.scheme.momentum_density = MomentumDensity::equation_of_state;
    });
    add("everything at once", [](auto& p) {
      p.displacement_gradient = base_gradient();
      p.scheme.momentum_density = MomentumDensity::equation_of_state;
      p.scheme.kernel_normalisation = KernelNormalisation::sum;
      p.scheme.damping = Damping{0.4};
    });
  }
  return variants;
}

}  // namespace sphstab::ladder
