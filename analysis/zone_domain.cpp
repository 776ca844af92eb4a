// SPDX-License-Identifier: MIT
#include "analysis/zone_domain.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "model/lattice_index.hpp"

namespace sphstab::analysis {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;
/// Rounding of phases of order π and of the walls of a domain: what lies outside by less still counts as inside.
constexpr double slack = 1e-12;
/// Images closer than this are one.
constexpr double same_image = 1e-9;

}  // namespace

template <int Dim>
std::array<PhaseBox<Dim>, 1u << Dim> PhaseBox<Dim>::children() const {
  std::array<PhaseBox, 1u << Dim> boxes;
  for (unsigned corner = 0; corner < boxes.size(); ++corner) {
    boxes[corner] = {centre, 0.5 * half_width};
    for (int axis = 0; axis < Dim; ++axis)
      boxes[corner].centre[axis] += (corner >> axis & 1u ? 0.5 : -0.5) * half_width;
  }
  return boxes;
}

template <int Dim>
ZoneDomain<Dim>::ZoneDomain()
    : low_(Vector<Dim>::Zero()),
      high_(Vector<Dim>::Constant(turn)),
      group_{Tensor<Dim>::Identity(), -Tensor<Dim>::Identity()} {
  high_[Dim - 1] = std::numbers::pi;
  for (int axis = 0; axis < Dim; ++axis)
    for (const double sign : {1.0, -1.0})
      half_spaces_.push_back({sign * Vector<Dim>::Unit(axis), sign > 0.0 ? high_[axis] : -low_[axis]});
}

template <int Dim>
ZoneDomain<Dim>::ZoneDomain(std::vector<PhaseHalfSpace<Dim>> half_spaces, const Vector<Dim>& low,
                            const Vector<Dim>& high, std::vector<Tensor<Dim>> group)
    : half_spaces_(std::move(half_spaces)), low_(low), high_(high), group_(std::move(group)) {}

template <int Dim>
bool ZoneDomain<Dim>::touches(const PhaseBox<Dim>& box) const {
  return std::all_of(half_spaces_.begin(), half_spaces_.end(), [&](const PhaseHalfSpace<Dim>& half) {
    const double reach = half.normal.template lpNorm<1>();
    return half.normal.dot(box.centre) <= half.offset + reach * (box.half_width + slack);
  });
}

template <int Dim>
bool ZoneDomain<Dim>::touches(const Vector<Dim>& centre, double radius) const {
  return std::all_of(half_spaces_.begin(), half_spaces_.end(), [&](const PhaseHalfSpace<Dim>& half) {
    return half.normal.dot(centre) <= half.offset + half.normal.norm() * (radius + slack);
  });
}

template <int Dim>
std::vector<Vector<Dim>> ZoneDomain<Dim>::images(const Vector<Dim>& centre, double radius) const {
  std::vector<Vector<Dim>> found;
  for (const auto& map : group_) {
    const Vector<Dim> image = map * centre;
    const LatticeIndex<Dim> first = ((low_ - image).array() / turn - radius / turn).ceil().template cast<int>();
    const LatticeIndex<Dim> last = ((high_ - image).array() / turn + radius / turn).floor().template cast<int>();
    for_each_index<Dim>(first, last, [&](const LatticeIndex<Dim>& n) {
      const Vector<Dim> shifted = image + turn * n.template cast<double>();
      const auto same = [&](const Vector<Dim>& other) { return (other - shifted).norm() < same_image; };
      if (touches(shifted, radius) && std::none_of(found.begin(), found.end(), same)) found.push_back(shifted);
    });
  }
  return found;
}

template <int Dim>
Vector<Dim> wrapped(const Vector<Dim>& phases) {
  Vector<Dim> result = phases;
  for (int axis = 0; axis < Dim; ++axis) result[axis] -= turn * std::floor(result[axis] / turn + 0.5);
  return result;
}

template struct PhaseBox<1>;
template class ZoneDomain<1>;
template Vector<1> wrapped<1>(const Vector<1>&);
template struct PhaseBox<2>;
template class ZoneDomain<2>;
template Vector<2> wrapped<2>(const Vector<2>&);
template struct PhaseBox<3>;
template class ZoneDomain<3>;
template Vector<3> wrapped<3>(const Vector<3>&);

}  // namespace sphstab::analysis
