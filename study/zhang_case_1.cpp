// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "analysis/critical_step.hpp"
#include "io/document.hpp"
#include "io/figure.hpp"
#include "solver/simulation.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"
#include "study/zhang_cases.hpp"
#include "study/zhang_stability.hpp"
#include "study/zhang_statics.hpp"

namespace sphstab::study {
namespace {

using namespace zhang;
using solver::Field;

/// The paper gives no H; the figures are drawn for this one.
constexpr double figure_ratio = 0.75;
constexpr std::array<double, 13> ratios{0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.1, 1.2, 1.3, 1.5};
/// Spectrum and damped run, relative; the run stops at a tenth of it.
constexpr double agreement = 1e-8;
/// Wider kernels have modes so soft that they take longer to come to rest than everything else here together.
constexpr double widest_run = 1.2;

/// A loaded plate, what it is and where it ends.
struct Plate {
  Problem<2> problem;
  Body<2> body;
};

Plate make_plate(double ratio, Edge edge, double load = 1.0, int side_particles = particles_a_side) {
  const double spacing = side / side_particles;
  const auto posed = problem(ratio * spacing, normalisation_at[static_cast<std::size_t>(edge)], Plane::stress, spacing);
  auto body = make_scene(stretched_plate(posed, load)).body;
  return {posed, edge == Edge::sums_and_load ? with_normalised_load(posed, body) : body};
}

RestState plate_in_theory(const Plate& plate, double load = 1.0) {
  return rest_of(plate.body,
                 [theory = plate_theory(plate.problem, load)](const Vector<2>& x) { return solution(theory, x); });
}

/// The particles that are not on the edge.
std::vector<int> inner_particles(const Body<2>& body) {
  const auto n = std::lround(std::sqrt(static_cast<double>(body.size())));
  std::vector<int> inner;
  for (int a = 0; a < body.size(); ++a)
    if (const auto& site = body.site[a]; site.minCoeff() > 0 && site.maxCoeff() < n - 1) inner.push_back(a);
  return inner;
}

// ---- statics

struct StaticRow {
  double ratio;
  std::array<RestErrors, 3> whole, inner;
  double disagreement;  ///< of spectrum and run, the worst of displacement and stress
};

StaticRow static_row(double ratio) {
  StaticRow row{.ratio = ratio, .whole = {}, .inner = {}, .disagreement = 0.0};
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Plate plate = make_plate(ratio, edges[i]);
    const auto rest = rest_by_theory(plate.problem, plate.body), expected = plate_in_theory(plate);
    row.whole[i] = errors(rest, expected);
    row.inner[i] = errors(rest, expected, inner_particles(plate.body));
    if (ratio > widest_run) continue;
    const auto both = errors(rest_by_running(plate.problem, plate.body), rest);
    row.disagreement = std::max({row.disagreement, both.displacement, both.von_mises});
  }
  return row;
}

io::Document to_document(const std::vector<StaticRow>& rows) {
  io::Document document = io::Document::array();
  for (const auto& row : rows) {
    io::Document entry{{"ratio", row.ratio}};
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const auto list = [&](const std::string& where, const RestErrors& error) {
        entry[fmt::format("{}_{}", where, i)] = {{"s", error.displacement},
                                                 {"s_max", error.largest_displacement},
                                                 {"v", error.von_mises},
                                                 {"v_max", error.largest_von_mises}};
      };
      list("whole", row.whole[i]);
      list("inner", row.inner[i]);
    }
    document.push_back(std::move(entry));
  }
  return document;
}

io::Table static_table(const std::vector<StaticRow>& rows, bool everything) {
  std::vector<io::Column> columns{{"ratio", "H/Δ", "{:.2f}"}};
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (const auto& [place, place_name] : {std::pair("whole", ""), std::pair("inner", " inside")})
      for (const auto& [key, name] :
           {std::pair("s", "s"), std::pair("s_max", "max s"), std::pair("v", "σ_v"), std::pair("v_max", "max σ_v")}) {
        const bool shown =
            place == std::string_view("whole") ? key != std::string_view("v_max") : key == std::string_view("v");
        if (everything || shown)
          columns.push_back({fmt::format("{}_{}.{}", place, i, key),
                             fmt::format("{}{}: {}", name, place_name, edge_names[i]), "{:.3f}"});
      }
  return io::select(to_document(rows), columns);
}

/// N of a particle of the outermost row far from corners: (1 + W₁(0) Δ)/2 with W₁ = exp(−x²/H²)/(√π H).
double edge_sum(double ratio) { return 0.5 * (1.0 + 1.0 / (std::sqrt(std::numbers::pi) * ratio)); }

/// Resolutions at H = Δ, where the kernel sees the gradient of a linear field to 0.1 %.
constexpr std::array<int, 3> resolutions{10, 20, 40};
constexpr double resolution_ratio = 1.0;

io::Table resolution_table() {
  std::array<std::array<RestErrors, 3>, 3> error;
  parallel_for(9, [&](int i) {
    const Plate plate = make_plate(resolution_ratio, edges[i % 3], 1.0, resolutions[i / 3]);
    error[i / 3][i % 3] = errors(rest_by_theory(plate.problem, plate.body), plate_in_theory(plate));
  });
  io::Document document = io::Document::array();
  for (std::size_t n = 0; n < resolutions.size(); ++n) {
    io::Document entry{{"n", fmt::format("{0}×{0}", resolutions[n])}};
    for (std::size_t i = 0; i < edges.size(); ++i) {
      entry[fmt::format("s_{}", i)] = error[n][i].displacement;
      if (n > 0) entry[fmt::format("order_{}", i)] = std::log2(error[n - 1][i].displacement / error[n][i].displacement);
    }
    document.push_back(std::move(entry));
  }
  std::vector<io::Column> columns{{"n", "particles"}};
  for (std::size_t i = 0; i < edges.size(); ++i) {
    columns.push_back({fmt::format("s_{}", i), fmt::format("s: {}", edge_names[i]), "{:.3f}"});
    columns.push_back({fmt::format("order_{}", i), "order", "{:.2f}"});
  }
  return io::select(document, columns);
}

