// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "io/document.hpp"
#include "study/gray_plate.hpp"
#include "study/parallel.hpp"
#include "study/particle_pictures.hpp"
#include "study/report.hpp"

namespace sphstab::study {
namespace {

using gray::Oscillation;
using gray::Plate;

/// A row of Table 1 (H = 2) or Table 2 (H = 1).
struct PrintedPeriod {
  double height, tip_velocity, shear_modulus;
  double sph;
  double theory;  ///< as printed
};

constexpr std::array printed{
    PrintedPeriod{2.0, 0.001, 0.22, 1674.6, 1557.0}, PrintedPeriod{2.0, 0.01, 0.22, 1671.5, 1557.0},
    PrintedPeriod{2.0, 0.03, 0.22, 1688.2, 1557.0},  PrintedPeriod{2.0, 0.05, 0.22, 1705.0, 1557.0},
    PrintedPeriod{2.0, 0.001, 0.30, 1473.6, 1341.9}, PrintedPeriod{2.0, 0.01, 0.30, 1469.8, 1341.9},
    PrintedPeriod{2.0, 0.03, 0.30, 1482.1, 1341.9},  PrintedPeriod{2.0, 0.05, 0.30, 1495.4, 1341.9},
    PrintedPeriod{2.0, 0.001, 0.60, 1131.6, 1030.4}, PrintedPeriod{2.0, 0.01, 0.60, 1127.2, 1030.4},
    PrintedPeriod{2.0, 0.03, 0.60, 1130.7, 1030.4},  PrintedPeriod{2.0, 0.05, 0.60, 1136.1, 1030.4},
    PrintedPeriod{1.0, 0.01, 0.22, 3333.6, 3213.0},  PrintedPeriod{1.0, 0.03, 0.22, 3385.7, 3213.0},
    PrintedPeriod{1.0, 0.05, 0.22, 3322.8, 3213.0},  PrintedPeriod{1.0, 0.01, 0.30, 2902.0, 2833.0},
    PrintedPeriod{1.0, 0.03, 0.30, 2977.7, 2833.0},  PrintedPeriod{1.0, 0.05, 0.30, 2934.9, 2833.0},
    PrintedPeriod{1.0, 0.01, 0.60, 2214.4, 2175.0},  PrintedPeriod{1.0, 0.03, 0.60, 2221.7, 2175.0},
    PrintedPeriod{1.0, 0.05, 0.60, 2200.4, 2175.0}};

/// Δp of the tables: that for which Eq. 7.1 with H − Δp gives the printed theory (errata.md G16).
constexpr double table_spacing = 0.1;
/// One oscillation of a plate whose period is up to 1.2 times that of Eq. 7.1 with H − Δp, and the next turn.
constexpr double periods = 1.55;
/// With it the plate of Table 2 is as finely resolved as that of Table 1. The paper does not say how finely it was.
constexpr double fine_spacing = 0.05;
/// The printed runs and ours differ in viscosity, time step and clamp, which the paper does not give.
constexpr double period_tolerance = 0.03;

/// Steps of the runs with other viscosities: α = 1 has its limit at 1.77.
constexpr double viscous_courant_number = 1.2;

/// A plate and how it swung.
struct Run {
  std::string what;
  Plate plate;
  int images = 0;
  double longer = 1.0;  ///< times the periods above
  Oscillation outcome = {};
};

Plate plate_of(const PrintedPeriod& row, double epsilon, double spacing = table_spacing) {
  return {.height = row.height,
          .across = static_cast<int>(std::lround(row.height / spacing)),
          .shear_modulus = row.shear_modulus,
          .tip_velocity = row.tip_velocity,
          .epsilon = epsilon};
}

/// All runs of the report, by what they are for.
struct Runs {
  std::vector<Run> with, without;        ///< artificial stress, in the order of `printed`
  std::vector<PrintedPeriod> fine_rows;  ///< of Table 2
  std::vector<Run> fine;                 ///< in their order
  std::vector<Run> resolution, viscosity, step, pictures;
};

Runs all_runs() {
  Runs runs;
  for (const auto& row : printed) {
    runs.with.push_back({"", plate_of(row, 0.3)});
    runs.without.push_back({"", plate_of(row, 0.0)});
    if (row.height == 1.0 && row.tip_velocity == 0.01) {
      runs.fine_rows.push_back(row);
      runs.fine.push_back({"", plate_of(row, 0.3, fine_spacing)});
    }
  }
  for (const int across : {10, 20, 30})
    runs.resolution.push_back({fmt::format("n = {}", across), {.across = across}, 0, 1.3});
  for (const double epsilon : {0.3, 0.0}) {
    for (const double alpha : {0.0, 0.02, 0.1, 0.5, 1.0})
      runs.viscosity.push_back({fmt::format("ε = {}, α = {}", epsilon, alpha),
                                {.epsilon = epsilon, .viscosity = alpha, .courant_number = viscous_courant_number}});
    const Plate on_approach{.epsilon = epsilon,
                            .viscosity = 1.0,
                            .viscous_pairs = ViscousPairs::approaching,
                            .courant_number = viscous_courant_number};
    runs.viscosity.push_back({fmt::format("ε = {}, α = 1 on approach", epsilon), on_approach});
  }
  const auto add_step = [&](Integrator integrator, double courant, double alpha) {
    const Plate plate{.across = 10, .viscosity = alpha, .integrator = integrator, .courant_number = courant};
    runs.step.push_back({fmt::format("{}, Δt = {} Δp/c_p, α = {}", name_of(integrator), courant, alpha), plate});
  };
  for (const double courant : {1.6, 0.8, 0.4}) add_step(Integrator::leapfrog, courant, 0.5);
  for (const Integrator integrator : {Integrator::verlet, Integrator::predictor_corrector}) {
    add_step(integrator, 0.8, 0.5);
    add_step(integrator, 0.4, 0.5);
  }
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::verlet, Integrator::predictor_corrector})
    add_step(integrator, 0.4, 0.0);
  for (const double epsilon : {0.0, 0.3}) {
    const Plate plate{.shear_modulus = 0.6, .tip_velocity = 0.05, .epsilon = epsilon};
    runs.pictures.push_back({epsilon > 0.0 ? "whole" : "fracture", plate, 3, 0.5});
  }
  return runs;
}

