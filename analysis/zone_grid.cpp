// SPDX-License-Identifier: MIT
#include "analysis/zone_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/errors.hpp"

namespace sphstab::analysis {
namespace {

using Row = std::vector<double>;

/// An end of a domain that is this part of a box beyond the end of a box lies on it.
constexpr double end_tolerance = 1e-9;

/// Cosines and sines of n θ_j, θ_j = (2 (first + j) + 1) π / cells, for 0 ≤ n ≤ reach: row n, column j.
struct AngleTable {
  std::size_t points;
  Row cosine;
  Row sine;

  AngleTable(long cells, long first, std::size_t points_, int reach) : points(points_) {
    Row cos_m(static_cast<std::size_t>(2 * cells)), sin_m(cos_m.size());  // of m π / cells
    for (std::size_t m = 0; m < cos_m.size(); ++m) {
      const double angle = std::numbers::pi * static_cast<double>(m) / static_cast<double>(cells);
      cos_m[m] = std::cos(angle);
      sin_m[m] = std::sin(angle);
    }
    for (long n = 0; n <= reach; ++n)
      for (long j = first; j < first + static_cast<long>(points); ++j) {
        const long turns = 2 * cells, m = ((2 * j + 1) * n % turns + turns) % turns;
        cosine.push_back(cos_m[static_cast<std::size_t>(m)]);
        sine.push_back(sin_m[static_cast<std::size_t>(m)]);
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
Row tabulate(const SineSeries<Dim>& series, int i, const std::vector<AngleTable>& tables) {
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
  for (int axis = 0; axis < Dim - 1; ++axis) {
    outer /= frequencies(axis);
    partial = sum_axis(partial, outer, reach[axis], inner, tables[axis]);
    inner *= tables[axis].points;
  }
  return sum_last_axis(partial, reach[Dim - 1], inner, tables[Dim - 1]);
}

}  // namespace

template <int Dim>
double zone_grid_size(const SineSeries<Dim>& series, const ZoneDomain<Dim>& domain, double resolution) {
  return ((domain.high() - domain.low()).array() * (0.5 * series.type() / resolution)).ceil().max(1.0).prod();
}

template <int Dim>
ZoneGrid<Dim>::ZoneGrid(const SineSeries<Dim>& series, const Tensor<Dim>& form, const ZoneDomain<Dim>& domain,
                        double resolution) {
  if (const double boxes = zone_grid_size(series, domain, resolution); boxes > largest_zone_grid)
    throw InvalidInput(
        fmt::format("smoothing_length: the sums reach so far that the zone needs {:.2g} boxes, more "
                    "than {:g}",
                    boxes, largest_zone_grid));
  const long cells = std::lround(std::ceil(std::numbers::pi * series.type() / resolution));
  half_width_ = std::numbers::pi / static_cast<double>(cells);
  std::vector<AngleTable> tables;
  for (int axis = 0; axis < Dim; ++axis) {
    first_[axis] = std::lround(std::floor(domain.low()[axis] / (2.0 * half_width_) + end_tolerance));
    const long end = std::lround(std::ceil(domain.high()[axis] / (2.0 * half_width_) - end_tolerance));
    points_[axis] = static_cast<std::size_t>(std::max(end - first_[axis], 1L));
    tables.emplace_back(cells, first_[axis], points_[axis], series.reach()[axis]);
  }
  std::array<Row, Dim> D;
  for (int i = 0; i < Dim; ++i) D[i] = tabulate(series, i, tables);
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
  for (int axis = 0; axis < Dim; index /= points_[axis], ++axis)
    box.centre[axis] =
        static_cast<double>(2 * (first_[axis] + static_cast<long>(index % points_[axis])) + 1) * half_width_;
  return box;
}

template double zone_grid_size(const SineSeries<1>&, const ZoneDomain<1>&, double);
template class ZoneGrid<1>;
template double zone_grid_size(const SineSeries<2>&, const ZoneDomain<2>&, double);
template class ZoneGrid<2>;
template double zone_grid_size(const SineSeries<3>&, const ZoneDomain<3>&, double);
template class ZoneGrid<3>;

}  // namespace sphstab::analysis
