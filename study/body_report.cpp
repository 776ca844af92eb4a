// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "analysis/spectrum.hpp"
#include "io/document.hpp"
#include "io/figure.hpp"
#include "model/scene.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"
#include "study/step_comparison.hpp"

namespace sphstab::study {
namespace {

constexpr double tolerance = 1e-6;
constexpr int plate_particles = 20;

/// Where nothing else is said: units of the spacing and of the density and Young's modulus of the body.
constexpr KernelFamily usual_kernel = KernelFamily::cubic_spline;
constexpr double usual_ratio = 1.3;
const Material usual_material = Material::from_young_modulus(1.0, 1.0, 0.3);

/// Cases 1 and 2 of Zhang et al.; H of Case 1 is not given and varied, that of Case 2 is twice the distance of rings.
constexpr double zhang_spacing = 2.5e-5;
constexpr double gaussian_cutoff = 5.0;  // W = 1e-11 W(0)
constexpr std::array<double, 8> zhang_ratios{0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.4};

constexpr std::array<KernelNormalisation, 2> normalisations{KernelNormalisation::none, KernelNormalisation::sum};

constexpr std::string_view suffix(KernelNormalisation normalisation) {
  return normalisation == KernelNormalisation::sum ? ", normalised" : "";
}

template <int Dim>
constexpr LatticeKind axes_lattice = Dim == 1   ? LatticeKind::chain
                                     : Dim == 2 ? LatticeKind::square
                                                : LatticeKind::cubic;

template <int Dim>
Problem<Dim> usual_problem(KernelFamily kernel = usual_kernel, double ratio = usual_ratio,
                           KernelNormalisation normalisation = KernelNormalisation::none) {
  Problem<Dim> problem{.lattice = Lattice<Dim>(axes_lattice<Dim>, 1.0),
                       .kernel = Kernel<Dim>(kernel, ratio, gaussian_cutoff),
                       .material = usual_material};
  problem.scheme.kernel_normalisation = normalisation;
  return problem;
}

Problem<2> zhang_problem(double smoothing_length, KernelNormalisation normalisation) {
  Problem<2> problem{.lattice = Lattice<2>(LatticeKind::square, zhang_spacing),
                     .kernel = Kernel<2>(KernelFamily::gaussian, smoothing_length, gaussian_cutoff),
                     .material = Material::from_young_modulus(1000.0, 0.39, 0.3),
                     .plane = Plane::stress};
  problem.scheme.kernel_normalisation = normalisation;
  return problem;
}

template <int Dim>
Box<Dim> box(const Vector<Dim>& from, const Vector<Dim>& to) {
  return {from, to};
}

template <int Dim>
SceneDescription<Dim> description_of(const Problem<Dim>& problem, const Placement<Dim>& placement) {
  return {.name = "", .problem = problem, .materials = {problem.material}, .parts = {{"body", placement}}};
}

template <int Dim>
Scene<Dim> scene_of(const Problem<Dim>& problem, const Placement<Dim>& placement) {
  return make_scene(description_of(problem, placement));
}

Placement<2> square_plate(int particles, const std::optional<Jitter>& jitter = {}, double spacing = 1.0) {
  return {.shape = box<2>(Vector<2>::Zero(), Vector<2>::Constant(spacing * particles)), .jitter = jitter};
}

Scene<2> annulus(KernelNormalisation normalisation) {
  const Annulus<2> shape{Vector<2>::Zero(), 2.5e-4, 5e-4};
  return scene_of<2>(zhang_problem(2.0 * zhang_spacing, normalisation),
                     {.shape = shape, .arrangement = PolarArrangement{.rings = 10, .sectors = 36}});
}

/// Its first two columns are held.
Scene<2> clamped_beam() {
  auto description = description_of<2>(usual_problem<2>(usual_kernel, usual_ratio, KernelNormalisation::sum),
                                       {.shape = box<2>({0.0, 0.0}, {40.0, 8.0})});
  description.clamps = {{box<2>({0.0, 0.0}, {2.0, 8.0}), Directions<2>::Constant(true)}};
  return make_scene(description);
}

/// The same elasticity, the right half a thousand times as dense.
Scene<2> bar_of_two_materials() {
  auto description = description_of<2>(usual_problem<2>(), {.shape = box<2>({0.0, 0.0}, {20.0, 8.0})});
  description.materials.push_back(Material::from_young_modulus(1000.0, 1.0, 0.3));
  const Placement<2> right{.shape = box<2>({20.0, 0.0}, {40.0, 8.0})};
  description.parts.push_back({"dense half", right, 1});
  return make_scene(description);
}

Scene<2> nearly_incompressible_plate() {
  auto problem = usual_problem<2>();
  problem.material = Material::from_young_modulus(1.0, 1.0, 0.4999);
  return scene_of(problem, square_plate(plate_particles));
}

Scene<2> disc_with_a_hole() {
  const Placement<2> placement{.shape = Ball<2>{Vector<2>::Zero(), 11.0}, .cut = {Ball<2>{{3.0, 2.0}, 4.0}}};
  return scene_of(usual_problem<2>(), placement);
}

/// The critical step of a body by its spectrum and by running it.
struct ComparedBody {
  std::string name;
  int particles;
  double critical_step;
  analysis::Bracket bracket;
  analysis::BoundKind bracket_kind;
  long applications;
  Bisection run;
  std::optional<double> bulk_deficit;  ///< of a body of one material cut from a lattice

