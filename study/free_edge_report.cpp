// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "analysis/critical_step.hpp"
#include "analysis/spectrum.hpp"
#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/p_wave_speed.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"
#include "study/rules_of_thumb.hpp"
#include "study/step_comparison.hpp"

namespace sphstab::study {
namespace {

struct KernelChoice {
  KernelFamily kernel;
  double h_over_spacing;
};
constexpr std::array kernels{KernelChoice{KernelFamily::sinc_5, 1.2}, KernelChoice{KernelFamily::cubic_spline, 1.3},
                             KernelChoice{KernelFamily::wendland_c2, 1.6}};
constexpr std::array poisson_ratios{-0.3, 0.0, 0.3, 0.4};
constexpr std::array plates{6, 10, 20};
constexpr int run_plate = 10;
/// Of the critical step of a run.
constexpr double tolerance = 1e-6;
/// About 0.6, errata T8.
constexpr double largest_factor = 0.7, smallest_factor = 0.5;
/// Between the two largest plates.
constexpr double size_independent = 5e-3;

Problem<2> problem_of(const KernelChoice& choice, double poisson_ratio, Formulation formulation) {
  Scheme scheme;
  scheme.formulation = formulation;
  return {.lattice = Lattice<2>(LatticeKind::square, 1.0),
          .kernel = Kernel<2>(choice.kernel, choice.h_over_spacing),
          .material = Material::from_young_modulus(1.0, 1.0, poisson_ratio),
          .scheme = scheme};
}

struct Edge {
  KernelChoice choice;
  double poisson_ratio;
  Formulation formulation;
  double bulk = 0.0;
  std::array<double, plates.size()> plate = {};
  StepComparison run = {};

