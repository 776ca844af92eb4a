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
  const auto lost = without_waves(displacement);
  for (int a = 0; a < scene_.body.size(); ++a) looks_lost_[a] = lost[a] ? looks_lost_[a] + 1 : 0;
  return longest_loss() >= looks_of_loss;
}

template <int Dim>
bool GrowthWatch<Dim>::is_elliptic(const Displacement& displacement) const {
  const auto lost = without_waves(displacement);
  return std::find(lost.begin(), lost.end(), true) == lost.end();
}

template <int Dim>
bool GrowthWatch<Dim>::has_grown(double energy, double given, double time_step) const {
  if (energy <= energy_of_growth * given) return false;
  const auto limit = critical_step(calm_);
  if (!limit || time_step >= *limit) return true;
  const double part = time_step / *limit;
  return !(energy <= energy_of_growth * given / (1.0 - part * part));
}

template <int Dim>
std::optional<GrowthCause> GrowthWatch<Dim>::cause(double time_step, bool is_fixed) const {
  if ((is_fixed && is_above_limit(time_step, start_)) || is_above_limit(time_step, calm_))
    return GrowthCause::time_step;
  if (longest_loss() >= looks_of_loss || !is_elliptic(calm_)) return GrowthCause::loss_of_ellipticity;
  return std::nullopt;
}

template <int Dim>
std::vector<bool> GrowthWatch<Dim>::without_waves(const Displacement& displacement) const {
  const Problem<Dim>& problem = scene_.problem;
  const Body<Dim>& body = scene_.body;
  solver::State<Dim> state(body.size());
  state.displacement = displacement;
  std::vector<bool> beyond;
  for (int a = 0; a < body.size(); ++a)
    beyond.push_back(!analysis::is_elliptic<Dim>(problem.scheme, body.material_of(a).lame(problem.plane),
                                                 simulation_.deformation_gradient(state, a)));
  std::vector<bool> lost = beyond;
  for (int a = 0; a < body.size(); ++a)
    for (int p = body.pairs.first[a]; p < body.pairs.first[a + 1]; ++p)
      if (!beyond[body.pairs.neighbour[p]]) lost[a] = false;
  return lost;
}

template <int Dim>
std::optional<double> GrowthWatch<Dim>::critical_step(const Displacement& displacement) const {
  if (!is_elliptic(displacement)) return std::nullopt;
  const auto limit = limit_about<Dim>(scene_.problem, scene_.body, displacement);
  return limit ? limit->critical_time_step : std::nullopt;
}

template <int Dim>
bool GrowthWatch<Dim>::is_above_limit(double time_step, const Displacement& displacement) const {
  const auto limit = critical_step(displacement);
  return limit && time_step > *limit;
}

template class GrowthWatch<1>;
template class GrowthWatch<2>;
template class GrowthWatch<3>;

}  // namespace sphstab::study
