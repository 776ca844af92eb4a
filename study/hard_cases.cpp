// SPDX-License-Identifier: MIT
#include "study/hard_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "analysis/critical_step.hpp"
#include "io/document.hpp"
#include "model/lattice_index.hpp"
#include "study/growth_run.hpp"
#include "study/parallel.hpp"
#include "study/report.hpp"
#include "study/step_comparison.hpp"
#include "study/updated_hard_cases.hpp"

namespace sphstab::study {
namespace {

/// A few dozen roundings of sums and products.
constexpr double rounding = 1e-12;
/// Growth is measured at this growth a step, to the 1e-5 a step of the ladder's rung 5.
constexpr double growth_per_step = 0.05, growth_tolerance = 1e-5 / growth_per_step;

constexpr std::string_view nearest_shell = "closed form of the nearest shell";
constexpr std::string_view direct_sum = "sum over the sites, written out";

using MakeCase = std::function<HardCase()>;

/// What a case is about, before anything is computed.
template <int Dim>
struct Subject {
  std::string name;
  Problem<Dim> problem;
  LatticeIndex<Dim> cells;
};

/// The lattice whose nearest neighbours are ± the axes.
template <int Dim>
constexpr LatticeKind axes_lattice = Dim == 1   ? LatticeKind::chain
                                     : Dim == 2 ? LatticeKind::square
                                                : LatticeKind::cubic;

/// Four cells an axis admit the maximiser (π/2, π/2, …) of the nearest shell.
template <int Dim>
LatticeIndex<Dim> four_cells() {
  return LatticeIndex<Dim>::Constant(4);
}

constexpr double some_density = 1.7, some_modulus = 2.9, some_ratio = 0.31, some_spacing = 0.37;

template <int Dim>
Problem<Dim> problem_of(KernelFamily kernel, double h_over_spacing, double gaussian_cutoff = default_gaussian_cutoff) {
  return {.lattice = Lattice<Dim>(axes_lattice<Dim>, some_spacing),
          .kernel = Kernel<Dim>(kernel, h_over_spacing * some_spacing, gaussian_cutoff),
          .material = Material::from_young_modulus(some_density, some_modulus, some_ratio)};
}

/// c_p from E and ν: E (1−ν)/((1+ν)(1−2ν)), in plane stress E/(1−ν²).
template <int Dim>
double p_wave_speed(const Problem<Dim>& problem) {
  const double E = problem.material.young_modulus(), nu = problem.material.poisson_ratio();
  const double modulus =
      problem.plane == Plane::stress ? E / ((1.0 - nu) * (1.0 + nu)) : E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
  return std::sqrt(modulus / problem.material.density());
}

/// max |D| Δp = 2 Δp V |W'(Δp)| √d: each component of D is −2 V W'(Δp) sin(k_i Δp).
template <int Dim>
double nearest_shell_maximum(const Problem<Dim>& problem) {
  const double spacing = problem.lattice.spacing();
  return -2.0 * spacing * problem.lattice.cell_volume() * problem.kernel.slope(spacing) * std::sqrt(Dim);
}

/// The same of every site x within the support, at the wave vectors of the patch: D = −V Σ sin(k·x) W'(r) x/r. Of the
/// site n the component n_i is b_i·x/2π.
template <int Dim>
double direct_maximum(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  const auto& lattice = problem.lattice;
  const Vector<Dim> farthest =
      lattice.reciprocal_vectors().colwise().norm() * problem.kernel.support() / (2.0 * std::numbers::pi);
  const LatticeIndex<Dim> reach = farthest.array().ceil().template cast<int>();
  double largest = 0.0;
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), cells.array() - 1, [&](const LatticeIndex<Dim>& m) {
    const Vector<Dim> phases =
        2.0 * std::numbers::pi * (m.template cast<double>().array() / cells.template cast<double>().array());
    Vector<Dim> D = Vector<Dim>::Zero();
    for_each_index<Dim>(-reach, reach, [&](const LatticeIndex<Dim>& n) {
      const Vector<Dim> x = lattice.site(n);
      const double r = x.norm();
      if (n.isZero() || r >= problem.kernel.support() * (1.0 - tie_margin)) return;
      D -= std::sin(phases.dot(n.template cast<double>())) * problem.kernel.slope(r) / r * x;
    });
    largest = std::max(largest, D.norm());
  });
  return largest * lattice.cell_volume() * lattice.spacing();
}

