// SPDX-License-Identifier: MIT
#include "model/shape.hpp"

#include <fmt/format.h>

#include "model/errors.hpp"

namespace sphstab {
namespace {

template <int Dim>
void check(const Box<Dim>& box) {
  for (int axis = 0; axis < Dim; ++axis)
    if (!(box.from[axis] <= box.to[axis]))
      throw InvalidInput(
          fmt::format("box: from {} to {} along {} is empty", box.from[axis], box.to[axis], "xyz"[axis]));
}

template <int Dim>
void check(const Ball<Dim>& ball) {
  in_context("ball", [&] { require_positive("radius", ball.radius); });
}

template <int Dim>
void check(const Annulus<Dim>& annulus) {
  if (!(annulus.inner >= 0.0)) throw InvalidInput(fmt::format("annulus: inner: {} is not at least 0", annulus.inner));
  if (!(annulus.outer > annulus.inner))
    throw InvalidInput(fmt::format("annulus: outer: {} is not above inner, {}", annulus.outer, annulus.inner));
}

template <int Dim>
bool holds(const Box<Dim>& box, const Vector<Dim>& point, double margin) {
  return (point.array() >= box.from.array() - margin).all() && (point.array() <= box.to.array() + margin).all();
}

template <int Dim>
bool holds(const Ball<Dim>& ball, const Vector<Dim>& point, double margin) {
  return (point - ball.centre).norm() <= ball.radius + margin;
}

template <int Dim>
bool holds(const Annulus<Dim>& annulus, const Vector<Dim>& point, double margin) {
  const double distance = (point - annulus.centre).norm();
  return distance >= annulus.inner - margin && distance <= annulus.outer + margin;
}

template <int Dim>
Box<Dim> bounds(const Box<Dim>& box) {
  return box;
}

template <int Dim>
Box<Dim> bounds(const Ball<Dim>& ball) {
  return {ball.centre.array() - ball.radius, ball.centre.array() + ball.radius};
}

template <int Dim>
Box<Dim> bounds(const Annulus<Dim>& annulus) {
  return bounds(Ball<Dim>{annulus.centre, annulus.outer});
}

}  // namespace

template <int Dim>
void check_shape(const Shape<Dim>& shape) {
  std::visit([](const auto& kind) { check(kind); }, shape);
}

template <int Dim>
bool contains(const Shape<Dim>& shape, const Vector<Dim>& point, double margin) {
  return std::visit([&](const auto& kind) { return holds(kind, point, margin); }, shape);
}

template <int Dim>
Box<Dim> bounding_box(const Shape<Dim>& shape) {
  return std::visit([](const auto& kind) { return bounds(kind); }, shape);
}

template void check_shape(const Shape<1>&);
template bool contains(const Shape<1>&, const Vector<1>&, double);
template Box<1> bounding_box(const Shape<1>&);
template void check_shape(const Shape<2>&);
template bool contains(const Shape<2>&, const Vector<2>&, double);
template Box<2> bounding_box(const Shape<2>&);
template void check_shape(const Shape<3>&);
template bool contains(const Shape<3>&, const Vector<3>&, double);
template Box<3> bounding_box(const Shape<3>&);

}  // namespace sphstab
