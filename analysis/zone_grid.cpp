// SPDX-License-Identifier: MIT
#include "analysis/zone_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sphstab::analysis {
namespace {

using Row = std::vector<double>;

/// Cosines and sines of n θ_j, θ_j = (2j + 1) π / cells, for 0 ≤ n ≤ reach: row n, column j.
struct AngleTable {
  std::size_t points;
  Row cosine;
  Row sine;

  AngleTable(std::size_t cells, std::size_t points_, int reach) : points(points_) {
    Row cos_m(2 * cells), sin_m(2 * cells);  // of m π / cells
    for (std::size_t m = 0; m <= cells; ++m) {
      const double angle = std::numbers::pi * static_cast<double>(m) / static_cast<double>(cells);
      cos_m[m] = std::cos(angle);
      sin_m[m] = std::sin(angle);
      if (m == 0 || m == cells) continue;
      cos_m[2 * cells - m] = cos_m[m];
      sin_m[2 * cells - m] = -sin_m[m];
    }
    for (std::size_t n = 0; n <= static_cast<std::size_t>(reach); ++n)
      for (std::size_t j = 0; j < points; ++j) {
        const std::size_t m = (2 * j + 1) * n % (2 * cells);
        cosine.push_back(cos_m[m]);
        sine.push_back(sin_m[m]);
      }
  }
};

/// Σ over frequencies and points of one component, axis 0 fastest; axes below the current one are points already.
struct Partial {
  Row real;
  Row imaginary;
};

/// Sums one axis, the innermost that is still frequencies −reach … reach (`inner` points inside it, `outer` rows
/// outside).
Partial sum_axis(const Partial& in, std::size_t outer, int reach, std::size_t inner, const AngleTable& table) {
  const std::size_t points = table.points;
  Partial out{Row(outer * points * inner), Row(outer * points * inner)};
  const double *in_re = in.real.data(), *in_im = in.imaginary.data();
  for (std::size_t o = 0; o < outer; ++o)
    for (int n = -reach; n <= reach; ++n, in_re += inner, in_im += inner)
      for (std::size_t j = 0; j < points; ++j) {
        const std::size_t entry = static_cast<std::size_t>(std::abs(n)) * points + j;
        const double c = table.cosine[entry], s = n < 0 ? -table.sine[entry] : table.sine[entry];
        double* const re = &out.real[(o * points + j) * inner];
        double* const im = &out.imaginary[(o * points + j) * inner];
        for (std::size_t i = 0; i < inner; ++i) {
          re[i] += c * in_re[i] - s * in_im[i];
          im[i] += c * in_im[i] + s * in_re[i];
        }
      }
  return out;
}

/// Sums the last axis, frequencies 0 … reach, and keeps the imaginary part, Σ w sin(n·θ).
Row sum_last_axis(const Partial& in, int reach, std::size_t inner, const AngleTable& table) {
  Row out(table.points * inner);
  for (std::size_t j = 0; j < table.points; ++j) {
    double* const row = &out[j * inner];
    const double *re = in.real.data(), *im = in.imaginary.data();
    for (std::size_t n = 0; n <= static_cast<std::size_t>(reach); ++n, re += inner, im += inner) {
      const double c = table.cosine[n * table.points + j], s = table.sine[n * table.points + j];
      for (std::size_t i = 0; i < inner; ++i) row[i] += c * im[i] + s * re[i];
    }
  }
  return out;
}

/// Component i of the series at every centre.
template <int Dim>
Row tabulate(const SineSeries<Dim>& series, int i, std::size_t cells) {
  const auto& reach = series.reach();
  const auto frequencies = [&](int axis) {
    return static_cast<std::size_t>((axis == Dim - 1 ? 1 : 2) * reach[axis] + 1);
  };
  std::size_t size = 1;
  for (int axis = 0; axis < Dim; ++axis) size *= frequencies(axis);
  Partial partial{Row(size), Row(size)};
  for (const auto& term : series.terms()) {
    std::size_t index = 0;
    const int sign = term.frequency[Dim - 1] < 0 ? -1 : 1;  // sin is odd: the last frequency can be made not negative
    for (int axis = Dim - 1; axis >= 0; --axis)
      index = index * frequencies(axis) +
              static_cast<std::size_t>(sign * term.frequency[axis] + (axis == Dim - 1 ? 0 : reach[axis]));
    partial.real[index] += sign * term.coefficient[i];
  }
  std::size_t outer = size, inner = 1;
  for (int axis = 0; axis < Dim - 1; ++axis, inner *= cells) {
    outer /= frequencies(axis);
    partial = sum_axis(partial, outer, reach[axis], inner, AngleTable(cells, cells, reach[axis]));
  }
  return sum_last_axis(partial, reach[Dim - 1], inner, AngleTable(cells, cells / 2, reach[Dim - 1]));
}

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
ZoneGrid<Dim>::ZoneGrid(const SineSeries<Dim>& series, const Tensor<Dim>& form, double resolution)
    : cells_(2 * static_cast<std::size_t>(std::ceil(0.5 * std::numbers::pi * series.type() / resolution))),
      half_width_(std::numbers::pi / static_cast<double>(cells_)) {
  std::array<Row, Dim> D;
  for (int i = 0; i < Dim; ++i) D[i] = tabulate(series, i, cells_);
  values_.assign(D[0].size(), 0.0);
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j <= i; ++j) {
      const Row &left = D[i], &right = D[j];
      const double factor = i == j ? form(i, i) : 2.0 * form(i, j);
      if (factor == 0.0) continue;
      for (std::size_t p = 0; p < values_.size(); ++p) values_[p] += factor * left[p] * right[p];
    }
}

template <int Dim>
PhaseBox<Dim> ZoneGrid<Dim>::box(std::size_t index) const {
  PhaseBox<Dim> box{{}, half_width_};
  for (int axis = 0; axis < Dim; ++axis, index /= cells_)
    box.centre[axis] = static_cast<double>(2 * (index % cells_) + 1) * half_width_;
  return box;
}

template <int Dim>
Vector<Dim> wrapped(const Vector<Dim>& phases) {
  constexpr double turn = 2.0 * std::numbers::pi;
  Vector<Dim> result = phases;
  for (int axis = 0; axis < Dim; ++axis) result[axis] -= turn * std::floor(result[axis] / turn + 0.5);
  return result;
}

template struct PhaseBox<1>;
template class ZoneGrid<1>;
template Vector<1> wrapped<1>(const Vector<1>&);
template struct PhaseBox<2>;
template class ZoneGrid<2>;
template Vector<2> wrapped<2>(const Vector<2>&);
template struct PhaseBox<3>;
template class ZoneGrid<3>;
template Vector<3> wrapped<3>(const Vector<3>&);

}  // namespace sphstab::analysis