// ---- Figs. 4-7: without, with, theory

struct Statics {
  std::array<Plate, 2> plate{make_plate(figure_ratio, Edge::plain), make_plate(figure_ratio, Edge::sums)};
  std::array<RestState, 2> rest{rest_by_theory(plate[0].problem, plate[0].body),
                                rest_by_theory(plate[1].problem, plate[1].body)};
  RestState theory = plate_in_theory(plate[0]);
  const Body<2>& body() const { return plate[0].body; }
};

constexpr double millisecond = 1e-3;

std::string positions_figure(const Statics& statics) {
  auto figure = particle_figure("Fig. 4: particles at rest (filled) and where elasticity puts them (circles)");
  for (std::size_t i = 0; i < names.size(); ++i)
    figure.panels.push_back({.title = std::string(names[i]),
                             .positions = displaced(statics.body(), statics.rest[i].displacement),
                             .circles = displaced(statics.body(), statics.theory.displacement)});
  return io::render_svg(figure);
}

std::string strain_figure(const Statics& statics) {
  auto figure = particle_figure("Fig. 5: strain as vectors (ε_x, ε_y); a strain of 0.08 is one spacing long");
  figure.columns = 3;
  constexpr double arrow = particle_spacing / millimetre / 0.08;
  const auto panel = [&](std::string_view title, const RestState& rest) {
    io::ParticlePanel drawn{.title = std::string(title), .positions = undisplaced(statics.body())};
    for (const auto& strain : rest.strain) drawn.arrows.emplace_back(arrow * strain(0, 0), arrow * strain(1, 1));
    figure.panels.push_back(std::move(drawn));
  };
  figure.radius *= 0.4;
  for (std::size_t i = 0; i < names.size(); ++i) panel(names[i], statics.rest[i]);
  panel("elasticity", statics.theory);
  return io::render_svg(figure);
}

std::string stress_map_figure(const Statics& statics) {
  auto figure = particle_figure("Fig. 6: von Mises stress of the left half", "log10(von Mises stress / Pa)");
  figure.columns = 3;
  const auto panel = [&](std::string_view title, const RestState& rest) {
    io::ParticlePanel drawn{.title = std::string(title), .positions = {}};
    const auto all = undisplaced(statics.body());
    for (int a = 0; a < statics.body().size(); ++a) {
      if (statics.body().site[a][0] >= particles_a_side / 2) continue;
      drawn.positions.push_back(all[a]);
      drawn.values.push_back(std::log10(rest.von_mises[a]));
    }
    figure.panels.push_back(std::move(drawn));
  };
  for (std::size_t i = 0; i < names.size(); ++i) panel(names[i], statics.rest[i]);
  panel("elasticity", statics.theory);
  figure.value_range = {-3.5, -1.5};
  return io::render_svg(figure);
}

std::string stress_profile_figure(const Statics& statics) {
  auto figure =
      line_figure("Fig. 7: von Mises stress along the column beside x = l/2", "y [mm]", "von Mises stress [mPa]");
  const auto curve = [&](std::string_view label, const RestState& rest, io::CurveStyle style) {
    io::Curve drawn{std::string(label), {}, style};
    for (int a = 0; a < statics.body().size(); ++a)
      if (statics.body().site[a][0] == particles_a_side / 2)
        drawn.points.emplace_back(statics.body().position[a][1] / millimetre, rest.von_mises[a] / 1e-3);
    figure.curves.push_back(std::move(drawn));
  };
  curve("elasticity", statics.theory, io::CurveStyle::line);
  for (std::size_t i = 0; i < names.size(); ++i) curve(names[i], statics.rest[i], io::CurveStyle::line_and_points);
  return io::render_svg(figure);
}

// ---- Table 1, Figs. 12-15

/// Cases (a) to (g), as multiples of T.
constexpr std::array<double, 7> table_1{1, 2, 4, 8, 16, 32, 64};
/// Powers of two only shift the exponents of every number on the way: these do not.
constexpr std::array<double, 3> other_loads{3, 10, 50};
/// Departure from proportion, over the largest value: CG and run end with residuals below 1e-9, and every load takes
/// the same iterations but for rounding.
constexpr double proportion = 1e-11;
constexpr double load_tolerance = 1e-5;  ///< of the bisections
/// With the density of Eq. 6 the loaded plate grows slowly at every step; runs this short show growth of 1.5 % a step
/// and more, that of a step which is too large.
constexpr long short_run = 200;
constexpr double short_run_tolerance = 1e-3;
/// The slow growth is measured at the paper's step and up to four times so many of them.
constexpr double papers_step = 5e-4;
constexpr long long_run = 20000;
/// Eq. 6 lowers the critical step by at least this a T, up to 4 T.
constexpr double least_fall = 0.025;
constexpr double least_slow_load = 8;  ///< below it the growth needs more steps

struct LoadRow {
  double load;
  std::array<RestState, 2> rest;
  std::array<double, 2> departure;               ///< from the load times case (a)
  std::array<std::optional<double>, 2> frozen;   ///< critical step with ρ0
  std::array<std::optional<double>, 2> varying;  ///< … with Eq. 6, slow growth apart
  std::array<std::optional<double>, 2> slow;     ///< slow growth with Eq. 6, 1/time
};

double largest_displacement(const RestState& rest) {
  double largest = 0.0;
  for (const auto& s : rest.displacement) largest = std::max(largest, s.norm());
  return largest;
}

double largest_stress(const RestState& rest) { return *std::max_element(rest.von_mises.begin(), rest.von_mises.end()); }