template <int Dim>
HardCase courant_case(const Subject<Dim>& subject, std::string_view expected_from, double expected,
                      double theory_tolerance = rounding) {
  const auto& problem = subject.problem;
  const double unit = problem.lattice.spacing() / p_wave_speed(problem);
  const auto theory = theory_limit<Dim>(problem, PeriodicPatch<Dim>{subject.cells}).critical_time_step;
  const auto found = bisect(GrowthRun<Dim>(problem, periodic_patch<Dim>(problem, subject.cells), 1),
                            {.start = scan_start(problem, {problem.material})});
  return {.name = subject.name,
          .expected_from = expected_from,
          .expected = expected,
          .theory = theory.value_or(0.0) / unit,
          .theory_tolerance = theory_tolerance,
          .run = found.critical_time_step.value_or(0.0) / unit};
}

/// A case whose expected value is 2 over the direct sum.
template <int Dim>
MakeCase by_direct_sum(Subject<Dim> subject) {
  return [subject = std::move(subject)] {
    return courant_case(subject, direct_sum, 2.0 / direct_maximum(subject.problem, subject.cells));
  };
}

template <int Dim>
MakeCase by_nearest_shell(Subject<Dim> subject) {
  return [subject = std::move(subject)] {
    return courant_case(subject, nearest_shell, 2.0 / nearest_shell_maximum(subject.problem));
  };
}

// ν close to its ends: the Courant number of tl-linear does not depend on it.

template <int Dim>
void add_poisson_ratios(std::vector<MakeCase>& cases, Plane plane) {
  for (const double nu : {-0.9, 0.4999, 0.499999}) {
    auto problem = problem_of<Dim>(KernelFamily::cubic_spline, 1.3);
    problem.plane = plane;
    problem.material = Material::from_young_modulus(some_density, some_modulus, nu);
    cases.push_back(by_direct_sum<Dim>({fmt::format("ν = {}, {}D, plane {}", nu, Dim, name_of(plane)), problem,
                                        LatticeIndex<Dim>::Constant(Dim == 3 ? 4 : 8)}));
  }
}

// Supports that barely hold a neighbour, and such that hold hundreds.

/// W'(Δp) of the cubic spline when only (2 − q)³/4 is left, and by what a rounding of Δp/h can change it: 2 − q is the
/// small difference, and enters squared.
template <int Dim>
MakeCase barely_a_neighbour(double excess) {
  return [excess] {
    const Subject<Dim> subject{fmt::format("support {:g} above the spacing, {}D", excess, Dim),
                               problem_of<Dim>(KernelFamily::cubic_spline, 0.5 * (1.0 + excess)), four_cells<Dim>()};
    const long double h = subject.problem.kernel.smoothing_length(), spacing = subject.problem.lattice.spacing();
    const long double gap = 2.0L - spacing / h;
    constexpr double pi = std::numbers::pi;
    constexpr double alpha = Dim == 1 ? 2.0 / 3.0 : Dim == 2 ? 10.0 / (7.0 * pi) : 1.0 / pi;
    const auto slope = static_cast<double>(0.75L * gap * gap * alpha * std::pow(spacing / h, Dim + 1));
    const double roundings_of_q = 8.0 * std::numeric_limits<double>::epsilon() / static_cast<double>(gap);
    return courant_case(subject, nearest_shell, 1.0 / (slope * std::sqrt(Dim)), rounding + roundings_of_q);
  };
}

/// A smooth kernel does not feel the lattice: |D| = k exp(−k²h²/4), largest at k h = √2 or, on a patch, at its wave
/// vectors of the first zone. Images and cut are below exp(−27).
template <int Dim>
MakeCase gaussian_spectrum(double h_over_spacing, int cells_per_axis) {
  return [=] {
    const Subject<Dim> subject{fmt::format("Gaussian, h = {:g} Δp, {}D", h_over_spacing, Dim),
                               problem_of<Dim>(KernelFamily::gaussian, h_over_spacing, 6.0),
                               LatticeIndex<Dim>::Constant(cells_per_axis)};
    double largest = 0.0;
    const auto half = LatticeIndex<Dim>::Constant(cells_per_axis / 2);
    for_each_index<Dim>(-half, half, [&](const LatticeIndex<Dim>& m) {
      const double k = 2.0 * std::numbers::pi / cells_per_axis * m.template cast<double>().norm();
      largest = std::max(largest, k * std::exp(-0.25 * k * k * h_over_spacing * h_over_spacing));
    });
    constexpr double images_and_cut = 1e-10;
    return courant_case(subject, "Fourier transform of the kernel", 2.0 / largest, images_and_cut);
  };
}

