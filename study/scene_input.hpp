// SPDX-License-Identifier: MIT
#pragma once

#include "model/scene.hpp"
#include "study/request.hpp"

namespace sphstab::study {

/// Whether the case names a whole body: by `plate` or by `scene`.
bool names_body(const Case& input);

/// That body with its problem: a free plate, or the scene of the file (its keys are in `input` already,
/// io::with_scene_keys). Throws InvalidInput if the case names none, or both, and for whatever is wrong with it.
template <int Dim>
Scene<Dim> make_scene(const Case& input);

/// How a result says which body it is of: the key that named it, with its value.
Json body_name(const Case& input);

extern template Scene<1> make_scene(const Case&);
extern template Scene<2> make_scene(const Case&);
extern template Scene<3> make_scene(const Case&);

}  // namespace sphstab::study
