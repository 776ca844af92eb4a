// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/growth.hpp"
#include "analysis/updated_lagrangian.hpp"
#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/growth_answer.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"

namespace sphstab::study {
namespace {

/// Gray's units, with his ε̃ and n: ρ̄ = c0 = Δp = 1. Tension of 5 % of ρ c0², μ as in his thresholds.
constexpr double pressure = -0.05;
constexpr double shear_modulus = 0.3;
constexpr double xsph = 0.5;
constexpr double usual_epsilon = 0.3;

constexpr std::array kernels{KernelFamily::cubic_spline, KernelFamily::quintic_spline, KernelFamily::wendland_c2};
constexpr std::array lattices{LatticeKind::square, LatticeKind::hexagonal, LatticeKind::staggered};
constexpr std::array table_ratios{1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2.0};
constexpr double map_h_over_spacing = 1.3;
/// Where the square lattice has a window between the two conditions of its zone boundary, and how well an edge is
/// found: growth below 1e-6 counts as none, which its root brings to some 1e-6 of ε.
constexpr double boundary_ratio = 1.1;
constexpr double edge_tolerance = 1e-5;

/// `count` equally spaced numbers, both ends included.
std::vector<double> spaced(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(std::lerp(low, high, static_cast<double>(i) / (count - 1)));
  return values;
}

const std::vector<double> map_ratios = spaced(0.8, 2.0, 25);
const std::vector<double> map_epsilons = spaced(0.0, 1.0, 21);
const std::vector<double> map_stretches = spaced(0.9, 1.15, 26);

/// ε = 0 is no artificial stress.
std::optional<ArtificialStress> artificial_stress(double epsilon) {
  if (epsilon == 0.0) return std::nullopt;
  return ArtificialStress{.epsilon = epsilon};
}

struct Setting {
  LatticeKind lattice = LatticeKind::square;
  KernelFamily kernel = KernelFamily::cubic_spline;
  double h_over_spacing = map_h_over_spacing;
  double epsilon = 0.0;
};

/// Isotropic tension.
Problem<2> problem_of(const Setting& setting) {
  return {.lattice = Lattice<2>(setting.lattice, 1.0),
          .kernel = Kernel<2>(setting.kernel, setting.h_over_spacing),
          .material = Material::from_sound_speed(1.0 - pressure, 1.0, shear_modulus),
          .scheme = {.formulation = Formulation::updated_lagrangian,
                     .artificial_stress = artificial_stress(setting.epsilon),
                     .xsph = Xsph{xsph}},
          .integrator = Integrator::leapfrog,
          .pressure = pressure};
}

/// A bar stretched along x by a factor, in plane strain, free to contract along y. Its material is hypoelastic, so that
/// coaxial stretching from rest gives S = 2μ dev ln F, and P = c0² (ρ − ρ0) with ρ0 = 1.
class StretchedBar {
 public:
  explicit StretchedBar(double stretch) : along_(stretch) {
    const auto close = [](double low, double high) { return high - low < 1e-15; };
    std::uintmax_t iterations = 100;
    const auto lateral = [this](double across) {
      across_ = across;
      return stress(1);
    };
    // Between no contraction and that of an incompressible bar, in stretching as in compression.
    const auto [low, high] = std::minmax({1.0, 1.0 / stretch});
    const auto ends =
        low == high ? std::pair(1.0, 1.0) : boost::math::tools::toms748_solve(lateral, low, high, close, iterations);
    across_ = 0.5 * (ends.first + ends.second);
  }