// Neighbours on a knot of the spline, shells on the support.

/// The order at which (Δt_c(h+δ) + Δt_c(h−δ))/2 − Δt_c(h) vanishes at a knot: W' has a kink there at most in its second
/// derivative, so that the limit has a slope, the same from both sides.
template <int Dim>
MakeCase order_across_knot(KernelFamily kernel, double knot) {
  return [=] {
    const auto step = [&](double change) { return *bulk_step(problem_of<Dim>(kernel, (1.0 + change) / knot)); };
    const auto bend = [&](double change) { return std::abs(step(change) + step(-change) - 2.0 * step(0.0)); };
    constexpr double change = 1e-3;
    return HardCase{.name = fmt::format("{}, neighbours at q = {:g}, {}D: order across it", name_of(kernel), knot, Dim),
                    .expected_from = "W'' is continuous",
                    .expected = 2.0,
                    .theory = std::log2(bend(change) / bend(0.5 * change)),
                    .theory_tolerance = 0.05};
  };
}

// Lattices that have no name.

template <int Dim>
Problem<Dim> on_lattice(const Tensor<Dim>& primitive_in_spacings, double h_over_spacing) {
  auto problem = problem_of<Dim>(KernelFamily::cubic_spline, h_over_spacing);
  problem.lattice = Lattice<Dim>(primitive_in_spacings, some_spacing);
  return problem;
}

/// The columns (1, 0), (x, y).
Tensor<2> oblique(double x, double y) { return Tensor<2>{{1.0, x}, {0.0, y}}; }

/// Neighbours ± d only, and d·k = π/2 on the patch: D = −2 V W'(d) sin(k·d) d/|d|, as on a chain.
MakeCase chains_side_by_side(std::string name, const Tensor<2>& primitive, double h_over_spacing, double distance) {
  return [=] {
    const Subject<2> subject{name, on_lattice<2>(primitive, h_over_spacing), {4, 4}};
    const auto& problem = subject.problem;
    const double D = -2.0 * problem.lattice.cell_volume() * problem.kernel.slope(distance * some_spacing);
    return courant_case<2>(subject, "closed form of the chain", 2.0 / (D * some_spacing));
  };
}

/// Its cells are the same torus in both bases, as 8 (7, 1) − 7 · 8 (1, 0) = 8 (0, 1).
MakeCase skewed_square() {
  return [] {
    const LatticeIndex<2> cells(8, 8);
    const auto square = problem_of<2>(KernelFamily::cubic_spline, 1.3);
    return courant_case<2>({"square in the basis (1, 0), (7, 1)", on_lattice<2>(oblique(7.0, 1.0), 1.3), cells},
                           "the square lattice in its own basis", 2.0 / direct_maximum(square, cells));
  };
}

/// Neighbours ± a in the plane and ± c along the axis: D = −2 V (W'(a) sin k_x a, W'(a) sin k_y a, W'(c) sin k_z c).
MakeCase tetragonal(double c) {
  return [c] {
    const auto problem = on_lattice<3>(Vector<3>(1.0, 1.0, c).asDiagonal(), 0.65);
    const double plane = problem.kernel.slope(some_spacing), axis = problem.kernel.slope(c * some_spacing);
    const double D = 2.0 * problem.lattice.cell_volume() * std::hypot(plane, plane, axis);
    return courant_case<3>({fmt::format("tetragonal, 1 x 1 x {}", c), problem, four_cells<3>()},
                           "closed form of both shells", 2.0 / (D * some_spacing));
  };
}

// Units and densities far from one.

struct Units {
  std::string_view name;
  double young_modulus, density, spacing;
};
constexpr std::array<Units, 6> all_units{{{"steel, Δp = 1 nm", 2e11, 7850.0, 1e-9},
                                          {"steel, Δp = 1 km", 2e11, 7850.0, 1e3},
                                          {"density 1e-15", 2.9, 1e-15, 0.37},
                                          {"density 1e15", 2.9, 1e15, 0.37},
                                          {"E = 1e-30", 1e-30, 1.7, 0.37},
                                          {"E = 1e30", 1e30, 1.7, 0.37}}};

