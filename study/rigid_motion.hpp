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

/// How the connected parts of a body can move as rigid ones: along the directions in which none of their particles is
/// clamped, and turning where none is clamped at all.
template <int Dim>
class FreeMotion {
 public:
  /// Keeps a reference. In a periodic box nothing turns.
  FreeMotion(const Body<Dim>& body, bool periodic);

  /// Whether any part can move.
  bool exists() const { return !parts_.empty(); }

  /// The velocities, or forces per mass, of particles that are now at `position`, less those that move the parts as
  /// rigid ones and fit them best, with masses as weights. Exact for a part that turns, however far it has turned.
  /// Tested in tests/study/test_rigid_motion.cpp.
  std::vector<Vector<Dim>> without(const std::vector<Vector<Dim>>& position, std::vector<Vector<Dim>> velocity) const;

 private:
  struct Part {
    std::vector<int> particles;
    Directions<Dim> moves;
    bool turns;
  };

  const Body<Dim>& body_;
  std::vector<Part> parts_;  ///< that can move
};

extern template std::vector<Vector<1>> remove_rigid_motion(const Body<1>&, std::vector<Vector<1>>);
extern template std::vector<Vector<2>> remove_rigid_motion(const Body<2>&, std::vector<Vector<2>>);
extern template std::vector<Vector<3>> remove_rigid_motion(const Body<3>&, std::vector<Vector<3>>);
extern template class FreeMotion<1>;
extern template class FreeMotion<2>;
extern template class FreeMotion<3>;

}  // namespace sphstab::study