/// The largest difference of the state from `load` times that of the load 1, over its largest value.
double departure_from_proportion(const RestState& rest, const RestState& unit, double load) {
  RestState scaled = unit;
  for (auto& s : scaled.displacement) s *= load;
  for (auto& stress : scaled.von_mises) stress *= load;
  const auto error = errors(rest, scaled);
  return std::max(error.largest_displacement, error.largest_von_mises);
}

std::vector<LoadRow> all_loads(double ratio) {
  std::vector<LoadRow> rows;
  for (const double load : table_1) rows.push_back({load, {}, {}, {}, {}, {}});
  for (const double load : other_loads) rows.push_back({load, {}, {}, {}, {}, {}});
  constexpr int tasks = static_cast<int>(2 * (table_1.size() + other_loads.size()));
  std::vector<std::array<RestState, 2>> by_running(rows.size());
  parallel_for(tasks, [&](int task) {
    LoadRow& row = rows[task / 2];
    const int i = task % 2;
    const Plate plate = make_plate(ratio, edges[i], row.load);
    row.rest[i] = rest_by_theory(plate.problem, plate.body);
    by_running[task / 2][i] = rest_by_running(plate.problem, plate.body);
    if (task / 2 >= static_cast<int>(table_1.size())) return;
    row.frozen[i] =
        bisect_loaded(plate.problem, plate.body, row.rest[i].displacement, load_tolerance).critical_time_step;
    Problem<2> nonlinear = plate.problem;
    nonlinear.scheme.momentum_density = MomentumDensity::equation_of_state;
    const auto rest = nonlinear_rest(nonlinear, plate.body);
    if (!rest) return;
    row.varying[i] = bisect_loaded(nonlinear, plate.body, *rest, short_run_tolerance, short_run).critical_time_step;
    if (row.load >= least_slow_load) row.slow[i] = growth_rate(nonlinear, plate.body, *rest, papers_step, long_run);
  });
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (int i = 0; i < 2; ++i)
      rows[r].departure[i] = std::max(departure_from_proportion(rows[r].rest[i], rows[0].rest[i], rows[r].load),
                                      departure_from_proportion(by_running[r][i], by_running[0][i], rows[r].load));
  return rows;
}

io::Document to_document(const std::vector<LoadRow>& rows, const RestState& theory) {
  io::Document document = io::Document::array();
  for (const auto& row : rows) {
    io::Document entry{{"load", row.load},
                       {"s_theory", row.load * largest_displacement(theory) / millimetre},
                       {"v_theory", row.load * largest_stress(theory)}};
    for (int i = 0; i < 2; ++i) {
      const auto put = [&](const char* key, std::optional<double> value, double unit) {
        if (value) entry[fmt::format("{}_{}", key, i)] = *value / unit;
      };
      put("s", largest_displacement(row.rest[i]), millimetre);
      put("v", largest_stress(row.rest[i]), 1.0);
      put("frozen", row.frozen[i], millisecond);
      put("varying", row.varying[i], millisecond);
      put("slow", row.slow[i], 1.0);
    }
    document.push_back(std::move(entry));
  }
  return document;
}

/// Columns of a quantity without and with normalisation.
void add_columns(std::vector<io::Column>& columns, const std::string& key, const std::string& name,
                 const std::string& format) {
  for (int i = 0; i < 2; ++i)
    columns.push_back({fmt::format("{}_{}", key, i), fmt::format("{}: {}", name, edge_names[i]), format});
}

io::Table proportion_table(const std::vector<LoadRow>& rows, const RestState& theory) {
  std::vector<io::Column> columns{{"load", "load / T", "{:g}"}, {"s_theory", "max s [mm]: elasticity", "{:.6f}"}};
  add_columns(columns, "s", "max s", "{:.6f}");
  columns.push_back({"v_theory", "max σ_v [Pa]: elasticity", "{:.6f}"});
  add_columns(columns, "v", "max σ_v", "{:.6f}");
  return io::select(to_document(rows, theory), columns);
}

io::Table step_table(std::vector<LoadRow> rows, const RestState& theory) {
  rows.resize(table_1.size());
  std::vector<io::Column> columns{{"load", "load / T", "{:g}"}};
  add_columns(columns, "frozen", "Δt_c with ρ0 [ms]", "{:.6f}");
  add_columns(columns, "varying", "with Eq. 6 [ms]", "{:.3f}");
  add_columns(columns, "slow", "slow growth with Eq. 6 [1/s]", "{:.2f}");
  return io::select(to_document(rows, theory), columns);
}

std::string load_panels(const std::vector<LoadRow>& rows, const Body<2>& body, int i) {
  auto figure =
      particle_figure(fmt::format("Fig. {}: the loads of Table 1, {}", 12 + i, names[i]), "σ_v T / load [Pa]");
  for (std::size_t r = 0; r < table_1.size(); ++r) {
    io::ParticlePanel panel{.title = fmt::format("({}) {:g} T", static_cast<char>('a' + r), rows[r].load),
                            .positions = displaced(body, rows[r].rest[i].displacement)};
    for (const double stress : rows[r].rest[i].von_mises) panel.values.push_back(stress / rows[r].load);
    figure.panels.push_back(std::move(panel));
  }
  figure.value_range = {0.0, 0.03};
  return io::render_svg(figure);
}

io::LineFigure load_figure(const std::string& title, const std::string& label) {
  auto figure = line_figure(title, "load / T", label);
  figure.x_log = true;
  return figure;
}

template <class Value>
io::Curve over_loads(const std::vector<LoadRow>& rows, std::string_view label, const Value& value,
                     io::CurveStyle style = io::CurveStyle::line_and_points) {
  io::Curve curve{std::string(label), {}, style};
  for (std::size_t r = 0; r < table_1.size(); ++r)
    if (const std::optional<double> y = value(rows[r])) curve.points.emplace_back(rows[r].load, *y);
  return curve;
}

