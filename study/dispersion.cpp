// SPDX-License-Identifier: MIT
#include "study/dispersion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/dispersion.hpp"
#include "analysis/finite_strain.hpp"
#include "model/band_path.hpp"
#include "model/brillouin_zone.hpp"
#include "model/lattice_index.hpp"
#include "study/counts.hpp"
#include "study/json_values.hpp"
#include "study/p_wave_speed.hpp"
#include "study/title.hpp"

namespace sphstab::study {
namespace {

/// Each point of an answer takes some 4 kB until it is printed.
constexpr int most_points = 200000;

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
    if (!chosen) chosen = &key;
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
  if (count < least)
    throw InvalidInput(
        fmt::format("path_points: {} is not at least {}, the labelled points of the path", count, least));
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
  const double count = input.required_number("path_points");
  if (count > most_points) throw InvalidInput(fmt::format("path_points: {} is more than {}", count, most_points));
  return points_along(labels ? band_path(lattice, *labels) : band_path(lattice), static_cast<int>(count));
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
Json grid_points(const analysis::DispersionRelation<Dim>& relation, const Lattice<Dim>& lattice,
                 const LatticeIndex<Dim>& counts, const Progress& progress) {
  const BrillouinZone<Dim> zone(lattice);
  Json points = Json::array();
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), counts.array() - 1, [&](const LatticeIndex<Dim>& i) {
    const Vector<Dim> fractions = i.template cast<double>().cwiseQuotient(counts.template cast<double>());
    points.push_back(point_of(relation, zone.in_first_zone(lattice.reciprocal_vectors() * fractions)));
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
      points = grid_points(relation, problem.lattice, *make_size<Dim>(input, "grid", most_points), request.progress);
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

/// What the figure shows of a wave: its frequency, or its growth rate below zero. A complex ω² has both.
double height(std::complex<double> omega_squared, double growth_rate) {
  return omega_squared.imag() == 0.0 && omega_squared.real() < 0.0 ? -growth_rate : std::sqrt(omega_squared).real();
}

/// The waves of the lattice and those of the continuum with the same base state, as heights of curves with fixed names.
/// Those of `tl-linear` by their branch, D = k in the continuum.
template <int Dim>
class LinearBands {
 public:
  using Heights = std::vector<double>;

  explicit LinearBands(const Problem<Dim>& problem)
      : relation_(problem), continuum_(problem, Tensor<Dim>::Identity()), steps_(problem) {}

  std::vector<std::string> names() const {
    if (Dim == 1) return {"longitudinal"};
    return {"longitudinal", Dim == 3 ? "transverse (two branches)" : "transverse"};
  }
  std::vector<std::string> continuum_names() const {
    return Dim == 1 ? std::vector<std::string>{"longitudinal"} : std::vector<std::string>{"longitudinal", "transverse"};
  }
  Heights of_lattice(const Vector<Dim>& k) const {
    Heights heights;
    const auto waves = relation_(k);
    for (const auto branch : branches()) {
      const auto wave = std::find_if(waves.begin(), waves.end(), [=](const auto& w) { return w.branch == branch; });
      heights.push_back(height(wave->omega_squared, wave->growth_rate));
    }
    return heights;
  }
  Heights of_continuum(const Vector<Dim>& k) const {
    Heights heights;
    for (const auto branch : branches()) {
      const bool longitudinal = branch == analysis::Branch::longitudinal;
      const double omega_squared = longitudinal ? continuum_.longitudinal(k) : continuum_.transverse(k);
      heights.push_back(height(omega_squared, steps_(omega_squared).continuous_growth_rate()));
    }
    return heights;
  }

 private:
  static std::vector<analysis::Branch> branches() {
    using enum analysis::Branch;
    return Dim == 1 ? std::vector{longitudinal} : std::vector{longitudinal, transverse};
  }

  analysis::DispersionRelation<Dim> relation_;
  analysis::AcousticForm<Dim> continuum_;
  analysis::ModeSteps steps_;
};

/// M of the continuum in the same base state.
template <int Dim>
Tensor<Dim> matrix_of_continuum(const Problem<Dim>& problem, const Vector<Dim>& k) {
  if (!is_finite_strain(problem.scheme.formulation)) return analysis::continuum_matrix(problem, k);
  return analysis::acoustic_tensor<Dim>(analysis::FiniteStrain<Dim>(problem).moduli(), k);
}

/// Those of `ul` and of finite strain, whose branches have no fixed kind, in the order of ω²; then the growth rate of a
/// complex pair, which has a frequency too.
template <int Dim>
class OrderedBands {
 public:
  using Heights = std::vector<double>;

  explicit OrderedBands(const Problem<Dim>& problem) : problem_(problem), relation_(problem) {}

  std::vector<std::string> names() const {
    auto names = continuum_names();
    names.emplace_back("growth rate of a coupled pair");
    return names;
  }
  std::vector<std::string> continuum_names() const {
    std::vector<std::string> names;
    for (int i = 1; i <= Dim; ++i) names.push_back(fmt::format("branch {}", i));
    return names;
  }
  Heights of_lattice(const Vector<Dim>& k) const {
    Heights heights;
    double growth_of_pair = std::numeric_limits<double>::quiet_NaN();
    for (const auto& wave : relation_(k)) {
      heights.push_back(height(wave.omega_squared, wave.growth_rate));
      if (wave.branch == analysis::Branch::coupled) growth_of_pair = -wave.growth_rate;
    }
    heights.push_back(growth_of_pair);
    return heights;
  }
  Heights of_continuum(const Vector<Dim>& k) const {
    Heights heights;
    for (const auto omega_squared : analysis::squared_frequencies<Dim>(matrix_of_continuum(problem_, k), 0.0))
      heights.push_back(height(omega_squared, analysis::growth_rate_of(omega_squared)));
    return heights;
  }

 private:
  Problem<Dim> problem_;
  analysis::DispersionRelation<Dim> relation_;
};

/// One curve for each name along the path, with gaps at its breaks, in units of `unit`. Curves without a point are left
/// out.
template <int Dim, class HeightsAt>
std::vector<io::Curve> curves_along(const PathPoints<Dim>& points, const std::vector<std::string>& names, double unit,
                                    const HeightsAt& heights_at) {
  std::vector<io::Curve> curves;
  for (const auto& name : names) curves.push_back({.label = name, .points = {}});
  for (const auto& run : points) {
    for (const auto& at : run) {
      const auto heights = heights_at(at.wave_vector);
      for (std::size_t i = 0; i < curves.size(); ++i) curves[i].points.emplace_back(at.distance, heights[i] / unit);
    }
    for (auto& curve : curves) curve.points.emplace_back(run.back().distance, std::numeric_limits<double>::quiet_NaN());
  }
  std::erase_if(curves, [](const io::Curve& curve) {
    return std::none_of(curve.points.begin(), curve.points.end(),
                        [](const auto& p) { return std::isfinite(p.second); });
  });
  return curves;
}

/// Gaps where a curve leaves what the others need.
void clip(io::Curve& curve, double low, double high) {
  for (auto& [x, y] : curve.points)
    if (y < low || y > high) y = std::numeric_limits<double>::quiet_NaN();
}

/// The labelled points; two at one place are the ends of a break.
template <int Dim>
std::vector<io::Mark> marks_of(const PathPoints<Dim>& points) {
  std::vector<io::Mark> marks;
  for (const auto& run : points)
    for (const auto& at : run) {
      if (at.label.empty()) continue;
      if (!marks.empty() && marks.back().x == at.distance)
        marks.back().label += "|" + at.label;
      else
        marks.push_back({at.distance, at.label});
    }
  return marks;
}

template <int Dim, class Bands>
io::LineFigure band_figure(const Case& input, const Problem<Dim>& problem, const Bands& bands) {
  const auto points = path_points(input, problem.lattice);
  const double unit = p_wave_speed(problem) / problem.lattice.spacing();
  io::LineFigure figure;
  figure.curves = curves_along(points, bands.names(), unit, [&](const auto& k) { return bands.of_lattice(k); });
  double low = 0.0, high = 0.0;
  for (const auto& curve : figure.curves)
    for (const auto& [distance, height] : curve.points) {
      low = std::fmin(low, height);
      high = std::fmax(high, height);
    }
  for (auto& curve :
       curves_along(points, bands.continuum_names(), unit, [&](const auto& k) { return bands.of_continuum(k); })) {
    clip(curve, low, high);
    curve.label += " in the continuum";
    curve.style = io::CurveStyle::dashed;
    figure.curves.push_back(std::move(curve));
  }
  figure.title = "Bands of " + title_of(problem);
  figure.x_label = "wave vector along the path";
  figure.y_label = low < 0.0 ? "ω Δp / c_p; below zero the growth rate" : "ω Δp / c_p";
  figure.x_ticks = marks_of(points);
  for (const auto& tick : figure.x_ticks) figure.vertical_lines.push_back({tick.x, ""});
  return figure;
}

template <int Dim>
io::LineFigure band_figure(const Case& input) {
  const auto problem = make_problem<Dim>(input);
  switch (problem.scheme.formulation) {
    case Formulation::total_lagrangian_linear:
      return band_figure(input, problem, LinearBands<Dim>(problem));
    case Formulation::total_lagrangian_corotated:
    case Formulation::total_lagrangian_pk1:
    case Formulation::updated_lagrangian:
      break;
  }
  return band_figure(input, problem, OrderedBands<Dim>(problem));
}

}  // namespace

Json dispersion_answer(const Case& input, const Request& request) {
  return in_dimension(input, [&](auto dimension) { return dispersion_answer<dimension()>(input, request); });
}

Json dispersion_rows(const Json& answer) {
  Json rows = Json::array();
  for (const Json& point : answer["points"]) {
    Json row;
    const auto add_vector = [&row](const std::string& name, const Json& vector, std::size_t size) {
      for (std::size_t axis = 0; axis < size; ++axis)
        row[name + "xyz"[axis]] = vector.is_null() ? Json() : vector[axis];
    };
    const Json& k = point["wave_vector"];
    add_vector("k", k, k.size());
    if (point.contains("distance")) {
      row["distance"] = point["distance"];
      row["label"] = point.contains("label") ? point["label"] : Json();
    }
    row["growth_rate"] = point["growth_rate"];
    for (std::size_t i = 0; i < point["branches"].size(); ++i) {
      const auto name = [i](std::string_view key) { return fmt::format("{}_{}", key, i + 1); };
      row[name("branch")] = point["branches"][i];
      row[name("omega_squared")] = point["omega_squared"][i][0];
      row[name("omega_squared") + "_im"] = point["omega_squared"][i][1];
      row[name("phase_speed")] = point["phase_speed"][i];
      row[name("group_speed")] = point["group_speed"][i];
      add_vector(name("group_velocity") + "_", point["group_velocity"][i], k.size());
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

io::LineFigure band_figure(const Case& input) {
  if (const auto key = extent_of(input); key.extent != Extent::path)
    throw InvalidInput(fmt::format("figure: shows the bands along a path, and cannot be given with {}", key.name));
  return in_dimension(input, [&](auto dimension) { return band_figure<dimension()>(input); });
}

}  // namespace sphstab::study
