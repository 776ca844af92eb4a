// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/document.hpp"
#include "io/figure.hpp"
#include "study/natural_frequencies.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"

namespace sphstab::study {
namespace {

constexpr std::array<KernelNormalisation, 2> normalisations{KernelNormalisation::none, KernelNormalisation::sum};
constexpr int bending_modes = 3;

constexpr std::string_view name_of_ends(BeamEnds ends) {
  return ends == BeamEnds::free_free ? "free-free" : "clamped-free";
}

/// Of values on three meshes, each half as wide as the one before, v = v∞ + c Δᵖ.
struct Convergence {
  double order;
  double limit;
};

Convergence extrapolate(double coarse, double middle, double fine) {
  const double before = middle - coarse, last = fine - middle;
  return {std::log2(before / last), fine + last * last / (before - last)};
}

// Beams.

constexpr KernelFamily beam_kernel = KernelFamily::cubic_spline;
constexpr double beam_ratio = 1.0;
constexpr std::array<int, 6> resolutions{4, 6, 8, 12, 16, 32};
/// With that kernel no more than a few zero-energy modes are slower than the third bending mode.
constexpr int beam_modes = 24;

Beam beam_of(BeamEnds ends) {
  return {.length = 10.0,
          .height = 1.0,
          .material = Material::from_young_modulus(1.0, 1.0, 0.3),
          .plane = Plane::stress,
          .ends = ends};
}

/// One beam at one resolution.
struct BeamRun {
  BeamEnds ends;
  KernelNormalisation normalisation;
  KernelFamily kernel;
  double ratio;
  int across;
  int modes;
  std::array<RecognisedMode, bending_modes> found = {};
  double factor = 0.0;  ///< long_wave_factor