  double pressure() const { return 1.0 / (along_ * across_) - 1.0; }
  double deviatoric(int axis) const {
    const double volume = std::log(along_ * across_);
    return 2.0 * shear_modulus * (std::log(axis == 0 ? along_ : across_) - volume / 3.0);
  }
  double stress(int axis) const { return deviatoric(axis) - pressure(); }
  /// The stress across it is zero, which the root leaves as rounding.
  Problem<2> problem(LatticeKind lattice, double epsilon) const {
    Problem<2> problem = problem_of({.lattice = lattice, .epsilon = epsilon});
    problem.lattice = problem.lattice.deformed(Vector<2>(along_, across_).asDiagonal().toDenseMatrix());
    problem.material = Material::from_sound_speed(1.0, 1.0, shear_modulus);
    problem.pressure = pressure();
    problem.deviatoric_stress = Vector<2>(deviatoric(0), pressure()).asDiagonal();
    return problem;
  }

 private:
  double along_;
  double across_ = 1.0;
};

/// Values over (x, y), worked out on all cores.
class Grid {
 public:
  Grid(const std::vector<double>& x, const std::vector<double>& y) : x_(x), y_(y), values_(x.size() * y.size()) {}

  template <class Value>
  void add_work(const Value& value, std::vector<std::function<void()>>& work) {
    for (std::size_t j = 0; j < y_.size(); ++j)
      for (std::size_t i = 0; i < x_.size(); ++i)
        work.push_back([this, value, i, j] { values_[i + j * x_.size()] = value(x_[i], y_[j]); });
  }

  std::size_t size() const { return values_.size(); }
  long growing() const {
    return std::count_if(values_.begin(), values_.end(), [](double value) { return value > 0.0; });
  }

  /// Cells without growth are left blank.
  io::MapFigure figure(std::string title, std::string x_label, std::string y_label) const {
    io::MapFigure map{.title = std::move(title),
                      .x_label = std::move(x_label),
                      .y_label = std::move(y_label),
                      .value_label = "growth rate Δp / c0",
                      .x = x_,
                      .y = y_,
                      .values = values_,
                      .blank_label = "nothing grows"};
    for (double& value : map.values)
      if (value == 0.0) value = std::numeric_limits<double>::quiet_NaN();
    return map;
  }

 private:
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<double> values_;
};

double growth(const Problem<2>& problem) { return analysis::growth_range(problem).growth_rate; }

/// The stable ε of one kernel and lattice at each h/Δp.
struct Windows {
  LatticeKind lattice;
  KernelFamily kernel;
  std::vector<std::vector<analysis::EpsilonInterval>> of_ratio;  ///< in the order of table_ratios

