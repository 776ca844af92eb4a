// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/answers.hpp"
#include "study/dispersion.hpp"
#include "study/report.hpp"

namespace sphstab::study {
namespace {

/// c_p = 1 with Δp = 1 and ρ = 1, so that frequencies are in c_p/Δp and speeds in c_p: E = (1+ν)(1−2ν)/(1−ν).
constexpr double poisson_ratio = 0.3, young_modulus = 0.52 / 0.7;
/// Equibiaxial compression beyond the stability of the continuous equation, −0.35 for ν = 0.3 (theory.md §2).
constexpr double compression = -0.4;
/// The frequency of a point of the path and the maximum over the zone differ by roundings of the lattice sum.
constexpr double rounding = 1e-12;

constexpr const char* case_file =
    R"(# Cubic spline, h = 1.3 spacings; units in which spacing, density and the p-wave speed are 1
scheme = "tl-linear"
young_modulus = 0.7428571428571429
poisson_ratio = 0.3
kernel = "cubic-spline"
h_over_spacing = 1.3
)";

constexpr const char* explanation = R"(
## How to read the figures

Each curve is the frequency of one branch along straight lines between the labelled points of the first Brillouin zone;
the dashed lines are the waves of the continuum, which end where they leave the range of the lattice's.

- **Long waves are right.** At Γ every branch leaves with the slope of the continuum, c_p or c_s = 0.535 c_p, up to the
  quadrature error of the kernel sum.
- **Short waves lag.** The bands bend down well before the zone ends; beyond the top of a band the group velocity points
  backwards: energy travels against the phase.
- **The top of the band gives the time step.** Leapfrog is stable up to Δt = 2/ω_max, where `dt` takes the maximum over the
  whole zone, not only along these lines.
- **Zero-energy modes are where the bands come down to zero away from Γ.** The SPH gradient does not see these patterns, no
  time step removes them, and they drift, but do not grow. They sit at every k with 2k in the reciprocal lattice, at K of the
  hexagonal, P of the bcc and W of the fcc lattice, and for the staggered and the fcc lattice off the labelled points too.
- **In three dimensions the transverse band is double.** Every direction normal to the symbol D is as good as another.
- **One shape for all branches.** Both are |D(k)| times a speed: the transverse band is c_s/c_p of the longitudinal one.

Regenerate with `sphstab report bands --overwrite`. One figure alone, here of the hexagonal lattice:
`sphstab dispersion --case reports/bands/case.toml --lattice hexagonal --figure hexagonal.svg`. The `.csv` of each figure
holds ω², speeds and growth at every point, in units of Δp, c_p and ρ.
)";

constexpr const char* compressed_explanation = R"(
## A state that grows

The square lattice again, compressed until its longitudinal stiffness is negative. The density of the equation of state lets
the base stress into the linearised equations; ω² < 0 is drawn below zero as the rate of growth. The growth has the shape of
the band: fastest where |D| is largest, none at the zero-energy modes. In the continuum it has no bound. The transverse
branch is slower than at rest, and stable.

![Bands of the compressed square lattice](compressed.svg)
)";

Case case_of(int dimension, LatticeKind kind) {
  Case input;
  input.set("dimension", static_cast<double>(dimension));
  input.set("lattice", std::string(name_of(kind)));
  input.set("scheme", "tl-linear");
  input.set("young_modulus", young_modulus);
  input.set("poisson_ratio", poisson_ratio);
  return input;
}

Case compressed_case() {
  Case input = case_of(2, LatticeKind::square);
  input.set("density_in_momentum", "equation-of-state");
  input.set("displacement_gradient", std::vector{compression, 0.0, 0.0, compression});
  return input;
}

/// The waves along the path of a case, and its limit over the whole zone.
struct Bands {
  std::string name;  ///< of its files
  Case input;
  Json waves;
  Json zone;

  Bands(std::string_view name_of_files, Case of_case)
      : name(name_of_files),
        input(std::move(of_case)),
        waves(dispersion_answer(input, {})),
        zone(time_step_answer(input, {})) {}
};

double highest_omega_squared(const Json& point) { return point["omega_squared"].back()[0]; }

/// The largest of `value` over the points.
template <class Value>
double largest(const Bands& bands, const Value& value) {
  double found = 0.0;
  for (const Json& point : bands.waves["points"]) found = std::max(found, value(point));
  return found;
}

double highest_omega(const Bands& bands) { return std::sqrt(largest(bands, highest_omega_squared)); }
double fastest_growth(const Bands& bands) {
  return largest(bands, [](const Json& point) { return point["growth_rate"].get<double>(); });
}

