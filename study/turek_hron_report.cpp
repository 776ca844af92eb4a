// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/beams.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"
#include "study/rules_of_thumb.hpp"
#include "study/scene_run.hpp"

namespace sphstab::study {
namespace {

using namespace beams;

constexpr std::array spacings{4e-3, 2e-3, 1e-3};
constexpr double soft = 0.5e6, stiff = 2e6;  ///< μ of CSM1 and CSM3, and of CSM2
constexpr double tolerance = 1e-6;
constexpr double duration = 4.0;  ///< of CSM3: four periods and more
constexpr double usual_fraction = 0.9, bold_fraction = 0.98, safe_fraction = 0.5;

/// Turek & Hron (2006), Table 9 to 11: displacements of the middle of the free end, finest elements.
struct Published {
  Vector<2> csm1{-7.187e-3, -66.10e-3};
  Vector<2> csm2{-0.469e-3, -16.97e-3};
  Vector<2> mean{-14.305e-3, -63.607e-3};
  Vector<2> amplitude{14.305e-3, 65.160e-3};
  double frequency = 1.0995;
};
const Published published;

struct Statics {
  Method method;
  double shear_modulus;
  double spacing;
  Rest rest = {};
  Vector<2> end = Vector<2>::Zero();
};

void settle(Statics& one) {
  const auto scene = make_scene(bar_scene({one.shear_modulus, one.spacing}, one.method));
  one.rest = rest_of(scene, tolerance);
  one.end = reading_at(scene, bar_end)(one.rest.displacement);
}

/// How the step of a run is chosen.
enum class Steps { followed, fixed };

struct Oscillation {
  Method method;
  double spacing;
  Steps steps;
  double fraction;
  int particles = 0;
  std::vector<double> time = {};
  std::vector<Vector<2>> end = {};
  Vector<2> mean = Vector<2>::Zero(), amplitude = Vector<2>::Zero();
  double frequency = 0.0;
  SceneSummary summary = {};
  double time_step_at_rest = 0.0;  ///< critical
  bool grew = false;
};

/// The lowest point through three equally spaced values.
double vertex(double before, double at, double after) { return 0.5 * (before - after) / (before - 2.0 * at + after); }

/// Means, amplitudes, and the frequency between the first and the last lowest point.
void read(Oscillation& run) {
  for (int i = 0; i < 2; ++i) {
    double low = 0.0, high = -1.0;
    for (const auto& u : run.end) {
      low = std::min(low, u[i]);
      high = std::max(high, u[i]);
    }
    run.mean[i] = 0.5 * (high + low);
    run.amplitude[i] = 0.5 * (high - low);
  }
  // One lowest point for every stay in the lower half.
  std::vector<double> lowest;
  for (std::size_t n = 0; n < run.end.size();) {
    if (run.end[n][1] >= run.mean[1]) {
      ++n;
      continue;
    }
    std::size_t best = n;
    for (; n < run.end.size() && run.end[n][1] < run.mean[1]; ++n)
      if (run.end[n][1] < run.end[best][1]) best = n;
    if (n == run.end.size() || best == 0) break;
    const double offset = vertex(run.end[best - 1][1], run.end[best][1], run.end[best + 1][1]);
    lowest.push_back(run.time[best] + offset * (run.time[best + 1] - run.time[best]));
  }
  if (lowest.size() > 1) run.frequency = static_cast<double>(lowest.size() - 1) / (lowest.back() - lowest.front());
}

void oscillate(Oscillation& run) {
  auto scene = make_scene(bar_scene({soft, run.spacing}, run.method));
  const auto reading = reading_at(scene, bar_end);
  for (const int particle : reading.particles) scene.probes.push_back({"", particle});
  run.particles = scene.body.size();
  run.time_step_at_rest = step_of(scene, 1.0);
  SceneRunOptions<2> options{.time_step = run.fraction * run.time_step_at_rest, .duration = duration};
  options.probe_samples = 4000;
  if (run.steps == Steps::followed) options.followed_fraction = run.fraction;
  const auto result = run_scene<2>(scene, options);
  run.time = result.sample_times;
  run.summary = result.summary;
  run.grew = result.growth || result.failure;
  for (std::size_t n = 0; n < run.time.size(); ++n) {
    Vector<2> u = Vector<2>::Zero();
    for (std::size_t i = 0; i < reading.particles.size(); ++i)
      u += reading.weights[i] * result.probes[i].displacement[n];
    run.end.push_back(u);
  }
  read(run);
}

struct Runs {
  std::vector<Statics> statics;
  std::vector<Oscillation> oscillations;
};

Runs everything(const Progress& progress) {
  Runs runs;
  const auto all = methods();
  for (const auto& method : {all[1], all[0]}) {
    for (const double mu : {soft, stiff})
      for (const double spacing : spacings) runs.statics.push_back({method, mu, spacing});
    for (const double spacing : spacings)
      if (method.name == all[1].name || spacing > spacings.back())
        runs.oscillations.push_back({method, spacing, Steps::followed, usual_fraction});
  }
  runs.oscillations.push_back({all[1], spacings.front(), Steps::followed, bold_fraction});
  runs.oscillations.push_back({all[1], spacings.front(), Steps::fixed, safe_fraction});
  std::vector<std::function<void()>> work;
  for (auto& one : runs.oscillations) work.push_back([&one] { oscillate(one); });
  for (auto& one : runs.statics) work.push_back([&one] { settle(one); });
  run_all(work, progress);
  return runs;
}

std::string name_of_step(const Oscillation& run) {
  return run.steps == Steps::followed ? fmt::format("auto, {:g}", run.fraction)
                                      : fmt::format("fixed, {:g} Δt_c at rest", run.fraction);
}

std::string percent(double ratio) { return fmt::format("{:+.2f} %", 100.0 * (ratio - 1.0)); }
std::string in_millimetres(double length) { return fmt::format("{:.3f}", 1e3 * length); }

const Vector<2>& published_of(const Statics& one) {
  return one.shear_modulus == soft ? published.csm1 : published.csm2;
}

/// Between one spacing and half of it, of a factor by which something falls.
std::string order_of(double factor) { return fmt::format("{:.2f}", std::log2(std::abs(factor))); }

/// Of the error of a displacement beside the published one.
std::string order_of_error(const Statics& coarse, const Statics& fine, int direction) {
  const auto error = [&](const Statics& one) { return one.end[direction] / published_of(one)[direction] - 1.0; };
  return order_of(error(coarse) / error(fine));
}

std::string name_of(const Statics& one) { return one.shear_modulus == soft ? "CSM1" : "CSM2"; }

io::Table static_table(const std::vector<Statics>& statics) {
  io::Table table{{"test", "scheme", "Δx [mm]", "steps", "u_x [mm]", "difference", "order", "u_y [mm]", "difference",
                   "order", "of self-convergence"},
                  {}};
  for (std::size_t i = 0; i < statics.size(); ++i) {
    const Statics& one = statics[i];
    const std::size_t level = i % spacings.size();
    std::array<std::string, 2> order;
    if (level > 0)
      for (int direction : {0, 1}) order[direction] = order_of_error(statics[i - 1], one, direction);
    const std::string of_itself =
        level == 2 ? order_of((statics[i - 2].end[1] - statics[i - 1].end[1]) / (statics[i - 1].end[1] - one.end[1]))
                   : "";
    table.rows.push_back({name_of(one), std::string(one.method.name), fmt::format("{:g}", 1e3 * one.spacing),
                          one.rest.converged ? fmt::format("{}", one.rest.steps) : "no rest",
                          in_millimetres(one.end[0]), percent(one.end[0] / published_of(one)[0]), order[0],
                          in_millimetres(one.end[1]), percent(one.end[1] / published_of(one)[1]), order[1], of_itself});
    if (level == spacings.size() - 1)
      table.rows.push_back({name_of(one), "published", "", "", in_millimetres(published_of(one)[0]), "", "",
                            in_millimetres(published_of(one)[1]), "", "", ""});
  }
  return table;
}

io::Table oscillation_table(const std::vector<Oscillation>& runs) {
  io::Table table{{"scheme", "Δx [mm]", "step", "steps", "f [Hz]", "difference", "u_x [mm]", "u_y [mm]",
                   "amplitude of u_y", "smallest … largest Δt/Δt_c at rest"},
                  {}};
  for (const auto& run : runs) {
    const auto& following = run.summary.following;
    table.rows.push_back({std::string(run.method.name), fmt::format("{:g}", 1e3 * run.spacing), name_of_step(run),
                          fmt::format("{}", run.summary.steps), fmt::format("{:.4f}", run.frequency),
                          percent(run.frequency / published.frequency),
                          fmt::format("{} ± {}", in_millimetres(run.mean[0]), in_millimetres(run.amplitude[0])),
                          fmt::format("{} ± {}", in_millimetres(run.mean[1]), in_millimetres(run.amplitude[1])),
                          percent(run.amplitude[1] / published.amplitude[1]),
                          following ? fmt::format("{:.4f} … {:.4f}", following->smallest_step / run.time_step_at_rest,
                                                  following->largest_step / run.time_step_at_rest)
                                    : ""});
  }
  table.rows.push_back(
      {"published", "", "", "", fmt::format("{:.4f}", published.frequency), "",
       fmt::format("{} ± {}", in_millimetres(published.mean[0]), in_millimetres(published.amplitude[0])),
       fmt::format("{} ± {}", in_millimetres(published.mean[1]), in_millimetres(published.amplitude[1])), "", ""});
  return table;
}

/// The work of following the limit in CSM3, in counts: no clock has a part in them.
double share_of_following(const Oscillation& run) {
  return static_cast<double>(run.summary.following->work.applications) / static_cast<double>(run.summary.steps);
}

io::Table following_table(const std::vector<Oscillation>& runs) {
  io::Table table{{"scheme", "Δx [mm]", "step", "steps", "updates", "steps an update", "applications of the operator",
                   "applications over steps"},
                  {}};
  for (const auto& run : runs) {
    if (run.steps != Steps::followed) continue;
    const auto& work = run.summary.following->work;
    table.rows.push_back(
        {std::string(run.method.name), fmt::format("{:g}", 1e3 * run.spacing), name_of_step(run),
         fmt::format("{}", run.summary.steps), fmt::format("{}", work.updates),
         fmt::format("{:.0f}", static_cast<double>(run.summary.steps) / static_cast<double>(work.updates)),
         fmt::format("{}", work.applications), fmt::format("{:.3f} %", 100.0 * share_of_following(run))});
  }
  return table;
}

/// What the law makes: R·S over F·S, all else the same.
io::Table law_table(const Runs& runs) {
  io::Table table{{"test", "Δx [mm]", "u_x", "u_y", "f", "amplitude of u_x", "amplitude of u_y"}, {}};
  const auto is_other = [](const auto& one, const auto& other) {
    return other.method.name == methods()[1].name && other.spacing == one.spacing;
  };
  const auto part = [](double corotated, double pk1) {
    return fmt::format("{:+.3f} %", 100.0 * (corotated / pk1 - 1.0));
  };
  for (const auto& one : runs.statics) {
    if (one.method.name != methods()[0].name) continue;
    const auto other = std::find_if(runs.statics.begin(), runs.statics.end(), [&](const Statics& pk1) {
      return is_other(one, pk1) && pk1.shear_modulus == one.shear_modulus;
    });
    table.rows.push_back({name_of(one), fmt::format("{:g}", 1e3 * one.spacing), part(one.end[0], other->end[0]),
                          part(one.end[1], other->end[1]), "", "", ""});
  }
  for (const auto& one : runs.oscillations) {
    if (one.method.name != methods()[0].name) continue;
    const auto other = std::find_if(runs.oscillations.begin(), runs.oscillations.end(),
                                    [&](const Oscillation& pk1) { return is_other(one, pk1); });
    table.rows.push_back({"CSM3", fmt::format("{:g}", 1e3 * one.spacing), "", "", part(one.frequency, other->frequency),
                          part(one.amplitude[0], other->amplitude[0]), part(one.amplitude[1], other->amplitude[1])});
  }
  return table;
}

/// Steps of CSM3 by rules of thumb beside those of `auto`.
io::Table rule_table(const Oscillation& run) {
  io::Table table{{"rule", "factor", "Δt/Δt_c at rest", "safe", "steps over those of auto"}, {}};
  const auto scene = bar_scene({soft, run.spacing}, run.method);
  for (const auto& rule : rules_of_thumb(scene.problem.material, scene.problem.kernel.smoothing_length(), 2)) {
    const double step = rule.default_factor.value_or(1.0) * rule.unit;
    const bool safe = step < run.time_step_at_rest;
    table.rows.push_back({std::string(rule.rule), rule.default_factor ? fmt::format("{}", *rule.default_factor) : "1",
                          fmt::format("{:.3f}", step / run.time_step_at_rest), safe ? "yes" : "no",
                          safe ? fmt::format("{:.2f}", duration / step / static_cast<double>(run.summary.steps)) : ""});
  }
  return table;
}

io::LineFigure figure_of(const std::vector<Oscillation>& runs) {
  io::LineFigure figure{
      .title = "CSM3: the middle of the free end", .x_label = "time [s]", .y_label = "u_y [m]", .curves = {}};
  for (const auto& run : runs) {
    if (run.steps != Steps::followed || run.fraction != usual_fraction) continue;
    io::Curve curve{fmt::format("{}, Δx = {:g} mm", run.method.name, 1e3 * run.spacing), {}};
    for (std::size_t n = 0; n < run.time.size(); n += 5) curve.points.emplace_back(run.time[n], run.end[n][1]);
    figure.curves.push_back(std::move(curve));
  }
  io::Curve range{"published range", {}, io::CurveStyle::dashed};
  for (const double sign : {-1.0, 1.0}) {
    const double y = published.mean[1] + sign * published.amplitude[1];
    range.points.emplace_back(0.0, y);
    range.points.emplace_back(duration, y);
    range.points.emplace_back(duration, std::nan(""));
  }
  figure.curves.push_back(std::move(range));
  return figure;
}

/// Of the finest particles of tl-pk1, the law of the benchmark.
constexpr double static_agreement = 0.03, frequency_agreement = 0.03, amplitude_agreement = 0.03;
/// An update of eight applications takes about as long as twenty steps: 0.8 % of the steps are 2 % of the run.
constexpr double largest_share_of_following = 0.008;
/// Two ways to choose the step give the same answer to these parts.
constexpr double same_frequency = 1e-3, same_amplitude = 5e-3;

std::vector<std::string> failures_of(const Runs& runs) {
  std::vector<std::string> failures;
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) failures.push_back(what);
  };
  for (const auto& one : runs.statics) {
    require(one.rest.converged, fmt::format("{} comes to no rest", one.method.name));
    if (one.spacing == spacings.back() && one.method.name == "tl-pk1")
      require(std::abs(one.end[1] / published_of(one)[1] - 1.0) < static_agreement,
              fmt::format("u_y of {:g} Pa is {} mm", one.shear_modulus, in_millimetres(one.end[1])));
  }
  for (const auto& run : runs.oscillations) {
    require(!run.grew, fmt::format("CSM3 of {} grows at {:g} of the limit", run.method.name, run.fraction));
    if (run.spacing == spacings.back()) {
      require(std::abs(run.frequency / published.frequency - 1.0) < frequency_agreement,
              fmt::format("CSM3 swings at {:.4f} Hz", run.frequency));
      require(std::abs(run.amplitude[1] / published.amplitude[1] - 1.0) < amplitude_agreement,
              fmt::format("CSM3 swings by {} mm", in_millimetres(run.amplitude[1])));
    }
    if (run.steps == Steps::followed)
      require(share_of_following(run) < largest_share_of_following,
              fmt::format("following takes {} applications", run.summary.following->work.applications));
    const Oscillation& other = runs.oscillations.front();
    if (run.spacing == other.spacing && run.method.name == other.method.name) {
      require(std::abs(run.frequency / other.frequency - 1.0) < same_frequency &&
                  std::abs(run.amplitude[1] / other.amplitude[1] - 1.0) < same_amplitude,
              fmt::format("at {:g} of the limit CSM3 swings at {:.5f} Hz by {} mm", run.fraction, run.frequency,
                          in_millimetres(run.amplitude[1])));
    }
  }
  return failures;
}

}  // namespace