  double relative_difference() const {
    return run.critical_time_step ? std::abs(*run.critical_time_step / critical_step - 1.0)
                                  : std::numeric_limits<double>::infinity();
  }
  double steps_over_applications() const { return static_cast<double>(run.steps) / static_cast<double>(applications); }
  /// No step below the bracket grew, and none above it stayed bounded.
  bool inside_bracket() const { return run.low <= bracket.high && run.high >= bracket.low; }
};

template <int Dim>
ComparedBody compare(std::string name, const Scene<Dim>& scene) {
  const Body<Dim>& body = scene.body;
  const auto limit = analysis::body_limit(scene.problem, body);
  const auto found = compare_step<Dim>(scene.problem, body, {.tolerance = tolerance});
  const bool has_bulk = !body.site.empty() && body.materials.size() == 1 && found.bulk_theory;
  return {std::move(name),
          body.size(),
          limit.critical_time_step,
          limit.bracket,
          limit.bracket_kind,
          limit.applications,
          found.run,
          has_bulk ? std::optional(limit.critical_time_step / *found.bulk_theory - 1.0) : std::nullopt};
}

using MakeBody = std::function<ComparedBody()>;

template <int Dim>
MakeBody comparison_of(std::string name, Scene<Dim> scene) {
  return [name = std::move(name), scene = std::move(scene)] { return compare(name, scene); };
}

std::vector<MakeBody> all_comparisons() {
  std::vector<MakeBody> bodies;
  for (const auto normalisation : normalisations)
    for (const double ratio : zhang_ratios)
      bodies.push_back(comparison_of(fmt::format("Case 1, H = {} Δ{}", ratio, suffix(normalisation)),
                                     scene_of(zhang_problem(ratio * zhang_spacing, normalisation),
                                              square_plate(plate_particles, {}, zhang_spacing))));
  for (const auto normalisation : normalisations)
    bodies.push_back(comparison_of(fmt::format("annulus of Case 2{}", suffix(normalisation)), annulus(normalisation)));
  bodies.push_back(comparison_of("clamped beam, normalised", clamped_beam()));
  for (const std::uint64_t seed : {1, 2, 3})
    bodies.push_back(comparison_of(fmt::format("plate jittered by 20 %, seed {}", seed),
                                   scene_of(usual_problem<2>(), square_plate(plate_particles, Jitter{0.2, seed}))));
  bodies.push_back(comparison_of("bar, densities 1 and 1000", bar_of_two_materials()));
  bodies.push_back(comparison_of("plate, ν = 0.4999, plane strain", nearly_incompressible_plate()));
  bodies.push_back(comparison_of("disc with a hole", disc_with_a_hole()));
  const Placement<1> bar{.shape = box<1>(Vector<1>(0.0), Vector<1>(40.0))};
  bodies.push_back(comparison_of("bar in 1D", scene_of(usual_problem<1>(), bar)));
  const Placement<3> block{.shape = box<3>({0.0, 0.0, 0.0}, {8.0, 6.0, 5.0})};
  bodies.push_back(comparison_of("block in 3D", scene_of(usual_problem<3>(), block)));
  return bodies;
}

io::Table to_table(const std::vector<ComparedBody>& bodies, const std::string& step, const std::string& difference) {
  io::Document rows = io::Document::array();
  for (const ComparedBody& body : bodies) {
    const auto& found = body.run.critical_time_step;
    rows.push_back({{"body", body.name},
                    {"particles", body.particles},
                    {"spectrum", body.critical_step},
                    {"bracket", name_of(body.bracket_kind)},
                    {"width", (body.bracket.high - body.bracket.low) / body.critical_step},
                    {"run", found ? io::Document(*found) : io::Document()},
                    {"difference", body.relative_difference()},
                    {"deficit", body.bulk_deficit ? io::Document(100.0 * *body.bulk_deficit) : io::Document()},
                    {"applications", body.applications},
                    {"runs", body.run.runs},
                    {"steps", body.run.steps},
                    {"ratio", body.steps_over_applications()}});
  }
  return io::select(rows, {{"body", "body"},
                           {"particles", "particles"},
                           {"spectrum", "step, spectrum", step},
                           {"bracket", "proven by"},
                           {"width", "width of the bracket", difference},
                           {"run", "step, bisection", step},
                           {"difference", "difference", difference},
                           {"deficit", "body/bulk − 1 [%]", "{:.2f}"},
                           {"applications", "applications"},
                           {"runs", "runs"},
                           {"steps", "steps"},
                           {"ratio", "steps/applications", "{:.0f}"}});
}

// Disorder: the largest frequency of jittered plates over that of the infinite lattice.

constexpr std::array<double, 5> jitters{0.0, 0.05, 0.1, 0.2, 0.3};

struct PlateSize {
  int side;   ///< particles
  int seeds;  ///< one where nothing is jittered
};
constexpr std::array<PlateSize, 3> plate_sizes{{{20, 8}, {100, 4}, {300, 2}}};

/// Far below the differences between seeds.
constexpr double disorder_tolerance = 1e-6;

struct Disorder {
  KernelNormalisation normalisation;
  PlateSize size;
  double jitter;
  std::vector<double> excess;  ///< ω_max over the bulk's, of every seed

