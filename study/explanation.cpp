// SPDX-License-Identifier: MIT
#include "study/explanation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "study/json_values.hpp"
#include "study/p_wave_speed.hpp"

namespace sphstab::study {
namespace {

/// Factors on the smoothing length that a user would try.
constexpr std::array<double, 2> other_smoothing_lengths{0.8, 1.25};
/// Changes that are named, and the gain below which none is worth its name.
constexpr std::size_t changes_named = 2;
constexpr double least_gain = 0.005;
/// Relative error of the speed of long waves that a change may bring.
constexpr double tolerable_long_wave_error = 0.05;
/// Relative rounding of a limit.
constexpr double same_step = 1e-9;
/// Particles in the drawing of a wave.
constexpr int particles_drawn = 13;

std::string line(std::string_view subject, std::string_view text) { return fmt::format("{:<12}{}", subject, text); }

template <int Rows>
std::string list_of(const Vector<Rows>& vector) {
  return fmt::format("({:.5g})", fmt::join(vector.data(), vector.data() + Rows, ", "));
}

template <int Dim>
std::vector<LatticeNeighbour<Dim>> neighbours_of(const Problem<Dim>& problem) {
  return lattice_neighbours(problem.lattice, problem.kernel.support(), problem.neighbour_rule);
}

/// Displacements cos(φ j) of the particles j = 0, 1, … of a row as bars of seven heights.
std::string wave(double phase) {
  static constexpr std::array<std::string_view, 7> bars{"▁", "▂", "▃", "▄", "▅", "▆", "▇"};
  std::string text;
  for (int j = 0; j < particles_drawn; ++j)
    text += bars[static_cast<std::size_t>(std::lround(3.0 + 3.0 * std::cos(phase * j)))];
  return text;
}

template <int Dim>
std::string waves(const Problem<Dim>& problem, const Vector<Dim>& wave_vector) {
  std::string text;
  for (int i = 0; i < Dim; ++i)
    text += fmt::format("{}a{} {}", i == 0 ? "" : "   ", i + 1,
                        wave(wave_vector.dot(problem.lattice.primitive_vectors().col(i))));
  return text;
}

template <int Dim>
std::string worst_mode(const Problem<Dim>& problem, const analysis::CriticalMode<Dim>& mode) {
  const double wavelength = 2.0 * std::numbers::pi / mode.wave_vector.norm();
  return fmt::format("k = {}, {}, {:.4g} spacings long; the displacements of its wave from particle to particle:",
                     list_of<Dim>(mode.wave_vector), name_of(mode.branch), wavelength / problem.lattice.spacing());
}

/// |L − I| of the consistency of the gradient: the relative error of the speed of long waves.
template <int Dim>
double long_wave_error(const Problem<Dim>& problem) {
  if (is_finite_strain(problem.scheme.formulation)) return 0.0;  // renormalised
  const Tensor<Dim> excess = analysis::GradientSymbol<Dim>(problem).consistency() - Tensor<Dim>::Identity();
  return excess.cwiseAbs().maxCoeff();
}

/// One change of the case and the limit that it leads to.
struct Change {
  std::string what;
  double factor;  ///< new limit over old one
  std::size_t neighbours;
};

/// The case with one key changed. Nothing where that has no finite limit, or where long waves run wrong by more than is
/// allowed: a kernel that hardly feels its neighbours bears any step.
template <int Dim>
std::optional<Change> change(const Case& changed, const std::string& what, double limit, double allowed_error) {
  const auto other = make_problem<Dim>(changed);
  if (long_wave_error(other) > allowed_error) return std::nullopt;
  const auto found = analysis::bulk_limit(other);
  const auto* const stable = std::get_if<analysis::ConditionallyStable<Dim>>(&found);
  if (stable == nullptr) return std::nullopt;
  return Change{what, stable->critical_time_step / limit, neighbours_of(other).size()};
}

template <int Dim>
std::vector<Change> changes(const Case& input, const Problem<Dim>& problem, double limit) {
  const double allowed_error = std::max(long_wave_error(problem), tolerable_long_wave_error);
  std::vector<Change> found;
  const auto attempt = [&](std::string_view key, KeyValue value, const std::string& what) {
    Case changed = input;
    changed.set(key, std::move(value));
    try {
      if (auto one = change<Dim>(changed, what, limit, allowed_error)) found.push_back(*std::move(one));
    } catch (const InvalidInput&) {  // such as no neighbour within a shorter h: no change to recommend
    }
  };
  for (const auto& [family, name] : Names<KernelFamily>::table)
    if (family != problem.kernel.family()) attempt("kernel", std::string(name), fmt::format("kernel {}", name));
  const double spacing = problem.lattice.spacing(), h = problem.kernel.smoothing_length();
  for (const double factor : other_smoothing_lengths) {
    const std::string what = fmt::format("h = {:.4g} spacings", factor * h / spacing);
    if (input.has("h_over_spacing"))
      attempt("h_over_spacing", factor * h / spacing, what);
    else
      attempt("smoothing_length", factor * h, what);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.factor > b.factor; });
  return found;
}

template <int Dim>
std::string advice(const Case& input, const Problem<Dim>& problem, double limit) {
  std::vector<std::string> parts;
  for (const auto& one : changes(input, problem, limit))
    if (parts.size() < changes_named && one.factor > 1.0 + least_gain)
      parts.push_back(
          fmt::format("{} {:+.0f} % ({} neighbours)", one.what, 100.0 * (one.factor - 1.0), one.neighbours));
  if (parts.empty())
    parts.push_back(
        "no other kernel of the same h, nor h a quarter longer or a fifth shorter, does without spoiling long waves");
  if (!problem.scheme.damping) parts.push_back("a coarser spacing with the same h/spacing in proportion");
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// The integrator's rule for the worst mode, and the limit that follows.
template <int Dim>
std::vector<std::string> integrator_and_limit(const Problem<Dim>& problem, double omega, double step) {
  const auto name = name_of(problem.integrator);
  const double rate = problem.scheme.damping ? problem.scheme.damping->rate : 0.0;
  // Beyond it verlet multiplies every velocity by (1 − cΔt/2)² > 1.
  if (problem.integrator == Integrator::verlet && std::abs(rate * step - 4.0) < same_step)
    return {line("Integrator", fmt::format("{} bears no damping beyond rate x dt = 4, whatever the mode", name)),
            line("Limit", fmt::format("dt = 4 / {:g} = {:.8g}", rate, step))};
  const bool neutral = problem.integrator == Integrator::leapfrog || problem.integrator == Integrator::verlet;
  const std::string friction = problem.scheme.viscosity
                                   ? fmt::format(" with viscosity alpha = {:g}", problem.scheme.viscosity->alpha)
                               : rate != 0.0 ? fmt::format(" with the damping rate {:g}", rate)
                                             : "";
  const std::string rule =
      neutral && friction.empty()
          ? fmt::format("{} makes each mode a 2x2 map whose eigenvalues stay on the unit circle while omega dt <= 2",
                        name)
          : fmt::format("{}{}: an eigenvalue of the worst mode's map passes {} at omega dt = {:.6g}", name, friction,
                        problem.scheme.viscosity || !neutral ? "the unit circle" : "-1", omega * step);
  return {line("Integrator", rule), line("Limit", fmt::format("dt = {:.4g} / omega = {:.8g}", omega * step, step))};
}

/// Components of a symmetric tensor in the order of the keys.
template <int Dim>
std::string list_of_tensor(const Tensor<Dim>& tensor) {
  return list_of<symmetric_size<Dim>>(symmetric_components<Dim, double>(tensor));
}

template <int Dim>
std::string base_state(const Problem<Dim>& problem) {
  if (problem.pressure == 0.0 && problem.deviatoric_stress.isZero(0.0))
    return "no stress: stress alone resists a wave, through A(k), which takes the place of -k in the particle sums";
  const auto& artificial = problem.scheme.artificial_stress;
  return fmt::format("pressure {:g}, deviatoric stress {}, {}: stress makes forces of moved particles, through B(k)",
                     problem.pressure, list_of_tensor<Dim>(problem.deviatoric_stress),
                     artificial ? fmt::format("artificial stress of epsilon = {:g}", artificial->epsilon)
                                : std::string("no artificial stress"));
}

/// What stands between the neighbours and the worst mode.
template <int Dim>
std::string sums_line(const Problem<Dim>& problem) {
  const double error = 100.0 * long_wave_error(problem);
  if (problem.scheme.formulation == Formulation::updated_lagrangian)
    return line("State", fmt::format("{}; long waves are off by {:.2g} %", base_state(problem), error));
  const double maximum = analysis::BulkModes<Dim>(problem).symbol_maximum();
  return line("Symbol", fmt::format("the particle sums see D(k) in place of k: off by {:.2g} % for long waves, |D| <= "
                                    "{:.6g} = {:.4g} / spacing for all",
                                    error, maximum, maximum * problem.lattice.spacing()));
}

template <int Dim>
std::string scheme_line(const Problem<Dim>& problem) {
  const auto name = name_of(problem.scheme.formulation);
  if (problem.scheme.formulation == Formulation::updated_lagrangian)
    return line("Scheme", fmt::format("{}: a wave r exp(ik.x) of the particles about a uniform stress obeys "
                                      "d2r/dt2 = -M(k) r{}",
                                      name, problem.scheme.viscosity ? ", and viscosity damps it" : ""));
  if (is_finite_strain(problem.scheme.formulation))
    return line("Scheme",
                fmt::format("{}: a wave exp(ik.X) about x = F0 X obeys d2x/dt2 = -M(k) x, M that of the tangent "
                            "moduli at F0 with the renormalised symbol",
                            name));
  return line("Scheme", fmt::format("{}: a wave s exp(ik.x) of small displacements obeys d2s/dt2 = -M(k) s", name));
}

/// The lines on a mode that limits the step.
template <int Dim>
std::vector<std::string> limit_lines(const Case& input, const Problem<Dim>& problem,
                                     const analysis::ConditionallyStable<Dim>& stable) {
  const double step = stable.critical_time_step, omega = stable.mode.omega;
  const double time_unit = problem.lattice.spacing() / p_wave_speed(problem);
  const bool largest = !problem.scheme.viscosity;
  std::vector<std::string> lines{
      line("Frequency", fmt::format("omega = {:.6g}{}: {:.4g} times p-wave speed / spacing", omega,
                                    largest ? ", the largest of all modes" : "", omega * time_unit))};
  for (auto& one : integrator_and_limit(problem, omega, step)) lines.push_back(std::move(one));
  lines.back() += fmt::format("; Courant number dt c_p / spacing = {:.6g}", step / time_unit);
  lines.push_back(line("To raise it", advice(input, problem, step)));
  return lines;
}

/// Growth per step that nobody notices in a run of some thousand steps.
constexpr double quiet_growth = 1e-4;

/// What a neutral integrator would bear.
template <int Dim>
std::string neutral_integrators(Problem<Dim> problem) {
  problem.integrator = Integrator::leapfrog;
  const auto limit = analysis::bulk_limit(problem);
  const auto* const stable = std::get_if<analysis::ConditionallyStable<Dim>>(&limit);
  return fmt::format("leapfrog and verlet do not grow at all{}; viscosity_alpha > 0 damps the worst modes",
                     stable ? fmt::format(" up to dt = {:.6g}", stable->critical_time_step) : "");
}

template <int Dim>
std::vector<std::string> weak_lines(const Problem<Dim>& problem, const analysis::WeaklyUnstable<Dim>& weak) {
  const double quiet_step = std::pow(quiet_growth / weak.coefficient, 1.0 / weak.exponent);
  const auto error = weak.exponent == 2 ? "moves particles with an acceleration that XSPH does not smooth"
                                        : "predicts density and stress to first order only";
  return {
      line("Frequency", fmt::format("omega = {:.6g}; in continuous time nothing grows", weak.mode.omega)),
      line("Integrator", fmt::format("{} {}: the error of a step feeds the wave, whatever the step",
                                     name_of(problem.integrator), error)),
      line("Limit", fmt::format("none; a short step multiplies the worst mode by 1 + {:.4g} dt^{}: {:g} per step at "
                                "dt = {:.4g}, a factor e in {:.0f} steps",
                                weak.coefficient, weak.exponent, quiet_growth, quiet_step, 1.0 / quiet_growth)),
      line("To cure it", neutral_integrators(problem))};
}

template <int Dim>
std::vector<std::string> growth_lines(const Problem<Dim>& problem, const analysis::NeverStable<Dim>& unstable) {
  const bool updated = problem.scheme.formulation == Formulation::updated_lagrangian;
  return {
      line("Growth", fmt::format("{}the base state makes the mode grow by exp({:.6g} t) in continuous time",
                                 updated ? "" : fmt::format("omega^2 = -{:.6g}: ", std::pow(unstable.mode.omega, 2)),
                                 unstable.growth_rate)),
      line("Limit", fmt::format("no time step is stable; the base state has to change, not the step{}",
                                updated ? ". `sphstab growth` says which artificial stress removes the growth" : ""))};
}

template <int Dim>
std::vector<std::string> explain(const Case& input) {
  const auto problem = make_problem<Dim>(input);
  const auto neighbours = neighbours_of(problem);
  const double rho = problem.material.density(), h = problem.kernel.smoothing_length();
  std::vector<std::string> lines{
      scheme_line(problem),
      line("Material", fmt::format("density {:g}, p-wave speed {:.5g}, s-wave speed {:.5g}", rho, p_wave_speed(problem),
                                   std::sqrt(problem.material.shear_modulus() / rho))),
      line("Neighbours",
           fmt::format(
               "{} on the {} lattice, from {:.4g} to {:.4g} away; the {} with h = {:.4g} spacings ends at {:.4g}",
               neighbours.size(), name_of(problem.lattice.kind()), neighbours.front().distance,
               neighbours.back().distance, name_of(problem.kernel.family()), h / problem.lattice.spacing(),
               problem.kernel.support())),
      sums_line(problem)};
  const auto add = [&](const std::vector<std::string>& more) { lines.insert(lines.end(), more.begin(), more.end()); };
  const auto add_mode = [&](const analysis::CriticalMode<Dim>& mode) {
    add({line("Worst mode", worst_mode(problem, mode)), line("", waves(problem, mode.wave_vector))});
  };
  std::visit(Overloaded{[&](const analysis::ConditionallyStable<Dim>& stable) {
                          add_mode(stable.mode);
                          add(limit_lines(input, problem, stable));
                        },
                        [&](const analysis::UnconditionallyStable&) {
                          add({line("Limit", "no mode has a restoring force, so that no step is too long")});
                        },
                        [&](const analysis::NeverStable<Dim>& unstable) {
                          add_mode(unstable.mode);
                          add(growth_lines(problem, unstable));
                        },
                        [&](const analysis::WeaklyUnstable<Dim>& weak) {
                          add_mode(weak.mode);
                          add(weak_lines(problem, weak));
                        }},
             analysis::bulk_limit(problem));
  return lines;
}

}  // namespace

std::vector<std::string> explain_time_step(const Case& input) {
  return in_dimension(input, [&](auto dimension) { return explain<dimension()>(input); });
}

}  // namespace sphstab::study
