// SPDX-License-Identifier: MIT
#include "ladder/cases.hpp"

#include <fmt/format.h>

namespace sphstab::ladder {
namespace {

constexpr double spacing = 0.37, density = 1.7, young_modulus = 2.9, poisson_ratio = 0.31;

constexpr std::array<double, 9> gradient_components{0.06, -0.03, 0.05, -0.09, 0.04, -0.02, 0.03, 0.01, -0.05};

template <int Dim>
Tensor<Dim> base_gradient() {
  return Eigen::Map<const Tensor<Dim>>(gradient_components.data());
}

}  // namespace

template <int Dim>
Problem<Dim> basic_problem(LatticeKind lattice, KernelFamily kernel, double h_over_spacing) {
  return {.lattice = Lattice<Dim>(lattice, spacing),
          .kernel = Kernel<Dim>(kernel, h_over_spacing * spacing),
          .material = Material::from_young_modulus(density, young_modulus, poisson_ratio)};
}

template <int Dim>
Tensor<Dim> consistency(const Problem<Dim>& problem) {
  Tensor<Dim> L = Tensor<Dim>::Zero();
  for (const auto& d : lattice_neighbours(problem.lattice, problem.kernel.support(), problem.neighbour_rule))
    L -= problem.lattice.cell_volume() * problem.kernel.slope(d.distance) / d.distance * d.position *
         d.position.transpose();
  return L;
}

/// Lattices without a name: a stretched one, and a skewed one whose vectors are not the shortest.
template <int Dim>
std::vector<std::pair<std::string, Lattice<Dim>>> custom_lattices() {
  Tensor<Dim> stretched = Tensor<Dim>::Identity(), skewed = Tensor<Dim>::Identity();
  for (int i = 0; i < Dim; ++i) stretched(i, i) += 0.2 * i;
  skewed(0, 0) = 1.1;
  if (Dim > 1) skewed(0, Dim - 1) = 2.5;
  return {{"stretched", Lattice<Dim>(stretched, spacing)}, {"skewed", Lattice<Dim>(skewed, spacing)}};
}

template <int Dim>
std::vector<NamedProblem<Dim>> every_variant() {
  constexpr double h_over_spacing = 1.27;
  std::vector<NamedProblem<Dim>> variants;
  for (const LatticeKind lattice : lattices_of(Dim)) {
    for (const auto& [kernel, kernel_name] : Names<KernelFamily>::table)
      if (Dim < 3 || lattice == LatticeKind::cubic || kernel == KernelFamily::wendland_c2)
        variants.push_back(
            {fmt::format("{} {}", kernel_name, name_of(lattice)), basic_problem<Dim>(lattice, kernel, h_over_spacing)});
    const Problem<Dim> plain = basic_problem<Dim>(lattice, KernelFamily::cubic_spline, h_over_spacing);
    const auto add = [&variants, &plain, lattice](std::string_view what, auto change) {
      Problem<Dim> problem = plain;
      change(problem);
      variants.push_back({fmt::format("{} {}", what, name_of(lattice)), problem});
    };
    add("nearest neighbours", [](auto& p) { p.neighbour_rule = NeighbourRule::nearest; });
    add("normalised", [](auto& p) { p.scheme.kernel_normalisation = KernelNormalisation::sum; });
    add("damped", [](auto& p) { p.scheme.damping = Damping{0.4}; });
    add("frozen density on a base state", [](auto& p) { p.displacement_gradient = base_gradient<Dim>(); });
    if (Dim == 2) add("plane stress", [](auto& p) { p.plane = Plane::stress; });
    for (const Plane plane : {Plane::strain, Plane::stress})
      if (plane == Plane::strain || Dim == 2)
        add(fmt::format("density of Eq. 6 on a base state, plane {}", name_of(plane)), [plane](auto& p) {
          p.plane = plane;
          p.displacement_gradient = base_gradient<Dim>();
          p.scheme.momentum_density = MomentumDensity::equation_of_state;
        });
    // Where compression softens the longitudinal branch below the transverse one, but not yet to an instability.
    if (Dim > 1)
      add("strong compression", [](auto& p) {
        p.displacement_gradient = (Dim == 2 ? -0.3 : -0.22) * Tensor<Dim>::Identity();
        p.scheme.momentum_density = MomentumDensity::equation_of_state;
      });
    add("everything at once", [](auto& p) {
      p.displacement_gradient = base_gradient<Dim>();
      p.scheme.momentum_density = MomentumDensity::equation_of_state;
      p.scheme.kernel_normalisation = KernelNormalisation::sum;
      p.scheme.damping = Damping{0.4};
    });
  }
  for (const auto& [name, lattice] : custom_lattices<Dim>()) {
    Problem<Dim> problem = basic_problem<Dim>(lattices_of(Dim).front(), KernelFamily::cubic_spline, h_over_spacing);
    problem.lattice = lattice;
    variants.push_back({name, problem});
    problem.displacement_gradient = base_gradient<Dim>();
    problem.scheme.momentum_density = MomentumDensity::equation_of_state;
    variants.push_back({name + " density of Eq. 6 on a base state", problem});
  }
  return variants;
}

template <>
std::vector<LatticeIndex<1>> patches() {
  return {LatticeIndex<1>(4), LatticeIndex<1>(7), LatticeIndex<1>(12)};
}
template <>
std::vector<LatticeIndex<2>> patches() {
  return {{4, 4}, {5, 3}, {6, 7}};
}
template <>
std::vector<LatticeIndex<3>> patches() {
  return {{2, 2, 2}, {3, 2, 4}};
}

template <>
LatticeIndex<1> small_patch() {
  return LatticeIndex<1>(20);
}
template <>
LatticeIndex<2> small_patch() {
  return {5, 4};
}
template <>
LatticeIndex<3> small_patch() {
  return {3, 2, 3};
}

template <>
LatticeIndex<1> running_patch() {
  return LatticeIndex<1>(31);
}
template <>
LatticeIndex<2> running_patch() {
  return {6, 5};
}
template <>
LatticeIndex<3> running_patch() {
  return {3, 4, 3};
}

std::string describe(const study::GrowthCase& found) {
  return fmt::format("{}, {}: theory {:.9f}, seeded {:+.1e}, noise {:+.1e} ± {:.1e}, growing {}", found.name,
                     name_of(found.integrator), found.theory, found.seeded - found.theory,
                     found.noise_mean - found.theory, found.noise_error, found.growing);
}

template Problem<1> basic_problem(LatticeKind, KernelFamily, double);
template Problem<2> basic_problem(LatticeKind, KernelFamily, double);
template Problem<3> basic_problem(LatticeKind, KernelFamily, double);
template Tensor<1> consistency(const Problem<1>&);
template Tensor<2> consistency(const Problem<2>&);
template Tensor<3> consistency(const Problem<3>&);
template std::vector<NamedProblem<1>> every_variant();
template std::vector<NamedProblem<2>> every_variant();
template std::vector<NamedProblem<3>> every_variant();

}  // namespace sphstab::ladder