  Problem<2> problem() const { return problem_of(choice, poisson_ratio, formulation); }
  double factor() const { return plate.back() / bulk; }
};

void find(Edge& edge) {
  const auto problem = edge.problem();
  edge.bulk = *bulk_step(problem);
  for (std::size_t i = 0; i < plates.size(); ++i)
    edge.plate[i] =
        analysis::body_limit(problem, free_plate<2>(problem, LatticeIndex<2>::Constant(plates[i]))).critical_time_step;
  edge.run =
      compare_step<2>(problem, free_plate<2>(problem, LatticeIndex<2>::Constant(run_plate)), {.tolerance = tolerance});
}

std::vector<Edge> all_edges(const Progress& progress) {
  std::vector<Edge> edges;
  for (const auto formulation : {Formulation::total_lagrangian_corotated, Formulation::total_lagrangian_pk1})
    for (const auto& choice : kernels)
      for (const double nu : poisson_ratios) edges.push_back({choice, nu, formulation});
  std::vector<std::function<void()>> work;
  for (auto& edge : edges) work.push_back([&edge] { find(edge); });
  run_all(work, progress);
  return edges;
}

io::Table edge_table(const std::vector<Edge>& edges) {
  io::Table table{{"scheme", "kernel", "h/Δp", "ν", "Δt_c c_p/Δp, bulk", "6×6", "10×10", "20×20", "20×20 / bulk",
                   "10×10 by running", "difference"},
                  {}};
  for (const auto& edge : edges) {
    const double unit = 1.0 / p_wave_speed(edge.problem());
    const auto courant = [&](double step) { return fmt::format("{:.5f}", step / unit); };
    table.rows.push_back({std::string(name_of(edge.formulation)), std::string(name_of(edge.choice.kernel)),
                          fmt::format("{:g}", edge.choice.h_over_spacing), fmt::format("{:g}", edge.poisson_ratio),
                          courant(edge.bulk), courant(edge.plate[0]), courant(edge.plate[1]), courant(edge.plate[2]),
                          fmt::format("{:.4f}", edge.factor()), courant(edge.run.run.critical_time_step.value_or(0.0)),
                          fmt::format("{:.0e}", edge.run.relative_difference().value_or(1.0))});
  }
  return table;
}

/// Rules whose default factor, or 1 where they have none, is above the limit of the plate.
io::Table rule_table(const std::vector<Edge>& edges) {
  io::Table table{{"rule", "factor", "kernel", "ν", "Δt/Δt_c, bulk", "Δt/Δt_c, plate", "safe"}, {}};
  for (const auto& edge : edges) {
    if (edge.formulation != Formulation::total_lagrangian_corotated) continue;
    const auto problem = edge.problem();
    for (const auto& rule : rules_of_thumb(problem.material, problem.kernel.smoothing_length(), 2)) {
      const double step = rule.default_factor.value_or(1.0) * rule.unit;
      const bool in_bulk = step < edge.bulk, on_plate = step < edge.plate.back();
      table.rows.push_back({std::string(rule.rule), fmt::format("{:g}", rule.default_factor.value_or(1.0)),
                            std::string(name_of(edge.choice.kernel)), fmt::format("{:g}", edge.poisson_ratio),
                            fmt::format("{:.3f}", step / edge.bulk), fmt::format("{:.3f}", step / edge.plate.back()),
                            on_plate ? "yes" : (in_bulk ? "in bulk only" : "no")});
    }
  }
  return table;
}

io::LineFigure figure_of(const std::vector<Edge>& edges) {
  io::LineFigure figure{.title = "Free, renormalised edges: critical step of a 20×20 plate over that of the lattice",
                        .x_label = "ν",
                        .y_label = "Δt_c(plate) / Δt_c(bulk)",
                        .curves = {}};
  for (const auto& choice : kernels) {
    io::Curve curve{fmt::format("{}, h = {:g} Δp", name_of(choice.kernel), choice.h_over_spacing),
                    {},
                    io::CurveStyle::line_and_points};
    for (const auto& edge : edges)
      if (edge.choice.kernel == choice.kernel && edge.formulation == Formulation::total_lagrangian_corotated)
        curve.points.emplace_back(edge.poisson_ratio, edge.factor());
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

std::vector<std::string> failures_of(const std::vector<Edge>& edges) {
  std::vector<std::string> failures;
  for (const auto& edge : edges) {
    const std::string name =
        fmt::format("{}, {}, ν = {:g}", name_of(edge.formulation), name_of(edge.choice.kernel), edge.poisson_ratio);
    if (!(edge.factor() > smallest_factor && edge.factor() < largest_factor))
      failures.push_back(fmt::format("{}: the factor is {:.4f}", name, edge.factor()));
    if (!(std::abs(edge.plate[1] / edge.plate[2] - 1.0) < size_independent))
      failures.push_back(fmt::format("{}: the limit depends on the size of the plate", name));
    if (!edge.run.agrees(tolerance))
      failures.push_back(
          fmt::format("{}: running differs by {:.1e}", name, edge.run.relative_difference().value_or(1.0)));
  }
  return failures;
}

}  // namespace

Report free_edge_report(const Progress& progress) {
  const auto edges = all_edges(progress);
  Report report;
  report.failures = failures_of(edges);
  double least = 1.0, most = 0.0;
  for (const auto& edge : edges) {
    least = std::min(least, edge.factor());
    most = std::max(most, edge.factor());
  }
  const io::Table table = edge_table(edges), rules = rule_table(edges);
  report.summary = fmt::format(
      "Free square plates of `tl-corotated` and `tl-pk1` at rest: the renormalisation N of particles at edges and "
      "corners "
      "raises the largest\nfrequency, and the critical step is {:.3f} to {:.3f} of that of the lattice, whatever the "
      "size "
      "of the plate. `leapfrog`, plane strain.\n\n{}\n"
      "Documented rules of other codes (`sphstab dt` says where they are from; their default factor, or 1 where they "
      "have none) over the limits\nof lattice and plate. They were made for their own schemes; here they are what "
      "somebody would carry over.\n\n{}",
      least, most, io::to_markdown(table), io::to_markdown(rules));
  report.files = {{"README.md", "# Free edges lower the critical step\n\n" + report.summary +
                                    "\n![factor over Poisson's ratio](factor.svg)\n\nRegenerate with `sphstab report "
                                    "free-edges --overwrite`.\n"},
                  {"edges.csv", io::to_csv(table)},
                  {"rules.csv", io::to_csv(rules)},
                  {"factor.svg", io::render_svg(figure_of(edges))}};
  return report;
}

}  // namespace sphstab::study
