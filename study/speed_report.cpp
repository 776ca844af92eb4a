// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "analysis/spectrum.hpp"
#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/beams.hpp"
#include "study/elastica.hpp"
#include "study/report.hpp"
#include "study/step_comparison.hpp"
#include "study/thread_clock.hpp"

namespace sphstab::study {
namespace {

using namespace beams;

constexpr double force = 250.0, soft = 0.5e6;
constexpr std::array beam_spacings{5e-3, 2e-3, 1e-3};
constexpr std::array bar_spacings{5e-3, 4e-3, 2e-3};
constexpr std::array fractions{0.85, 0.5, 0.25};
constexpr double tolerance = 1e-5;
constexpr double csm1_drop = 66.10e-3;  ///< Turek & Hron (2006)

/// One run to rest.
struct Point {
  std::string_view scene;
  Method method;
  double spacing;
  double fraction;
  int particles = 0;
  long steps = 0;
  double seconds = 0.0;
  double error = 0.0;  ///< of the displacement of the end across the beam, relative
  bool rests = false;
};

void measure(Point& point) {
  const bool is_beam = point.scene == "cantilever";
  const Beam beam = cantilever(force, point.spacing);
  const auto scene =
      make_scene(is_beam ? beam_scene(beam, point.method) : bar_scene({soft, point.spacing}, point.method));
  point.particles = scene.body.size();
  const double start = thread_seconds();
  const Rest rest = rest_of(scene, tolerance, point.fraction);
  point.seconds = thread_seconds() - start;
  point.steps = rest.steps;
  point.rests = rest.converged;
  const Vector<2> place = is_beam ? Vector<2>(beam.length, 0.5 * beam.height) : bar_end;
  const double reference =
      is_beam ? beam.length * shearable_elastica({beam.length, beam.height, beam.young_modulus}, -force).drop
              : csm1_drop;
  point.error = -reading_at(scene, place)(rest.displacement)[1] / reference - 1.0;
}

/// A way to a critical step.
struct Way {
  std::string name;
  std::string of;
  double seconds;
  double error;  ///< relative, to the exact one of the same lattice or plate
};

/// Median CPU time of several calls.
template <class Work>
double median_seconds(int calls, const Work& work) {
  std::vector<double> seconds;
  for (int i = 0; i < calls; ++i) {
    const double start = thread_seconds();
    work();
    seconds.push_back(thread_seconds() - start);
  }
  std::nth_element(seconds.begin(), seconds.begin() + calls / 2, seconds.end());
  return seconds[calls / 2];
}

constexpr int plate_across = 20;

std::vector<Way> ways() {
  const auto scene = beam_scene(cantilever(force, 2e-3), methods().front());
  const Problem<2>& problem = scene.problem;
  std::vector<Way> found;
  const double exact = *bulk_step(problem);
  const analysis::GradientSymbol<2> symbol(problem);
  for (const int points : {50, 200, 1000}) {
    double step = 0.0;
    const double seconds = median_seconds(5, [&] {
      double largest = 0.0;
      const double unit = symbol.consistency()(0, 0);
      for (int i = 0; i < points; ++i)
        for (int j = 0; j < points; ++j)
          largest =
              std::max(largest, symbol(problem.lattice.reciprocal_vectors() * Vector<2>(i, j) / points).squaredNorm());
      step = 2.0 * unit / std::sqrt(largest * problem.material.p_wave_modulus() / problem.material.density());
    });
    found.push_back({fmt::format("scan of {0}×{0} wave vectors", points), "lattice", seconds, step / exact - 1.0});
  }
  double step = 0.0;
  const double of_maximum = median_seconds(5, [&] { step = *bulk_step(problem); });
  found.push_back({"certified maximum", "lattice", of_maximum, step / exact - 1.0});

  const auto plate = free_plate<2>(problem, LatticeIndex<2>::Constant(plate_across));
  const double of_plate = analysis::body_limit(problem, plate).critical_time_step;
  for (const double accuracy : {1e-2, 1e-4, 1e-10}) {
    const double seconds = median_seconds(3, [&] {
      step = analysis::body_limit(problem, plate, {.bound = analysis::BoundKind::norm_bound, .tolerance = accuracy})
                 .critical_time_step;
    });
    found.push_back({fmt::format("spectrum, Lanczos to {:g}", accuracy), "plate", seconds, step / of_plate - 1.0});
  }
  const double proven = median_seconds(3, [&] { step = analysis::body_limit(problem, plate).critical_time_step; });
  found.push_back({"spectrum, proven by a factorisation", "plate", proven, step / of_plate - 1.0});
  for (const double accuracy : {1e-3, 1e-6}) {
    const double seconds = median_seconds(
        1, [&] { step = *compare_step<2>(problem, plate, {.tolerance = accuracy}).run.critical_time_step; });
    found.push_back({fmt::format("bisection by running, to {:g}", accuracy), "plate", seconds, step / of_plate - 1.0});
  }
  return found;
}

std::vector<Point> points(const Progress& progress) {
  std::vector<Point> all;
  const auto methods_of_beams = methods();
  const auto add = [&](std::string_view scene, int method, double spacing, double fraction) {
    all.push_back({scene, methods_of_beams[method], spacing, fraction});
  };
  for (int method : {0, 1}) {
    for (const double spacing : beam_spacings)
      for (const double fraction : fractions) add("cantilever", method, spacing, fraction);
    for (const double spacing : bar_spacings)
      for (const double fraction : fractions) add("CSM1", method, spacing, fraction);
  }
  // Without artificial stress ul breaks under this force, and with it takes a quarter of the limit of its lattice.
  for (const double spacing : {beam_spacings[0], beam_spacings[1]}) add("cantilever", 3, spacing, fractions.back());
  double done = 0.0;
  for (auto& point : all) {
    measure(point);
    if (progress) progress(++done / static_cast<double>(all.size() + 1));
  }
  return all;
}

io::Table point_table(const std::vector<Point>& all) {
  io::Table table{
      {"scene", "scheme", "Δx [mm]", "particles", "Δt/Δt_c", "steps", "CPU [s]", "ns a particle and step", "error"},
      {}};
  for (const auto& point : all)
    table.rows.push_back(
        {std::string(point.scene), std::string(point.method.name), fmt::format("{:g}", 1e3 * point.spacing),
         fmt::format("{}", point.particles), fmt::format("{:g}", point.fraction), fmt::format("{}", point.steps),
         fmt::format("{:.2f}", point.seconds),
         fmt::format("{:.0f}", 1e9 * point.seconds / (static_cast<double>(point.steps) * point.particles)),
         point.rests ? fmt::format("{:+.3f} %", 100.0 * point.error) : "no rest"});
  return table;
}

io::Table way_table(const std::vector<Way>& all) {
  io::Table table{{"way to Δt_c", "of the", "CPU [s]", "relative error"}, {}};
  for (const auto& way : all)
    table.rows.push_back({way.name, way.of, fmt::format("{:.2e}", way.seconds), fmt::format("{:+.0e}", way.error)});
  return table;
}

io::LineFigure point_figure(const std::vector<Point>& all, std::string_view scene) {
  io::LineFigure figure{.title = fmt::format("Speed against error: {}, displacement of the free end at rest", scene),
                        .x_label = "CPU seconds",
                        .y_label = "relative error",
                        .x_log = true,
                        .y_log = true,
                        .curves = {}};
  for (const auto& point : all) {
    if (point.scene != scene) continue;
    const std::string label = fmt::format("{}, {:g} Δt_c", point.method.name, point.fraction);
    auto curve = std::find_if(figure.curves.begin(), figure.curves.end(),
                              [&](const io::Curve& one) { return one.label == label; });
    if (curve == figure.curves.end())
      curve = figure.curves.insert(curve, io::Curve{label, {}, io::CurveStyle::line_and_points});
    curve->points.emplace_back(point.seconds, std::abs(point.error));
  }
  return figure;
}

io::LineFigure way_figure(const std::vector<Way>& all) {
  io::LineFigure figure{
      .title = "Speed against error: ways to the critical step, but for the two that are the references",
      .x_label = "CPU seconds",
      .y_label = "relative error",
      .x_log = true,
      .y_log = true,
      .curves = {}};
  for (const auto& way : all)
    if (way.error != 0.0)
      figure.curves.push_back({way.name, {{way.seconds, std::abs(way.error)}}, io::CurveStyle::points});
  return figure;
}

std::vector<std::string> failures_of(const std::vector<Point>& all, const std::vector<Way>& found) {
  std::vector<std::string> failures;
  for (const auto& point : all)
    if (!point.rests) failures.push_back(fmt::format("{} of {} comes to no rest", point.scene, point.method.name));
  for (const auto& way : found)
    if (way.name.starts_with("spectrum, proven") && !(std::abs(way.error) < 1e-9))
      failures.push_back(fmt::format("{} errs by {:.1e}", way.name, way.error));
  return failures;
}

}  // namespace

Report speed_report(const Progress& progress) {
  const auto found = ways();
  const auto all = points(progress);
  Report report;
  report.failures = failures_of(all, found);
  report.summary = fmt::format(
      "CPU seconds of one thread against the error that they buy; times are of one machine on one day, errors are "
      "not.\n\n"
      "## To rest\n\nThe cantilever of `report tran-duc` under {:g} N beside a strip with shear and stretch, and CSM1 "
      "of "
      "`report turek-hron` beside its\npublished value; the step is a part of the critical one of the body at rest. "
      "Damping near the critical one of the slowest motion,\nto {:g} of the displacement. A shorter step buys "
      "nothing: the error is that of the spacing.\n\n{}\n"
      "## Ways to the critical step\n\nOf the lattice of that cantilever, and of a free plate of {}×{} particles of "
      "it; "
      "errors against the certified maximum and the\nfactorised spectrum. Medians; the runs of a bisection once.\n\n{}",
      force, tolerance, io::to_markdown(point_table(all)), plate_across, plate_across,
      io::to_markdown(way_table(found)));
  report.files = {
      {"README.md",
       "# Speed against error\n\n" + report.summary +
           "\n![cantilever](cantilever.svg)\n\n![CSM1](csm1.svg)\n\n![critical steps](steps.svg)\n\nRegenerate with "
           "`sphstab report speed-vs-error --overwrite`.\n"},
      {"rest.csv", io::to_csv(point_table(all))},
      {"steps.csv", io::to_csv(way_table(found))},
      {"cantilever.svg", io::render_svg(point_figure(all, "cantilever"))},
      {"csm1.svg", io::render_svg(point_figure(all, "CSM1"))},
      {"steps.svg", io::render_svg(way_figure(found))}};
  return report;
}

}  // namespace sphstab::study