std::string proportion_figure(const std::vector<LoadRow>& rows, const RestState& theory, bool stress) {
  auto figure = stress ? load_figure("Fig. 14b: largest von Mises stress against load", "largest von Mises stress [Pa]")
                       : load_figure("Fig. 14a: largest displacement against load", "largest displacement [mm]");
  figure.y_log = true;
  const auto value = [stress](const RestState& rest) {
    return stress ? largest_stress(rest) : largest_displacement(rest) / millimetre;
  };
  for (int i = 0; i < 2; ++i)
    figure.curves.push_back(over_loads(
        rows, names[i], [&](const LoadRow& row) { return value(row.rest[i]); }, io::CurveStyle::points));
  figure.curves.push_back(over_loads(
      rows, "elasticity", [&](const LoadRow& row) { return row.load * value(theory); }, io::CurveStyle::line));
  return io::render_svg(figure);
}

std::string step_against_load_figure(const std::vector<LoadRow>& rows) {
  auto figure = load_figure("Fig. 15: critical step of the loaded plate, by running", "critical time step [ms]");
  for (int i = 0; i < 2; ++i) {
    const auto in_ms = [](std::optional<double> step) { return step ? std::optional(*step * 1e3) : std::nullopt; };
    figure.curves.push_back(
        over_loads(rows, fmt::format("ρ0, {}", names[i]), [&](const LoadRow& row) { return in_ms(row.frozen[i]); }));
    figure.curves.push_back(over_loads(rows, fmt::format("ρ of Eq. 6, {}", names[i]),
                                       [&](const LoadRow& row) { return in_ms(row.varying[i]); }));
  }
  return io::render_svg(figure);
}

// ---- Fig. 16

constexpr std::array<double, 5> run_ratios{0.6, 0.75, 0.85, 1.0, 1.2};
constexpr double run_tolerance = 1e-4;  ///< of the bisections: brackets; their roots are far better
constexpr int curve_points = 37;
constexpr double least_drawn_ratio = 0.5, largest_drawn_ratio = 1.4;

double drawn_ratio(int i) {
  return least_drawn_ratio + (largest_drawn_ratio - least_drawn_ratio) * i / (curve_points - 1);
}

/// Minima of both normalisations, H/Δ and step, and where their curves meet.
struct Extremes {
  std::array<std::pair<double, double>, 2> smallest;
  double crossing;
};
constexpr std::array<Plane, 2> planes{Plane::stress, Plane::strain};
/// In the order of `planes`: steps of errata.md Z7, crossings of Z8; and of Z7 the H/Δ in plane stress.
constexpr std::array<std::array<double, 2>, 2> expected_step{{{2.398e-3, 2.264e-3}, {2.163e-3, 1.987e-3}}};
constexpr std::array<double, 2> expected_crossing{0.722, 0.699}, expected_ratio{0.744, 0.849};
constexpr double printed_ratio = 1e-3, printed_step = 1e-6;  // one of the last digit

struct Smoothing {
  std::array<std::array<double, curve_points>, 2> spectrum;
  std::array<std::array<std::optional<double>, run_ratios.size()>, 2> run;
  std::array<Extremes, 2> extremes;
};

std::optional<double> bisect_unloaded(const Problem<2>& problem, const Body<2>& body) {
  return bisect_loaded(problem, body, Field<2>(body.size(), Vector<2>::Zero()), run_tolerance).critical_time_step;
}

Smoothing smoothing_study() {
  Smoothing study{};
  parallel_for(2 * curve_points, [&](int task) {
    study.spectrum[task % 2][task / 2] = critical_step({drawn_ratio(task / 2), normalisation_at[task % 2]});
  });
  parallel_for(static_cast<int>(2 * run_ratios.size()), [&](int task) {
    const PlateKind kind{run_ratios[task / 2], normalisation_at[task % 2]};
    study.run[task % 2][task / 2] = bisect_unloaded(plate_problem(kind), plate_body(kind, 0.0));
  });
  parallel_for(6, [&](int task) {
    Extremes& extremes = study.extremes[task / 3];
    if (task % 3 == 2) {
      extremes.crossing = crossing_of_normalisation(planes[task / 3]);
    } else {
      extremes.smallest[task % 3] = smallest_critical_step(normalisation_at[task % 3], planes[task / 3]);
    }
  });
  return study;
}

std::string smoothing_figure(const Smoothing& study) {
  auto figure = line_figure("Fig. 16: critical step against the smoothing length, plane stress", "H / Δ",
                            "critical time step [ms]");
  for (std::size_t i = 0; i < names.size(); ++i) {
    io::Curve spectrum{fmt::format("spectrum, {}", names[i]), {}, io::CurveStyle::line};
    for (int p = 0; p < curve_points; ++p) spectrum.points.emplace_back(drawn_ratio(p), study.spectrum[i][p] * 1e3);
    io::Curve run{fmt::format("bisection, {}", names[i]), {}, io::CurveStyle::points};
    for (std::size_t r = 0; r < run_ratios.size(); ++r)
      if (study.run[i][r]) run.points.emplace_back(run_ratios[r], *study.run[i][r] * 1e3);
    figure.curves.push_back(std::move(spectrum));
    figure.curves.push_back(std::move(run));
  }
  figure.vertical_lines = {{study.extremes[0].crossing, "both alike"}};
  return io::render_svg(figure);
}

io::Table extremes_table(const Smoothing& study) {
  io::Document document = io::Document::array();
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const Extremes& found = study.extremes[p];
    document.push_back({{"plane", name_of(planes[p])},
                        {"ratio_0", found.smallest[0].first},
                        {"step_0", found.smallest[0].second * 1e3},
                        {"ratio_1", found.smallest[1].first},
                        {"step_1", found.smallest[1].second * 1e3},
                        {"crossing", found.crossing}});
  }
  return io::select(document, {{"plane", "plane"},
                               {"ratio_0", "H/Δ of the minimum, without", "{:.4f}"},
                               {"step_0", "Δt_c [ms]", "{:.4f}"},
                               {"ratio_1", "H/Δ of the minimum, with", "{:.4f}"},
                               {"step_1", "Δt_c [ms]", "{:.4f}"},
                               {"crossing", "H/Δ where both are alike", "{:.4f}"}});
}