  double relative(int mode) const { return found[mode - 1].frequency / timoshenko_frequency(beam_of(ends), mode); }
};

void find(BeamRun& run) {
  const Beam beam = beam_of(run.ends);
  const auto scene = beam_of_particles(beam, run.across, run.kernel, run.ratio, run.normalisation);
  const auto modes = analysis::lowest_modes(scene.problem, scene.body, run.modes);
  for (int mode = 1; mode <= bending_modes; ++mode)
    run.found[mode - 1] = recognise(scene.body, modes, bending_shapes(beam, mode));
  run.factor = long_wave_factor(scene.problem);
}

std::vector<BeamRun> beam_runs() {
  std::vector<BeamRun> runs;
  for (const BeamEnds ends : {BeamEnds::free_free, BeamEnds::clamped_free})
    for (const auto normalisation : normalisations)
      for (const int across : resolutions)
        runs.push_back({ends, normalisation, beam_kernel, beam_ratio, across, beam_modes});
  return runs;
}

/// Kernels from which that of the beams was chosen, on a free beam.
std::vector<BeamRun> kernel_runs() {
  constexpr int across = 8, modes = 60;
  std::vector<BeamRun> runs;
  for (const auto& [kernel, ratios] :
       std::vector<std::pair<KernelFamily, std::vector<double>>>{{KernelFamily::cubic_spline, {0.8, 1.0, 1.15, 1.3}},
                                                                 {KernelFamily::quintic_spline, {0.8, 1.0}},
                                                                 {KernelFamily::wendland_c2, {1.0, 1.3}},
                                                                 {KernelFamily::gaussian, {0.8, 1.0}}})
    for (const double ratio : ratios)
      for (const auto normalisation : normalisations)
        runs.push_back({BeamEnds::free_free, normalisation, kernel, ratio, across, modes});
  return runs;
}

double percent(double ratio) { return 100.0 * (ratio - 1.0); }

/// Order of the distance to L/N times Timoshenko on the two finest meshes of the beam whose runs begin at `first`; the
/// finest has half the spacing of the one before.
double final_order(const std::vector<BeamRun>& runs, std::size_t first, int mode) {
  const auto error = [&](std::size_t i) { return runs[i].relative(mode) / runs[i].factor - 1.0; };
  const std::size_t last = first + resolutions.size() - 1;
  return std::log2(error(last - 1) / error(last));
}

std::vector<std::string> find_failures(const std::vector<BeamRun>& runs) {
  constexpr double least_order = 0.6, largest_order = 1.4;
  std::vector<std::string> failures;
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (int mode = 1; mode <= bending_modes; ++mode) {
      const BeamRun& run = runs[i];
      const std::string name =
          fmt::format("{} beam, {} across, bending mode {}", name_of_ends(run.ends), run.across, mode);
      // At worst the outermost rows, which feel half of the strain, carry nothing.
      const double least = std::pow(1.0 - 2.0 / run.across, 1.5), found = run.relative(mode) / run.factor;
      if (found < least || found > 1.0)
        failures.push_back(fmt::format("{}: {:.4f} of L/N times Timoshenko, not {:.4f} to 1", name, found, least));
      if (i % resolutions.size() != 0) continue;
      if (const double order = final_order(runs, i, mode); order < least_order || order > largest_order)
        failures.push_back(
            fmt::format("{} and more: order {:.2f}, not {} to {}", name, order, least_order, largest_order));
    }
  return failures;
}

io::Table beam_table(const std::vector<BeamRun>& runs) {
  io::Document rows = io::Document::array();
  for (std::size_t first = 0; first < runs.size(); first += resolutions.size())
    for (int mode = 1; mode <= bending_modes; ++mode) {
      const Beam beam = beam_of(runs[first].ends);
      const double timoshenko = timoshenko_frequency(beam, mode);
      const auto at = [&](std::size_t i) { return runs[first + i].relative(mode); };
      const std::size_t last = resolutions.size() - 1;
      io::Document row{{"ends", name_of_ends(beam.ends)},
                       {"normalisation", name_of(runs[first].normalisation)},
                       {"mode", mode},
                       {"timoshenko", timoshenko},
                       {"euler", percent(euler_bernoulli_frequency(beam, mode) / timoshenko)}};
      for (std::size_t i = 0; i < resolutions.size(); ++i) row[fmt::format("{}", resolutions[i])] = percent(at(i));
      row.update({{"order", final_order(runs, first, mode)},
                  {"limit", percent(2.0 * at(last) - at(last - 1))},
                  {"factor", percent(runs[first].factor)}});
      rows.push_back(std::move(row));
    }
  std::vector<io::Column> columns{{"ends", "ends"},
                                  {"normalisation", "normalisation"},
                                  {"mode", "bending mode"},
                                  {"timoshenko", "Timoshenko [Hz]", "{:.6f}"},
                                  {"euler", "Euler–Bernoulli [%]", "{:.2f}"}};
  for (const int across : resolutions)
    columns.push_back({fmt::format("{}", across), fmt::format("{} across [%]", across), "{:.2f}"});
  columns.push_back({"order", "order", "{:.2f}"});
  columns.push_back({"limit", "extrapolated [%]", "{:.2f}"});
  columns.push_back({"factor", "L/N − 1 [%]", "{:.2f}"});
  return io::select(rows, columns);
}

io::Table kernel_table(const std::vector<BeamRun>& runs) {
  io::Document rows = io::Document::array();
  for (const BeamRun& run : runs) {
    io::Document row{{"kernel", name_of(run.kernel)},
                     {"ratio", run.ratio},
                     {"normalisation", name_of(run.normalisation)},
                     {"factor", percent(run.factor)}};
    for (int mode = 1; mode <= bending_modes; ++mode) {
      const RecognisedMode& found = run.found[mode - 1];
      row[fmt::format("error_{}", mode)] = percent(run.relative(mode));
      row[fmt::format("slower_{}", mode)] = found.index;
      row[fmt::format("likeness_{}", mode)] = found.likeness;
      row[fmt::format("kind_{}", mode)] = name_of(found.kind);
    }
    rows.push_back(std::move(row));
  }
  std::vector<io::Column> columns{{"kernel", "kernel"},
                                  {"ratio", "h/Δp", "{}"},
                                  {"normalisation", "normalisation"},
                                  {"factor", "L/N − 1 [%]", "{:.2f}"}};
  for (int mode = 1; mode <= bending_modes; ++mode) {
    columns.push_back({fmt::format("error_{}", mode), fmt::format("mode {} [%]", mode), "{:.2f}"});
    columns.push_back({fmt::format("slower_{}", mode), "slower modes"});
    columns.push_back({fmt::format("likeness_{}", mode), "likeness", "{:.2f}"});
    columns.push_back({fmt::format("kind_{}", mode), "named"});
  }
  return io::select(rows, columns);
}

io::LineFigure beam_figure(const std::vector<BeamRun>& runs) {
  io::LineFigure figure;
  figure.title = "Error of the first bending mode: distance from L/N times Timoshenko";
  figure.x_label = "particles across";
  figure.y_label = "relative error";
  figure.x_log = figure.y_log = true;
  for (std::size_t first = 0; first < runs.size(); first += resolutions.size()) {
    io::Curve curve{fmt::format("{}, {}", name_of_ends(runs[first].ends),
                                runs[first].normalisation == KernelNormalisation::sum ? "normalised" : "plain"),
                    {},
                    io::CurveStyle::line_and_points};
    for (std::size_t i = 0; i < resolutions.size(); ++i)
      curve.points.emplace_back(resolutions[i], std::abs(runs[first + i].relative(1) / runs[first].factor - 1.0));
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

// The bodies of Table 2.

constexpr double young_modulus = 650.0, density = 1000.0, poisson_ratio = 0.3;
constexpr double inner = 2.5e-4, outer = 5e-4, length = 5e-4, height = 2.5e-4;
constexpr double gaussian_cutoff = 5.0;
/// 1/(2048 · 2e-5 s): what one bin of the paper's Fourier transform is (errata.md Z12).
constexpr double bin = 1.0 / (2048 * 2e-5);

enum class Table2Body { annulus, rectangle };

/// A mode that has a name, its finite-element value on the finest mesh (finite_elements.csv), and what the paper has.
struct NamedMode {
  Table2Body body;
  std::string_view name;
  double finite_elements;
  std::optional<double> paper_finite_elements;
  std::optional<double> paper;
  std::vector<ShapeFunction> shapes;
};

/// All displacements with n waves around that do not depend on the radius.
std::vector<ShapeFunction> waves_around(int n) {
  std::vector<ShapeFunction> shapes;
  for (const bool radial : {true, false})
    for (const double phase : {0.0, 0.5 * std::numbers::pi}) {
      if (n == 0 && (!radial || phase > 0.0)) continue;
      shapes.emplace_back([=](const Vector<2>& x) {
        const Vector<2> outwards = x.normalized();
        const double wave = std::cos(n * std::atan2(x[1], x[0]) - phase);
        return Vector<2>(wave * (radial ? outwards : Vector<2>(-outwards[1], outwards[0])));
      });
    }
  return shapes;
}

/// (cos πx/a sin πy/a, −sin πx/a cos πy/a): Lamé's mode of a square of side a, and of two side by side.
Vector<2> lame_shape(const Vector<2>& x) {
  const Vector<2> phase = std::numbers::pi / height * x;
  return {std::cos(phase[0]) * std::sin(phase[1]), -std::sin(phase[0]) * std::cos(phase[1])};
}

Material table_2_material() { return Material::from_young_modulus(density, young_modulus, poisson_ratio); }

std::vector<NamedMode> named_modes() {
  const Beam beam{length, height, table_2_material(), Plane::stress, BeamEnds::free_free};
  const ShapeFunction extension = [](const Vector<2>& x) {
    return Vector<2>(std::cos(std::numbers::pi * x[0] / length), 0.0);
  };
  return {{Table2Body::annulus, "2 waves around", 150.898, 152.5, 146.5, waves_around(2)},
          {Table2Body::annulus, "breathing", 355.982, 356.0, 366.2, waves_around(0)},
          {Table2Body::annulus, "3 waves around", 357.491, {}, {}, waves_around(3)},
          {Table2Body::annulus, "1 wave around", 447.348, 445.3, 468.3, waves_around(1)},
          {Table2Body::rectangle, "bending 1", 525.573, {}, {}, bending_shapes(beam, 1)},
          {Table2Body::rectangle, "extension", 796.522, {}, {}, {extension}},
          {Table2Body::rectangle, "bending 2", 878.906, 874.3, 878.9, bending_shapes(beam, 2)},
          {Table2Body::rectangle, "Lamé", 1414.214, 1415.0, 1465.0, {lame_shape}}};
}

Scene<2> table_2_scene(Table2Body which, double ratio, int refinement) {
  const bool is_annulus = which == Table2Body::annulus;
  const double spacing = (is_annulus ? 5e-5 : 2.5e-5) / refinement;
  Problem<2> problem{.lattice = Lattice<2>(LatticeKind::square, spacing),
                     .kernel = Kernel<2>(KernelFamily::gaussian, ratio * spacing, gaussian_cutoff),
                     .material = table_2_material(),
                     .plane = Plane::stress};
  problem.scheme.kernel_normalisation = KernelNormalisation::sum;
  Placement<2> placement{.shape = Box<2>{{0.0, 0.0}, {length, height}}};
  if (is_annulus)
    placement = {.shape = Annulus<2>{Vector<2>::Zero(), inner, outer},
                 .arrangement = PolarArrangement{.rings = 5 * refinement, .sectors = 36 * refinement}};
  return make_scene(SceneDescription<2>{
      .name = "", .problem = problem, .materials = {problem.material}, .parts = {{"body", placement}}});
}

/// The named modes of a body of Table 2 at one H and resolution.
struct Table2Run {
  Table2Body body;
  double ratio;
  int refinement;
  int modes;
  std::vector<RecognisedMode> found = {};
  double factor = 0.0;
};

constexpr std::array<double, 6> table_2_ratios{0.7, 0.8, 0.9, 1.0, 1.2, 1.4};
/// Modes that are less like a shape than this are not taken for it.
constexpr double recognisable = 0.5;
constexpr std::array<int, 3> refinements{1, 2, 4};
/// H/Δ of the refined bodies: few zero-energy modes are slower than those that are named.
constexpr double refined_annulus = 1.0, refined_rectangle = 0.8;

std::vector<Table2Run> table_2_runs() {
  constexpr int all = 400, lowest = 64;
  std::vector<Table2Run> runs;
  for (const auto body : {Table2Body::annulus, Table2Body::rectangle}) {
    for (const double ratio : table_2_ratios) runs.push_back({body, ratio, 1, all});
    for (const int refinement : refinements)
      runs.push_back({body, body == Table2Body::annulus ? refined_annulus : refined_rectangle, refinement, lowest});
  }
  return runs;
}

void find(Table2Run& run) {
  const auto scene = table_2_scene(run.body, run.ratio, run.refinement);
  const auto modes = analysis::lowest_modes(scene.problem, scene.body, run.modes);
  for (const NamedMode& named : named_modes())
    if (named.body == run.body) run.found.push_back(recognise(scene.body, modes, named.shapes));
  run.factor = long_wave_factor(scene.problem);
}

constexpr std::string_view name_of_body(Table2Body body) {
  return body == Table2Body::annulus ? "annulus" : "rectangle";
}

io::Document if_any(const std::optional<double>& value) { return value ? io::Document(*value) : io::Document(); }

constexpr std::size_t runs_of_a_body = table_2_ratios.size() + refinements.size();

/// Calls use(mode, runs of its body, which of their found modes it is).
template <class Use>
void for_each_named(const std::vector<Table2Run>& runs, const Use& use) {
  std::size_t first = 0, which = 0;
  for (const NamedMode& named : named_modes()) {
    if (named.body != runs[first].body) {
      first += runs_of_a_body;
      which = 0;
    }
    use(named, &runs[first], which++);
  }
}

io::Table paper_table(const std::vector<Table2Run>& runs) {
  io::Document rows = io::Document::array();
  for_each_named(runs, [&](const NamedMode& named, const Table2Run* of_body, std::size_t which) {
    io::Document row{
        {"body", name_of_body(named.body)}, {"mode", named.name},
        {"fe", named.finite_elements},      {"paper_fe", if_any(named.paper_finite_elements)},
        {"paper", if_any(named.paper)},     {"bins", named.paper ? io::Document(*named.paper / bin) : io::Document()}};
    for (std::size_t i = 0; i < table_2_ratios.size(); ++i) {
      const RecognisedMode& found = of_body[i].found[which];
      row[fmt::format("{}", table_2_ratios[i])] =
          found.likeness < recognisable ? fmt::format("spread ({:.2f})", found.likeness)
                                        : fmt::format("{:.1f} ({:+.1f} %, {:.2f})", found.frequency,
                                                      percent(found.frequency / named.finite_elements), found.likeness);
    }
    rows.push_back(std::move(row));
  });
  std::vector<io::Column> columns{{"body", "body"},
                                  {"mode", "mode"},
                                  {"fe", "CalculiX [Hz]", "{:.3f}"},
                                  {"paper_fe", "paper, FEM [Hz]", "{:.1f}"},
                                  {"paper", "paper, SPH [Hz]", "{:.1f}"},
                                  {"bins", "that in bins", "{:.2f}"}};
  for (const double ratio : table_2_ratios)
    columns.push_back({fmt::format("{}", ratio), fmt::format("H = {} Δ [Hz] (error, likeness)", ratio)});
  return io::select(rows, columns);
}

io::Table refinement_table(const std::vector<Table2Run>& runs) {
  io::Document rows = io::Document::array();
  for_each_named(runs, [&](const NamedMode& named, const Table2Run* of_body, std::size_t which) {
    const Table2Run* refined = of_body + table_2_ratios.size();
    const auto error = [&](std::size_t i) { return refined[i].found[which].frequency / named.finite_elements; };
    const auto [order, limit] = extrapolate(error(0), error(1), error(2));
    io::Document row{{"body", name_of_body(named.body)}, {"mode", named.name}, {"ratio", refined->ratio}};
    for (std::size_t i = 0; i < refinements.size(); ++i) {
      row[fmt::format("{}", refinements[i])] = percent(error(i));
      row[fmt::format("likeness_{}", refinements[i])] = refined[i].found[which].likeness;
    }
    row.update(
        {{"order", std::isfinite(order) ? io::Document(order) : io::Document()},
         {"limit", std::isfinite(order) ? io::Document(percent(limit)) : io::Document()},
         {"factor", named.body == Table2Body::rectangle ? io::Document(percent(refined->factor)) : io::Document()}});
    rows.push_back(std::move(row));
  });
  std::vector<io::Column> columns{{"body", "body"}, {"mode", "mode"}, {"ratio", "H/Δ", "{}"}};
  for (const int refinement : refinements) {
    columns.push_back({fmt::format("{}", refinement), fmt::format("Δ/{} [%]", refinement), "{:.2f}"});
    columns.push_back({fmt::format("likeness_{}", refinement), "likeness", "{:.2f}"});
  }
  columns.push_back({"order", "order", "{:.2f}"});
  columns.push_back({"limit", "extrapolated [%]", "{:.2f}"});
  columns.push_back({"factor", "L/N − 1 [%]", "{:.2f}"});
  return io::select(rows, columns);
}

// Pictures.

/// The largest displacement is drawn as this part of the body's length.
constexpr double drawn_amplitude = 0.06;

io::ParticlePanel panel(const std::string& title, const Body<2>& body, const analysis::BodyMode& mode) {
  double largest = 0.0, length_of_body = 0.0;
  for (int a = 0; a < body.size(); ++a) {
    largest = std::max(largest, mode.displacement.segment<2>(2 * a).norm());
    length_of_body = std::max(length_of_body, (body.position[a] - body.position[0]).norm());
  }
  io::ParticlePanel picture{.title = title, .positions = {}};
  for (int a = 0; a < body.size(); ++a) {
    const Vector<2> s = mode.displacement.segment<2>(2 * a) / largest;
    const Vector<2> x = body.position[a] + drawn_amplitude * length_of_body * s;
    picture.positions.emplace_back(1e3 * x[0], 1e3 * x[1]);
    picture.values.push_back(s.norm());
  }
  return picture;
}

io::ParticleFigure mode_figure(Table2Body which) {
  const bool is_annulus = which == Table2Body::annulus;
  io::ParticleFigure figure{.title = fmt::format("Modes of the {} of Table 2, enlarged", name_of_body(which)),
                            .x_label = "x [mm]",
                            .y_label = "y [mm]",
                            .value_label = "displacement",
                            .radius = 8e-3,
                            .panels = {},
                            .columns = 2,
                            .value_range = std::pair(0.0, 1.0)};
  constexpr int enough_modes = 64;
  const auto scene = table_2_scene(which, is_annulus ? refined_annulus : refined_rectangle, 1);
  const auto modes = analysis::lowest_modes(scene.problem, scene.body, enough_modes);
  for (const NamedMode& named : named_modes())
    if (named.body == which) {
      const auto found = recognise(scene.body, modes, named.shapes);
      figure.panels.push_back(
          panel(fmt::format("{}: {:.1f} Hz", named.name, found.frequency), scene.body, modes[found.index]));
    }
  // The slowest one that is not at rest.
  constexpr double at_rest = 1e-3;
  const auto slow = std::find_if(modes.begin(), modes.end(), [&](const analysis::BodyMode& mode) {
    return mode.kind == analysis::BodyModeKind::zero_energy && mode.omega > at_rest * modes.back().omega;
  });
  if (slow != modes.end())
    figure.panels.push_back(
        panel(fmt::format("zero-energy: {:.1f} Hz", 0.5 * slow->omega / std::numbers::pi), scene.body, *slow));
  return figure;
}

constexpr const char* beam_text = R"(
A mode is recognised by its shape, deflection and rotation of Euler and Bernoulli, among all modes of the spectrum:
likeness is the part of its displacement that the shape explains. "Named" is what `spectrum` calls it.

Two errors are apart. Inside a body SPH makes the frequency of every long wave wrong by L/N, L δ_ij = −Σ V x_i ∂_j W:
that depends on h/Δp alone and no refinement takes it away. The rest comes from free edges, where the sums lack half
of their neighbours, and from the clamp. It falls with first order: "order" is that of the distance to L/N times
Timoshenko on the two finest meshes, "extrapolated" assumes 1. Normalisation makes the error of edges several times
smaller, not of higher order; that normalised beams seem right at 16 or 32 across is the two errors cancelling.

)";

constexpr const char* kernel_text = R"(The kernel was chosen from these, on the free beam with 8 particles across.
L/N − 1 is small, and nothing but the three rigid motions and the slower bending modes lies below the third bending
mode; at h = 1.3 Δp dozens of zero-energy modes do.

)";

constexpr const char* table_2_text = R"(
Gaussian, kernel normalisation, plane stress, ν = 0.3; the paper gives neither ν, plane nor H, so that H is varied.
Modes are recognised by shape: displacements with n waves around the annulus that do not depend on the radius; on the
rectangle the bending of a slender beam, cos πx/L along it, and Lamé's equivoluminal mode. Beside each frequency its
error against CalculiX ([finite_elements.md](finite_elements.md)) and its likeness; "spread" where no mode has half of
the shape, because zero-energy modes of nearly its frequency share it. The paper's third frequency of the rectangle,
2148 Hz (FEM 2058), was not identified; its 366.2 Hz may be either of the annulus' near 356 Hz.

All but one of the paper's SPH frequencies are whole bins of 1/(2048 · 2e-5 s) = 24.41 Hz of its Fourier transform
(errata Z12): they are known to ±12 Hz, 8 % of the first, and say no more than that of its errors of 0.5 to 5 %.

)";

constexpr const char* refinement_text = R"(
Refined at fixed H/Δ, errors against CalculiX. Order and limit are those of the three values, and missing where these
do not fall steadily. The rectangle is within 1.5 % of its limit L/N at once, so that its differences are too small for
an order to mean much. The annulus tends to errors of its own: on its polar grid the sums are wrong by as much, and
differently along the radius and around, at every resolution.

)";

}  // namespace