template <int Dim>
MakeCase in_units(const Units& units) {
  auto problem = problem_of<Dim>(KernelFamily::cubic_spline, 1.1);
  problem.lattice = Lattice<Dim>(axes_lattice<Dim>, units.spacing);
  problem.kernel = Kernel<Dim>(KernelFamily::cubic_spline, 1.1 * units.spacing);
  problem.material = Material::from_young_modulus(units.density, units.young_modulus, some_ratio);
  return by_direct_sum<Dim>(
      {fmt::format("{}, {}D", units.name, Dim), problem, LatticeIndex<Dim>::Constant(Dim == 3 ? 4 : 8)});
}

// Damping from negligible to what a mode bears.

/// Of a chain with ω_max = c_p/Δp (cubic spline, h = Δp: D Δp = sin kΔp), damped at x ω_max, a = cΔt. The eigenvalue
/// that leaves the circle does so at −1: leapfrog ω²Δt² + 2cΔt = 4; verlet ω²Δt²(1 − a/4) = 4 − 2a + a²/2 before a = 4,
/// if at all, and a = 4 else.
double damped_courant(Integrator integrator, double x) {
  const double leapfrog = 4.0 / (x + std::sqrt(x * x + 4.0));
  if (integrator == Integrator::leapfrog) return leapfrog;
  const auto excess = [x](double dt) {
    const double a = x * dt;
    return dt * dt * (1.0 - 0.25 * a) - (4.0 - 2.0 * a + 0.5 * a * a);
  };
  constexpr int parts = 1000;
  const double end = 4.0 / x;
  for (int i = 1; i <= parts; ++i)
    if (excess(end * i / parts) > 0.0) {
      std::uintmax_t iterations = 100;
      const auto root = boost::math::tools::toms748_solve(excess, end * (i - 1) / parts, end * i / parts,
                                                          boost::math::tools::eps_tolerance<double>(), iterations);
      return 0.5 * (root.first + root.second);
    }
  return end;
}

MakeCase damped_chain(Integrator integrator, double x) {
  return [=] {
    auto problem = problem_of<1>(KernelFamily::cubic_spline, 1.0);
    problem.integrator = integrator;
    problem.scheme.damping = Damping{x * p_wave_speed(problem) / problem.lattice.spacing()};
    return courant_case<1>({fmt::format("{}, damping {:g} ω_max", name_of(integrator), x), problem, four_cells<1>()},
                           "closed form of one damped mode", damped_courant(integrator, x));
  };
}

// Compression at the onset of its instability.

/// A cube compressed by e in every direction, of which SPH sees e (H = e/L, L of the nearest shell):
/// ρ0 ω_L²/|D|² = f [γ + 2G + 2κ (2G + dγ) e], ρ0 ω_T²/|D|² = f G, f = exp(2κ d e).
template <int Dim>
struct Compressed {
  Problem<Dim> problem;
  double onset;       ///< e
  double softening;   ///< ω_L² over c_p²|D|²
  double shear_part;  ///< ω_T² over c_p²|D|²
};

template <int Dim>
Compressed<Dim> compressed(Plane plane, double beyond_onset) {
  Compressed<Dim> result{problem_of<Dim>(KernelFamily::cubic_spline, 0.6), 0.0, 0.0, 0.0};
  auto& problem = result.problem;
  problem.plane = plane;
  problem.scheme.momentum_density = MomentumDensity::equation_of_state;
  const double G = problem.material.shear_modulus(), nu = some_ratio;
  const double gamma = 2.0 * G * nu / (plane == Plane::stress ? 1.0 - nu : 1.0 - 2.0 * nu);
  const double kappa = plane == Plane::stress ? (1.0 - 2.0 * nu) / (1.0 - nu) : 1.0, p_modulus = gamma + 2.0 * G;
  result.onset = -p_modulus / (2.0 * kappa * (2.0 * G + Dim * gamma));
  const double e = result.onset * (1.0 + beyond_onset), f = std::exp(2.0 * kappa * Dim * e);
  result.softening = -f * beyond_onset;
  result.shear_part = f * G / p_modulus;
  const double L = nearest_shell_maximum(problem) / std::sqrt(Dim);
  problem.displacement_gradient = e / L * Tensor<Dim>::Identity();
  return result;
}

