// SPDX-License-Identifier: MIT
#include "analysis/ellipticity.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "analysis/finite_strain.hpp"

namespace sphstab::analysis {
namespace {

/// Directions along half a circle. Q is a polynomial of degree 2 in n: its least eigenvalue has few, wide minima.
constexpr int directions_of_half_circle = 180;
/// So many of the lowest directions are polished.
constexpr std::size_t most_starts = 32;
/// Where polishing ends, in radians: the square of it is below rounding.
constexpr double smallest_step = 1e-9;
/// A gain below it is rounding.
constexpr double least_gain = 4.0 * std::numeric_limits<double>::epsilon();
constexpr double roundings = 32.0 * std::numeric_limits<double>::epsilon();

/// Unit vectors over half of the sphere, about `directions_of_half_circle` (in space half of that) along a meridian.
template <int Dim>
std::vector<Vector<Dim>> half_sphere() {
  constexpr double pi = std::numbers::pi;
  std::vector<Vector<Dim>> directions;
  if constexpr (Dim == 1) {
    directions.push_back(Vector<1>::Ones());
  } else if constexpr (Dim == 2) {
    for (int i = 0; i < directions_of_half_circle; ++i) {
      const double angle = pi * i / directions_of_half_circle;
      directions.push_back({std::cos(angle), std::sin(angle)});
    }
  } else {
    constexpr int rings = directions_of_half_circle / 4;  // from the pole to the equator
    for (int ring = 0; ring <= rings; ++ring) {
      const double polar = 0.5 * pi * ring / rings;
      const int points = std::max(1, static_cast<int>(std::ceil(4.0 * rings * std::sin(polar))));
      for (int i = 0; i < points; ++i) {
        const double azimuth = 2.0 * pi * i / points;
        directions.push_back(
            {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)});
      }
    }
  }
  return directions;
}

/// The directions normal to n, an orthonormal basis, and their sums and differences.
template <int Dim>
std::vector<Vector<Dim>> moves_about(const Vector<Dim>& n) {
  std::vector<Vector<Dim>> moves;
  if constexpr (Dim > 1) {
    const Tensor<Dim> frame = Eigen::HouseholderQR<Vector<Dim>>(n).householderQ();
    for (int i = 1; i < Dim; ++i) moves.push_back(frame.col(i));
    if constexpr (Dim == 3) {
      moves.push_back(frame.col(1) + frame.col(2));
      moves.push_back(frame.col(1) - frame.col(2));
    }
  }
  return moves;
}

template <int Dim>
class SpeedSearch {
 public:
  explicit SpeedSearch(const Problem<Dim>& problem) : moduli_(FiniteStrain<Dim>(problem).moduli()) {}

  WeakestDirection<Dim> at(const Vector<Dim>& direction) const {
    const Vector<Dim> n = direction.normalized();
    return {n, squared_frequencies<Dim>(acoustic_tensor<Dim>(moduli_, n), roundings * moduli_.norm())[0].real()};
  }

  /// The local minimum below `start`, by steps to either side that are halved where none goes down.
  WeakestDirection<Dim> polished(const WeakestDirection<Dim>& start) const {
    WeakestDirection<Dim> best = start;
    const double noise = least_gain * moduli_.norm();
    for (double step = std::numbers::pi / directions_of_half_circle; step > smallest_step;) {
      const WeakestDirection<Dim> centre = best;
      for (const auto& move : moves_about<Dim>(centre.direction))
        for (const double side : {-step, step})
          if (const auto reached = at(centre.direction + side * move); reached.squared_speed < best.squared_speed)
            best = reached;
      if (best.squared_speed > centre.squared_speed - noise) step *= 0.5;
    }
    return best;
  }

 private:
  TangentModuli<Dim> moduli_;
};

/// Cuts of a simplex of squares, each of which halves its longest edge: of one edge 4^−12 is left of what a polynomial
/// may be below its values at the corners.
template <int Dim>
constexpr int cuts = 12 * (Dim - 1);

/// det Q over the squares p of the components of n along the principal axes.
template <int Dim>
class WaveDeterminant {
 public:
  using Corners = std::array<Vector<Dim>, Dim>;  ///< of a part of the simplex p_1 + … + p_Dim = 1