Report natural_frequency_report(const Progress& progress) {
  auto beams = beam_runs(), kernels = kernel_runs();
  auto table_2 = table_2_runs();
  std::vector<std::function<void()>> work;
  for (auto& run : table_2) work.emplace_back([&run] { find(run); });
  for (auto* runs : {&beams, &kernels})
    for (auto& run : *runs) work.emplace_back([&run] { find(run); });
  run_all(work, progress);

  const auto beam_rows = beam_table(beams), kernel_rows = kernel_table(kernels);
  const auto paper_rows = paper_table(table_2), refinement_rows = refinement_table(table_2);
  Report report;
  report.failures = find_failures(beams);
  const int coarse = 8;
  report.summary = fmt::format(
      "Bending frequencies of beams of slenderness 10 from the spectrum: {}, h = {} Δp, plane stress, ν = 0.3. Errors "
      "are\nagainst Timoshenko's beam.\n\n{}\n{}"
      "The clamped end is made of columns of held particles at x < 0, as many as the kernel reaches. The length counts "
      "from\nx = 0, between the last held and the first free column. To count it from the last held column is to add "
      "Δp/2, and so to\nexpect frequencies that are lower by Δp/length, {:.2f} % at {} across: of the order of what "
      "the "
      "clamp adds to the error.\n",
      name_of(beam_kernel), beam_ratio, io::to_markdown(beam_rows), beam_text,
      100.0 * beam_of(BeamEnds::clamped_free).height / (coarse * beam_of(BeamEnds::clamped_free).length), coarse);
  report.files = {
      {"README.md",
       "# Natural frequencies\n\n## Beams\n\n" + report.summary + "\n![Error against particles across](beams.svg)\n\n" +
           kernel_text + io::to_markdown(kernel_rows) + "\n## Table 2 of the paper\n" + table_2_text +
           io::to_markdown(paper_rows) + refinement_text + io::to_markdown(refinement_rows) +
           "\n![Modes of the annulus](annulus.svg)\n\n![Modes of the rectangle](rectangle.svg)\n\nRegenerate with "
           "`sphstab report natural-frequencies --overwrite`; "
           "[finite_elements.md](finite_elements.md) is made by another program.\n"},
      {"beams.csv", io::to_csv(beam_rows)},
      {"kernels.csv", io::to_csv(kernel_rows)},
      {"table_2.csv", io::to_csv(paper_rows)},
      {"refinement.csv", io::to_csv(refinement_rows)},
      {"beams.svg", io::render_svg(beam_figure(beams))},
      {"annulus.svg", io::render_svg(mode_figure(Table2Body::annulus))},
      {"rectangle.svg", io::render_svg(mode_figure(Table2Body::rectangle))}};
  return report;
}

}  // namespace sphstab::study
