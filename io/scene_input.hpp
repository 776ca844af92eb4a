// SPDX-License-Identifier: MIT
#pragma once

#include "model/case.hpp"
#include "model/scene.hpp"

namespace sphstab::io {

/// The keys of the scene file that the key `scene` names, those of `input` over them; `input` itself if it names none.
/// Throws InvalidInput where the file cannot be read, and for a key that does not exist.
Case with_scene_keys(const Case& input);

/// The scene of the file that `scene` names, with the keys of `input` (from with_scene_keys): its bodies, or with the
/// key `patch` a periodic patch. The tables of the file
/// are described in docs/scenes.md. Throws InvalidInput naming file, table and key for whatever is missing, unknown or
/// impossible.
template <int Dim>
Scene<Dim> read_scene(const Case& input);

extern template Scene<1> read_scene(const Case&);
extern template Scene<2> read_scene(const Case&);
extern template Scene<3> read_scene(const Case&);

}  // namespace sphstab::io
