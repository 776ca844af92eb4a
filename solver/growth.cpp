// SPDX-License-Identifier: MIT
#include "solver/growth.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sphstab::solver {
namespace {

/// Least-squares slope of equally spaced values, per value.
double slope(std::span<const double> values) {
  const double centre = 0.5 * static_cast<double>(values.size() - 1);
  double covariance = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = static_cast<double>(i) - centre;
    covariance += x * values[i];
    variance += x * x;
  }
  return covariance / variance;
}

}  // namespace

GrowthFit judge_growth(std::span<const double> log_amplitude, int stride) {
  assert(log_amplitude.size() >= 6);
  const std::size_t third = log_amplitude.size() / 3;
  const double last = slope(log_amplitude.last(third)) / stride;
  const double before = slope(log_amplitude.last(2 * third).first(third)) / stride;
  const double smallest = smallest_e_foldings / (static_cast<double>(third) * stride);
  const double disagreement = std::abs(last - before) / std::abs(last);
  const auto first = log_amplitude.first(third);
  const bool higher = log_amplitude.back() >= *std::max_element(first.begin(), first.end()) + smallest_e_foldings;
  const bool steady = disagreement <= slope_agreement && higher;
  const Trend trend = last < smallest ? Trend::bounded : steady ? Trend::growing : Trend::undecided;
  return {trend, last, smallest, disagreement, (static_cast<long>(log_amplitude.size()) - 1) * stride};
}

}  // namespace sphstab::solver
