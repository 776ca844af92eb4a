// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/growth_cases.hpp"
#include "study/parallel.hpp"
#include "study/patch_wave.hpp"
#include "study/report.hpp"
#include "study/unit_problem.hpp"
#include "study/updated_growth_run.hpp"

namespace sphstab::study {
namespace {

constexpr double bisection_tolerance = 1e-6;

struct Findings {
  std::vector<GrowthCase> growths;
  std::vector<WeakGrowthCase> weak_growths;
  std::vector<BisectionCase> bisections;
  std::vector<DampingCase> dampings;
  std::vector<SwitchCase> switches;
};

/// Queues what fills `results`.
template <class Result>
void queue(const std::vector<std::function<Result()>>& makers, std::vector<Result>& results,
           std::vector<std::function<void()>>& work) {
  results.resize(makers.size());
  for (std::size_t i = 0; i < makers.size(); ++i)
    work.push_back([make = makers[i], &results, i] { results[i] = make(); });
}

Findings find_all(const Progress& progress) {
  Findings found;
  std::vector<std::function<void()>> work;
  queue(bisection_cases(), found.bisections, work);
  queue(growth_cases(), found.growths, work);
  queue(weak_growth_cases(), found.weak_growths, work);
  queue(damping_cases(), found.dampings, work);
  queue(switch_cases(), found.switches, work);
  run_all(work, progress);
  return found;
}

bool holds(const BisectionCase& bisection) { return bisection.found.agrees(bisection_tolerance); }

/// Half, to what the harmonics of half a wave take with them.
bool holds(const DampingCase& damping) {
  const double ratio = damping.approaching / damping.all_pairs;
  return damping.alpha > 0.02 || std::abs(ratio - 0.5) < (damping.is_standing ? 1e-3 : 5e-3);
}

std::vector<std::string> failures_of(const Findings& found) {
  std::vector<std::string> failures;
  for (const auto& growth : found.growths)
    if (!growth.holds()) failures.push_back("growth: " + growth.name);
  for (const auto& weak : found.weak_growths)
    if (!weak.holds()) failures.push_back(fmt::format("{} at ωΔt = {}", name_of(weak.integrator), weak.phase));
  for (const auto& bisection : found.bisections)
    if (!holds(bisection))
      failures.push_back(fmt::format("bisection: {}, {}", bisection.name, name_of(bisection.integrator)));
  for (const auto& damping : found.dampings)
    if (!holds(damping)) failures.push_back(fmt::format("damping: α = {}", damping.alpha));
  return failures;
}

io::Table table_of(const std::vector<GrowthCase>& growths) {
  io::Table table{{"case", "integrator", "Δt c0/Δp", "theory", "seeded run", "seeded − theory", "mean from noise",
                   "± standard error", "noise − theory", "growing"},
                  {}};
  for (const auto& growth : growths) {
    const auto number = [&](double value) { return growth.is_stable() ? "0" : fmt::format("{:.8f}", value); };
    const bool quiet = !growth.has_noise || growth.is_stable();
    table.rows.push_back({growth.name, std::string(name_of(growth.integrator)), fmt::format("{:g}", growth.time_step),
                          number(growth.theory), number(growth.seeded),
                          fmt::format("{:.0e}", growth.seeded - growth.theory), quiet ? "" : number(growth.noise_mean),
                          quiet ? "" : fmt::format("{:.0e}", growth.noise_error),
                          quiet ? "" : fmt::format("{:.0e}", growth.noise_mean - growth.theory),
                          growth.has_noise ? fmt::format("{}/{}", growth.growing, noise_runs) : ""});
  }
  return table;
}

io::Table table_of(const std::vector<WeakGrowthCase>& growths) {
  io::Table table{
      {"integrator", "ωΔt", "leading order", "theory", "seeded run", "seeded − theory", "run / leading order"}, {}};
  for (const auto& weak : growths)
    table.rows.push_back({std::string(name_of(weak.integrator)), fmt::format("{:g}", weak.phase),
                          fmt::format("{:.6e}", weak.leading_order), fmt::format("{:.6e}", weak.theory),
                          fmt::format("{:.6e}", weak.seeded), fmt::format("{:.0e}", weak.seeded - weak.theory),
                          fmt::format("{:.5f}", weak.seeded / weak.leading_order)});
  return table;
}

io::Table table_of(const std::vector<BisectionCase>& bisections) {
  io::Table table{{"case", "integrator", "theory", "run", "difference", "runs", "steps"}, {}};
  for (const auto& [name, integrator, found] : bisections)
    table.rows.push_back({name, std::string(name_of(integrator)),
                          fmt::format("{:.9f}", found.theory.critical_time_step.value_or(0.0)),
                          fmt::format("{:.9f}", found.run.critical_time_step.value_or(0.0)),
                          fmt::format("{:.0e}", found.relative_difference().value_or(1.0)),
                          fmt::format("{}", found.run.runs), fmt::format("{}", found.run.steps)});
  return table;
}

io::Table table_of(const std::vector<DampingCase>& dampings) {
  io::Table table{
      {"wave", "α", "velocity / c0", "theory, all pairs", "run, all pairs", "run, approaching", "approaching / all"},
      {}};
  for (const auto& damping : dampings)
    table.rows.push_back({damping.is_standing ? "standing" : "travelling", fmt::format("{:g}", damping.alpha),
                          fmt::format("{:g}", damping.velocity), fmt::format("{:.6e}", damping.theory),
                          fmt::format("{:.6e}", damping.all_pairs), fmt::format("{:.6e}", damping.approaching),
                          fmt::format("{:.4f}", damping.approaching / damping.all_pairs)});
  return table;
}

io::Table table_of(const std::vector<SwitchCase>& switches) {
  io::Table table{{"Δt / Δt_c", "least slope", "largest slope", "growing"}, {}};
  for (const auto& at : switches)
    table.rows.push_back({fmt::format("{:g}", at.fraction), fmt::format("{:.1e}", at.smallest),
                          fmt::format("{:.1e}", at.largest), fmt::format("{}/{}", at.growing, noise_runs)});
  return table;
}

/// The amplitude of one run from noise over time, and the theory's slope through the last of it that is small.
void add_course(std::string name, const Problem<2>& problem, std::vector<io::Curve>& curves) {
  const LatticeIndex<2> cells(8, 8);
  constexpr double time_step = 0.2, duration = 60.0, small = 1e-4, largest_shown = 1.0;
  constexpr int stride = 5, samples = 60;
  PerturbedPatch<2> patch(problem, cells);
  Eigen::VectorXd departure = patch.noise_departure(1);
  departure *= patch.seed_amplitude(time_step) / patch.amplitude(departure);
  const double rate = fastest_wave<2>(problem, cells, time_step).growth_per_step() / time_step;
  io::Curve course{std::move(name), {}}, slope{"", {}, io::CurveStyle::dashed};
  double at_start = 0.0;
  for (int i = 0; i <= samples; ++i) {
    const double time = i * duration / samples, amplitude = patch.amplitude(departure);
    course.points.emplace_back(time, amplitude);
    if (amplitude < small) at_start = amplitude * std::exp(-rate * time);
    patch.advance(departure, time_step, stride);
  }
  for (const auto& point : course.points)
    if (const double line = at_start * std::exp(rate * point.first); line < largest_shown)
      slope.points.emplace_back(point.first, line);
  curves.push_back(std::move(course));
  if (rate > no_growth) curves.push_back(std::move(slope));
}

/// 60 Δp/c0 in steps of 0.2.
io::LineFigure courses() {
  const auto problem = [](LatticeKind lattice, double epsilon) {
    const auto tension = unit_problem<2>(lattice, KernelFamily::cubic_spline, 1.0, -0.05);
    return epsilon > 0.0 ? with_artificial_stress(tension, epsilon) : tension;
  };
  std::vector<io::Curve> curves;
  for (const double epsilon : {0.0, 0.3})
    for (const auto lattice : {LatticeKind::square, LatticeKind::staggered, LatticeKind::hexagonal})
      add_course(fmt::format("{}, ε = {:g}", name_of(lattice), epsilon), problem(lattice, epsilon), curves);
  return {.title = "A patch in tension, from noise (h = Δp, P = −0.05 ρ0 c0²; dashed: theory's slope)",
          .x_label = "time c0 / Δp",
          .y_label = "amplitude",
          .y_log = true,
          .curves = curves};
}

template <class Cases, class Value>
double largest(const Cases& cases, const Value& value) {
  double result = 0.0;
  for (const auto& one : cases) result = std::max(result, std::abs(value(one)));
  return result;
}

std::string summary_of(const Findings& found) {
  const auto seeded = largest(found.growths, [](const auto& growth) { return growth.seeded - growth.theory; });
  const auto noisy = largest(found.growths, [](const auto& growth) {
    return growth.has_noise && !growth.is_stable() ? growth.noise_mean / growth.theory - 1.0 : 0.0;
  });
  const auto bisected = largest(
      found.bisections, [](const auto& bisection) { return bisection.found.relative_difference().value_or(1.0); });
  const auto at_switch =
      std::count_if(found.switches.begin(), found.switches.end(), [](const auto& at) { return at.growing > 0; });
  return fmt::format(
      "The running solver of the scheme `ul` beside its theory, which is written independently: periodic patches, in "
      "units\nρ0 = c0 = Δp = 1, μ = 0.3, stresses of 5 % of ρ0 c0². How it is "
      "measured:\n[docs/updated_lagrangian.md](../../docs/updated_lagrangian.md).\n\n"
      "- Growth per step of {} base states, both signs of stress: runs from the theory's wave differ from ln |λ| by "
      "at most {:.0e},\n  means over {} runs from noise by at most {:.0e} of the growth; what theory calls stable "
      "grows in no run. The means are\n  within 3 standard errors, or 1e-9 a step where rounding, which is the same in "
      "all runs, makes these smaller.\n"
      "- The predictor-corrector at zero stress grows by (ωΔt)⁴/8 a step, with stored rates by twice that.\n"
      "- {} critical steps by bisection, inviscid `leapfrog` and `verlet`, viscous all four integrators: within "
      "{:.0e} of theory.\n"
      "- Viscosity on approach alone damps a small wave half as fast as on approach and separation, the more exactly "
      "the weaker it\n  is: the harmonics of half a wave's force remain, and in a wave that travels they travel with "
      "it.\n"
      "- At exactly zero stress with artificial stress a run follows neither of the two linearisations, both stable: "
      "at {} of {}\n  steps below the limit of both some of {} runs grow, the faster the nearer to it.\n",
      found.growths.size(), seeded, noise_runs, noisy, found.bisections.size(), bisected, at_switch,
      found.switches.size(), noise_runs);
}

}  // namespace

Report growth_runs_report(const Progress& progress) {
  const Findings found = find_all(progress);
  Report report;
  report.failures = failures_of(found);
  report.summary = summary_of(found) + fmt::format("\n{} claims do not hold.\n", report.failures.size());
  struct Part {
    std::string_view name, title, note;
    io::Table table;
  };
  const std::vector<Part> parts{
      {"growth", "Growth per step", "Of stable states the growth is below rounding.", table_of(found.growths)},
      {"weak_growth", "Predictor-corrector at zero stress", "Square lattice, h = 1.3 Δp, its fastest wave.",
       table_of(found.weak_growths)},
      {"bisection", "Critical steps by bisection", "", table_of(found.bisections)},
      {"damping", "Viscosity on approach alone",
       "Decay rates of a longitudinal wave of 32 particles, h = 1.3 Δp, over four periods.", table_of(found.dampings)},
      {"switch", "At the sign switch",
       "Hexagonal, h = Δp, ε = 0.3, no stress; Δt_c of the side of compression; growth per step over 2000 steps.",
       table_of(found.switches)}};
  std::string text = "# Growth and critical steps of the running scheme `ul`\n\n" + report.summary +
                     "\n![amplitude of patches in tension over time](courses.svg)\n";
  for (const auto& part : parts) {
    text += fmt::format("\n## {}\n\n{}{}{}", part.title, part.note, part.note.empty() ? "" : "\n\n",
                        io::to_markdown(part.table));
    report.files.emplace_back(fmt::format("{}.csv", part.name), io::to_csv(part.table));
  }
  report.files.emplace_back("courses.svg", io::render_svg(courses()));
  report.files.emplace_back("README.md", text + "\nRegenerate with `sphstab report growth-runs --overwrite`.\n");
  return report;
}

}  // namespace sphstab::study