void run_all_plates(Runs& runs, const Progress& progress) {
  std::vector<std::function<void()>> work;
  for (auto* group :
       {&runs.fine, &runs.with, &runs.without, &runs.resolution, &runs.viscosity, &runs.step, &runs.pictures})
    for (Run& run : *group)
      work.push_back([&run] { run.outcome = gray::oscillate(run.plate, periods * run.longer, run.images); });
  run_all(work, progress);
}

std::string number(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "–";
}

std::string percent(const std::optional<double>& value) {
  return value ? fmt::format("{:+.1f} %", 100.0 * *value) : "–";
}

/// Where and when pairs parted, in words.
std::vector<std::string> parting_cells(const Oscillation& run) {
  if (!run.parting) return {"–", "–", "–", "–"};
  const auto& parting = *run.parting;
  return {fmt::format("{:.0f}", parting.time), fmt::format("({:.1f}, {:.1f})", parting.place[0], parting.place[1]),
          fmt::format("{:.3g}", parting.tension), fmt::format("{:.1f}", parting.e_foldings)};
}

std::string state_of(const Oscillation& run) {
  if (run.failed) return "no numbers";
  if (!run.period) return "breaks";
  return run.parting ? "swings, pairs part" : "whole";
}

const std::vector<std::string> parting_header{"pairs part at t", "at (x, y)", "tension before", "e-foldings predicted"};

void append(std::vector<std::string>& row, const std::vector<std::string>& cells) {
  row.insert(row.end(), cells.begin(), cells.end());
}

/// T over the paper's less 1, if the plate swung.
std::optional<double> difference(const PrintedPeriod& row, const Run& run) {
  std::optional<double> difference;
  if (run.outcome.period) difference = *run.outcome.period / row.sph - 1.0;
  return difference;
}

/// Rows of Tables 1 and 2 beside three theories.
io::Table period_table(std::span<const PrintedPeriod> rows, const std::vector<Run>& runs) {
  io::Table table{{"H", "V_f", "μ", "T", "T of the paper", "T / paper's", "theory printed", "Eq. 7.1, H − Δp",
                   "Eq. 7.1, H", "T / Eq. 7.1, H − Δp", "amplitude lost a period", "plate"},
                  {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = rows[i];
    const auto& run = runs[i].outcome;
    const double thin = gray::slender_period(row.height - runs[i].plate.spacing(), row.shear_modulus);
    std::optional<double> over_thin;
    if (run.period) over_thin = *run.period / thin - 1.0;
    table.rows.push_back({fmt::format("{:.0f}", row.height), fmt::format("{}", row.tip_velocity),
                          fmt::format("{:.2f}", row.shear_modulus), number(run.period, "{:.1f}"),
                          fmt::format("{:.1f}", row.sph), percent(difference(row, runs[i])),
                          fmt::format("{:.1f}", row.theory), fmt::format("{:.1f}", thin),
                          fmt::format("{:.1f}", gray::slender_period(row.height, row.shear_modulus)),
                          percent(over_thin), percent(run.decay), state_of(run)});
  }
  return table;
}

/// Largest difference of rows of one height, none if a plate did not swing.
std::optional<double> largest_difference(std::span<const PrintedPeriod> rows, const std::vector<Run>& runs,
                                         double height) {
  double largest = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].height != height) continue;
    const auto found = difference(rows[i], runs[i]);
    if (!found) return std::nullopt;
    largest = std::max(largest, std::abs(*found));
  }
  return largest;
}