  const std::vector<analysis::EpsilonInterval>& at(double ratio) const {
    return of_ratio[static_cast<std::size_t>(std::find(table_ratios.begin(), table_ratios.end(), ratio) -
                                             table_ratios.begin())];
  }
};

std::string text_of(const std::vector<analysis::EpsilonInterval>& intervals) {
  std::string text;
  for (const auto& [from, to] : intervals)
    text += fmt::format("{}{:.4f} to {:.4f}", text.empty() ? "" : ", ", from, to);
  return text.empty() ? "none" : text;
}

io::Table table_of(const std::vector<Windows>& all) {
  io::Table table{{"lattice", "kernel"}, {}};
  for (const double ratio : table_ratios) table.header.push_back(fmt::format("h = {:.1f} Δp", ratio));
  for (const auto& windows : all) {
    table.rows.push_back({std::string(name_of(windows.lattice)), std::string(name_of(windows.kernel))});
    for (const auto& intervals : windows.of_ratio) table.rows.back().push_back(text_of(intervals));
  }
  return table;
}

io::Table price_table() {
  io::Table table{{"lattice", "kernel"}, {}};
  for (const double ratio : table_ratios) table.header.push_back(fmt::format("h = {:.1f} Δp", ratio));
  for (const auto lattice : lattices)
    for (const auto kernel : kernels) {
      table.rows.push_back({std::string(name_of(lattice)), std::string(name_of(kernel))});
      for (const double ratio : table_ratios)
        table.rows.back().push_back(
            fmt::format("{:.4f}", analysis::UpdatedLagrangian<2>(problem_of({lattice, kernel, ratio, usual_epsilon}))
                                      .tension_modulus_factor()));
    }
  return table;
}

/// At k = (π/Δp, 0) of the square lattice A = 0, and in isotropic tension nothing grows there while ε f − B ≥ 0
/// (theory.md §9): the interval of ε between the two conditions.
analysis::EpsilonInterval window_at_zone_boundary(double ratio) {
  const Problem<2> problem = problem_of({.h_over_spacing = ratio, .epsilon = 1.0});
  const analysis::LatticeSummation<2> summation(problem.lattice, problem.kernel, problem.neighbour_rule,
                                                problem.scheme.artificial_stress, std::nullopt);
  const auto sums = summation(Vector<2>(std::numbers::pi, 0.0));
  return {sums.B(0, 0) / sums.f(0, 0), sums.B(1, 1) / sums.f(1, 1)};
}

/// Of the cubic spline: the square lattice has no window at h = 1, 1.2 … 1.5 Δp, and at 1.1 Δp that of its zone
/// boundary; the hexagonal one has windows up to 1.5 Δp and none at 2 (theory.md §3, §9).
std::vector<std::string> failures_of(const std::vector<Windows>& all) {
  std::vector<std::string> failures;
  const auto cubic = [&](LatticeKind lattice) -> const Windows& {
    return *std::find_if(all.begin(), all.end(), [=](const Windows& windows) {
      return windows.lattice == lattice && windows.kernel == KernelFamily::cubic_spline;
    });
  };
  const auto claim = [&](LatticeKind lattice, double ratio, bool stabilised) {
    if (cubic(lattice).at(ratio).empty() == stabilised)
      failures.push_back(
          fmt::format("{} lattice, h = {} Δp: {} ε stabilises it", name_of(lattice), ratio, stabilised ? "no" : "an"));
  };
  for (const double ratio : {1.0, 1.2, 1.3, 1.4, 1.5}) {
    claim(LatticeKind::square, ratio, false);
    claim(LatticeKind::hexagonal, ratio, true);
  }
  claim(LatticeKind::hexagonal, 2.0, false);
  const auto& found = cubic(LatticeKind::square).at(boundary_ratio);
  const auto expected = window_at_zone_boundary(boundary_ratio);
  if (found.size() != 1 || std::abs(found[0].from - expected.from) > edge_tolerance ||
      std::abs(found[0].to - expected.to) > edge_tolerance)
    failures.push_back(fmt::format("square lattice, h = {} Δp: the window is {}, at the zone boundary {:.6f} to {:.6f}",
                                   boundary_ratio, text_of(found), expected.from, expected.to));
  return failures;
}

constexpr const char* summary_text =
    R"(Gray's scheme in isotropic tension, P = {pressure} ρ c0², μ = {shear_modulus} ρ c0² with ρ the density under stress
(`--density {density} --pressure={pressure} --shear-modulus {shear_modulus} --sound-speed 1`), XSPH with {xsph}, artificial stress with n = 4 that follows the perturbed stress: the ε between 0 and {largest_epsilon} for which no wave of the lattice grows by more than
{negligible_growth} c_p/Δp.

{windows}
On the square lattice what cures clumping drives the transverse wave of its zone boundary, so that most h/Δp have no window; at
h = 1.1 Δp it is what the two conditions at k = (π/Δp, 0) leave, and wider supports have one again: that no ε stabilises the
square lattice holds of the cubic spline at h = 1 and 1.2 to 1.5 Δp only. Windows end from above as well, and some have gaps: narrow
tongues of complex ω² (flutter). Of the bars stretched along one axis that are drawn below, {growing} of {bars} grow.

The price of ε = {epsilon}, the factor on the modulus of long waves in tension, whatever the stress:

{price})";

}  // namespace

