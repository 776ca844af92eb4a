// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ladder/cases.hpp"

/// What theory and running solver of finite strain are confronted with.
namespace sphstab::ladder {

struct FiniteStrainScheme {
  Formulation formulation;
  ElasticLaw law;
};

inline constexpr std::array finite_strain_schemes{
    FiniteStrainScheme{Formulation::total_lagrangian_corotated, ElasticLaw::saint_venant_kirchhoff},
    FiniteStrainScheme{Formulation::total_lagrangian_pk1, ElasticLaw::saint_venant_kirchhoff},
    FiniteStrainScheme{Formulation::total_lagrangian_pk1, ElasticLaw::neo_hookean}};

/// "tl-pk1 neo-hookean".
std::string describe(const Scheme& scheme);

/// `basic_problem` with such a scheme.
template <int Dim>
Problem<Dim> finite_strain_problem(const FiniteStrainScheme& scheme, LatticeKind lattice, KernelFamily kernel,
                                   double h_over_spacing);

/// A uniform deformation F0 that every scheme bears without growth.
template <int Dim>
struct BaseState {
  std::string name;
  Tensor<Dim> gradient;
};

/// At rest, stretched, compressed along one axis, of equal stretches, sheared, and stretched and turned by 2 rad.
template <int Dim>
std::vector<BaseState<Dim>> base_states();

/// Every scheme on every lattice in every base state, with one kernel, on the chain and the square lattice with three.
template <int Dim>
std::vector<NamedProblem<Dim>> every_finite_strain();

/// Every integrator without damping and with it.
template <int Dim>
std::vector<NamedProblem<Dim>> every_step(const NamedProblem<Dim>& variant);

}  // namespace sphstab::ladder
