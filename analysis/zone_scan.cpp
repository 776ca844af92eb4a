// SPDX-License-Identifier: MIT
#include "analysis/zone_scan.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/irreducible_domain.hpp"
#include "model/brillouin_zone.hpp"
#include "model/lattice_index.hpp"

namespace sphstab::analysis {
namespace {

/// σ w of the grid: dips and tongues narrower than a box are reached from the local extrema beside them.
template <int Dim>
constexpr double scan_resolution = Dim == 3 ? 0.25 : 0.15;
/// Where polishing ends, in phase.
constexpr double smallest_step = 1e-9;
/// The step shrinks by this, some 14 times in all: a parabola of the larger stencil is right to its square.
constexpr double shrinkage = 0.25;
/// The parabola is trusted this far beyond its stencil.
constexpr double farthest_move = 2.0;
/// Climbing a curved ridge takes many steps, but not forever.
constexpr int most_steps = 300;
/// A gain below it is rounding.
constexpr double least_gain = 4.0 * std::numeric_limits<double>::epsilon();
/// Relative width at which the upper bound is tight enough, and the evaluations spent to get there.
constexpr double tight = 1e-10;
template <int Dim>
constexpr long evaluation_budget = Dim == 3 ? 300'000 : 40'000;

/// So many of the starting points, the highest ones, are climbed from: in space ridges hold thousands.
constexpr std::size_t most_starts = 96;

/// A grid can miss the top of a ridge by this part of the range: sin²(τw/2) by Riesz's bound, of type τ = 3σ.
template <int Dim>
constexpr double hidden_part = Dim == 3 ? 0.14 : 0.05;

template <int Dim>
constexpr int stencil_size = Dim == 1   ? 3
                             : Dim == 2 ? 9
                                        : 27;

/// Values at every corner, edge and face of a cube of half-width 1 and at its centre.
template <int Dim>
class Stencil {
 public:
  double& operator[](const LatticeIndex<Dim>& n) { return values_[place(n)]; }
  double operator[](const LatticeIndex<Dim>& n) const { return values_[place(n)]; }

  /// Where the parabola through the values has its maximum, or as far towards it as it is trusted; nothing unless it
  /// has one.
  std::optional<Vector<Dim>> summit() const {
    using Index = LatticeIndex<Dim>;
    const double centre = (*this)[Index::Zero()];
    Vector<Dim> gradient;
    Tensor<Dim> curvature;  // negative
    for (int i = 0; i < Dim; ++i) {
      const Index e_i = Index::Unit(i);
      gradient[i] = 0.5 * ((*this)[e_i] - (*this)[-e_i]);
      curvature(i, i) = 2.0 * centre - (*this)[e_i] - (*this)[-e_i];
      for (int j = 0; j < i; ++j) {
        const Index e_j = Index::Unit(j);
        curvature(i, j) = curvature(j, i) =
            -0.25 * ((*this)[e_i + e_j] - (*this)[e_i - e_j] - (*this)[e_j - e_i] + (*this)[-e_i - e_j]);
      }
    }
    const Eigen::LLT<Tensor<Dim>> factors(curvature);
    if (factors.info() != Eigen::Success) return std::nullopt;
    const Vector<Dim> move = factors.solve(gradient);
    const double size = move.cwiseAbs().maxCoeff();
    if (!std::isfinite(size)) return std::nullopt;
    return size > farthest_move ? Vector<Dim>(move * (farthest_move / size)) : move;
  }

 private:
  static std::size_t place(const LatticeIndex<Dim>& n) {
    int index = 0;
    for (int axis = Dim - 1; axis >= 0; --axis) index = 3 * index + n[axis] + 1;
    return static_cast<std::size_t>(index);
  }