Report turek_hron_report(const Progress& progress) {
  const Runs runs = everything(progress);
  Report report;
  report.failures = failures_of(runs);
  const io::Table statics = static_table(runs.statics), oscillations = oscillation_table(runs.oscillations),
                  laws = law_table(runs), following = following_table(runs.oscillations),
                  rules = rule_table(runs.oscillations.front());
  report.summary = fmt::format(
      "The elastic bar of Turek & Hron (2006) without its fluid, under its weight: 0.35 × 0.02 m, clamped in a "
      "cylinder, "
      "Saint Venant–Kirchhoff,\nν = 0.4, plane strain; sinc-5, h = 1.2 Δx, `leapfrog`. `tl-pk1` has the law of the "
      "benchmark, `tl-corotated` another one (R·S).\n\n"
      "## CSM1 and CSM2, at rest\n\nDisplacements of the middle of the free end. The order is that of the error of "
      "u_x and u_y beside the published values, between one\nspacing and half of it; that of self-convergence is of "
      "u_y alone, without a reference. The former falls from spacing to spacing, as where an error has parts:\nin the "
      "small bending of `report tran-duc` that of few particles across falls faster than that of the clamp.\n"
      "Cells of {:g} mm do not fit the free length of 0.35 m: their clamp is up to half a cell off.\n\n{}\n"
      "## Where R·S and F·S differ\n\n`tl-corotated` over `tl-pk1`, all else the same.\n\n{}\n"
      "## CSM3, from rest without damping, {:g} s\n\n`auto` follows the largest eigenvalue of the moving bar: that of "
      "its "
      "free corners, which hardly strain, so\nthat it does not change by a thousandth;\nthe step is less by what waves "
      "of the bar's velocity may take of it. Frequency between the first and "
      "the last lowest point.\n\n{}\n"
      "What following takes, in counts: applications of the linearised operator, each of which takes about as long as "
      "two or three steps.\n\n{}\n"
      "## Steps of other rules\n\nFor tl-pk1, Δx = {:g} mm. A rule is safe if its step is below the critical step of "
      "the "
      "bar at rest.\n\n{}",
      1e3 * spacings.front(), io::to_markdown(statics), io::to_markdown(laws), duration, io::to_markdown(oscillations),
      io::to_markdown(following), 1e3 * spacings.front(), io::to_markdown(rules));
  report.files = {
      {"README.md", "# The bar of Turek and Hron\n\n" + report.summary +
                        "\n![the free end over time](csm3.svg)\n\nRegenerate with `sphstab report turek-hron "
                        "--overwrite`.\n"},
      {"statics.csv", io::to_csv(statics)},
      {"laws.csv", io::to_csv(laws)},
      {"csm3.csv", io::to_csv(oscillations)},
      {"following.csv", io::to_csv(following)},
      {"rules.csv", io::to_csv(rules)},
      {"csm3.svg", io::render_svg(figure_of(runs.oscillations))}};
  return report;
}

}  // namespace sphstab::study