// ---- Fig. 17

/// Density over 1000 kg/m³ and shear modulus over 0.3 Pa; no powers of four, which would only shift exponents.
constexpr std::array<double, 5> factors{0.1, 0.3, 1.0, 3.0, 10.0};

/// A plate of another material; `of_density` says which of the two constants is other.
struct ScaledPlate {
  bool of_density;
  double factor;
  std::array<std::optional<double>, 2> run;
  double eq_15;
  double unit;  ///< Δ √(ρ/G), a time
};

std::vector<ScaledPlate> scaling_study() {
  std::vector<ScaledPlate> plates;
  for (const bool of_density : {true, false})
    for (const double factor : factors) plates.push_back({of_density, factor, {}, 0.0, 0.0});
  parallel_for(static_cast<int>(2 * plates.size()), [&](int task) {
    ScaledPlate& scaled = plates[task / 2];
    const double rho = density * (scaled.of_density ? scaled.factor : 1.0);
    const double G = papers_shear_modulus * (scaled.of_density ? 1.0 : scaled.factor);
    Problem<2> posed = plate_problem({figure_ratio, normalisation_at[task % 2]});
    posed.material = Material::from_young_modulus(rho, G * (1.0 + poisson_ratio), poisson_ratio);
    scaled.run[task % 2] = bisect_unloaded(posed, make_scene(stretched_plate(posed, 0.0)).body);
    if (task % 2 == 1) return;
    scaled.eq_15 = *analysis::published_bound(posed);
    scaled.unit = particle_spacing * std::sqrt(rho / G);
  });
  return plates;
}

std::string scaling_figure(const std::vector<ScaledPlate>& plates, bool of_density) {
  auto figure = line_figure(of_density ? "Fig. 17a: critical step against density, G = 0.3 Pa"
                                       : "Fig. 17b: critical step against shear modulus, ρ = 1000 kg/m³",
                            of_density ? "density [kg/m³]" : "shear modulus G = E/(1+μ) [Pa]", "time step [ms]");
  figure.x_log = figure.y_log = true;
  io::Curve eq_15{"Eq. 15", {}, io::CurveStyle::dashed};
  std::array<io::Curve, 2> runs;
  for (int i = 0; i < 2; ++i) runs[i] = {fmt::format("bisection, {}", names[i]), {}, io::CurveStyle::line_and_points};
  for (const auto& plate : plates) {
    if (plate.of_density != of_density) continue;
    const double x = plate.factor * (of_density ? density : papers_shear_modulus);
    eq_15.points.emplace_back(x, plate.eq_15 * 1e3);
    for (int i = 0; i < 2; ++i)
      if (plate.run[i]) runs[i].points.emplace_back(x, *plate.run[i] * 1e3);
  }
  figure.curves = {runs[0], runs[1], eq_15};
  return io::render_svg(figure);
}

/// A bisection on another material takes the same runs in another unit of time, but for rounding and what it decides.
constexpr double scaling_tolerance = 1e-7;

/// Largest relative departure of Δt_c √(G/ρ)/Δ from its value in Case 1.
double departure_from_scaling(const std::vector<ScaledPlate>& plates) {
  double largest = 0.0;
  for (int i = 0; i < 2; ++i) {
    const double first = plates[2].run[i].value_or(0.0) / plates[2].unit;
    for (const auto& plate : plates)
      largest = std::max(largest, std::abs(plate.run[i].value_or(0.0) / plate.unit / first - 1.0));
  }
  return largest;
}

// ---- Fig. 18

constexpr double explosive_step = 4e-3;
constexpr std::array<long, 4> drawn_steps{1, 2, 3, 4};
constexpr long growth_steps = 40000;
constexpr double growth_tolerance = 1e-5;
/// A corner is its 4×4 particles: at most a twenty-fifth of the plate.
constexpr int corner_particles = 4;

/// Where a field is, as parts of its square.
struct Share {
  double bottom_corners, top_corners, elsewhere;
};

Share share(const Body<2>& body, const Field<2>& field) {
  Share sum{};
  for (int a = 0; a < body.size(); ++a) {
    const auto far = [&](int i) { return std::min(body.site[a][i], particles_a_side - 1 - body.site[a][i]); };
    const bool corner = far(0) < corner_particles && far(1) < corner_particles;
    double& part =
        !corner ? sum.elsewhere : (body.site[a][1] < particles_a_side / 2 ? sum.bottom_corners : sum.top_corners);
    part += field[a].squaredNorm();
  }
  const double whole = sum.bottom_corners + sum.top_corners + sum.elsewhere;
  return {sum.bottom_corners / whole, sum.top_corners / whole, sum.elsewhere / whole};
}

/// From the undeformed plate on, which starts to be loaded: the only start that needs no equilibrium.
struct Explosion {
  std::pair<double, double> unstable;  ///< H/Δ between which the step is unstable
  std::vector<Field<2>> displacement;  ///< at the drawn steps
  std::vector<Share> departure;        ///< of the displacement from rest, at the drawn steps
  Share mode;                          ///< of the fastest mode
  double predicted, measured;          ///< growth a step
};

