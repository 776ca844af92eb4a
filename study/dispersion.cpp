// SPDX-License-Identifier: MIT
#include "study/dispersion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/dispersion.hpp"
#include "model/band_path.hpp"
#include "model/brillouin_zone.hpp"
#include "model/lattice_index.hpp"
#include "study/counts.hpp"
#include "study/json_values.hpp"

namespace sphstab::study {
namespace {

/// For which k a case asks.
enum class Extent { one, grid, path };

struct ExtentKey {
  std::string_view name;
  Extent extent;
};
constexpr std::array<ExtentKey, 6> extent_keys{{{"wave_vector", Extent::one},
                                                {"mode", Extent::one},
                                                {"box", Extent::one},
                                                {"grid", Extent::grid},
                                                {"path", Extent::path},
                                                {"path_points", Extent::path}}};

ExtentKey extent_of(const Case& input) {
  const ExtentKey* chosen = nullptr;
  for (const ExtentKey& key : extent_keys) {
    if (!input.has(key.name)) continue;
    if (chosen && chosen->extent != key.extent)
      throw InvalidInput(fmt::format("{}: cannot be given with {}", chosen->name, key.name));
    chosen = &key;
  }
  return chosen ? *chosen : ExtentKey{"path", Extent::path};
}

template <int Dim>
struct PathPoint {
  Vector<Dim> wave_vector;
  double distance;    ///< along the path, breaks left out
  std::string label;  ///< empty between the labelled points
};

template <int Dim>
using PathPoints = std::vector<std::vector<PathPoint<Dim>>>;

/// Into how many steps each line is cut when there are so many in all: at least one each, then always one more where
/// the steps are longest.
std::vector<int> shared_steps(const std::vector<double>& lengths, int steps) {
  std::vector<int> shares(lengths.size(), 1);
  std::vector<double> longest = lengths;
  for (int left = steps - static_cast<int>(lengths.size()); left > 0; --left) {
    const auto line = static_cast<std::size_t>(std::max_element(longest.begin(), longest.end()) - longest.begin());
    longest[line] = lengths[line] / ++shares[line];
  }
  return shares;
}

/// So many points along the path, its labelled points among them; a break is passed over at no distance.
template <int Dim>
PathPoints<Dim> points_along(const BandPath<Dim>& path, int count) {
  std::vector<double> lengths;
  for (const auto& stretch : path.stretches)
    for (std::size_t i = 1; i < stretch.size(); ++i)
      lengths.push_back((stretch[i].wave_vector - stretch[i - 1].wave_vector).norm());
  const int least = static_cast<int>(lengths.size() + path.stretches.size());
  if (count < least) throw InvalidInput(fmt::format("path_points: {} is not at least {}, the labelled points of the path", count, least));
  const auto steps = shared_steps(lengths, count - static_cast<int>(path.stretches.size()));

  PathPoints<Dim> points;
  double begin = 0.0;
  std::size_t line = 0;
  for (const auto& stretch : path.stretches) {
    auto& run = points.emplace_back();
    run.push_back({stretch.front().wave_vector, begin, stretch.front().label});
    for (std::size_t i = 1; i < stretch.size(); ++i, begin += lengths[line++]) {
      const Vector<Dim> from = stretch[i - 1].wave_vector, to = stretch[i].wave_vector;
      for (int n = 1; n < steps[line]; ++n) {
        const double part = static_cast<double>(n) / steps[line];
        run.push_back({from + part * (to - from), begin + part * lengths[line], {}});
      }
      run.push_back({to, begin + lengths[line], stretch[i].label});
    }
  }
  return points;
}

template <int Dim>
PathPoints<Dim> path_points(const Case& input, const Lattice<Dim>& lattice) {
  const auto labels = input.word("path");
  return points_along(labels ? band_path(lattice, *labels) : band_path(lattice),
                      static_cast<int>(input.required_number("path_points")));
}

/// Everything about one k, in the keys of the interface.
template <int Dim>
Json point_of(const analysis::DispersionRelation<Dim>& relation, const Vector<Dim>& wave_vector) {
  Json omega_squared = Json::array(), phase_speed = Json::array(), group_speed = Json::array(),
       group_velocity = Json::array(), branches = Json::array();
  double growth_rate = 0.0;
  for (const auto& wave : relation(wave_vector)) {
    omega_squared.push_back(complex_pair(wave.omega_squared));
    growth_rate = std::max(growth_rate, wave.growth_rate);
    phase_speed.push_back(number_or_null(wave.phase_speed));
    group_speed.push_back(wave.group_velocity ? Json(wave.group_velocity->norm()) : Json());
    group_velocity.push_back(wave.group_velocity ? components<Dim>(*wave.group_velocity) : Json());
    branches.push_back(name_of(wave.branch));
  }
  return {{"wave_vector", components<Dim>(wave_vector)},
          {"omega_squared", std::move(omega_squared)},
          {"growth_rate", growth_rate},
          {"phase_speed", std::move(phase_speed)},
          {"group_speed", std::move(group_speed)},
          {"group_velocity", std::move(group_velocity)},
          {"branches", std::move(branches)}};
}

/// Told every so many points of a grid.
constexpr std::size_t progress_interval = 1024;

/// k = Σ (i_j/n_j) b_j in the first zone, i_j = 0 … n_j − 1.
template <int Dim>
Json grid_points(const Problem<Dim>& problem, const LatticeIndex<Dim>& counts, const Progress& progress) {
  const analysis::DispersionRelation<Dim> relation(problem);
  const BrillouinZone<Dim> zone(problem.lattice);
  Json points = Json::array();
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), counts.array() - 1, [&](const LatticeIndex<Dim>& i) {
    const Vector<Dim> fractions = i.template cast<double>().cwiseQuotient(counts.template cast<double>());
    points.push_back(point_of(relation, zone.in_first_zone(problem.lattice.reciprocal_vectors() * fractions)));
    if (progress && points.size() % progress_interval == 0)
      progress(static_cast<double>(points.size()) / counts.template cast<double>().prod());
  });
  return points;
}

