// SPDX-License-Identifier: MIT
#include "solver/updated_neighbours.hpp"

#include <Eigen/LU>

#include "model/body.hpp"
#include "model/lattice_index.hpp"

namespace sphstab::solver {
namespace {

/// Particles farther out than this many periods, where a run that blows up may throw them, have no neighbours.
constexpr double farthest_period = 0x1p28;

/// A particle, or an image of one, in the box.
template <int Dim>
struct Site {
  int particle;
  LatticeIndex<Dim> periods;  ///< that it was moved by from where the particle is
};

template <int Dim>
bool comes_first(const LatticeIndex<Dim>& left, const LatticeIndex<Dim>& right) {
  return std::lexicographical_compare(left.begin(), left.end(), right.begin(), right.end());
}

}  // namespace

template <int Dim>
NeighbourList<Dim>::NeighbourList(double support, const std::optional<Tensor<Dim>>& box)
    : reach_((1.0 + skin_fraction) * support), skin_(skin_fraction * support), box_(box) {}

template <int Dim>
int NeighbourList<Dim>::image_of(const LatticeIndex<Dim>& periods) {
  const auto known = std::find(periods_.begin(), periods_.end(), periods);
  if (known != periods_.end()) return static_cast<int>(known - periods_.begin());
  periods_.push_back(periods);
  shifts_.push_back(box_ ? Vector<Dim>(*box_ * periods.template cast<double>()) : Vector<Dim>::Zero());
  return static_cast<int>(shifts_.size()) - 1;
}

template <int Dim>
void NeighbourList<Dim>::build() {
  const int particles = static_cast<int>(built_at_.size());
  Field<Dim> place;
  std::vector<Site<Dim>> site;
  for (int a = 0; a < particles; ++a) {
    place.push_back(built_at_[a]);
    site.push_back({a, LatticeIndex<Dim>::Zero()});
  }
  if (box_) {
    const Tensor<Dim> inverse = box_->inverse();
    const Vector<Dim> margin = reach_ * inverse.rowwise().norm();  // the reach in periods
    for (int a = 0; a < particles; ++a) {
      const Vector<Dim> fraction = (inverse * built_at_[a]).cwiseMax(-farthest_period).cwiseMin(farthest_period);
      const LatticeIndex<Dim> home = -fraction.array().floor().template cast<int>().matrix();
      site[a].periods = home;
      place[a] += *box_ * home.template cast<double>();
      const LatticeIndex<Dim> low = (-margin - fraction).array().ceil().template cast<int>();
      const LatticeIndex<Dim> high = (Vector<Dim>::Ones() + margin - fraction).array().floor().template cast<int>();
      for_each_index<Dim>(low, high, [&](const LatticeIndex<Dim>& periods) {
        if (periods == home) return;
        place.push_back(built_at_[a] + *box_ * periods.template cast<double>());
        site.push_back({a, periods});
      });
    }
  }

  const auto pairs = find_pairs<Dim>(place, reach_);
  periods_.clear();
  shifts_.clear();
  candidates_.clear();
  first_.assign(1, 0);
  for (int a = 0; a < particles; ++a) {
    for (int pair = pairs.first[a]; pair < pairs.first[a + 1]; ++pair) {
      const auto& [b, periods] = site[pairs.neighbour[pair]];
      if (b > a) candidates_.push_back({b, image_of(periods - site[a].periods)});
    }
    std::sort(candidates_.begin() + first_[a], candidates_.end(), [&](const auto& left, const auto& right) {
      return left.particle != right.particle ? left.particle < right.particle
                                             : comes_first<Dim>(periods_[left.image], periods_[right.image]);
    });
    first_.push_back(static_cast<int>(candidates_.size()));
  }
}

template class NeighbourList<1>;
template class NeighbourList<2>;
template class NeighbourList<3>;

}  // namespace sphstab::solver
