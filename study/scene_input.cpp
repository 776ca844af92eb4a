// SPDX-License-Identifier: MIT
#include "study/scene_input.hpp"

#include <fmt/format.h>

#include "io/case_input.hpp"
#include "io/scene_input.hpp"
#include "study/counts.hpp"
#include "study/noise.hpp"
#include "study/p_wave_speed.hpp"

namespace sphstab::study {

bool names_body(const Case& input) { return input.has("plate") || input.has("scene"); }

namespace {

template <int Dim>
Scene<Dim> make_plate(const Case& input) {
  const auto problem = make_problem<Dim>(input);
  Scene<Dim> scene{.name = "free plate",
                   .problem = problem,
                   .body = free_plate(problem, *make_size<Dim>(input, "plate")),
                   .probes = {}};
  const Vector<Dim> gravity = make_gravity<Dim>(input);
  if (!gravity.isZero(0.0)) scene.body.load.assign(scene.body.size(), gravity);
  return scene;
}

template <int Dim>
Scene<Dim> make_patch(const Case& input) {
  const auto problem = make_problem<Dim>(input);
  return make_scene(SceneDescription<Dim>{.name = "periodic patch",
                                          .problem = problem,
                                          .materials = {problem.material},
                                          .parts = {},
                                          .periodic_cells = make_size<Dim>(input, "patch"),
                                          .gravity = make_gravity<Dim>(input)});
}

template <int Dim>
Scene<Dim> named_scene(const Case& input) {
  if (input.has("scene")) {
    if (input.has("plate")) throw InvalidInput("plate: cannot be given with scene");
    return io::read_scene<Dim>(input);
  }
  if (!input.has("patch")) return make_plate<Dim>(input);
  if (input.has("plate")) throw InvalidInput("plate: cannot be given with patch");
  return make_patch<Dim>(input);
}

template <int Dim>
void require_equilibrium(const Scene<Dim>& scene) {
  if (!scene.periodic_cells && scene.problem.deformation_gradient != Tensor<Dim>::Identity())
    throw InvalidInput("deformation_gradient: a body with free surfaces takes none, it would not be in equilibrium");
  const bool stressed = scene.problem.pressure != 0.0 || !scene.problem.deviatoric_stress.isZero(0.0);
  if (stressed && !scene.periodic_cells)
    throw InvalidInput(
        fmt::format("{}: a body with free surfaces is in no equilibrium under a stress; only a periodic patch is",
                    scene.problem.pressure != 0.0 ? "pressure" : "deviatoric_stress"));
}

/// Adds velocities of which every component is uniform in ±`speed`.
template <int Dim>
void add_noise(Scene<Dim>& scene, double speed, unsigned seed) {
  const auto velocity = noise<Dim>(scene.body.size(), seed);
  scene.velocity.resize(scene.body.size(), Vector<Dim>::Zero());
  for (int a = 0; a < scene.body.size(); ++a)
    for (int i = 0; i < Dim; ++i)
      if (scene.body.clamped.empty() || !scene.body.clamped[a][i]) scene.velocity[a][i] += speed * velocity[a][i];
}

}  // namespace

template <int Dim>
Scene<Dim> make_scene(const Case& input) {
  if (!names_body(input) && !input.has("patch")) throw InvalidInput("scene: missing (or plate or patch)");
  Scene<Dim> scene = named_scene<Dim>(input);
  require_equilibrium(scene);
  if (const double speed = input.required_number("initial_noise"); speed > 0.0)
    add_noise(scene, speed * p_wave_speed(scene.problem), static_cast<unsigned>(input.required_number("noise_seed")));
  return scene;
}

Json body_name(const Case& input) {
  const char* key = input.has("scene") ? "scene" : input.has("plate") ? "plate" : "patch";
  return {{key, io::to_json(input, find_key(key))}};
}

template Scene<1> make_scene(const Case&);
template Scene<2> make_scene(const Case&);
template Scene<3> make_scene(const Case&);

}  // namespace sphstab::study
