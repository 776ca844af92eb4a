// SPDX-License-Identifier: MIT
#pragma once

#include <variant>

#include "model/tensor.hpp"

namespace sphstab {

/// An interval, a rectangle or a cuboid along the axes.
template <int Dim>
struct Box {
  Vector<Dim> from;
  Vector<Dim> to;
};

/// A disc in 2-D.
template <int Dim>
struct Ball {
  Vector<Dim> centre;
  double radius;
};

/// What lies between two circles about a centre; a spherical shell in 3-D.
template <int Dim>
struct Annulus {
  Vector<Dim> centre;
  double inner;
  double outer;
};

/// A closed set of points: a body before it is made of particles, or a region of one.
template <int Dim>
using Shape = std::variant<Box<Dim>, Ball<Dim>, Annulus<Dim>>;

/// Throws InvalidInput naming what is wrong unless from ≤ to in every direction, radius > 0, 0 ≤ inner < outer.
template <int Dim>
void check_shape(const Shape<Dim>& shape);

/// Whether the point lies in the shape or, a length, at most `margin` outside.
template <int Dim>
bool contains(const Shape<Dim>& shape, const Vector<Dim>& point, double margin);

template <int Dim>
Box<Dim> bounding_box(const Shape<Dim>& shape);

extern template void check_shape(const Shape<1>&);
extern template bool contains(const Shape<1>&, const Vector<1>&, double);
extern template Box<1> bounding_box(const Shape<1>&);
extern template void check_shape(const Shape<2>&);
extern template bool contains(const Shape<2>&, const Vector<2>&, double);
extern template Box<2> bounding_box(const Shape<2>&);
extern template void check_shape(const Shape<3>&);
extern template bool contains(const Shape<3>&, const Vector<3>&, double);
extern template Box<3> bounding_box(const Shape<3>&);

}  // namespace sphstab
