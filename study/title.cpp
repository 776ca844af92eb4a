// SPDX-License-Identifier: MIT
#include "study/title.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sphstab::study {
namespace {

/// What a title says of the base state; nothing of one at rest.
template <int Dim>
std::string base_state_of(const Problem<Dim>& problem) {
  std::string text;
  if (problem.scheme.momentum_density == MomentumDensity::equation_of_state &&
      !problem.displacement_gradient.isZero(0.0))
    text += ", strained";
  if (problem.pressure != 0.0) text += fmt::format(", P = {:.4g}", problem.pressure);
  if (const auto S = symmetric_components<Dim, double>(problem.deviatoric_stress); !S.isZero(0.0))
    text += fmt::format(", S = ({:.4g})", fmt::join(S.data(), S.data() + S.size(), ", "));
  if (problem.scheme.artificial_stress) text += fmt::format(", ε = {:.4g}", problem.scheme.artificial_stress->epsilon);
  return text;
}

}  // namespace

template <int Dim>
std::string title_of(const Problem<Dim>& problem) {
  return fmt::format("the {} lattice: {}, h = {:.4g} Δp{}, {}, ν = {:.4g}{}", name_of(problem.lattice.kind()),
                     name_of(problem.kernel.family()), problem.kernel.smoothing_length() / problem.lattice.spacing(),
                     problem.neighbour_rule == NeighbourRule::nearest ? ", nearest neighbours" : "",
                     name_of(problem.scheme.formulation), problem.material.poisson_ratio(), base_state_of(problem));
}

template std::string title_of(const Problem<1>&);
template std::string title_of(const Problem<2>&);
template std::string title_of(const Problem<3>&);

}  // namespace sphstab::study
