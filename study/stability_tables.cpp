// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/answers.hpp"
#include "study/report.hpp"
#include "study/rules_of_thumb.hpp"
#include "study/sweep.hpp"

namespace sphstab::study {
namespace {

/// The Courant number of tl-linear depends on kernel, h/Δp and lattice alone; the rules of thumb on ν as well.
constexpr double poisson_ratio = 0.3;
const std::vector<double> plane_ratios{1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2.0, 2.5, 3.0};
/// In space wide supports hold many hundreds of neighbours.
const std::vector<double> space_ratios{1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2.0};
/// Every bracket is claimed to be narrower, relative, and most to be tight; wide isotropic kernels have nearly constant
/// |D| on whole shells.
constexpr double widest_bracket = 2e-5, tight_bracket = 1e-11;
/// Of SPHinXsys, a rule with the bulk speed.
constexpr double bulk_rule_default = 0.6;

std::vector<RuleOfThumb> rules(int dimension) {
  return rules_of_thumb(Material::from_young_modulus(1.0, 1.0, poisson_ratio), 1.0, dimension);
}

std::string factor_column(std::string_view rule) { return fmt::format("equivalents.{}.factor_at_limit", rule); }

Case base_case(int dimension) {
  Case base;
  base.set("dimension", static_cast<double>(dimension));
  base.set("scheme", "tl-linear");
  base.set("young_modulus", 1.0);
  base.set("poisson_ratio", poisson_ratio);
  return base;
}

/// Kernels by name, ratios by value: the cells of one lattice.
struct LatticeTable {
  std::string lattice;
  std::vector<double> ratios;
  std::map<std::string, std::vector<double>> courant_numbers;
};

/// What one dimension gives: the rows of the sweep, and from them a table a lattice.
struct DimensionTables {
  int dimension;
  Json rows;
  std::vector<LatticeTable> lattices;
};

std::vector<KeyValue> words(std::span<const std::string_view> names) {
  std::vector<KeyValue> values;
  for (const auto name : names) values.emplace_back(std::string(name));
  return values;
}

DimensionTables work_out(int dimension, const Progress& progress) {
  const auto& ratios = dimension == 3 ? space_ratios : plane_ratios;
  std::vector<KeyValue> lattices;
  for (const auto kind : lattices_of(dimension)) lattices.emplace_back(std::string(name_of(kind)));
  const Sweep sweep = make_sweep(base_case(dimension), {{"lattice", lattices},
                                                        {"kernel", words(all_names<KernelFamily>)},
                                                        {"h_over_spacing", {ratios.begin(), ratios.end()}}});
  Question question{time_step_answer, {"neighbours", "courant_number", "bracket", "critical_mode.wave_vector"}};
  for (const auto& rule : rules(dimension)) question.columns.push_back(factor_column(rule.rule));

  DimensionTables tables{
      dimension, table_rows(sweep, question, run_sweep(sweep, question, {.progress = progress})), {}};
  for (const Json& row : tables.rows) {
    if (tables.lattices.empty() || tables.lattices.back().lattice != row["lattice"])
      tables.lattices.push_back({row["lattice"], ratios, {}});
    tables.lattices.back().courant_numbers[row["kernel"]].push_back(row["courant_number"]);
  }
  return tables;
}

/// One row a kernel, one column an h/Δp, and Δt c_p/h at the last.
io::Table pivot(const LatticeTable& table) {
  io::Table cells{{"kernel"}, {}};
  for (const double ratio : table.ratios) cells.header.push_back(fmt::format("{:.1f}", ratio));
  cells.header.push_back("per h");
  for (const auto kernel : all_names<KernelFamily>) {
    const auto& numbers = table.courant_numbers.at(std::string(kernel));
    cells.rows.push_back({std::string(kernel)});
    for (const double number : numbers) cells.rows.back().push_back(fmt::format("{:.4f}", number));
    cells.rows.back().push_back(fmt::format("{:.4f}", numbers.back() / table.ratios.back()));
  }
  return cells;
}

io::LineFigure figure(const LatticeTable& table) {
  io::LineFigure figure;
  figure.title = fmt::format("Critical time step on the {} lattice, tl-linear", table.lattice);
  figure.x_label = "h / Δp";
  figure.y_label = "Courant number Δt c_p / Δp";
  for (const auto kernel : all_names<KernelFamily>) {
    io::Curve curve{std::string(kernel), {}, io::CurveStyle::line_and_points};
    const auto& numbers = table.courant_numbers.at(std::string(kernel));
    for (std::size_t i = 0; i < numbers.size(); ++i) curve.points.emplace_back(table.ratios[i], numbers[i]);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

/// The rows for a file: numbers to ten digits, which no rounding error of the search reaches.
io::Table file_table(const DimensionTables& tables) {
  std::vector<io::Column> columns{{"lattice", "lattice"},
                                  {"kernel", "kernel"},
                                  {"h_over_spacing", "h_over_spacing"},
                                  {"neighbours", "neighbours"},
                                  {"courant_number", "courant_number", "{:.10g}"}};
  for (const auto& rule : rules(tables.dimension))
    columns.push_back({factor_column(rule.rule), std::string(rule.rule), "{:.10g}"});
  return io::select(tables.rows, columns);
}

/// The smallest factor that a rule bears in one dimension.
double least_factor(const DimensionTables& tables, std::string_view rule) {
  const std::string column = factor_column(rule);
  double least = tables.rows.front()[column];
  for (const Json& row : tables.rows) least = std::min(least, row[column].get<double>());
  return least;
}

double least_factor(const std::vector<DimensionTables>& all, std::string_view rule) {
  double least = least_factor(all.front(), rule);
  for (const auto& tables : all) least = std::min(least, least_factor(tables, rule));
  return least;
}

io::Table rules_table(const std::vector<DimensionTables>& all) {
  io::Table cells{{"rule", "time step", "default", "least factor at the limit 1D", "2D", "3D"}, {}};
  for (const auto& rule : rules(3)) {
    cells.rows.push_back({std::string(rule.rule), fmt::format("factor × {}", rule.formula),
                          rule.default_factor ? fmt::format("{}", *rule.default_factor) : "none"});
    for (const auto& tables : all) cells.rows.back().push_back(fmt::format("{:.3f}", least_factor(tables, rule.rule)));
  }
  return cells;
}

/// Widths of all brackets, relative.
std::vector<double> widths(const std::vector<DimensionTables>& all) {
  std::vector<double> found;
  for (const auto& tables : all)
    for (const Json& row : tables.rows)
      found.push_back(row["bracket"][1].get<double>() / row["bracket"][0].get<double>() - 1.0);
  return found;
}

/// The Poisson's ratio below which a rule with the bulk speed √(K/ρ) needs a smaller factor than `factor` where one
/// with the p-wave speed √(M/ρ) bears `p_wave_factor`: K/M = (1 + ν)/(3(1 − ν)).
double poisson_ratio_of_bulk_rule(double factor, double p_wave_factor) {
  const double ratio = 3.0 * std::pow(factor / p_wave_factor, 2);
  return (ratio - 1.0) / (ratio + 1.0);
}

}  // namespace

Report stability_tables_report(const Progress& progress) {
  std::vector<DimensionTables> all;
  for (const int dimension : {1, 2, 3})
    all.push_back(work_out(dimension, [&](double fraction) {
      // Nearly all of the work is in space.
      if (progress) progress(dimension == 3 ? fraction : 0.0);
    }));

  Report report;
  std::string text = fmt::format(
      "Critical time step of `tl-linear` with leapfrog or velocity Verlet on an infinite lattice, as the Courant "
      "number "
      "Δt c_p/Δp\n"
      "(p-wave speed c_p). For this scheme it depends on kernel, lattice and h/Δp alone: not on the material, nor on "
      "plane "
      "strain or\n"
      "stress. The last column, Δt c_p/h at the largest h/Δp, is what a kernel tends to whatever the lattice: a step "
      "of so "
      "many h/c_p.\n"
      "Gaussian cut at 3 h. Bulk values: free, renormalised edges and irregular particles bear less.\n");
  std::string latex;
  for (const auto& tables : all)
    for (const auto& table : tables.lattices) {
      const std::string name = fmt::format("{}d-{}", tables.dimension, table.lattice);
      text += fmt::format("\n## {} ({}D)\n\n{}\n![Courant number against h/Δp]({}.svg)\n", table.lattice,
                          tables.dimension, io::to_markdown(pivot(table)), name);
      latex += fmt::format("% {}, {}D: Courant number over kernel and h / spacing\n{}\n", table.lattice,
                           tables.dimension, io::to_latex(pivot(table)));
      report.files.emplace_back(name + ".svg", io::render_svg(figure(table)));
    }
  text += fmt::format(
      "\n## Rules of thumb of other codes\n\n"
      "The smallest factor that a rule bears over all of these tables, for ν = {}; its default is safe in bulk if it "
      "is "
      "below.\n\n{}\n"
      "The factors of every row are in `1d.csv`, `2d.csv` and `3d.csv`. A rule with the bulk speed √(K/ρ) bears √(K/M) "
      "of "
      "what one with\n"
      "the p-wave speed does, K/M = (1 + ν)/(3(1 − ν)): the default {} of SPHinXsys is unsafe somewhere in these "
      "tables "
      "for ν < {:.2f}.\n",
      poisson_ratio, io::to_markdown(rules_table(all)), bulk_rule_default,
      poisson_ratio_of_bulk_rule(bulk_rule_default, least_factor(all, "Radioss SPH cell step")));
  const auto brackets = widths(all);
  const auto narrow =
      std::count_if(brackets.begin(), brackets.end(), [](double width) { return width < tight_bracket; });
  if (const double widest = *std::max_element(brackets.begin(), brackets.end()); widest > widest_bracket)
    report.failures.push_back(fmt::format("a bracket is {:.1e} wide", widest));
  text += fmt::format(
      "\n{} critical steps, each the maximum over the whole zone, certified: {} to better than {:g}, all to better "
      "than "
      "{:g}.\n",
      brackets.size(), narrow, tight_bracket, widest_bracket);

  report.summary = text;
  report.files.emplace_back("README.md",
                            "# Stability tables\n\n" + text +
                                "\nRegenerate with `sphstab report stability-tables --overwrite`; a table of "
                                "your own with `sphstab table`.\n");
  for (const auto& tables : all)
    report.files.emplace_back(fmt::format("{}d.csv", tables.dimension), io::to_csv(file_table(tables)));
  report.files.emplace_back("tables.tex", latex);
  return report;
}

}  // namespace sphstab::study