/// The same plates without artificial stress.
io::Table fracture_table(const Runs& runs) {
  io::Table table{{"H", "V_f", "μ", "T"}, {}};
  append(table.header, parting_header);
  table.header.push_back("plate");
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const auto& row = printed[i];
    const auto& run = runs.without[i].outcome;
    table.rows.push_back({fmt::format("{:.0f}", row.height), fmt::format("{}", row.tip_velocity),
                          fmt::format("{:.2f}", row.shear_modulus), number(run.period, "{:.1f}")});
    append(table.rows.back(), parting_cells(run));
    table.rows.back().push_back(state_of(run));
  }
  return table;
}

/// Runs of one plate that differ in one thing.
io::Table comparison_table(const std::string& what, const std::vector<Run>& runs) {
  io::Table table{{what, "T", "amplitude lost a period"}, {}};
  append(table.header, parting_header);
  table.header.push_back("plate");
  for (const Run& run : runs) {
    table.rows.push_back({run.what, number(run.outcome.period, "{:.1f}"), percent(run.outcome.decay)});
    append(table.rows.back(), parting_cells(run.outcome));
    table.rows.back().push_back(state_of(run.outcome));
  }
  return table;
}

constexpr std::size_t points_of_curve = 400;

io::LineFigure deflection_figure(const std::string& title, const std::vector<const Run*>& runs) {
  io::LineFigure figure{
      .title = title, .x_label = "time c0 / cm", .y_label = "deflection of the tip / cm", .curves = {}};
  for (const Run* run : runs) {
    const auto& [time, deflection] = std::tie(run->outcome.time, run->outcome.deflection);
    io::Curve curve{run->what, {}};
    const std::size_t every = std::max<std::size_t>(1, time.size() / points_of_curve);
    for (std::size_t n = 0; n < time.size(); n += every) curve.points.emplace_back(time[n], deflection[n]);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

io::ParticleFigure picture(const Run& run) {
  const Body<2> body = make_scene(gray::plate_scene(run.plate)).body;
  io::ParticleFigure figure{.title = fmt::format("μ = {}, V_f = {}, ε = {}", run.plate.shear_modulus,
                                                 run.plate.tip_velocity, run.plate.epsilon),
                            .x_label = "x / cm",
                            .y_label = "y / cm",
                            .value_label = "σxx",
                            .radius = particle_radius(body),
                            .panels = {},
                            .columns = 2};
  for (const auto& image : run.outcome.images)
    if (image.time > 0.0 && drawable<2>(body, image.displacement))
      figure.panels.push_back(
          particle_panel<2>(fmt::format("t = {:.0f}", image.time), body, image.displacement, 1.0, image.stress));
  return figure;
}

std::vector<std::string> failures_of(const Runs& runs) {
  std::vector<std::string> failures;
  if (const auto largest = largest_difference(printed, runs.with, 2.0); !largest || *largest > period_tolerance)
    failures.push_back(fmt::format("Table 1: periods differ from the paper's by {}", percent(largest)));
  if (!largest_difference(printed, runs.with, 1.0) || !largest_difference(runs.fine_rows, runs.fine, 1.0))
    failures.push_back("a plate of Table 2 does not swing");
  for (std::size_t i = 0; i < printed.size(); ++i)
    if (printed[i].tip_velocity >= 0.03 && runs.without[i].outcome.period)
      failures.push_back(fmt::format("H = {}, V_f = {}, μ = {}: does not break without artificial stress",
                                     printed[i].height, printed[i].tip_velocity, printed[i].shear_modulus));
  if (runs.viscosity[0].outcome.period) failures.push_back("artificial stress keeps the plate without viscosity");
  const auto lost = [](const Run& run) { return run.outcome.lost_particles > 0; };
  if (std::any_of(runs.with.begin(), runs.with.end(), lost))
    failures.push_back("a plate with artificial stress loses particles");
  return failures;
}

}  // namespace

Report gray_plate_report(const Progress& progress) {
  Runs runs = all_runs();
  run_all_plates(runs, progress);
  Report report;
  report.failures = failures_of(runs);
  const auto percent_of = [](const std::optional<double>& largest) {
    return largest ? fmt::format("{:.1f} %", 100.0 * *largest) : "–";
  };
  const std::vector<std::pair<std::string, io::Table>> tables{
      {"periods", period_table(printed, runs.with)},
      {"without_artificial_stress", fracture_table(runs)},
      {"resolution", comparison_table("spacings across H", runs.resolution)},
      {"viscosity", comparison_table("artificial stress and viscosity", runs.viscosity)},
      {"steps", comparison_table("integrator and step", runs.step)},
      {"fine_periods", period_table(runs.fine_rows, runs.fine)}};
  report.summary = fmt::format(
      "The oscillating plate of Gray, Monaghan & Swift, Sec. 7.1, in their units (cm, c0, ρ0 c0²): L = {} cm, H = 2 "
      "or 1 cm, h = 1.5 Δp,\nΔp = {} cm, XSPH 0.5, n = 4. The paper gives neither viscosity nor time step nor the "
      "size of the clamp: here α = 0.5, `leapfrog`\nwith Δt = 1.6 Δp/c_p, and a clamp of {} cm between two layers of "
      "{} particles.\n\n"
      "- With artificial stress every plate swings. Periods differ from the paper's by at most {} in Table 1. Table 2 "
      "does not come out:\n  {}, and {} with 20 spacings across as in Table 1; the paper does not say how finely it "
      "was resolved.\n"
      "- Periods are 10 to 14 % above the thin plate of Eq. 7.1 with H − Δp, and 15 to 25 % above it with H; the "
      "printed theory is the former\n  (errata.md G16).\n"
      "- Without artificial stress plates with V_f of 0.03 and more break where the lower side meets the clamp, that "
      "of Fig. 2 too.\n"
      "- Artificial stress alone does not keep the plate: without viscosity it falls apart within half a period, "
      "whatever the step\n  and the integrator. On the square lattice no ε is stable in tension (report tension); "
      "viscosity slows what grows.\n\n"
      "T is the time of the second passage through the place of rest. A plate `breaks` if its tip does not come back; "
      "pairs `part` when\nneighbours on the lattice are more than {} Δp apart.\n\n"
      "Tables 1 and 2, ε = 0.3:\n\n"
      "{}\nTable 2 with Δp = {}:\n\n"
      "{}\nThe same as Tables 1 and 2 without artificial stress. The e-foldings are those of the fastest mode of the "
      "tension at the root,\nviscosity included, over its history up to then:\n\n"
      "{}",
      gray::plate_length, table_spacing, gray::clamp_length, gray::clamp_layers,
      percent_of(largest_difference(printed, runs.with, 2.0)), percent_of(largest_difference(printed, runs.with, 1.0)),
      percent_of(largest_difference(runs.fine_rows, runs.fine, 1.0)), gray::parted, io::to_markdown(tables[0].second),
      fine_spacing, io::to_markdown(tables[5].second), io::to_markdown(tables[1].second));
  std::string text = "# The oscillating plate\n\n" + report.summary;
  text += "\n## Resolution (Fig. 4)\n\nμ = 0.22, V_f = 0.01, ε = 0.3.\n\n" + io::to_markdown(tables[2].second) +
          "\n![deflection of the tip for three resolutions](resolution.svg)\n";
  text += "\n## Viscosity\n\nn = 20, μ = 0.22, V_f = 0.01: what the paper does not give decides.\n\n" +
          io::to_markdown(tables[3].second) + "\n![deflection of the tip for several viscosities](viscosity.svg)\n";
  text += "\n## Integrator and step\n\nn = 10, μ = 0.22, V_f = 0.01, ε = 0.3.\n\n" + io::to_markdown(tables[4].second);
  text += "\n## Fracture (Figs. 2 and 3)\n\nμ = 0.6, V_f = 0.05, without and with artificial stress.\n";
  for (const Run& run : runs.pictures) {
    report.files.emplace_back(run.what + ".svg", io::render_svg(picture(run)));
    text += fmt::format("\n![the plate with ε = {}]({}.svg)\n", run.plate.epsilon, run.what);
  }
  text += "\nRegenerate with `sphstab report gray-plate --overwrite`.\n";
  const auto figure_of = [](const std::string& title, const std::vector<Run>& group) {
    std::vector<const Run*> chosen;
    for (const Run& run : group) chosen.push_back(&run);
    return io::render_svg(deflection_figure(title, chosen));
  };
  std::vector<Run> with_artificial_stress;
  for (const Run& run : runs.viscosity)
    if (run.plate.epsilon > 0.0 && run.outcome.period) with_artificial_stress.push_back(run);
  report.files.emplace_back("resolution.svg", figure_of("n spacings across H = 2 cm", runs.resolution));
  report.files.emplace_back("viscosity.svg", figure_of("ε = 0.3, several viscosities", with_artificial_stress));
  for (const auto& [name, table] : tables) report.files.emplace_back(name + ".csv", io::to_csv(table));
  report.files.emplace_back("README.md", std::move(text));
  return report;
}

}  // namespace sphstab::study
