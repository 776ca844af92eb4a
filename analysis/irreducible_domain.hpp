// SPDX-License-Identifier: MIT
#pragma once

#include "analysis/gradient_symbol.hpp"
#include "analysis/zone_domain.hpp"
#include "model/brillouin_zone.hpp"

namespace sphstab::analysis {

/// The phases of the irreducible wedge of those symmetries R of the lattice that leave D · Q D as it is: D(Rk) = R D(k)
/// for an isotropic kernel, so those with Rᵀ Q R = Q, to a few roundings, that take every neighbour to a neighbour.
/// |D|² (Q = I) has all of them, 8 on the square and 48 on the cubic lattices. Tested in
/// tests/analysis/test_zone_domain.cpp.
template <int Dim>
ZoneDomain<Dim> irreducible_domain(const BrillouinZone<Dim>& zone, const GradientSymbol<Dim>& symbol,
                                   const Tensor<Dim>& form);

extern template ZoneDomain<1> irreducible_domain(const BrillouinZone<1>&, const GradientSymbol<1>&, const Tensor<1>&);
extern template ZoneDomain<2> irreducible_domain(const BrillouinZone<2>&, const GradientSymbol<2>&, const Tensor<2>&);
extern template ZoneDomain<3> irreducible_domain(const BrillouinZone<3>&, const GradientSymbol<3>&, const Tensor<3>&);

}  // namespace sphstab::analysis
