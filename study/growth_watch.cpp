// SPDX-License-Identifier: MIT
#include "study/growth_watch.hpp"

#include "analysis/ellipticity.hpp"
#include "study/step_follower.hpp"

namespace sphstab::study {

template <int Dim>
GrowthWatch<Dim>::GrowthWatch(const Scene<Dim>& scene, const solver::FiniteStrainSimulation<Dim>& simulation,
                              Displacement start)
    : scene_(scene),
      simulation_(simulation),
      start_(std::move(start)),
      calm_(start_),
      looks_lost_(scene.body.size(), 0) {}

template <int Dim>
bool GrowthWatch<Dim>::sees_lasting_loss(const Displacement& displacement) {
  const auto lost = beyond_loss(displacement);
  const auto& pairs = scene_.body.pairs;
  for (int a = 0; a < scene_.body.size(); ++a) {
    const bool has_no_waves =
        lost[a] && std::all_of(pairs.neighbour.begin() + pairs.first[a], pairs.neighbour.begin() + pairs.first[a + 1],
                               [&lost](int b) { return lost[b] != 0; });
    looks_lost_[a] = has_no_waves ? looks_lost_[a] + 1 : 0;
  }
  return longest_loss() >= looks_of_loss;
}

template <int Dim>
bool GrowthWatch<Dim>::is_elliptic(const Displacement& displacement) const {
  const auto lost = beyond_loss(displacement);
  return std::find(lost.begin(), lost.end(), 1) == lost.end();
}

template <int Dim>
std::optional<GrowthCause> GrowthWatch<Dim>::cause(double time_step, bool is_fixed) const {
  if ((is_fixed && is_above_limit(time_step, start_)) || is_above_limit(time_step, calm_))
    return GrowthCause::time_step;
  if (longest_loss() >= looks_of_loss || !is_elliptic(calm_)) return GrowthCause::loss_of_ellipticity;
  return std::nullopt;
}

template <int Dim>
std::vector<char> GrowthWatch<Dim>::beyond_loss(const Displacement& displacement) const {
  solver::State<Dim> state(scene_.body.size());
  state.displacement = displacement;
  std::vector<char> lost;
  for (int a = 0; a < scene_.body.size(); ++a)
    lost.push_back(!analysis::is_elliptic<Dim>(scene_.problem.scheme,
                                               scene_.body.material_of(a).lame(scene_.problem.plane),
                                               simulation_.deformation_gradient(state, a)));
  return lost;
}

template <int Dim>
bool GrowthWatch<Dim>::is_above_limit(double time_step, const Displacement& displacement) const {
  if (!is_elliptic(displacement)) return false;
  const auto limit = limit_about<Dim>(scene_.problem, scene_.body, displacement);
  return limit && limit->critical_time_step && time_step > *limit->critical_time_step;
}

template class GrowthWatch<1>;
template class GrowthWatch<2>;
template class GrowthWatch<3>;

}  // namespace sphstab::study
