// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/document.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"
#include "study/zhang_cases.hpp"
#include "study/zhang_statics.hpp"

namespace sphstab::study {
namespace {

using namespace zhang;

/// H over the thickness of a ring. The paper gives no H; the figures are drawn for this one, where the error is least.
constexpr double figure_ratio = 1.0;
constexpr std::array<double, 9> ratios{0.9, 0.95, 1.0, 1.05, 1.1, 1.2, 1.4, 1.6, 2.0};
/// Spectrum and damped run, relative; the run stops at a tenth of it. It is made for the figures: at some other H what
/// rounding leaves of the driving load keeps it from coming to rest.
constexpr double agreement = 1e-8;
/// Of the torque, over the sum of all moments: 360 roundings.
constexpr double balance = 1e-13;

struct Ring {
  Problem<2> problem;
  Body<2> body;
  Motions motions;
  double torque;   ///< of the load, over the sum of all moments
  double driving;  ///< part of the load that drives the nearly rigid motions, and is taken off
};

Ring make_ring(double ratio, Edge edge) {
  const auto posed = problem(ratio * particle_spacing, normalisation_at[static_cast<std::size_t>(edge)]);
  Ring ring{posed, make_scene(sheared_annulus(posed)).body, {}, 0.0, 0.0};
  double moments = 0.0;
  for (int a = 0; a < ring.body.size(); ++a) {
    const Vector<2>&x = ring.body.position[a], f = ring.body.mass(a) * ring.body.load[a];
    ring.torque += x[0] * f[1] - x[1] * f[0];
    moments += std::abs(x[0] * f[1] - x[1] * f[0]);
  }
  ring.torque /= moments;
  if (edge == Edge::sums_and_load) ring.body = with_normalised_load(posed, ring.body);
  ring.motions = nearly_rigid_motions(posed, ring.body);
  const auto given = ring.body.load;
  ring.body.load = without(ring.motions, posed, ring.body, given);
  double square = 0.0, taken = 0.0;
  for (int a = 0; a < ring.body.size(); ++a) {
    square += given[a].squaredNorm();
    taken += (given[a] - ring.body.load[a]).squaredNorm();
  }
  ring.driving = std::sqrt(taken / square);
  return ring;
}

RestState ring_in_theory(const Ring& ring) {
  return rest_of(ring.body,
                 [theory = annulus_theory(ring.problem)](const Vector<2>& x) { return solution(theory, x); });
}

struct Row {
  double ratio;
  std::array<RestErrors, 3> error;
  std::array<double, 3> driving;
  double torque = 0.0;
  double disagreement = 0.0;
};

Row make_row(double ratio) {
  Row row{.ratio = ratio, .error = {}, .driving = {}};
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Ring ring = make_ring(ratio, edges[i]);
    const auto rest = rest_by_theory(ring.problem, ring.body, ring.motions);
    row.error[i] = errors(rest, ring_in_theory(ring));
    row.driving[i] = ring.driving;
    row.torque = std::max(row.torque, std::abs(ring.torque));
    if (ratio != figure_ratio) continue;
    const auto both = errors(rest_by_running(ring.problem, ring.body, ring.motions), rest);
    row.disagreement = std::max({row.disagreement, both.displacement, both.von_mises});
  }
  return row;
}

io::Table table(const std::vector<Row>& rows) {
  io::Document document = io::Document::array();
  std::vector<io::Column> columns{{"ratio", "H / ring", "{:.2f}"}};
  for (const auto& row : rows) {
    io::Document entry{{"ratio", row.ratio}};
    for (std::size_t i = 0; i < edges.size(); ++i)
      entry[fmt::format("edge_{}", i)] = {{"s", row.error[i].displacement},
                                          {"v", row.error[i].von_mises},
                                          {"v_max", row.error[i].largest_von_mises},
                                          {"driving", row.driving[i]}};
    document.push_back(std::move(entry));
  }
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (const auto& [key, name] : {std::pair("s", "s"), std::pair("v", "σ_v"), std::pair("v_max", "max σ_v"),
                                    std::pair("driving", "driving part of the load")})
      columns.push_back({fmt::format("edge_{}.{}", i, key), fmt::format("{}: {}", name, edge_names[i]), "{:.3f}"});
  return io::select(document, columns);
}

struct Statics {
  std::array<Ring, 2> ring{make_ring(figure_ratio, edges[0]), make_ring(figure_ratio, edges[1])};
  std::array<RestState, 2> rest{rest_by_theory(ring[0].problem, ring[0].body, ring[0].motions),
                                rest_by_theory(ring[1].problem, ring[1].body, ring[1].motions)};
  RestState theory = ring_in_theory(ring[0]);
  const Body<2>& body() const { return ring[0].body; }
};

std::string positions_figure(const Statics& statics) {
  auto figure = particle_figure("Fig. 9: particles at rest (filled) and where elasticity puts them (circles)");
  for (std::size_t i = 0; i < names.size(); ++i)
    figure.panels.push_back({.title = std::string(names[i]),
                             .positions = displaced(statics.body(), statics.rest[i].displacement),
                             .circles = displaced(statics.body(), statics.theory.displacement)});
  return io::render_svg(figure);
}

std::string stress_map_figure(const Statics& statics) {
  auto figure = particle_figure("Fig. 10: von Mises stress", "von Mises stress [Pa]");
  figure.columns = 3;
  const auto panel = [&](std::string_view title, const RestState& rest) {
    figure.panels.push_back(
        {.title = std::string(title), .positions = undisplaced(statics.body()), .values = rest.von_mises});
  };
  for (std::size_t i = 0; i < names.size(); ++i) panel(names[i], statics.rest[i]);
  panel("elasticity", statics.theory);
  figure.value_range = {0.0, 0.05};
  return io::render_svg(figure);
}

/// All sectors are alike: the first tells all.
std::string radial_figure(const Statics& statics) {
  auto figure = line_figure("Fig. 11: von Mises stress along the radius", "r [mm]", "von Mises stress [mPa]");
  const auto curve = [&](std::string_view label, const RestState& rest, io::CurveStyle style) {
    io::Curve drawn{std::string(label), {}, style};
    for (int a = 0; a < statics.body().size(); a += sector_count)
      drawn.points.emplace_back(statics.body().position[a].norm() / millimetre, rest.von_mises[a] / 1e-3);
    figure.curves.push_back(std::move(drawn));
  };
  curve("elasticity", statics.theory, io::CurveStyle::line);
  for (std::size_t i = 0; i < names.size(); ++i) curve(names[i], statics.rest[i], io::CurveStyle::line_and_points);
  return io::render_svg(figure);
}

std::string text_of(const std::vector<Row>& rows) {
  const auto& row = *std::find_if(rows.begin(), rows.end(), [](const auto& r) { return r.ratio == figure_ratio; });
  return fmt::format(
             "An annulus between a = 0.25 mm and b = 0.5 mm of 10 rings and 36 sectors, sheared by −q/a² at its inner "
             "and "
             "q/b² at\nits outer edge, q = 1.7227e-9 N; material and kernel of Case 1, plane stress (plane strain is "
             "the "
             "same: no strain but\nshear). The load is on the outer rings, scaled so that each has the torque of its "
             "edge; both torques cancel to\nless than {:g} of the sum of all moments. H is one number for all "
             "particles.\n\n"
             "The paper gives no H. Rings are 0.025 mm apart and sectors 0.046 to 0.085 mm: a kernel wide enough for "
             "the "
             "sectors\nis soft for waves from ring to ring, and one for the rings hardly sees the sectors. The figures "
             "take H = {:g} ring, where the\nerrors below are near their least in sum; with H under 0.9 rings sectors "
             "hardly feel each other.\n\n"
             "**A balanced torque is not enough.** The sums of Eq. 9 give a rotation strain at the edges, so that the "
             "motion which\nmeets next to no resistance is a rotation that differs a little from ring to ring. The "
             "load "
             "drives it, to thousands\nof times the displacement of Appendix B, but "
             "slowly: its period is tens of seconds, tens of thousands of the paper's\nsteps. Here the part of the "
             "load that drives it is taken off; the "
             "table has it, in parts of the load. Then both "
             "ways,\nconjugate gradients and a damped run, agree to {:g} at the H of the figures.\n\n"
             "Errors against Appendix B as in [Case 1](../zhang-case-1/README.md), relative, in the L2 norm and (max) "
             "over "
             "the largest\nvalue:\n\n",
             balance, figure_ratio, agreement) +
         io::to_markdown(table(rows)) +
         fmt::format(
             "\nAt H = {:g} rings normalisation takes the error of displacement from {:.1f} % to {:.1f} % and that of "
             "stress from {:.1f} %\nto {:.1f} %. That the plain sums are acceptable because there is no corner, as the "
             "paper has it, is not found here.\n\n",
             figure_ratio, 100 * row.error[0].displacement, 100 * row.error[1].displacement,
             100 * row.error[0].von_mises, 100 * row.error[1].von_mises) +
         image("Fig. 9", "09") + image("Fig. 10", "10") + image("Fig. 11", "11");
}

std::vector<std::string> find_failures(const std::vector<Row>& rows) {
  std::vector<std::string> failures;
  for (const auto& row : rows) {
    if (!(row.torque < balance)) failures.push_back(fmt::format("H = {} rings: a torque is left", row.ratio));
    if (!(row.disagreement < agreement))
      failures.push_back(fmt::format("H = {} rings: spectrum and run come to rest apart", row.ratio));
    if (row.ratio == figure_ratio && !(row.error[1].displacement < row.error[0].displacement))
      failures.push_back(fmt::format("H = {} rings: normalisation does not help", row.ratio));
  }
  return failures;
}

}  // namespace

Report zhang_case_2_report(const Progress& progress) {
  std::vector<Row> rows(ratios.size());
  parallel_for(static_cast<int>(ratios.size()), [&](int i) { rows[i] = make_row(ratios[i]); });
  if (progress) progress(0.9);
  const Statics statics;
  Report report;
  report.failures = find_failures(rows);
  report.summary = text_of(rows) + fmt::format("{} of the claims above do not hold.\n", report.failures.size());
  report.files = {{"README.md", "# Case 2 of Zhang, Hu, Cui & Wang\n\n" + report.summary +
                                    "\nRegenerate with `sphstab report zhang-case-2 --overwrite`; the annulus is that "
                                    "of `scenes/zhang-case-2.toml`, with H of one ring.\n"},
                  {"table.csv", io::to_csv(table(rows))},
                  {"figure_09.svg", positions_figure(statics)},
                  {"figure_10.svg", stress_map_figure(statics)},
                  {"figure_11.svg", radial_figure(statics)}};
  return report;
}

}  // namespace sphstab::study