template <int Dim>
std::string onset_name(Plane plane, double distance, std::string_view side) {
  return fmt::format("{:g} {} the onset, {}D, plane {}", distance, side, Dim, name_of(plane));
}

/// The longitudinal wave at the maximiser (π/2, π/2, …) of the nearest shell, the fastest of those that grow.
template <int Dim>
solver::Field<Dim> fastest_wave(const Body<Dim>& patch) {
  solver::Field<Dim> displacement;
  for (const auto& site : patch.site)
    displacement.push_back(Vector<Dim>::Constant(std::cos(0.5 * std::numbers::pi * (site.sum() + 0.5))));
  return displacement;
}

/// Below the onset the transverse waves, or in 1D what is left of the longitudinal ones, limit the step.
template <int Dim>
MakeCase before_onset(Plane plane, double short_of) {
  return [=] {
    const auto state = compressed<Dim>(plane, -short_of);
    const double largest = std::max(Dim == 1 ? 0.0 : state.shear_part, state.softening);
    const double roundings_of_e = rounding / (Dim == 1 ? short_of : 1.0);
    return courant_case<Dim>({onset_name<Dim>(plane, short_of, "short of"), state.problem, four_cells<Dim>()},
                             "closed form of the pre-stressed scheme",
                             2.0 / (nearest_shell_maximum(state.problem) * std::sqrt(largest)), roundings_of_e);
  };
}

/// Beyond it everything grows; the value is the growth rate times Δp/c_p.
template <int Dim>
MakeCase after_onset(Plane plane, double beyond, bool run) {
  return [=] {
    const auto state = compressed<Dim>(plane, beyond);
    const auto& problem = state.problem;
    const PeriodicPatch<Dim> patch{four_cells<Dim>()};
    const double unit = problem.lattice.spacing() / p_wave_speed(problem);
    HardCase result{.name = onset_name<Dim>(plane, beyond, "beyond") + ": growth rate",
                    .expected_from = "closed form of the pre-stressed scheme",
                    .expected = nearest_shell_maximum(problem) * std::sqrt(-state.softening),
                    .theory = theory_limit<Dim>(problem, patch).growth_rate.value_or(0.0) * unit,
                    .theory_tolerance = rounding / beyond};
    if (!run) return result;
    const auto body = periodic_patch<Dim>(problem, patch.cells);
    const double time_step = growth_per_step * unit / result.expected;
    const auto fit = GrowthRun<Dim>(problem, body, fastest_wave(body))(time_step, 400);
    // Leapfrog: e^g + e^−g − 2 = r²Δt².
    const double rate = 2.0 * std::sinh(0.5 * fit.growth_per_step) / time_step;
    result.run = fit.trend == solver::Trend::growing ? rate * unit : 0.0;
    result.run_tolerance = growth_tolerance;
    return result;
  };
}

template <int Dim>
void add_onset(std::vector<MakeCase>& cases, Plane plane) {
  cases.push_back(before_onset<Dim>(plane, 1e-3));
  cases.push_back(after_onset<Dim>(plane, 1e-9, false));
  cases.push_back(after_onset<Dim>(plane, 0.1, true));
}

std::vector<MakeCase> poisson_ratios() {
  std::vector<MakeCase> cases;
  add_poisson_ratios<2>(cases, Plane::strain);
  add_poisson_ratios<2>(cases, Plane::stress);
  add_poisson_ratios<3>(cases, Plane::strain);
  return cases;
}

std::vector<MakeCase> supports() {
  constexpr auto cubic = KernelFamily::cubic_spline;
  std::vector<MakeCase> cases;
  for (const double excess : {1e-6, 1e-3}) {
    cases.push_back(barely_a_neighbour<1>(excess));
    cases.push_back(barely_a_neighbour<2>(excess));
    cases.push_back(barely_a_neighbour<3>(excess));
  }
  for (const double h : {0.6, 0.7}) {
    cases.push_back(by_nearest_shell<2>({fmt::format("h = {} Δp, 2D", h), problem_of<2>(cubic, h), four_cells<2>()}));
    cases.push_back(by_nearest_shell<3>({fmt::format("h = {} Δp, 3D", h), problem_of<3>(cubic, h), four_cells<3>()}));
  }
  for (const double h : {3.0, 4.0})
    cases.push_back(by_direct_sum<2>({fmt::format("h = {:g} Δp, 2D", h), problem_of<2>(cubic, h), {8, 8}}));
  cases.push_back(by_direct_sum<3>({"h = 2 Δp, 3D", problem_of<3>(cubic, 2.0), {5, 4, 3}}));
  cases.push_back(gaussian_spectrum<1>(4.0, 36));
  cases.push_back(gaussian_spectrum<2>(2.0, 6));
  return cases;
}