  std::array<double, stencil_size<Dim>> values_{};
};

template <int Dim>
std::size_t cell_number(const LatticeIndex<Dim>& n, const LatticeIndex<Dim>& cells) {
  long number = 0;
  for (int axis = Dim - 1; axis >= 0; --axis) number = number * cells[axis] + n[axis];
  return static_cast<std::size_t>(number);
}

/// What a symmetry of the lattice must leave as it is: the stress of `ul`, C = F0ᵀ F0 of finite strain.
template <int Dim>
Tensor<Dim> base_form(const Problem<Dim>& problem) {
  if (is_finite_strain(problem.scheme.formulation))
    return problem.deformation_gradient.transpose() * problem.deformation_gradient;
  return problem.deviatoric_stress - problem.pressure * Tensor<Dim>::Identity();
}

}  // namespace

template <int Dim>
EigenvalueRange symmetric_range(const Tensor<Dim>& M) {
  if constexpr (Dim == 2) {
    const double mean = 0.5 * M.trace();
    const double radius = std::hypot(0.5 * (M(0, 0) - M(1, 1)), 0.5 * (M(0, 1) + M(1, 0)));
    return {mean - radius, mean + radius};
  } else {
    const Tensor<Dim> symmetric = 0.5 * (M + M.transpose());
    const Vector<Dim> values = symmetric.template selfadjointView<Eigen::Lower>().eigenvalues();
    return {values[0], values[Dim - 1]};
  }
}

template <int Dim>
ZoneScan<Dim>::ZoneScan(const Problem<Dim>& problem) {
  const GradientSymbol<Dim> symbol(problem);
  domain_ = irreducible_domain<Dim>(BrillouinZone<Dim>(problem.lattice), symbol, base_form(problem));
  for (int axis = 0; axis < Dim; ++axis) phase_axes_.col(axis) = symbol.wave_vector(Vector<Dim>::Unit(axis));
  type_ = symbol.series().type();
  half_width_ = scan_resolution<Dim> / type_;
  const Vector<Dim> extent = domain_.high() - domain_.low();
  cells_ = (extent / (2.0 * half_width_)).array().ceil().template cast<int>().max(1);
  point_of_cell_.assign(static_cast<std::size_t>(cells_.template cast<long>().prod()), -1);
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), cells_.array() - 1, [&](const LatticeIndex<Dim>& n) {
    const Vector<Dim> offset = (2.0 * n.template cast<double>().array() + 1.0) * half_width_;
    const PhaseBox<Dim> box{domain_.low() + offset, half_width_};
    if (!domain_.touches(box)) return;
    point_of_cell_[cell_number<Dim>(n, cells_)] = static_cast<long>(points_.size());
    points_.push_back(wave_vector(box.centre));
    boxes_.push_back(box);
  });
  const auto zero_energy = zero_energy_modes(problem).wave_vectors;
  points_.insert(points_.end(), zero_energy.begin(), zero_energy.end());
}

template <int Dim>
ZoneScan<Dim>::ZoneScan(std::vector<Vector<Dim>> wave_vectors)
    : points_(std::move(wave_vectors)), phase_axes_(Tensor<Dim>::Zero()), cells_(LatticeIndex<Dim>::Zero()) {}

template <int Dim>
std::vector<double> ZoneScan<Dim>::sampled(const Function& function) const {
  std::vector<double> values(points_.size());
  std::transform(points_.begin(), points_.end(), values.begin(), function);
  return values;
}

template <int Dim>
std::vector<std::size_t> ZoneScan<Dim>::local_maxima(const std::vector<double>& values) const {
  return summits_above(values, std::numeric_limits<double>::infinity());
}

template <int Dim>
std::vector<std::size_t> ZoneScan<Dim>::summits_above(const std::vector<double>& values, double ridge_level) const {
  std::vector<std::size_t> found;
  // The value at a cell beside n, or nothing outside the domain.
  const auto value_at = [&](const LatticeIndex<Dim>& n) -> std::optional<double> {
    if ((n.array() < 0).any() || (n.array() >= cells_.array()).any()) return std::nullopt;
    const long point = point_of_cell_[cell_number<Dim>(n, cells_)];
    return point < 0 ? std::nullopt : std::optional(values[static_cast<std::size_t>(point)]);
  };
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), cells_.array() - 1, [&](const LatticeIndex<Dim>& n) {
    const long point = point_of_cell_[cell_number<Dim>(n, cells_)];
    if (point < 0) return;
    const double value = values[static_cast<std::size_t>(point)];
    bool highest = true, above_one = false, on_ridge = false;
    for_each_index<Dim>(LatticeIndex<Dim>::Constant(-1), LatticeIndex<Dim>::Ones(), [&](const LatticeIndex<Dim>& m) {
      if (!in_upper_half<Dim>(m)) return;
      const auto before = value_at(n - m), after = value_at(n + m);
      const bool along = value >= before.value_or(value) && value >= after.value_or(value);
      const bool above = value > before.value_or(value) || value > after.value_or(value);
      highest = highest && along;
      above_one = above_one || above;
      on_ridge = on_ridge || (along && above);
    });
    if ((highest && above_one) || (on_ridge && value >= ridge_level)) found.push_back(static_cast<std::size_t>(point));
  });
  const double least = *std::min_element(values.begin(), values.end());
  for (std::size_t i = boxes_.size(); i < points_.size(); ++i)
    if (boxes_.empty() || values[i] > least) found.push_back(i);
  if (!boxes_.empty() && found.size() > most_starts) {
    const auto end = found.begin() + most_starts;
    std::partial_sort(found.begin(), end, found.end(), [&](std::size_t a, std::size_t b) {
      return values[a] != values[b] ? values[a] > values[b] : a < b;
    });
    found.erase(end, found.end());
  }
  return found;
}

