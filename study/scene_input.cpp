// SPDX-License-Identifier: MIT
#include "study/scene_input.hpp"

#include "io/case_input.hpp"
#include "io/scene_input.hpp"
#include "study/counts.hpp"

namespace sphstab::study {

bool names_body(const Case& input) { return input.has("plate") || input.has("scene"); }

template <int Dim>
Scene<Dim> make_scene(const Case& input) {
  if (!names_body(input)) throw InvalidInput("scene: missing (or plate)");
  if (const auto name = input.word("scheme")) {
    Scheme scheme;
    scheme.formulation = from_name<Formulation>("scheme", *name);
    require_total_lagrangian(scheme, "a plate or scene");
  }
  if (input.has("scene")) {
    if (input.has("plate")) throw InvalidInput("plate: cannot be given with scene");
    return io::read_scene<Dim>(input);
  }
  const auto counts = make_size<Dim>(input, "plate");
  const auto problem = make_problem<Dim>(input);
  Scene<Dim> scene{.name = "free plate", .problem = problem, .body = free_plate(problem, *counts), .probes = {}};
  const Vector<Dim> gravity = make_gravity<Dim>(input);
  if (!gravity.isZero(0.0)) scene.body.load.assign(scene.body.size(), gravity);
  return scene;
}

Json body_name(const Case& input) {
  const char* key = input.has("scene") ? "scene" : "plate";
  return {{key, io::to_json(input, find_key(key))}};
}

template Scene<1> make_scene(const Case&);
template Scene<2> make_scene(const Case&);
template Scene<3> make_scene(const Case&);

}  // namespace sphstab::study