std::vector<MakeCase> knots_and_shells() {
  std::vector<MakeCase> cases;
  // h = Δp: only q = 1 is left inside the support of the cubic spline, where V W' = −1/2: D Δp = sin kΔp.
  cases.push_back([] {
    return courant_case<1>({"cubic-spline, a shell on the support (q = 2), 1D",
                            problem_of<1>(KernelFamily::cubic_spline, 1.0), four_cells<1>()},
                           nearest_shell, 2.0);
  });
  cases.push_back(by_direct_sum<2>(
      {"cubic-spline, a shell on the support (q = 2), 2D", problem_of<2>(KernelFamily::cubic_spline, 1.0), {8, 8}}));
  cases.push_back(by_direct_sum<3>({"cubic-spline, a shell on the support (q = 2), 3D",
                                    problem_of<3>(KernelFamily::cubic_spline, 1.0), four_cells<3>()}));
  cases.push_back(by_direct_sum<1>(
      {"gaussian cut on a shell (q = 3), 1D", problem_of<1>(KernelFamily::gaussian, 1.0), LatticeIndex<1>(16)}));
  cases.push_back(order_across_knot<2>(KernelFamily::cubic_spline, 1.0));
  cases.push_back(order_across_knot<3>(KernelFamily::cubic_spline, 1.0));
  cases.push_back(order_across_knot<2>(KernelFamily::quartic_spline, 0.5));
  cases.push_back(order_across_knot<2>(KernelFamily::quartic_spline, 1.5));
  cases.push_back(order_across_knot<2>(KernelFamily::quintic_spline, 1.0));
  cases.push_back(order_across_knot<3>(KernelFamily::quintic_spline, 2.0));
  return cases;
}

std::vector<MakeCase> custom_lattices() {
  const auto rectangle = oblique(0.0, 3.0);
  const LatticeIndex<2> cells(8, 8);
  std::vector<MakeCase> cases;
  cases.push_back(by_direct_sum<2>({"rectangle 1 x 3, neighbours along both", on_lattice<2>(rectangle, 1.6), cells}));
  cases.push_back(chains_side_by_side("rectangle 1 x 3, neighbours along one", rectangle, 0.8, 1.0));
  cases.push_back(skewed_square());
  cases.push_back(tetragonal(1.2));
  cases.push_back(by_direct_sum<2>({"oblique (1, 0), (0.5, 0.02)", on_lattice<2>(oblique(0.5, 0.02), 0.3), cells}));
  // Its shortest vector is 10 (0.3, 1e-4) − 3 (1, 0) = (0, 1e-3).
  cases.push_back(chains_side_by_side("oblique (1, 0), (0.3, 1e-4)", oblique(0.3, 1e-4), 8e-4, 1e-3));
  return cases;
}

std::vector<MakeCase> units() {
  std::vector<MakeCase> cases;
  for (const Units& system : all_units) {
    cases.push_back(in_units<2>(system));
    cases.push_back(in_units<3>(system));
  }
  return cases;
}

std::vector<MakeCase> dampings() {
  std::vector<MakeCase> cases;
  for (const auto& [integrator, name] : total_lagrangian_integrators)
    for (const double rate : {1e-6, 0.1, 2.0, 10.0, 60.0}) cases.push_back(damped_chain(integrator, rate));
  return cases;
}

std::vector<MakeCase> onsets() {
  std::vector<MakeCase> cases;
  add_onset<1>(cases, Plane::strain);
  add_onset<2>(cases, Plane::strain);
  add_onset<2>(cases, Plane::stress);
  add_onset<3>(cases, Plane::strain);
  return cases;
}

std::vector<HardCaseGroup> all_groups() {
  std::vector<HardCaseGroup> groups{
      {"Poisson's ratio", poisson_ratios()},  {"support", supports()}, {"knots and shells", knots_and_shells()},
      {"custom lattices", custom_lattices()}, {"units", units()},      {"damping", dampings()},
      {"onset of compression", onsets()}};
  for (auto& group : updated_hard_cases()) groups.push_back(std::move(group));
  return groups;
}