template <int Dim>
ZonePoint<Dim> ZoneScan<Dim>::polished(const Function& function, const Vector<Dim>& start) const {
  ZonePoint<Dim> best{start, function(start)};
  double step = half_width_;
  for (int count = 0; step > smallest_step && count < most_steps; ++count) {
    const ZonePoint<Dim> centre = best;
    const double noise = least_gain * std::abs(centre.value);
    const auto visit = [&](const Vector<Dim>& move) {
      const Vector<Dim> k = centre.wave_vector + wave_vector(step * move);
      const double value = function(k);
      const bool better = value > best.value + noise;
      if (better) best = {k, value};
      return std::pair(value, better);
    };
    Stencil<Dim> stencil;
    for_each_index<Dim>(LatticeIndex<Dim>::Constant(-1), LatticeIndex<Dim>::Ones(), [&](const LatticeIndex<Dim>& n) {
      stencil[n] = n.isZero() ? centre.value : visit(n.template cast<double>()).first;
    });
    const bool moved = best.value > centre.value + noise;
    const auto summit = stencil.summit();
    const bool at_summit = summit && visit(*summit).second && summit->cwiseAbs().maxCoeff() <= 1.0;
    if (at_summit || (!moved && best.value <= centre.value + noise)) step *= shrinkage;
  }
  return best;
}

template <int Dim>
ZonePoint<Dim> ZoneScan<Dim>::maximum(const Function& function, const std::vector<double>& values) const {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  ZonePoint<Dim> best{points_[static_cast<std::size_t>(largest - values.begin())], *largest};
  for (const std::size_t start : summits_above(values, *largest - hidden_part<Dim> * (*largest - *least))) {
    const ZonePoint<Dim> reached = polished(function, points_[start]);
    if (reached.value > best.value) best = reached;
  }
  return best;
}

template <int Dim>
double ZoneScan<Dim>::upper_bound(const std::function<EigenvalueRange(const Vector<Dim>&)>& eigenvalues, int order,
                                  double found) const {
  struct Candidate {
    PhaseBox<Dim> box;
    double value;
  };
  std::vector<Candidate> live;
  EigenvalueRange sampled{found, found};
  for (const auto& box : boxes_) {
    const EigenvalueRange here = eigenvalues(wave_vector(box.centre));
    sampled = {std::min(sampled.low, here.low), std::max(sampled.high, here.high)};
    live.push_back({box, here.high});
  }
  if (live.empty()) return found;
  const double type = order * type_;
  // Neither end of the sampled range is off by more than s² of the true one, s = sin(τw/2).
  const double s_squared = std::pow(std::sin(0.5 * type * half_width_), 2);
  const double range = (sampled.high - sampled.low) / (1.0 - 2.0 * s_squared), low = sampled.low - s_squared * range;
  double bound = sampled.high + s_squared * range, best = sampled.high;
  for (long spent = 0; !live.empty() && bound > best * (1.0 + tight) && spent < evaluation_budget<Dim>;) {
    const double half_width = live.front().box.half_width, cosine = std::cos(0.5 * type * half_width);
    const double needed = low + (best - low) * cosine * cosine;
    live.erase(std::remove_if(live.begin(), live.end(), [&](const Candidate& c) { return c.value < needed; }),
               live.end());
    bound = std::min(bound, low + (best - low) / (cosine * cosine));
    std::vector<Candidate> next;
    for (const Candidate& candidate : live)
      for (const auto& child : candidate.box.children())
        if (domain_.touches(child)) {
          next.push_back({child, eigenvalues(wave_vector(child.centre)).high});
          best = std::max(best, next.back().value);
        }
    spent += static_cast<long>(next.size());
    live = std::move(next);
  }
  return std::max(bound, best);
}

template class ZoneScan<1>;
template EigenvalueRange symmetric_range(const Tensor<1>&);
template class ZoneScan<2>;
template EigenvalueRange symmetric_range(const Tensor<2>&);
template class ZoneScan<3>;
template EigenvalueRange symmetric_range(const Tensor<3>&);

}  // namespace sphstab::analysis
