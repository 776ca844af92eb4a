// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <boost/math/tools/toms748_solve.hpp>

#include "analysis/critical_step.hpp"
#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"
#include "study/step_comparison.hpp"
#include "study/zhang_cases.hpp"

namespace sphstab::study {
namespace {

constexpr int patch_cells = 12;
constexpr double tolerance = 1e-6;
constexpr std::array<double, 13> h_over_spacing{0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.1, 1.2, 1.4};
/// Points of the curves of Eq. 15 and of the bulk limit.
constexpr int curve_points = 46;
/// The figure ends here, a little above the other curves; Eq. 15 leaves it.
constexpr double largest_drawn_step = 7e-3;

constexpr const char* case_file =
    R"(# Zhang, Hu, Cui & Wang, validation Case 1; H is varied (smoothing length over spacing)
scheme = "tl-linear"
plane = "stress"
spacing = 2.5e-5
density = 1000.0
young_modulus = 0.39
poisson_ratio = 0.3
kernel = "gaussian"
gaussian_cutoff = 5
h_over_spacing = 0.8
plate = [20, 20]
)";

Problem<2> plate_problem(double ratio, Plane plane, KernelNormalisation normalisation) {
  return zhang::problem(ratio * zhang::particle_spacing, normalisation, plane);
}

Body<2> plate(const Problem<2>& problem) {
  return free_plate<2>(problem, {zhang::particles_a_side, zhang::particles_a_side});
}

/// The three things that are run, with the column that shows them.
struct Setting {
  std::string_view name;
  bool periodic;
  KernelNormalisation normalisation;

  BodyChoice<2> body(const Problem<2>& problem) const {
    if (periodic) return PeriodicPatch<2>{{patch_cells, patch_cells}};
    return plate(problem);
  }
};
constexpr std::array<Setting, 3> settings{{{"periodic patch", true, KernelNormalisation::none},
                                           {"free plate", false, KernelNormalisation::none},
                                           {"free plate, normalised", false, KernelNormalisation::sum}}};

struct Row {
  double ratio;
  double published;
  double bulk;
  std::array<StepComparison, 3> runs;
};

double published(double ratio, Plane plane) {
  return *analysis::published_bound(plate_problem(ratio, plane, KernelNormalisation::none));
}

/// H/Δ at which Eq. 15 equals the limit, above which it is unsafe; to 1e-4.
double crossing(Plane plane, const std::function<double(double ratio)>& limit) {
  const auto excess = [&](double ratio) { return published(ratio, plane) - limit(ratio); };
  const auto close = [](double low, double high) { return high - low < 1e-4; };
  std::uintmax_t iterations = 50;
  const auto [low, high] = boost::math::tools::toms748_solve(excess, 0.72, 1.2, close, iterations);
  return 0.5 * (low + high);
}

double bulk_crossing(Plane plane) {
  return crossing(plane,
                  [plane](double ratio) { return *bulk_step(plate_problem(ratio, plane, KernelNormalisation::none)); });
}

double plate_crossing(Plane plane, KernelNormalisation normalisation) {
  return crossing(plane, [=](double ratio) {
    const auto problem = plate_problem(ratio, plane, normalisation);
    return *theory_limit<2>(problem, plate(problem)).critical_time_step;
  });
}

std::vector<Row> compare_all(const Progress& progress) {
  std::vector<Row> rows(h_over_spacing.size());
  std::vector<std::function<void()>> work;
  // Wide kernels cost most: they go first, so that no thread is left with one at the end.
  for (std::size_t i = rows.size(); i-- > 0;)
    for (std::size_t run = 0; run < settings.size(); ++run)
      work.push_back([&rows, i, run] {
        const auto problem = plate_problem(h_over_spacing[i], Plane::stress, settings[run].normalisation);
        rows[i].runs[run] = compare_step(problem, settings[run].body(problem), {.tolerance = tolerance});
      });
  run_all(work, progress);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].ratio = h_over_spacing[i];
    rows[i].published = published(rows[i].ratio, Plane::stress);
    rows[i].bulk = *bulk_step(plate_problem(rows[i].ratio, Plane::stress, KernelNormalisation::none));
  }
  return rows;
}