/// Makes the cases of some groups on all cores.
std::vector<HardCase> make(const std::vector<HardCaseGroup>& groups, const Progress& progress) {
  std::vector<std::pair<std::string_view, const MakeCase*>> makers;
  for (const HardCaseGroup& group : groups)
    for (const MakeCase& make_case : group.cases) makers.emplace_back(group.name, &make_case);
  std::vector<HardCase> cases(makers.size());
  std::vector<std::function<void()>> work;
  for (std::size_t i = 0; i < makers.size(); ++i)
    work.push_back([&, i] {
      cases[i] = (*makers[i].second)();
      cases[i].group = makers[i].first;
    });
  run_all(work, progress);
  return cases;
}

/// Relative, but where the reference is 0.
double difference(double value, double reference) {
  return reference == 0.0 ? std::abs(value) : std::abs(value / reference - 1.0);
}

io::Table to_table(const std::vector<HardCase>& cases, std::string_view number, std::string_view difference) {
  const auto if_any = [](const std::optional<double>& value) { return value ? io::Document(*value) : io::Document(); };
  io::Document rows = io::Document::array();
  for (const HardCase& hard : cases)
    rows.push_back({{"group", hard.group},
                    {"case", hard.name},
                    {"from", hard.expected_from},
                    {"expected", hard.expected},
                    {"theory", hard.theory},
                    {"theory_difference", hard.theory_difference()},
                    {"run", if_any(hard.run)},
                    {"run_difference", if_any(hard.run_difference())},
                    {"verdict", hard.holds() ? "holds" : "FAILS"}});
  const std::string number_format(number), difference_format(difference);
  return io::select(rows, {{"group", "group"},
                           {"case", "case"},
                           {"from", "expected from"},
                           {"expected", "expected", number_format},
                           {"theory", "theory", number_format},
                           {"theory_difference", "theory to expected", difference_format},
                           {"run", "run", number_format},
                           {"run_difference", "run to theory", difference_format},
                           {"verdict", "verdict"}});
}

}  // namespace

double HardCase::theory_difference() const { return difference(theory, expected); }

std::optional<double> HardCase::run_difference() const {
  return run ? std::optional(difference(*run, theory)) : std::nullopt;
}

bool HardCase::holds() const {
  return theory_difference() <= theory_tolerance && (!run || *run_difference() <= run_tolerance);
}

std::vector<std::string_view> hard_case_groups() {
  std::vector<std::string_view> names;
  for (const HardCaseGroup& group : all_groups()) names.push_back(group.name);
  return names;
}

std::vector<HardCase> hard_cases(std::string_view group) {
  auto groups = all_groups();
  std::erase_if(groups, [group](const HardCaseGroup& other) { return other.name != group; });
  return make(groups, nullptr);
}

Report hard_cases_report(const Progress& progress) {
  const auto cases = make(all_groups(), progress);
  const auto runs =
      std::count_if(cases.begin(), cases.end(), [](const HardCase& hard) { return hard.run.has_value(); });
  Report report;
  for (const HardCase& hard : cases)
    if (!hard.holds()) report.failures.push_back(fmt::format("{}: {}", hard.group, hard.name));
  const auto table = to_table(cases, "{:.9g}", "{:.0e}");
  report.summary = fmt::format(
      "Cases that are easy to get wrong: what must come out by an argument that knows nothing of the theory's code, "
      "what\n"
      "the theory says, and what the running solver does. Values are critical Courant numbers Δt_c c_p/Δp of a "
      "periodic\n"
      "patch unless the case says otherwise; those of `ul` are in units of c0 and Δp.\n\n{}\n"
      "{} cases, {} of them run on the solver: {} do not hold.\n",
      io::to_markdown(table), cases.size(), runs, report.failures.size());
  report.files = {
      {"README.md", "# Hard cases\n\n" + report.summary +
                        "\nRegenerate with `sphstab report hard-cases --overwrite`; `table.csv` holds every "
                        "digit. What each group is about: [docs/hard-cases.md](../../docs/hard-cases.md).\n"},
      {"table.csv", io::to_csv(to_table(cases, "{}", "{:.3e}"))},
      {"table.md", io::to_markdown(table)}};
  return report;
}

}  // namespace sphstab::study
