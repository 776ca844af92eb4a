// SPDX-License-Identifier: MIT
#pragma once

#include "model/scene.hpp"
#include "study/request.hpp"

namespace sphstab::study {

/// Whether the case names a whole body: by `plate` or by `scene`.
bool names_body(const Case& input);

/// What the case names, with its problem: a free plate, a periodic patch, or the scene of the file (its keys are in
/// `input` already, io::with_scene_keys), which may be a patch. `initial_noise` adds to the velocities of all particles
/// that are not held. Throws InvalidInput if the case names nothing, or two of them; where a body with
/// free surfaces has a base state in which it is in no equilibrium (`pressure` of `ul`, `deformation_gradient`); and
/// for whatever else is wrong. Tested in tests/study/test_scene_input.cpp.
template <int Dim>
Scene<Dim> make_scene(const Case& input);

/// How a result says which body it is of: the key that named it, with its value.
Json body_name(const Case& input);

extern template Scene<1> make_scene(const Case&);
extern template Scene<2> make_scene(const Case&);
extern template Scene<3> make_scene(const Case&);

}  // namespace sphstab::study
