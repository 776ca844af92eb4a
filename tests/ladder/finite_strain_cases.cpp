// SPDX-License-Identifier: MIT
#include "ladder/finite_strain_cases.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace sphstab::ladder {
namespace {

/// The part of a matrix of space that one, two or three dimensions see; a rotation is about the third axis.
template <int Dim>
Tensor<Dim> part_of(const Tensor<3>& matrix) {
  return matrix.topLeftCorner<Dim, Dim>();
}

}  // namespace

std::string describe(const Scheme& scheme) {
  return fmt::format("{} {}", name_of(scheme.formulation), name_of(scheme.elastic_law));
}

template <int Dim>
Problem<Dim> finite_strain_problem(const FiniteStrainScheme& scheme, LatticeKind lattice, KernelFamily kernel,
                                   double h_over_spacing) {
  auto problem = basic_problem<Dim>(lattice, kernel, h_over_spacing);
  problem.scheme.formulation = scheme.formulation;
  problem.scheme.elastic_law = scheme.law;
  return problem;
}

template <int Dim>
std::vector<BaseState<Dim>> base_states() {
  const Tensor<3> stretched = Vector<3>(1.4, 0.9, 1.1).asDiagonal();
  Tensor<3> sheared;
  sheared << 1.1, 0.35, -0.1, -0.15, 0.95, 0.2, 0.05, -0.1, 1.2;
  std::vector<BaseState<Dim>> states{{"at rest", Tensor<Dim>::Identity()},
                                     {"stretched", part_of<Dim>(stretched)},
                                     {"compressed", part_of<Dim>(Vector<3>(0.85, 1.0, 1.0).asDiagonal())},
                                     {"of equal stretches", 1.2 * Tensor<Dim>::Identity()}};
  if constexpr (Dim > 1) {
    const Tensor<3> turn = Eigen::AngleAxisd(2.0, Vector<3>::UnitZ()).matrix();
    states.push_back({"sheared", part_of<Dim>(sheared)});
    states.push_back({"turned", part_of<Dim>(turn * stretched)});
  }
  return states;
}

template <int Dim>
std::vector<NamedProblem<Dim>> every_finite_strain() {
  constexpr double h_over_spacing = 1.27;
  std::vector<NamedProblem<Dim>> variants;
  for (const auto& scheme : finite_strain_schemes)
    for (const auto& [state, gradient] : base_states<Dim>())
      for (const LatticeKind lattice : lattices_of(Dim))
        for (const auto kernel : {KernelFamily::wendland_c2, KernelFamily::cubic_spline, KernelFamily::sinc_5}) {
          if (kernel != KernelFamily::wendland_c2 && (Dim == 3 || lattice != lattices_of(Dim).front())) continue;
          auto problem = finite_strain_problem<Dim>(scheme, lattice, kernel, h_over_spacing);
          problem.deformation_gradient = gradient;
          variants.push_back(
              {fmt::format("{}, {} {}, {}", describe(problem.scheme), name_of(kernel), name_of(lattice), state),
               problem});
        }
  return variants;
}

template <int Dim>
std::vector<NamedProblem<Dim>> every_step(const NamedProblem<Dim>& variant) {
  std::vector<NamedProblem<Dim>> steps;
  for (const auto& [integrator, name] : total_lagrangian_integrators) {
    auto problem = variant.problem;
    problem.integrator = integrator;
    steps.push_back({fmt::format("{}, {}", variant.name, name), problem});
    problem.scheme.damping = Damping{0.4};
    steps.push_back({steps.back().name + ", damped", problem});
  }
  return steps;
}

template Problem<1> finite_strain_problem(const FiniteStrainScheme&, LatticeKind, KernelFamily, double);
template std::vector<BaseState<1>> base_states();
template std::vector<NamedProblem<1>> every_finite_strain();
template std::vector<NamedProblem<1>> every_step(const NamedProblem<1>&);
template Problem<2> finite_strain_problem(const FiniteStrainScheme&, LatticeKind, KernelFamily, double);
template std::vector<BaseState<2>> base_states();
template std::vector<NamedProblem<2>> every_finite_strain();
template std::vector<NamedProblem<2>> every_step(const NamedProblem<2>&);
template Problem<3> finite_strain_problem(const FiniteStrainScheme&, LatticeKind, KernelFamily, double);
template std::vector<BaseState<3>> base_states();
template std::vector<NamedProblem<3>> every_finite_strain();
template std::vector<NamedProblem<3>> every_step(const NamedProblem<3>&);

}  // namespace sphstab::ladder