template <int Dim>
Json dispersion_answer(const Case& input, const Request& request) {
  const auto problem = make_problem<Dim>(input);
  const analysis::DispersionRelation<Dim> relation(problem);
  Json points = Json::array();
  switch (extent_of(input).extent) {
    case Extent::one:
      points.push_back(point_of(relation, make_wave_vector<Dim>(input)));
      break;
    case Extent::grid:
      points = grid_points(problem, *make_size<Dim>(input, "grid"), request.progress);
      break;
    case Extent::path:
      for (const auto& run : path_points(input, problem.lattice))
        for (const auto& at : run) {
          points.push_back(point_of(relation, at.wave_vector));
          points.back()["distance"] = at.distance;
          if (!at.label.empty()) points.back()["label"] = at.label;
        }
      break;
  }
  return {{"points", std::move(points)}};
}

/// What the figure shows of a branch: its frequency, or its growth rate below zero.
double height(double omega_squared, double growth_rate) {
  return omega_squared < 0.0 ? -growth_rate : std::sqrt(omega_squared);
}

constexpr double gap = std::numeric_limits<double>::quiet_NaN();

/// The curve of a branch, and that of the continuum, D = k.
template <int Dim>
struct BranchCurves {
  io::Curve discrete;
  io::Curve continuum;
};

template <int Dim>
std::string title_of(const Problem<Dim>& problem) {
  return fmt::format("{} lattice, {}, h = {:.4g} Δp, {}, ν = {:.4g}{}", name_of(problem.lattice.kind()),
                     name_of(problem.kernel.family()), problem.kernel.smoothing_length() / problem.lattice.spacing(),
                     name_of(problem.scheme.formulation), problem.material.poisson_ratio(),
                     problem.neighbour_rule == NeighbourRule::nearest ? ", nearest neighbours" : "");
}