  double largest() const { return *std::max_element(excess.begin(), excess.end()); }
  double least() const { return *std::min_element(excess.begin(), excess.end()); }
};

template <int Dim>
double frequency_over_bulk(const Problem<Dim>& problem, const Body<Dim>& body, double bound_tolerance) {
  const auto limit =
      analysis::body_limit(problem, body, {.bound = analysis::BoundKind::norm_bound, .tolerance = bound_tolerance});
  return *bulk_step(problem) / limit.critical_time_step;
}

std::vector<Disorder> all_disorders() {
  std::vector<Disorder> disorders;
  for (const auto normalisation : normalisations)
    for (const PlateSize& size : plate_sizes)
      for (const double jitter : jitters)
        disorders.push_back({normalisation, size, jitter, std::vector<double>(jitter == 0.0 ? 1 : size.seeds)});
  return disorders;
}

void measure(Disorder& disorder) {
  const auto problem = usual_problem<2>(usual_kernel, usual_ratio, disorder.normalisation);
  for (std::size_t i = 0; i < disorder.excess.size(); ++i) {
    const auto plate = square_plate(disorder.size.side, Jitter{disorder.jitter, i + 1});
    disorder.excess[i] = frequency_over_bulk(problem, scene_of(problem, plate).body, disorder_tolerance);
  }
}

io::Table to_table(const std::vector<Disorder>& disorders) {
  io::Document rows = io::Document::array();
  for (const Disorder& disorder : disorders)
    rows.push_back({{"normalisation", name_of(disorder.normalisation)},
                    {"particles", disorder.size.side * disorder.size.side},
                    {"jitter", 100.0 * disorder.jitter},
                    {"seeds", disorder.excess.size()},
                    {"least", disorder.least()},
                    {"largest", disorder.largest()},
                    {"factor", 1.0 / disorder.largest()}});
  return io::select(rows, {{"normalisation", "kernel normalisation"},
                           {"particles", "particles"},
                           {"jitter", "jitter [% of Δp]", "{:.0f}"},
                           {"seeds", "seeds"},
                           {"least", "ω_max/bulk, least", "{:.4f}"},
                           {"largest", "ω_max/bulk, largest", "{:.4f}"},
                           {"factor", "safe factor on the bulk step", "{:.3f}"}});
}

io::LineFigure to_figure(const std::vector<Disorder>& disorders) {
  io::LineFigure figure;
  figure.title = "Largest frequency of jittered plates over that of the lattice";
  figure.x_label = "jitter [% of the spacing]";
  figure.y_label = "ω_max of the body / ω_max of the bulk";
  for (const auto normalisation : normalisations)
    for (const PlateSize& size : plate_sizes) {
      io::Curve curve{fmt::format("{} particles{}", size.side * size.side, suffix(normalisation)),
                      {},
                      io::CurveStyle::line_and_points};
      for (const Disorder& disorder : disorders)
        if (disorder.normalisation == normalisation && disorder.size.side == size.side)
          curve.points.emplace_back(100.0 * disorder.jitter, disorder.largest());
      figure.curves.push_back(std::move(curve));
    }
  return figure;
}

// Edges: the step of a body over that of the infinite lattice.

constexpr std::array<double, 4> edge_ratios{0.8, 1.0, 1.3, 2.0};
constexpr int block_particles = 8;

/// What is left of the bulk step, body/bulk − 1, on a plate, free and held by its two outermost rows and columns, and
/// on a free cube.
struct Edges {
  KernelFamily kernel;
  double ratio;
  std::array<double, 6> deficit;
};

constexpr std::array<std::string_view, 6> edge_names{
    "plate", "plate, normalised", "held plate", "held plate, normalised", "cube", "cube, normalised"};

Body<2> held(Body<2> body) {
  body.clamped.assign(body.size(), Directions<2>::Constant(false));
  for (int a = 0; a < body.size(); ++a)
    if (body.site[a].minCoeff() < 2 || body.site[a].maxCoeff() > plate_particles - 3) body.clamped[a].setConstant(true);
  return body;
}

template <int Dim>
double deficit(const Problem<Dim>& problem, const Body<Dim>& body) {
  return 1.0 / frequency_over_bulk(problem, body, disorder_tolerance) - 1.0;
}

Edges measure_edges(KernelFamily kernel, double ratio) {
  Edges edges{kernel, ratio, {}};
  for (std::size_t i = 0; i < normalisations.size(); ++i) {
    const auto plane = usual_problem<2>(kernel, ratio, normalisations[i]);
    const auto plate = free_plate<2>(plane, {plate_particles, plate_particles});
    edges.deficit[i] = deficit(plane, plate);
    edges.deficit[2 + i] = deficit(plane, held(plate));
    const auto space = usual_problem<3>(kernel, ratio, normalisations[i]);
    const Placement<3> cube{.shape = box<3>(Vector<3>::Zero(), Vector<3>::Constant(block_particles))};
    edges.deficit[4 + i] = deficit(space, scene_of(space, cube).body);
  }
  return edges;
}

std::vector<Edges> all_edges() {
  std::vector<Edges> all;
  for (const auto& [kernel, name] : Names<KernelFamily>::table)
    for (const double ratio : edge_ratios) all.push_back({kernel, ratio, {}});
  return all;
}

io::Table to_table(const std::vector<Edges>& all) {
  io::Document rows = io::Document::array();
  for (const Edges& edges : all) {
    io::Document row{{"kernel", name_of(edges.kernel)}, {"ratio", edges.ratio}};
    for (std::size_t i = 0; i < edge_names.size(); ++i) row[std::string(edge_names[i])] = 100.0 * edges.deficit[i];
    rows.push_back(std::move(row));
  }
  std::vector<io::Column> columns{{"kernel", "kernel"}, {"ratio", "h/Δp", "{}"}};
  for (const auto name : edge_names) columns.push_back({std::string(name), std::string(name) + " [%]", "{:.2f}"});
  return io::select(rows, columns);
}

/// All three tables.
struct Measured {
  std::vector<ComparedBody> bodies;
  std::vector<Disorder> disorders;
  std::vector<Edges> edges;
};

Measured measure_all(const Progress& progress) {
  const auto comparisons = all_comparisons();
  Measured measured{std::vector<ComparedBody>(comparisons.size()), all_disorders(), all_edges()};
  std::vector<std::function<void()>> work;
  for (std::size_t i = 0; i < comparisons.size(); ++i)
    work.emplace_back([&, i] { measured.bodies[i] = comparisons[i](); });
  for (auto& disorder : measured.disorders) work.emplace_back([&disorder] { measure(disorder); });
  for (auto& edges : measured.edges) work.emplace_back([&edges] { edges = measure_edges(edges.kernel, edges.ratio); });
  run_all(work, progress);
  return measured;
}

std::vector<std::string> find_failures(const std::vector<ComparedBody>& bodies) {
  std::vector<std::string> failures;
  for (const ComparedBody& body : bodies) {
    if (body.relative_difference() > tolerance)
      failures.push_back(fmt::format("{}: spectrum and bisection differ by more than {:g}", body.name, tolerance));
    if (!body.inside_bracket())
      failures.push_back(fmt::format("{}: a run grew below the bracket or stayed bounded above it", body.name));
  }
  return failures;
}

double worst_difference(const std::vector<ComparedBody>& bodies) {
  double worst = 0.0;
  for (const ComparedBody& body : bodies) worst = std::max(worst, body.relative_difference());
  return worst;
}

/// Where the upper bound is farther from the Ritz value than Lanczos believed.
std::string describe_wide_brackets(const std::vector<ComparedBody>& bodies) {
  constexpr double wide = 1e-9;  // ten times what is asked of ω²
  std::string text;
  for (const ComparedBody& body : bodies)
    if (const double width = (body.bracket.high - body.bracket.low) / body.critical_step; width > wide)
      text += fmt::format(
          "\n{}: the bracket is {:.0e} wide. Lanczos took frequencies that hardly differ for one and stopped below "
          "the\n"
          "largest; the factorisation noticed, and the run is inside what it proves.\n",
          body.name, width);
  return text;
}

std::string describe_cost(const std::vector<ComparedBody>& bodies) {
  long applications = 0, steps = 0;
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const ComparedBody& body : bodies) {
    least = std::min(least, body.steps_over_applications());
    most = std::max(most, body.steps_over_applications());
    applications += body.applications;
    steps += body.run.steps;
  }
  return fmt::format(
      "\nAn application of the operator does the work of one time step. Lanczos took {} of them for all bodies, to "
      "1e-10 "
      "of ω²;\nbisection {} steps, to {:g} of the step: {:.0f} times as many, between {:.0f} and {:.0f} times on one "
      "body.\n",
      applications, steps, tolerance, static_cast<double>(steps) / static_cast<double>(applications), least, most);
}

std::string describe_disorder(const std::vector<Disorder>& disorders) {
  std::string text;
  for (const auto normalisation : normalisations) {
    text += normalisation == KernelNormalisation::none ? "Without" : "With";
    text += " kernel normalisation the step of the lattice is safe times";
    for (const double jitter : jitters) {
      double largest = 0.0;
      for (const Disorder& disorder : disorders)
        if (disorder.normalisation == normalisation && disorder.jitter == jitter)
          largest = std::max(largest, disorder.largest());
      // Rounded down: a factor is to be safe.
      text += fmt::format("{} {:.2f} ({:.0f} %)", jitter == jitters.front() ? "" : ",",
                          std::floor(100.0 / largest) / 100.0, 100.0 * jitter);
    }
    text += ".\n";
  }
  return text;
}

std::string describe_edges(const std::vector<Edges>& all) {
  std::string text;
  for (std::size_t i = 0; i < edge_names.size(); ++i) {
    const auto [least, most] = std::minmax_element(
        all.begin(), all.end(), [i](const Edges& a, const Edges& b) { return a.deficit[i] < b.deficit[i]; });
    const auto name = [](const Edges& edges) {
      return fmt::format("{}, h = {} Δp", name_of(edges.kernel), edges.ratio);
    };
    text += fmt::format("- {}: from {:+.1f} % ({}) to {:+.1f} % ({})\n", edge_names[i], 100.0 * least->deficit[i],
                        name(*least), 100.0 * most->deficit[i], name(*most));
  }
  return text;
}

}  // namespace

