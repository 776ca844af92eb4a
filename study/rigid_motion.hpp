// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "model/body.hpp"

namespace sphstab::study {

/// The displacements less the translation and infinitesimal rotation t + Ω x (Ω antisymmetric) that fit them best, with
/// the particles' masses as weights: what is left has no momentum and no angular momentum. Tested in
/// tests/study/test_rigid_motion.cpp.
template <int Dim>
std::vector<Vector<Dim>> remove_rigid_motion(const Body<Dim>& body, std::vector<Vector<Dim>> displacement);

extern template std::vector<Vector<1>> remove_rigid_motion(const Body<1>&, std::vector<Vector<1>>);
extern template std::vector<Vector<2>> remove_rigid_motion(const Body<2>&, std::vector<Vector<2>>);
extern template std::vector<Vector<3>> remove_rigid_motion(const Body<3>&, std::vector<Vector<3>>);

}  // namespace sphstab::study