Explosion explode(const Statics& statics, int i) {
  const auto& [problem, body] = statics.plate[i];
  const auto& rest = statics.rest[i].displacement;
  const FastestMode mode = fastest_mode(problem, body);
  Explosion explosion{.unstable = unstable_range(explosive_step, normalisation_at[i]),
                      .displacement = {},
                      .departure = {},
                      .mode = share(body, mode.displacement),
                      .predicted = growth_per_step(mode.omega, explosive_step),
                      .measured = measured_growth_per_step(problem, body, rest, explosive_step, growth_steps)};
  solver::Simulation<2> simulation(problem, body);
  solver::State<2> state(body.size());
  long step = 0;
  for (const long drawn : drawn_steps) {
    simulation.advance(state, explosive_step, drawn - step);
    step = drawn;
    Field<2> departure = state.displacement;
    for (int a = 0; a < body.size(); ++a) departure[a] -= rest[a];
    explosion.displacement.push_back(state.displacement);
    explosion.departure.push_back(share(body, departure));
  }
  return explosion;
}

std::string explosion_figure(const Statics& statics, const Explosion& explosion, int i) {
  auto figure = particle_figure(fmt::format("Fig. 18: Δt = 4 ms, {}", names[i]));
  for (std::size_t n = 0; n < drawn_steps.size(); ++n)
    figure.panels.push_back({.title = fmt::format("after step {}", drawn_steps[n]),
                             .positions = displaced(statics.body(), explosion.displacement[n])});
  return io::render_svg(figure);
}

io::Table explosion_table(const std::array<Explosion, 2>& explosions) {
  io::Document document = io::Document::array();
  const auto list = [&](const std::string& when, const Share& a, const Share& b) {
    document.push_back({{"when", when},
                        {"b0", a.bottom_corners},
                        {"t0", a.top_corners},
                        {"e0", a.elsewhere},
                        {"b1", b.bottom_corners},
                        {"t1", b.top_corners},
                        {"e1", b.elsewhere}});
  };
  for (std::size_t n = 0; n < drawn_steps.size(); ++n)
    list(fmt::format("step {}", drawn_steps[n]), explosions[0].departure[n], explosions[1].departure[n]);
  list("fastest mode", explosions[0].mode, explosions[1].mode);
  return io::select(document, {{"when", "departure from rest"},
                               {"b0", "bottom corners: without", "{:.3f}"},
                               {"t0", "top corners", "{:.3f}"},
                               {"e0", "elsewhere", "{:.3f}"},
                               {"b1", "bottom corners: with", "{:.3f}"},
                               {"t1", "top corners", "{:.3f}"},
                               {"e1", "elsewhere", "{:.3f}"}});
}

// ---- text and claims

std::string statics_text(const std::vector<StaticRow>& rows) {
  const auto& row = *std::find_if(rows.begin(), rows.end(), [](const auto& r) { return r.ratio == figure_ratio; });
  std::string text = fmt::format(
      "A square of 20×20 particles, l = h = 0.5 mm, pulled at its left and right edge by σ_x = k (h − y), k = 50 "
      "Pa/m;\n"
      "ρ = 1000 kg/m³, E = 0.39 Pa, Gaussian kernel. What the paper leaves open, and what is taken here:\n\n"
      "- the smoothing length H: all of them below, H = {0} Δ in the figures;\n"
      "- μ: it gives G = 0.3 Pa = E/(1+μ), twice the shear modulus, so that μ = 0.3;\n"
      "- the plane: Appendix B is plane stress;\n"
      "- how the plate comes to rest without damping in Eqs. 7-11: by damping the run, and by conjugate gradients on "
      "the\n"
      "  theory's operator. Both agree to {1:g} of displacement and stress, for every H up to {2} Δ and every "
      "normalisation\n  below;\n"
      "- how the load is put on particles: σ_x/(ρΔ) on the outer columns;\n"
      "- whether normalisation also divides the load by N: as printed it divides the sums of Eqs. 7 and 9.\n\n"
      "## At rest: Figs. 4-7\n\n"
      "Errors against Appendix B, rigid motion removed from both: of the displacement s and the von Mises stress σ_v "
      "over\n"
      "all particles, relative in the L2 norm, `max` over the largest value (at the bottom corners), `inside` without "
      "the\n"
      "outer layer. `without`, `with`: normalisation of the sums; `with, load too`: the load divided by N as well.\n\n",
      figure_ratio, agreement, widest_run);
  text += io::to_markdown(static_table(rows, false));
  text += fmt::format(
      "\nThe figures take H = {} Δ, where normalisation as printed is best for all three together: s {:.1f} % instead "
      "of\n"
      "{:.1f} %, corners {:.1f} % instead of {:.1f} %, σ_v {:.1f} % instead of {:.1f} %, as the paper's Figs. 4 and 7 "
      "show it.\n\n"
      "That is a balance of two errors. An edge particle has N < 1; its load is not divided by N, so that the plate\n"
      "carries only N times the load: (1 + W₁(0)Δ)/2 = {:.3f} with H = Δ in the middle of an edge, W₁ the Gaussian of\n"
      "one dimension. Refining does not help (H = Δ, relative error of s):\n\n",
      figure_ratio, 100 * row.whole[1].displacement, 100 * row.whole[0].displacement,
      100 * row.whole[1].largest_displacement, 100 * row.whole[0].largest_displacement, 100 * row.whole[1].von_mises,
      100 * row.whole[0].von_mises, edge_sum(1.0));
  text += io::to_markdown(resolution_table());
  text += "\nWithout normalisation, and with the load divided too, the error falls with order one.\n\n";
  text += image("Fig. 4", "04") + image("Fig. 5", "05") + image("Fig. 6", "06") + image("Fig. 7", "07");
  return text;
}