/// What Eq. 15 is worth at this H: safe everywhere, or where it is not.
std::string judgement(const Row& row) {
  std::string unsafe = row.published > row.bulk ? "bulk" : "";
  for (std::size_t i = 1; i < settings.size(); ++i)
    if (row.published > row.runs[i].run.critical_time_step)
      unsafe += (unsafe.empty() ? "" : ", ") + std::string(settings[i].name);
  return unsafe.empty() ? "conservative" : "unsafe: " + unsafe;
}

double largest_difference(const Row& row) {
  double largest = 0.0;
  for (const auto& comparison : row.runs) largest = std::max(largest, comparison.relative_difference().value_or(0.0));
  return largest;
}

/// The rows with every step in units of `unit`, a time.
io::Document to_document(const std::vector<Row>& rows, double unit) {
  const auto step = [unit](const std::optional<double>& value) {
    return value ? io::Document(*value / unit) : io::Document();
  };
  io::Document document = io::Document::array();
  for (const Row& row : rows) {
    io::Document entry{{"h_over_spacing", row.ratio}, {"eq_15", row.published / unit}, {"bulk", row.bulk / unit}};
    for (std::size_t i = 0; i < settings.size(); ++i) {
      entry[fmt::format("run_{}", i)] = step(row.runs[i].run.critical_time_step);
      entry[fmt::format("theory_{}", i)] = step(row.runs[i].theory.critical_time_step);
    }
    entry["largest_difference"] = largest_difference(row);
    entry["eq_15_over_bulk"] = row.published / row.bulk;
    entry["eq_15_is"] = judgement(row);
    document.push_back(std::move(entry));
  }
  return document;
}

/// For people: milliseconds, the runs, and how far the worst of them is from its theory.
io::Table short_table(const std::vector<Row>& rows) {
  std::vector<io::Column> columns{
      {"h_over_spacing", "H/Δ", "{:.2f}"}, {"eq_15", "Eq. 15 [ms]", "{:.6f}"}, {"bulk", "exact bulk [ms]", "{:.6f}"}};
  for (std::size_t i = 0; i < settings.size(); ++i)
    columns.push_back({fmt::format("run_{}", i), fmt::format("run: {} [ms]", settings[i].name), "{:.6f}"});
  columns.push_back({"largest_difference", "run to theory, worst", "{:.0e}"});
  columns.push_back({"eq_15_over_bulk", "Eq. 15 / bulk", "{:.3f}"});
  columns.push_back({"eq_15_is", "Eq. 15 is"});
  return io::select(to_document(rows, 1e-3), columns);
}

/// For programs: seconds, every run beside the theory of the same body.
io::Table full_table(const std::vector<Row>& rows) {
  std::vector<io::Column> columns{
      {"h_over_spacing", "H/Δ", "{}"}, {"eq_15", "Eq. 15 [s]", "{:.9e}"}, {"bulk", "exact bulk [s]", "{:.9e}"}};
  for (std::size_t i = 0; i < settings.size(); ++i)
    for (const std::string_view kind : {"run", "theory"})
      columns.push_back({fmt::format("{}_{}", kind, i), fmt::format("{}: {} [s]", kind, settings[i].name), "{:.9e}"});
  columns.push_back({"eq_15_is", "Eq. 15 is"});
  return io::select(to_document(rows, 1.0), columns);
}

