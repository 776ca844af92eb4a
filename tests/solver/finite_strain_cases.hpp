// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "solver/bodies.hpp"
#include "solver/finite_strain_simulation.hpp"

/// Schemes, deformations and states of finite strain that several tests share.
namespace sphstab::solver::test {

inline const Scheme corotated{.formulation = Formulation::total_lagrangian_corotated};
inline const Scheme pk1{.formulation = Formulation::total_lagrangian_pk1};
inline const Scheme neo_hookean{.formulation = Formulation::total_lagrangian_pk1,
                                .elastic_law = ElasticLaw::neo_hookean};
inline const std::vector<Scheme> finite_strain_schemes{corotated, pk1, neo_hookean};

inline std::string describe(const Scheme& scheme) {
  return std::string(name_of(scheme.formulation)) + ", " + std::string(name_of(scheme.elastic_law));
}

template <int Dim>
inline constexpr LatticeKind plain_lattice = Dim == 1   ? LatticeKind::chain
                                             : Dim == 2 ? LatticeKind::square
                                                        : LatticeKind::cubic;

template <int Dim>
Problem<Dim> finite_strain_problem(const Scheme& scheme) {
  Problem<Dim> problem = problem_in<Dim>(plain_lattice<Dim>);
  problem.scheme = scheme;
  return problem;
}

/// By `angle` about no axis of the lattice; one dimension has no rotations.
template <int Dim>
Tensor<Dim> turn(double angle) {
  if constexpr (Dim == 1) return Tensor<1>::Identity();
  if constexpr (Dim == 2) return Eigen::Rotation2D<double>(angle).toRotationMatrix();
  if constexpr (Dim == 3)
    return Eigen::AngleAxis<double>(angle, Vector<3>(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
}

/// Symmetric, with principal stretches between 0.7 and 1.4.
template <int Dim>
Tensor<Dim> stretch() {
  return (Tensor<3>() << 1.3, 0.1, -0.05, 0.1, 0.8, 0.02, -0.05, 0.02, 0.9).finished().topLeftCorner<Dim, Dim>();
}

/// A deformation far from rest: turned by 2 and stretched.
template <int Dim>
Tensor<Dim> large_deformation() {
  return turn<Dim>(2.0) * stretch<Dim>();
}

/// `state`, carried along by x → A x + (F0 − A F0) X: a particle is then at A x of where it was, and velocities turn
/// too.
template <int Dim>
State<Dim> carried(const Problem<Dim>& problem, const Body<Dim>& body, State<Dim> state, const Tensor<Dim>& A) {
  const auto& F0 = problem.deformation_gradient;
  for (int a = 0; a < body.size(); ++a) {
    const Vector<Dim> x = F0 * body.position[a] + state.displacement[a];
    state.displacement[a] = A * x - F0 * body.position[a];
    state.velocity[a] = A * state.velocity[a];
  }
  return state;
}

template <int Dim>
Field<Dim> accelerations_of(TotalLagrangian<Dim>& simulation, const State<Dim>& state) {
  Field<Dim> acceleration(simulation.particles());
  simulation.accelerations(state, acceleration);
  return acceleration;
}

template <int Dim>
Field<Dim> accelerations_of(const Problem<Dim>& problem, const Body<Dim>& body, const State<Dim>& state) {
  FiniteStrainSimulation<Dim> simulation(problem, body);
  return accelerations_of<Dim>(simulation, state);
}

/// A stress of this size, differing from particle to particle, gives forces of this size.
template <int Dim>
double force_scale(const Body<Dim>& body) {
  double modulus = 0.0;
  for (const auto& material : body.materials) modulus = std::max(modulus, material.p_wave_modulus());
  return modulus / spacing;
}

}  // namespace sphstab::solver::test