std::string loads_text(const std::vector<LoadRow>& loads, const RestState& theory) {
  return fmt::format(
             "## Loads of Table 1: Figs. 12-15\n\n"
             "Each load is solved and run by itself. Powers of two only shift exponents and come out exactly; 3, 10 "
             "and "
             "50 T\n"
             "depart from proportion by less than {:g} of the largest value, by conjugate gradients and by "
             "running.\n\n",
             proportion) +
         io::to_markdown(proportion_table(loads, theory)) + "\n" + image("Fig. 12", "12") + image("Fig. 13", "13") +
         image("Fig. 14a", "14a") + image("Fig. 14b", "14b") +
         fmt::format(
             "Critical step of the plate that runs under its load, from its rest with noise; what grows is what "
             "departs "
             "from\n"
             "rest. With ρ0 in Eq. 7 it is that of the spectrum to {:g} at every load: the scheme is linear. With the "
             "density of\n"
             "Eq. 6 (rest found by running) it falls, and the plate grows slowly at every step besides: its operator "
             "is "
             "not\n"
             "symmetric. The rate below is that at the paper's own 0.5 ms (loads below {:g} T grow too slowly for {} "
             "steps).\n\n",
             load_tolerance, least_slow_load, 4 * long_run) +
         io::to_markdown(step_table(loads, theory)) +
         "\nThe straight lines of the paper's Figs. 14 and 15 are those of ρ0: Eq. 6 cannot have been active in "
         "them.\n\n" +
         image("Fig. 15", "15");
}

std::string smoothing_text(const Smoothing& smoothing) {
  return fmt::format(
             "## Smoothing length: Fig. 16\n\n"
             "By the spectrum, with bisections on top (to {:g}; [zhang-plate](../zhang-plate/README.md) has them to "
             "1e-6, "
             "with\n"
             "Eq. 15 and the bulk). As the paper says there is a minimum, and normalisation helps for small H and "
             "harms "
             "for\n"
             "large ones. The paper's bound of 1.8 ms lies below the minimum.\n\n",
             run_tolerance) +
         io::to_markdown(extremes_table(smoothing)) + "\n" + image("Fig. 16", "16");
}

std::string scaling_text(const std::vector<ScaledPlate>& scaled) {
  const ScaledPlate& unit = scaled[factors.size() / 2];
  return fmt::format(
             "## Density and shear modulus: Fig. 17\n\n"
             "Bisections, H = {} Δ. Δt_c √(G/ρ)/Δ is one number: {:.6f} without, {:.6f} with normalisation, constant "
             "to "
             "{:g}.\n"
             "Eq. 15 has the same scaling, {:.6f}: whether it is safe depends on H/Δ and μ alone. Here it is; it is "
             "not "
             "for\n"
             "H/Δ above 0.81 with normalisation and 0.89 without ([zhang-plate](../zhang-plate/README.md)).\n\n",
             figure_ratio, *unit.run[0] / unit.unit, *unit.run[1] / unit.unit, scaling_tolerance,
             unit.eq_15 / unit.unit) +
         image("Fig. 17a", "17a") + image("Fig. 17b", "17b");
}

std::string explosion_text(const Statics& statics, const std::array<Explosion, 2>& explosions) {
  std::string text = fmt::format(
      "## Explosion: Fig. 18\n\n"
      "Δt = 4 ms is unstable for {:.3f} < H/Δ < {:.3f} without and {:.3f} < H/Δ < {:.3f} with normalisation. Here H = "
      "{} "
      "Δ,\n"
      "from the undeformed plate, loaded from the first step on.\n\n",
      explosions[0].unstable.first, explosions[0].unstable.second, explosions[1].unstable.first,
      explosions[1].unstable.second, figure_ratio);
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format(
        "- {}: ln|λ| a step is {:.6f} by 2 arcosh(ω_max Δt/2) with ω_max of the spectrum, and the same to {:g} in a "
        "run "
        "of\n"
        "  {} steps;\n",
        names[i], explosions[i].predicted, growth_tolerance, growth_steps);
  text += fmt::format(
      "\nWhere the departure from rest is, as parts of Σ s², corners of {0}×{0} particles; an even spread would have "
      "{1:.2f}\n"
      "in the bottom corners:\n\n",
      corner_particles, 2.0 * corner_particles * corner_particles / statics.body().size());
  text += io::to_markdown(explosion_table(explosions));
  text +=
      "\nIt starts at the loaded edges and most at the bottom corners, as the paper says, because the load is largest "
      "there.\n"
      "Without normalisation it then goes to the mode that grows fastest, which fills the inside; with normalisation "
      "the\n"
      "fastest modes are in the corners themselves, top and bottom alike.\n\n";
  return text + image("Fig. 18, without normalisation", "18a") + image("Fig. 18, with normalisation", "18b");
}

/// Below it no normalisation makes the sums good.
constexpr double least_useful_ratio = 0.7;

std::string conclusions(const std::vector<StaticRow>& rows) {
  const auto& row = *std::find_if(rows.begin(), rows.end(), [](const auto& r) { return r.ratio == figure_ratio; });
  const auto worse_stress = std::find_if(rows.begin(), rows.end(), [](const auto& r) {
    return r.ratio > figure_ratio && r.whole[1].von_mises > r.whole[0].von_mises;
  });
  return fmt::format(
      "## The paper's conclusions 3 and 4\n\n"
      "**3, \"Eq. (15) can be used to ensure stability\"**: false in general. It holds while only the four nearest\n"
      "neighbours count; above H/Δ = 0.89 (bulk) or 0.81 (this plate, normalised) it lets unstable steps through.\n\n"
      "**4, normalisation \"is necessary to ensure the accuracy\", most at sharp corners**: true at the H of the "
      "figures:\ncorners {:.1f} % instead of {:.1f} %, stresses {:.1f} % instead of {:.1f} %. Not as such: as printed "
      "it "
      "leaves an error that\nrefining does not remove, because the load keeps its size where the sums are divided, and "
      "from H/Δ = {:g} on it makes\nthe stresses worse.\n"
      "With the load divided too the corners are still better than without, for every H/Δ from {:g} to {:g} above.\n\n",
      100 * row.whole[1].largest_displacement, 100 * row.whole[0].largest_displacement, 100 * row.whole[1].von_mises,
      100 * row.whole[0].von_mises, worse_stress->ratio, least_useful_ratio, widest_run);
}