Report body_report(const Progress& progress) {
  const auto [bodies, disorders, edges] = measure_all(progress);
  Report report;
  report.failures = find_failures(bodies);
  const auto table = to_table(bodies, "{:.9g}", "{:.0e}");
  report.summary = fmt::format(
      "The critical step of whole bodies, by the spectrum of their operator (docs/spectrum.md) and by bisection on "
      "the\n"
      "running solver to {:g}; leapfrog, each in the units of the body. Case 1: plate of {}×{}, Gaussian, plane "
      "stress,\n"
      "as is the annulus; all others: {}, h = {} Δp, ν = 0.3 where nothing else is said, plane strain. Bulk is the\n"
      "infinite lattice, where there is one.\n\n{}\n"
      "{} bodies: the worst difference is {:.0e}; {} claims do not hold.\n{}{}",
      tolerance, plate_particles, plate_particles, name_of(usual_kernel), usual_ratio, io::to_markdown(table),
      bodies.size(), worst_difference(bodies), report.failures.size(), describe_wide_brackets(bodies),
      describe_cost(bodies));
  const std::string disorder_text = fmt::format(
      "Free square plates, {}, h = {} Δp, ν = 0.3, plane strain. Every component of every position is off its site by "
      "a number\ndrawn from ± the jitter; the least and the largest ω_max over seeds beside that of the infinite "
      "lattice. A larger body has\nmore places where chance has brought particles close together: without "
      "normalisation "
      "the least grows with the size.\n\n{}\n{}",
      name_of(usual_kernel), usual_ratio, io::to_markdown(to_table(disorders)), describe_disorder(disorders));
  const std::string edge_text = fmt::format(
      "body/bulk − 1 of the critical step; where it is negative, the step of the infinite lattice is unstable on the "
      "body. Plate of\n{0}×{0}, held: its two outermost rows and columns are clamped; cube of {1}×{1}×{1}. Gaussian "
      "cut "
      "at {2:g} h.\n\n{3}\n"
      "Free edges alone lower the largest frequency. Normalisation divides the sums of a particle by the part N of the "
      "kernel\nthat is inside the body: a half at an edge, a quarter in the corner of a plate, an eighth in that of a "
      "cube, more for\nnarrow kernels, where the particle itself counts most. What is divided by less is faster; held "
      "edges have no such particles.\n\n{4}",
      plate_particles, block_particles, gaussian_cutoff, describe_edges(edges), io::to_markdown(to_table(edges)));
  report.files = {
      {"README.md", "# The critical step of whole bodies\n\n## Spectrum against bisection\n\n" + report.summary +
                        "\n## Disorder\n\n" + disorder_text + "\n![Largest frequency against jitter](disorder.svg)\n" +
                        "\n## Edges, normalisation and clamps\n\n" + edge_text +
                        "\nRegenerate with `sphstab report bodies --overwrite`; `table.csv` holds every digit of the "
                        "first table.\n"},
      {"table.csv", io::to_csv(to_table(bodies, "{}", "{:.3e}"))},
      {"table.md", io::to_markdown(table)},
      {"disorder.csv", io::to_csv(to_table(disorders))},
      {"edges.csv", io::to_csv(to_table(edges))},
      {"disorder.svg", io::render_svg(to_figure(disorders))}};
  return report;
}

}  // namespace sphstab::study