/// The labelled points, Γ left out, where no wave has a frequency.
std::string still_labels(const Bands& bands) {
  std::string labels;
  for (const Json& point : bands.waves["points"]) {
    if (!point.contains("label") || highest_omega_squared(point) > 0.0) continue;
    const bool at_gamma = std::all_of(point["wave_vector"].begin(), point["wave_vector"].end(),
                                      [](const Json& component) { return component == 0.0; });
    const std::string label = point["label"];
    if (!at_gamma && labels.find(label) == std::string::npos) labels += (labels.empty() ? "" : ", ") + label;
  }
  return labels;
}

io::Table summary_table(const std::vector<Bands>& lattices) {
  io::Document rows = io::Document::array();
  for (const Bands& bands : lattices)
    rows.push_back({{"lattice", bands.name},
                    {"omega", bands.zone["critical_mode"]["omega"]},
                    {"courant_number", bands.zone["courant_number"]},
                    {"zero_energy_modes", fmt::format("{}{}", bands.zone["zero_energy_modes"].size(),
                                                      bands.zone["zero_energy_modes_complete"] ? "" : " or more")},
                    {"at_labels", still_labels(bands)}});
  return io::select(rows, {{"lattice", "lattice"},
                           {"omega", "highest ω in the zone [c_p/Δp]", "{:.4f}"},
                           {"courant_number", "Δt_c c_p/Δp = 2/ω", "{:.4f}"},
                           {"zero_energy_modes", "zero-energy modes in the zone"},
                           {"at_labels", "of them labelled"}});
}

/// c_s/c_p, the ratio of the branches at every k.
const double speed_ratio = std::sqrt((1.0 - 2.0 * poisson_ratio) / (2.0 - 2.0 * poisson_ratio));

bool branches_keep_ratio(const Bands& bands) {
  const auto& points = bands.waves["points"];
  return std::all_of(points.begin(), points.end(), [](const Json& point) {
    const double expected = highest_omega_squared(point) * speed_ratio * speed_ratio;
    const auto& squares = point["omega_squared"];
    return std::all_of(squares.begin(), squares.end() - 1, [&](const Json& square) {
      return std::abs(square[0].get<double>() - expected) <= rounding * expected;
    });
  });
}

std::vector<std::string> find_failures(const std::vector<Bands>& lattices, const Bands& compressed) {
  std::vector<std::string> failures;
  for (const Bands& bands : lattices) {
    if (highest_omega(bands) * bands.zone["critical_time_step"].get<double>() > 2.0 * (1.0 + rounding))
      failures.push_back(fmt::format("{}: a wave of the path is faster than the limit of the zone admits", bands.name));
    if (!branches_keep_ratio(bands))
      failures.push_back(
          fmt::format("{}: the transverse branch is not c_s/c_p times the longitudinal one", bands.name));
  }
  const double growth = fastest_growth(compressed);
  if (!(growth > 0.0 && growth <= compressed.zone["growth_rate"].get<double>() * (1.0 + rounding)))
    failures.push_back("the compressed state does not grow on the path, or faster than anywhere in the zone");
  return failures;
}

void add_files(Report& report, const Bands& bands) {
  report.files.emplace_back(bands.name + ".svg", io::render_svg(band_figure(bands.input)));
  report.files.emplace_back(bands.name + ".csv", io::write(dispersion_rows(bands.waves), io::Format::csv));
}

}  // namespace

Report band_report(const Progress& progress) {
  std::vector<Bands> lattices;
  for (int dimension = 1; dimension <= 3; ++dimension) {
    for (const LatticeKind kind : lattices_of(dimension))
      lattices.emplace_back(name_of(kind), case_of(dimension, kind));
    if (progress) progress(dimension / 3.0);
  }
  const Bands compressed("compressed", compressed_case());

  std::string text =
      "Waves of a linear elastic solid on seven lattices: cubic spline, h = 1.3 Δp, ν = 0.3, tl-linear.\n\n";
  text += io::to_markdown(summary_table(lattices));
  text += fmt::format(
      "\nThe square lattice compressed by {:g} % both ways, with the density of the equation of state, grows at up to "
      "{:.4f} c_p/Δp\non the path and {:.4f} c_p/Δp in the zone.\n",
      -100.0 * compression, fastest_growth(compressed), compressed.zone["growth_rate"].get<double>());

  Report report;
  report.summary = text;
  report.failures = find_failures(lattices, compressed);
  std::string readme = "# Bands of the named lattices\n\n" + text + explanation;
  for (const Bands& bands : lattices) {
    readme += fmt::format("\n![Bands of the {0} lattice]({0}.svg)\n", bands.name);
    add_files(report, bands);
  }
  add_files(report, compressed);
  report.files.emplace_back("case.toml", case_file);
  report.files.emplace_back("README.md", readme + compressed_explanation);
  return report;
}

}  // namespace sphstab::study
