// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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

Plate plate_of(const PrintedPeriod& row, double epsilon) {
  return {.height = row.height,
          .across = static_cast<int>(std::lround(row.height / table_spacing)),
          .shear_modulus = row.shear_modulus,
          .tip_velocity = row.tip_velocity,
          .epsilon = epsilon};
}

/// All runs of the report, by what they are for.
struct Runs {
  std::vector<Run> with, without;  ///< artificial stress, in the order of `printed`
  std::vector<Run> resolution, viscosity, step, pictures;
};

Runs all_runs() {
  Runs runs;
  for (const auto& row : printed) {
    runs.with.push_back({"", plate_of(row, 0.3)});
    runs.without.push_back({"", plate_of(row, 0.0)});
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
    runs.pictures.push_back({epsilon > 0.0 ? "whole" : "fracture", plate, 5});
  }
  return runs;
}

void run_all_plates(Runs& runs, const Progress& progress) {
  std::vector<std::function<void()>> work;
  for (auto* group : {&runs.with, &runs.without, &runs.resolution, &runs.viscosity, &runs.step, &runs.pictures})
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

/// Tables 1 and 2 beside three theories.
io::Table period_table(const Runs& runs) {
  io::Table table{{"H", "V_f", "μ", "T", "T of the paper", "T / paper's", "theory printed", "Eq. 7.1, H − Δp",
                   "Eq. 7.1, H", "T / Eq. 7.1, H − Δp", "amplitude lost a period", "plate"},
                  {}};
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const auto& row = printed[i];
    const auto& run = runs.with[i].outcome;
    const double thin = gray::slender_period(row.height - table_spacing, row.shear_modulus);
    const auto over = [&](double value) {
      return run.period ? std::optional(*run.period / value - 1.0) : std::nullopt;
    };
    table.rows.push_back({fmt::format("{:.0f}", row.height), fmt::format("{}", row.tip_velocity),
                          fmt::format("{:.2f}", row.shear_modulus), number(run.period, "{:.1f}"),
                          fmt::format("{:.1f}", row.sph), percent(over(row.sph)), fmt::format("{:.1f}", row.theory),
                          fmt::format("{:.1f}", thin),
                          fmt::format("{:.1f}", gray::slender_period(row.height, row.shear_modulus)),
                          percent(over(thin)), percent(run.decay), state_of(run)});
  }
  return table;
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
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const auto& period = runs.with[i].outcome.period;
    if (!period || std::abs(*period / printed[i].sph - 1.0) > period_tolerance)
      failures.push_back(fmt::format(
          "H = {}, V_f = {}, μ = {}: with artificial stress the period is {}, the paper's {}", printed[i].height,
          printed[i].tip_velocity, printed[i].shear_modulus, number(period, "{:.1f}"), printed[i].sph));
  }
  if (runs.pictures[0].outcome.period)
    failures.push_back("without artificial stress the plate of Fig. 2 does not break");
  if (runs.pictures[1].outcome.parting)
    failures.push_back("with artificial stress the plate of Fig. 3 does not stay whole");
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
  const std::vector<std::pair<std::string, io::Table>> tables{
      {"periods", period_table(runs)},
      {"without_artificial_stress", fracture_table(runs)},
      {"resolution", comparison_table("spacings across H", runs.resolution)},
      {"viscosity", comparison_table("artificial stress and viscosity", runs.viscosity)},
      {"steps", comparison_table("integrator and step", runs.step)}};
  report.summary = fmt::format(
      "The oscillating plate of Gray, Monaghan & Swift, Sec. 7.1, in their units (cm, c0, ρ0 c0²): L = {} cm, H = 2 or "
      "1 cm, h = 1.5 Δp,\nΔp = 0.1 cm, XSPH 0.5, n = 4. The paper gives neither viscosity nor time step nor the size "
      "of "
      "the clamp: here α = 0.5, `leapfrog` with\nΔt = 1.6 Δp/c_p, and a clamp of {} cm between two layers of {} "
      "particles. A plate `breaks` if its tip does not come back; pairs `part` when\nlattice neighbours are more than "
      "{} "
      "Δp apart.\n\nTables 1 and 2, ε = 0.3:\n\n{}\nThe same without artificial stress. The e-foldings are those of "
      "the fastest mode of the tension at the root, viscosity included,\nover its history up to then:\n\n{}",
      gray::plate_length, gray::clamp_length, gray::clamp_layers, gray::parted, io::to_markdown(tables[0].second),
      io::to_markdown(tables[1].second));
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
  report.files.emplace_back("resolution.svg", figure_of("n spacings across H = 2 cm", runs.resolution));
  report.files.emplace_back("viscosity.svg", figure_of("with and without viscosity", runs.viscosity));
  for (const auto& [name, table] : tables) report.files.emplace_back(name + ".csv", io::to_csv(table));
  report.files.emplace_back("README.md", std::move(text));
  return report;
}

}  // namespace sphstab::study