io::LineFigure to_figure(const std::vector<Row>& rows, double unsafe_from) {
  constexpr double millisecond = 1e-3;
  io::LineFigure figure;
  figure.title = "Critical time step of Zhang's Case 1 plate against the smoothing length";
  figure.x_label = "H / Δ";
  figure.y_label = "critical time step [ms]";
  figure.shades.push_back({unsafe_from, h_over_spacing.back(), "Eq. 15 unsafe in bulk"});
  io::Curve eq_15{"Eq. 15", {}, io::CurveStyle::dashed}, bulk{"exact bulk limit", {}, io::CurveStyle::line};
  for (int i = 0; i < curve_points; ++i) {
    const double ratio =
        h_over_spacing.front() + (h_over_spacing.back() - h_over_spacing.front()) * i / (curve_points - 1);
    if (const double step = published(ratio, Plane::stress); step < largest_drawn_step)
      eq_15.points.emplace_back(ratio, step / millisecond);
    bulk.points.emplace_back(ratio,
                             *bulk_step(plate_problem(ratio, Plane::stress, KernelNormalisation::none)) / millisecond);
  }
  figure.curves = {eq_15, bulk};
  for (std::size_t i = 0; i < settings.size(); ++i) {
    io::Curve curve{fmt::format("bisection, {}", settings[i].name), {}, io::CurveStyle::points};
    for (const Row& row : rows)
      if (row.runs[i].run.critical_time_step)
        curve.points.emplace_back(row.ratio, *row.runs[i].run.critical_time_step / millisecond);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

std::vector<std::string> find_failures(const std::vector<Row>& rows) {
  std::vector<std::string> failures;
  for (const Row& row : rows)
    for (std::size_t i = 0; i < settings.size(); ++i)
      if (!row.runs[i].agrees(tolerance))
        failures.push_back(fmt::format("H/Δ = {}: bisection on the {} and its theory differ by more than {:g}",
                                       row.ratio, settings[i].name, tolerance));
  return failures;
}

}  // namespace

Report zhang_plate_report(const Progress& progress) {
  const auto rows = compare_all(progress);
  const double bulk_stress = bulk_crossing(Plane::stress);
  std::array<double, 2> plate_crossings{};
  parallel_for(2, [&](int i) { plate_crossings[i] = plate_crossing(Plane::stress, settings[i + 1].normalisation); });
  std::string text = fmt::format(
      "Zhang, Hu, Cui & Wang, Case 1: {0}×{0} particles, Gaussian kernel, plane stress, leapfrog.\n"
      "Critical time step by Eq. 15, by the exact bulk theory, and by bisection on the running solver: a periodic "
      "patch\n"
      "of {1}×{1} particles and the free plate, without and with kernel normalisation, each beside its own theory.\n\n",
      zhang::particles_a_side, patch_cells);
  text += io::to_markdown(short_table(rows));
  text += fmt::format(
      "\nEq. 15 is conservative where only the four nearest neighbours matter and unsafe for wider kernels:\n\n"
      "- above H/Δ = {:.3f} in bulk (plane strain: {:.3f}),\n"
      "- above H/Δ = {:.3f} on the free plate,\n"
      "- above H/Δ = {:.3f} on the free plate with kernel normalisation.\n\n",
      bulk_stress, bulk_crossing(Plane::strain), plate_crossings[0], plate_crossings[1]);
  double least_limit = rows.front().bulk, least_bound = rows.front().published;
  for (const Row& row : rows) {
    least_limit = std::min(least_limit, row.bulk);
    least_bound = std::min(least_bound, row.published);
    for (const auto& comparison : row.runs) least_limit = std::min(least_limit, comparison.run.low);
  }
  text += fmt::format(
      "The paper gives no H. It states 1.8 ms as the bound and steps with 0.5 ms: below every limit here (least {:.3f} "
      "ms),\n"
      "though Eq. 15 gives 1.8 ms for none of these H (least {:.3f} ms).\n\n",
      least_limit * 1e3, least_bound * 1e3);
  const auto failures = find_failures(rows);
  text += fmt::format("{} bisections, tolerance {:g}: {} differ from theory by more than it.\n",
                      rows.size() * settings.size(), tolerance, failures.size());

  Report report;
  report.summary = text;
  report.files = {
      {"README.md", "# Critical time step of Zhang's Case 1 plate\n\n" + text +
                        "\n![Critical time step against H/Δ](figure.svg)\n\n"
                        "Regenerate with `sphstab report zhang-plate --overwrite`; `case.toml` holds the data "
                        "of one H, `table.csv` the numbers in seconds.\n"},
      {"case.toml", case_file},
      {"table.csv", io::to_csv(full_table(rows))},
      {"table.md", io::to_markdown(short_table(rows))},
      {"figure.svg", io::render_svg(to_figure(rows, bulk_stress))}};
  report.failures = failures;
  return report;
}

}  // namespace sphstab::study
