// SPDX-License-Identifier: MIT
#include "analysis/sine_series.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sphstab::analysis {
namespace {

/// cos + i sin of an angle; std::complex would test every product for NaN.
struct Rotation {
  double cosine;
  double sine;

  Rotation operator*(const Rotation& other) const {
    return {cosine * other.cosine - sine * other.sine, cosine * other.sine + sine * other.cosine};
  }
};

template <int Dim>
double largest_eigenvalue(const Tensor<Dim>& symmetric) {
  Eigen::SelfAdjointEigenSolver<Tensor<Dim>> solver;
  return solver.computeDirect(symmetric, Eigen::EigenvaluesOnly).eigenvalues()[Dim - 1];
}

}  // namespace

template <int Dim>
SineSeries<Dim>::SineSeries(std::vector<SineTerm<Dim>> terms, double coefficient_error) : terms_(std::move(terms)) {
  reach_.setZero();
  double weights = 0.0;
  for (const auto& term : terms_) {
    reach_ = reach_.cwiseMax(term.frequency.cwiseAbs());
    type_ = std::max(type_, static_cast<double>(term.frequency.cwiseAbs().sum()));
    euclidean_type_ = std::max(euclidean_type_, term.frequency.template cast<double>().norm());
    weights += term.coefficient.norm();
  }
  for (int order = 1; order <= 3; ++order) {
    Tensor<Dim> of_w = Tensor<Dim>::Zero(), of_n = Tensor<Dim>::Zero();
    for (const auto& [frequency, w] : terms_) {
      const Vector<Dim> n = frequency.template cast<double>();
      const double size = w.norm();
      if (size == 0.0) continue;
      of_w += w * w.transpose() * (std::pow(n.norm(), order) / size);
      of_n += n * n.transpose() * (std::pow(n.norm(), order - 2) * size);
    }
    derivative_bounds_[order - 1] = std::sqrt(largest_eigenvalue(of_w) * largest_eigenvalue(of_n));
  }
  // Per term: reach products of rotations (2 roundings each) on each axis, Dim products of them, one with the weight;
  // then as many additions as terms. Unit roundoff is ε/2.
  const double roundings = 2.0 * reach_.sum() + 2.0 * Dim + 2.0 + static_cast<double>(terms_.size());
  rounding_ = roundings * 0.5 * std::numeric_limits<double>::epsilon() * weights + coefficient_error;
}

/// Calls visit(term, cos n·θ, sin n·θ), the angles composed from powers of e^{iθ_axis}.
template <int Dim>
template <class Visit>
void SineSeries<Dim>::for_each_term(const Vector<Dim>& phases, const Visit& visit) const {
  std::vector<Rotation> powers(static_cast<std::size_t>(2 * reach_.sum() + Dim));
  std::array<const Rotation*, Dim> zeroth;
  Rotation* next = powers.data();
  for (int axis = 0; axis < Dim; ++axis) {
    Rotation* const middle = next + reach_[axis];
    const Rotation unit{std::cos(phases[axis]), std::sin(phases[axis])};
    middle[0] = {1.0, 0.0};
    for (int n = 1; n <= reach_[axis]; ++n) {
      middle[n] = middle[n - 1] * unit;
      middle[-n] = {middle[n].cosine, -middle[n].sine};
    }
    zeroth[axis] = middle;
    next = middle + reach_[axis] + 1;
  }
  for (const auto& term : terms_) {
    Rotation angle = zeroth[0][term.frequency[0]];
    for (int axis = 1; axis < Dim; ++axis) angle = angle * zeroth[axis][term.frequency[axis]];
    visit(term, angle.cosine, angle.sine);
  }
}

template <int Dim>
Vector<Dim> SineSeries<Dim>::operator()(const Vector<Dim>& phases) const {
  Vector<Dim> value = Vector<Dim>::Zero();
  for_each_term(phases, [&](const SineTerm<Dim>& term, double, double sine) { value += sine * term.coefficient; });
  return value;
}

template <int Dim>
SineJet<Dim> SineSeries<Dim>::jet(const Vector<Dim>& phases) const {
  SineJet<Dim> jet;
  jet.value.setZero();
  jet.jacobian.setZero();
  jet.hessian.fill(Tensor<Dim>::Zero());
  for_each_term(phases, [&](const SineTerm<Dim>& term, double cosine, double sine) {
    const Vector<Dim> n = term.frequency.template cast<double>();
    const Tensor<Dim> nn = n * n.transpose();
    const Vector<Dim> w_sine = sine * term.coefficient;
    jet.value += w_sine;
    jet.jacobian += (cosine * term.coefficient) * n.transpose();
    for (int i = 0; i < Dim; ++i) jet.hessian[i] -= w_sine[i] * nn;
  });
  return jet;
}

template class SineSeries<1>;
template class SineSeries<2>;
template class SineSeries<3>;

}  // namespace sphstab::analysis