Report tension_report(const Progress& progress) {
  std::vector<std::function<void()>> work;
  std::vector<Windows> all;
  for (const auto lattice : lattices)
    for (const auto kernel : kernels)
      all.push_back({lattice, kernel, std::vector<std::vector<analysis::EpsilonInterval>>(table_ratios.size())});
  for (auto& windows : all)
    for (std::size_t i = 0; i < table_ratios.size(); ++i)
      work.push_back([&windows, i] {
        windows.of_ratio[i] =
            analysis::stabilising_epsilon(problem_of({windows.lattice, windows.kernel, table_ratios[i]}));
      });
  std::vector<Grid> of_ratio, of_stretch;
  for (std::size_t i = 0; i < lattices.size(); ++i) {
    of_ratio.emplace_back(map_ratios, map_epsilons);
    of_stretch.emplace_back(map_stretches, map_epsilons);
  }
  for (std::size_t i = 0; i < lattices.size(); ++i) {
    const auto lattice = lattices[i];
    of_ratio[i].add_work(
        [lattice](double ratio, double epsilon) {
          return growth(problem_of({lattice, KernelFamily::cubic_spline, ratio, epsilon}));
        },
        work);
    of_stretch[i].add_work(
        [lattice](double stretch, double epsilon) { return growth(StretchedBar(stretch).problem(lattice, epsilon)); },
        work);
  }
  run_all(work, progress);

  Report report;
  report.failures = failures_of(all);
  std::string maps;
  const auto add = [&](const std::string& name, const io::MapFigure& map) {
    report.files.emplace_back(name + ".svg", io::render_svg(map));
    maps += fmt::format("\n![{}]({}.svg)\n", map.title, name);
  };
  for (std::size_t i = 0; i < lattices.size(); ++i) {
    const auto lattice = name_of(lattices[i]);
    add(fmt::format("epsilon-{}", lattice),
        of_ratio[i].figure(fmt::format("Growth in isotropic tension, {} lattice, cubic spline", lattice), "h / Δp",
                           "ε"));
    add(fmt::format("stretch-{}", lattice),
        of_stretch[i].figure(
            fmt::format("Growth of a stretched bar, {} lattice, cubic spline, h = {} Δp", lattice, map_h_over_spacing),
            "stretch", "ε"));
    for (const double epsilon : {0.0, usual_epsilon})
      add(fmt::format("zone-{}-{}", lattice, epsilon == 0.0 ? "without" : "with"),
          growth_map(problem_of({.lattice = lattices[i], .epsilon = epsilon})));
  }
  long growing = 0;
  for (const auto& bars : of_stretch) growing += bars.growing();
  report.summary = fmt::format(summary_text, fmt::arg("pressure", pressure), fmt::arg("shear_modulus", shear_modulus),
                               fmt::arg("xsph", xsph), fmt::arg("density", 1.0 - pressure), fmt::arg("largest_epsilon", analysis::largest_epsilon),
                               fmt::arg("negligible_growth", analysis::negligible_growth),
                               fmt::arg("windows", io::to_markdown(table_of(all))), fmt::arg("growing", growing),
                               fmt::arg("bars", of_stretch.size() * of_stretch.front().size()),
                               fmt::arg("epsilon", usual_epsilon), fmt::arg("price", io::to_markdown(price_table())));
  report.files.emplace_back(
      "README.md",
      "# Which lattice, h/Δp and ε are stable in tension\n\n" + report.summary +
          fmt::format("\nMaps, cubic spline: growth over h/Δp and ε, of a bar stretched along x in plane strain "
                      "and free to contract (over stretch\nand ε, h = {} Δp), and over the wave vectors at ε = 0 "
                      "and {}.\n",
                      map_h_over_spacing, usual_epsilon) +
          maps + "\nRegenerate with `sphstab report tension --overwrite`.\n");
  report.files.emplace_back("windows.csv", io::to_csv(table_of(all)));
  return report;
}

}  // namespace sphstab::study
