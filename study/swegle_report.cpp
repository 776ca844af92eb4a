// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/growth.hpp"
#include "analysis/updated_lagrangian.hpp"
#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/report.hpp"

namespace sphstab::study {
namespace {

/// |σ| over ρ̄ c0². The signs of the criteria do not depend on it; where the whole zone decides, c0² does.
constexpr double stress = 0.05;
constexpr std::array table_ratios{0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2.0, 2.5, 3.0};
constexpr double first_ratio = 0.7, last_ratio = 3.0;
constexpr int curve_points = 116;
constexpr std::array figure_kernels{KernelFamily::cubic_spline, KernelFamily::quintic_spline,
                                    KernelFamily::wendland_c2};
/// Growth below this part of c0/Δp is none, and a second derivative or sum below this part of its terms is marginal.
constexpr double nothing = 1e-7;
constexpr double cancelled = 1e-12;

/// A chain of spacing 1 with ρ̄ = 1 and c0 = 1 under this pressure, no shear modulus.
Problem<1> chain(KernelFamily family, double ratio, double pressure) {
  return {.lattice = Lattice<1>(LatticeKind::chain, 1.0),
          .kernel = Kernel<1>(family, ratio),
          .material = Material::from_sound_speed(1.0 - pressure, 1.0, 0.0),
          .scheme = {.formulation = Formulation::updated_lagrangian},
          .integrator = Integrator::leapfrog,
          .pressure = pressure};
}

/// What the three criteria say of one kernel and h/Δp. All but the last two are those of clumping in pairs, k = π/Δp.
struct Verdicts {
  KernelFamily family;
  double ratio;
  double nearest;  ///< W''(Δp): Swegle, unstable in tension if positive, in compression if negative
  double all;      ///< Σ W'' over the odd neighbours on one side, as ω² at π/Δp is −8 (σ/ρ) Δp times it
  double growth_nearest;  ///< in tension (in compression if W'' is negative) √(8Δp |W''| |σ|/ρ)
  double tension;         ///< fastest growth over all k
  double compression;
  double fastest_in_tension;  ///< its k, in π/Δp
};

/// The sums over the odd neighbours and their sizes: what is left of a cancelled sum is rounding.
struct OddSum {
  double value = 0.0;
  double size = 0.0;
};

OddSum odd_neighbours(const Kernel<1>& kernel) {
  OddSum sum;
  for (int j = 1; j < kernel.support(); j += 2) {
    sum.value += kernel.curvature(static_cast<double>(j));
    sum.size += std::abs(kernel.curvature(static_cast<double>(j)));
  }
  return sum;
}

double sign_of(double value, double size) { return std::abs(value) <= cancelled * size ? 0.0 : value; }

Verdicts judge(KernelFamily family, double ratio) {
  const Problem<1> in_tension = chain(family, ratio, -stress);
  const Kernel<1>& kernel = in_tension.kernel;
  const OddSum sum = odd_neighbours(kernel);
  const auto tension = analysis::growth_range(in_tension);
  const auto compression = analysis::growth_range(chain(family, ratio, stress));
  const double nearest = sign_of(kernel.curvature(1.0), kernel.value(0.0) / (ratio * ratio));
  return {.family = family,
          .ratio = ratio,
          .nearest = nearest,
          .all = sign_of(sum.value, std::max(sum.size, kernel.value(0.0) / (ratio * ratio))),
          .growth_nearest = std::sqrt(8.0 * std::abs(nearest) * stress),
          .tension = tension.growth_rate,
          .compression = compression.growth_rate,
          .fastest_in_tension = std::abs(tension.fastest.wave_vector[0]) / std::numbers::pi};
}

/// Which stress a second derivative or sum of this sign makes unstable.
std::string_view unstable_in(double curvature) {
  return curvature > 0.0 ? "tension" : curvature < 0.0 ? "compression" : "neither";
}

std::string_view unstable_in(const Verdicts& verdicts) {
  const bool tension = verdicts.tension > nothing, compression = verdicts.compression > nothing;
  return tension && compression ? "both" : tension ? "tension" : compression ? "compression" : "neither";
}

io::Table table_of(const std::vector<Verdicts>& all) {
  io::Table table{{"kernel", "h/Δp", "W''(Δp) Δp³", "Swegle: unstable in", "ΣW'' Δp³", "all neighbours, π/Δp",
                   "growth in tension", "at k Δp/π", "growth in compression", "all neighbours, all k"},
                  {}};
  for (const auto& row : all)
    table.rows.push_back({std::string(name_of(row.family)), fmt::format("{:.1f}", row.ratio),
                          fmt::format("{:.5f}", row.nearest), std::string(unstable_in(row.nearest)),
                          fmt::format("{:.5f}", row.all), std::string(unstable_in(row.all)),
                          fmt::format("{:.5f}", row.tension), fmt::format("{:.3f}", row.fastest_in_tension),
                          fmt::format("{:.5f}", row.compression), std::string(unstable_in(row))});
  return table;
}

/// Growth rates of one kernel in tension against h/Δp: by the nearest neighbours, by all at π/Δp, and at the worst k.
io::LineFigure figure_of(KernelFamily family) {
  io::Curve nearest{"nearest neighbours, k = π/Δp (Swegle)", {}, io::CurveStyle::dashed};
  io::Curve pairs{"all neighbours, k = π/Δp", {}};
  io::Curve worst{"all neighbours, worst k", {}};
  io::Curve compression{"in compression, worst k", {}};
  for (int i = 0; i < curve_points; ++i) {
    const double ratio = std::lerp(first_ratio, last_ratio, static_cast<double>(i) / (curve_points - 1));
    const Verdicts verdicts = judge(family, ratio);
    nearest.points.emplace_back(ratio, verdicts.nearest > 0.0 ? verdicts.growth_nearest : 0.0);
    pairs.points.emplace_back(ratio, std::sqrt(8.0 * stress * std::max(verdicts.all, 0.0)));
    worst.points.emplace_back(ratio, verdicts.tension);
    compression.points.emplace_back(ratio, verdicts.compression);
  }
  return {.title = fmt::format("Growth on a chain, {}, |σ| = {} ρ c0²", name_of(family), stress),
          .x_label = "h / Δp",
          .y_label = "growth rate Δp / c0",
          .curves = {nearest, pairs, worst, compression}};
}

/// The rows where a criterion misses an instability that there is, or names one that there is not.
std::vector<const Verdicts*> wrong_by(const std::vector<Verdicts>& all, double Verdicts::*criterion) {
  std::vector<const Verdicts*> wrong;
  for (const auto& row : all)
    if (unstable_in(row.*criterion) != unstable_in(row)) wrong.push_back(&row);
  return wrong;
}

/// Kernel by kernel the h/Δp of these rows.
std::string named(const std::vector<const Verdicts*>& rows) {
  std::string text;
  const Verdicts* before = nullptr;
  for (const Verdicts* row : rows) {
    const bool same = before != nullptr && before->family == row->family;
    text +=
        same ? fmt::format(", {:.1f}", row->ratio) : fmt::format("\n- {}: {:.1f}", name_of(row->family), row->ratio);
    before = row;
  }
  return text.empty() ? " none" : text;
}

/// What theory.md §7 says of these rows, and Swegle's own case.
std::vector<std::string> failures_of(const std::vector<Verdicts>& all) {
  std::vector<std::string> failures;
  const auto row_of = [&](KernelFamily family, double ratio) -> const Verdicts& {
    return *std::find_if(all.begin(), all.end(),
                         [&](const Verdicts& row) { return row.family == family && row.ratio == ratio; });
  };
  const auto expect = [&](bool holds, std::string_view claim) {
    if (!holds) failures.emplace_back(claim);
  };
  const auto& swegle = row_of(KernelFamily::cubic_spline, 1.0);
  expect(swegle.nearest == swegle.all && unstable_in(swegle) == "tension",
         "cubic spline, h = Δp: nearest neighbours are all there are, and tension is unstable");
  for (const auto family : {KernelFamily::quartic_spline, KernelFamily::quintic_spline, KernelFamily::gaussian})
    expect(row_of(family, 1.5).nearest < 0.0 && row_of(family, 1.5).all > 0.0,
           "h = 1.5 Δp: beyond the inflection of the smooth kernels the sum over all neighbours has the other sign");
  for (const auto family : {KernelFamily::cubic_spline, KernelFamily::wendland_c2})
    expect(row_of(family, 1.5).nearest == 0.0, "h = 1.5 Δp: the neighbour sits on the inflection");
  for (const auto family : {KernelFamily::cubic_spline, KernelFamily::quintic_spline})
    expect(row_of(family, 2.0).all == 0.0, "h = 2 Δp: the sum over all neighbours cancels");
  return failures;
}

}  // namespace

Report swegle_report(const Progress& progress) {
  std::vector<Verdicts> all;
  for (const auto& [family, name] : Names<KernelFamily>::table)
    for (const double ratio : table_ratios) {
      all.push_back(judge(family, ratio));
      if (progress)
        progress(static_cast<double>(all.size()) /
                 static_cast<double>(Names<KernelFamily>::table.size() * table_ratios.size()));
    }
  const auto wrong_nearest = wrong_by(all, &Verdicts::nearest), wrong_pairs = wrong_by(all, &Verdicts::all);
  Report report;
  report.failures = failures_of(all);
  const auto count_if = [&](const auto& is) { return std::count_if(all.begin(), all.end(), is); };
  const auto in_tension = count_if([](const Verdicts& row) { return row.tension > nothing; });
  const auto in_compression = count_if([](const Verdicts& row) { return row.compression > nothing; });
  report.summary = fmt::format(
      "Swegle's criterion W''(Δp) σ > 0 on a chain (scheme `ul`, no shear modulus, no artificial stress, |σ| = {} ρ "
      "c0²), "
      "beside\nwhat all neighbours do at k = π/Δp, where A = 0 and ω² = −8 (σ/ρ) Δp Σ W'' over the odd neighbours of "
      "one "
      "side, and what\nthey do at any k, ω² = c0² A² + (2σ/ρ)(A² − B). Growth rates are in c0/Δp.\n\n"
      "Of {} cases (8 kernels, {} values of h/Δp) {} grow in tension and {} in compression. A wider support moves the "
      "worst "
      "wave to\nlonger lengths and slows it; past the inflection of the kernel the criterion promises a tension "
      "without "
      "instability that there is not.\n\n"
      "The nearest neighbour is wrong in {}:{}\n\nall neighbours at k = π/Δp in {}:{}\n",
      stress, all.size(), table_ratios.size(), in_tension, in_compression, wrong_nearest.size(), named(wrong_nearest),
      wrong_pairs.size(), named(wrong_pairs));
  std::string figures;
  for (const auto family : figure_kernels) {
    const auto name = fmt::format("{}.svg", name_of(family));
    report.files.emplace_back(name, io::render_svg(figure_of(family)));
    figures += fmt::format("\n![growth rate against h/Δp, {}]({})\n", name_of(family), name);
  }
  report.files.emplace_back("README.md", "# Swegle's criterion, and where it fails\n\n" + report.summary + figures +
                                             "\n" + io::to_markdown(table_of(all)) +
                                             "\nRegenerate with `sphstab report swegle --overwrite`.\n");
  report.files.emplace_back("swegle.csv", io::to_csv(table_of(all)));
  return report;
}

}  // namespace sphstab::study