std::vector<std::string> find_failures(const std::vector<StaticRow>& rows, const std::vector<LoadRow>& loads,
                                       const Smoothing& smoothing, const std::vector<ScaledPlate>& scaled,
                                       const std::array<Explosion, 2>& explosions) {
  std::vector<std::string> failures;
  const auto claim = [&](bool holds, const std::string& what) {
    if (!holds) failures.push_back(what);
  };
  for (const auto& row : rows) {
    claim(row.disagreement < agreement, fmt::format("H/Δ = {}: spectrum and run come to rest apart", row.ratio));
    claim(row.ratio < least_useful_ratio || row.ratio > widest_run ||
              row.whole[2].largest_displacement < row.whole[0].largest_displacement,
          fmt::format("H/Δ = {}: corners are not better with normalisation of sums and load", row.ratio));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double spectrum = critical_step({figure_ratio, normalisation_at[i]});
    const auto near = [](std::optional<double> step, double expected, double tolerance) {
      return step && std::abs(*step / expected - 1.0) < tolerance;
    };
    for (const auto& row : loads) {
      claim(row.departure[i] < proportion, fmt::format("{} T, {}: not in proportion", row.load, names[i]));
      if (&row - loads.data() >= std::ssize(table_1)) continue;
      claim(near(row.frozen[i], spectrum, load_tolerance),
            fmt::format("{} T, {}: the critical step is not that of the spectrum", row.load, names[i]));
      claim(row.varying[i] && *row.varying[i] < (1.0 - least_fall * std::min(row.load, 4.0)) * spectrum,
            fmt::format("{} T, {}: Eq. 6 does not lower the critical step", row.load, names[i]));
      claim(row.load < least_slow_load || row.slow[i],
            fmt::format("{} T, {}: no slow growth with Eq. 6", row.load, names[i]));
    }
    for (std::size_t r = 0; r < run_ratios.size(); ++r)
      claim(near(smoothing.run[i][r], critical_step({run_ratios[r], normalisation_at[i]}), run_tolerance),
            fmt::format("H/Δ = {}, {}: bisection and spectrum differ", run_ratios[r], names[i]));
    for (std::size_t p = 0; p < planes.size(); ++p) {
      const auto [ratio, step] = smoothing.extremes[p].smallest[i];
      const bool elsewhere = planes[p] == Plane::stress && std::abs(ratio - expected_ratio[i]) > printed_ratio;
      claim(std::abs(step - expected_step[p][i]) < printed_step && !elsewhere,
            fmt::format("plane {}, {}: another minimum of the critical step", name_of(planes[p]), names[i]));
    }
    claim(std::abs(explosions[i].measured - explosions[i].predicted) < growth_tolerance,
          fmt::format("4 ms, {}: growth is not that of the spectrum", names[i]));
  }
  for (std::size_t p = 0; p < planes.size(); ++p)
    claim(std::abs(smoothing.extremes[p].crossing - expected_crossing[p]) < printed_ratio,
          fmt::format("plane {}: the curves meet elsewhere", name_of(planes[p])));
  claim(departure_from_scaling(scaled) < scaling_tolerance, "Δt_c √(G/ρ) is not constant");
  return failures;
}

}  // namespace

Report zhang_case_1_report(const Progress& progress) {
  const auto done = [&](double fraction) {
    if (progress) progress(fraction);
  };
  const Statics statics;
  std::vector<StaticRow> rows(ratios.size());
  parallel_for(static_cast<int>(ratios.size()), [&](int i) {
    const std::size_t last = ratios.size() - 1 - i;  // wide kernels cost most
    rows[last] = static_row(ratios[last]);
  });
  done(0.2);
  const auto loads = all_loads(figure_ratio);
  done(0.5);
  const Smoothing smoothing = smoothing_study();
  done(0.7);
  const auto scaled = scaling_study();
  done(0.8);
  std::array<Explosion, 2> explosions;
  parallel_for(2, [&](int i) { explosions[i] = explode(statics, i); });
  done(1.0);

  const auto failures = find_failures(rows, loads, smoothing, scaled, explosions);
  const std::string text = statics_text(rows) + loads_text(loads, statics.theory) + smoothing_text(smoothing) +
                           scaling_text(scaled) + explosion_text(statics, explosions) + conclusions(rows) +
                           fmt::format("{} of the claims above do not hold.\n", failures.size());
  Report report;
  report.summary = text;
  report.failures = failures;
  report.files = {{"README.md", "# Case 1 of Zhang, Hu, Cui & Wang, and the stability tests on its plate\n\n" + text +
                                    "\nRegenerate with `sphstab report zhang-case-1 --overwrite`; the plate is that of "
                                    "`scenes/zhang-case-1.toml`, with H as said.\n"},
                  {"statics.csv", io::to_csv(static_table(rows, true))},
                  {"figure_04.svg", positions_figure(statics)},
                  {"figure_05.svg", strain_figure(statics)},
                  {"figure_06.svg", stress_map_figure(statics)},
                  {"figure_07.svg", stress_profile_figure(statics)},
                  {"figure_12.svg", load_panels(loads, statics.body(), 0)},
                  {"figure_13.svg", load_panels(loads, statics.body(), 1)},
                  {"figure_14a.svg", proportion_figure(loads, statics.theory, false)},
                  {"figure_14b.svg", proportion_figure(loads, statics.theory, true)},
                  {"figure_15.svg", step_against_load_figure(loads)},
                  {"figure_16.svg", smoothing_figure(smoothing)},
                  {"figure_17a.svg", scaling_figure(scaled, true)},
                  {"figure_17b.svg", scaling_figure(scaled, false)},
                  {"figure_18a.svg", explosion_figure(statics, explosions[0], 0)},
                  {"figure_18b.svg", explosion_figure(statics, explosions[1], 1)}};
  return report;
}

}  // namespace sphstab::study