  explicit WaveDeterminant(const TangentModuli<Dim>& moduli) : moduli_(moduli) {}

  double operator()(const Vector<Dim>& p) const { return acoustic_tensor<Dim>(moduli_, p.cwiseSqrt()).determinant(); }

  bool is_positive(const Corners& corners, int cuts_left) const {
    for (const auto& corner : corners)
      if (!((*this)(corner) > 0.0)) return false;
    if (cuts_left == 0 || least_coefficient(corners) > 0.0) return true;
    int from = 0, to = 0;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < i; ++j)
        if ((corners[i] - corners[j]).norm() > (corners[from] - corners[to]).norm()) from = i, to = j;
    Corners one = corners, other = corners;
    one[from] = other[to] = 0.5 * (corners[from] + corners[to]);
    return is_positive(one, cuts_left - 1) && is_positive(other, cuts_left - 1);
  }

 private:
  using Factors = std::array<int, Dim>;  ///< corners, in ascending order

  double least_coefficient(const Corners& corners, Factors factors = {}, int chosen = 0) const {
    if (chosen == Dim) return coefficient(corners, factors);
    double least = std::numeric_limits<double>::infinity();
    for (int i = chosen > 0 ? factors[chosen - 1] : 0; i < Dim; ++i) {
      factors[chosen] = i;
      least = std::min(least, least_coefficient(corners, factors, chosen + 1));
    }
    return least;
  }

  /// The symmetric multilinear form of det Q: (1/Dim!) Σ over the subsets of the factors of ± det Q of their sum.
  double coefficient(const Corners& corners, const Factors& factors) const {
    double sum = 0.0;
    for (unsigned subset = 1; subset < 1u << Dim; ++subset) {
      Vector<Dim> p = Vector<Dim>::Zero();
      double sign = Dim % 2 == 0 ? 1.0 : -1.0;
      for (int i = 0; i < Dim; ++i)
        if (subset >> i & 1u) {
          p += corners[factors[i]];
          sign = -sign;
        }
      sum += sign * (*this)(p);
    }
    return sum / std::tgamma(Dim + 1.0);
  }

  const TangentModuli<Dim>& moduli_;
};

}  // namespace

template <int Dim>
WeakestDirection<Dim> weakest_direction(const Problem<Dim>& problem) {
  const SpeedSearch<Dim> search(problem);
  std::vector<WeakestDirection<Dim>> found;
  for (const auto& n : half_sphere<Dim>()) found.push_back(search.at(n));
  const auto slower = [](const auto& a, const auto& b) { return a.squared_speed < b.squared_speed; };
  std::sort(found.begin(), found.end(), slower);
  found.resize(std::min(found.size(), most_starts));
  for (auto& direction : found) direction = search.polished(direction);
  return *std::min_element(found.begin(), found.end(), slower);
}

template <int Dim>
bool is_elliptic(const Scheme& scheme, const LameConstants& lame, const Tensor<Dim>& F) {
  if (!(F.determinant() > 0.0) || !F.allFinite()) return false;
  const Vector<Dim> squares = Tensor<Dim>(F.transpose() * F).template selfadjointView<Eigen::Lower>().eigenvalues();
  const auto moduli = tangent_moduli<Dim>(scheme, lame, squares.cwiseMax(0.0).cwiseSqrt().asDiagonal());
  typename WaveDeterminant<Dim>::Corners axes;
  for (int i = 0; i < Dim; ++i) {
    axes[i] = Vector<Dim>::Unit(i);
    if (!(acoustic_tensor<Dim>(moduli, axes[i]).diagonal().array() > 0.0).all()) return false;
  }
  return WaveDeterminant<Dim>(moduli).is_positive(axes, cuts<Dim>);
}

template WeakestDirection<1> weakest_direction(const Problem<1>&);
template bool is_elliptic(const Scheme&, const LameConstants&, const Tensor<1>&);
template WeakestDirection<2> weakest_direction(const Problem<2>&);
template bool is_elliptic(const Scheme&, const LameConstants&, const Tensor<2>&);
template WeakestDirection<3> weakest_direction(const Problem<3>&);
template bool is_elliptic(const Scheme&, const LameConstants&, const Tensor<3>&);

}  // namespace sphstab::analysis
