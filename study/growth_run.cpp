// SPDX-License-Identifier: MIT
#include "study/growth_run.hpp"

#include <cmath>
#include <vector>

#include "model/uniform.hpp"

namespace sphstab::study {
namespace {

using solver::Field;
using solver::GrowthFit;
using solver::State;
using solver::Trend;

/// Size of the perturbation, √(strain energy / that of a strain of 1): a strain. Six digits above rounding even on
/// a base state of strain 1, so that noise of the arithmetic stays small beside it.
constexpr double seed_strain = 1e-10;
/// A linear scheme may grow until the modes have parted; a nonlinear one must stay below strains of 2e-5, where the
/// error of the growth is of that order.
constexpr double linear_e_foldings = 40.0;
constexpr double nonlinear_e_foldings = 12.0;
/// A displacement s of which SPH sees less strain than this times s/h consists of zero-energy modes.
constexpr double smallest_strain = 1e-12;
/// Noise beside the fastest mode of the run before.
constexpr double noise_beside_mode = 0.1;
/// Runs are judged for the first time at this part of the horizon, and again whenever they are twice as long; those
/// that grow at one rate by then end, undecided ones go on up to `longest_run` horizons.
constexpr int first_look = 8;
constexpr int longest_run = 4;
/// Relative difference of two slopes below which a growth is known well enough to find the root of the bisection.
constexpr double settled = 1e-4;
/// Strain energies taken in a horizon; each costs half a right-hand side.
constexpr long samples = 1000;

/// Uniform numbers in [−1, 1).
template <int Dim>
Field<Dim> noise(int particles, unsigned noise_seed) {
  std::mt19937_64 generator(noise_seed);
  Field<Dim> field(particles);
  for (auto& vector : field)
    for (int i = 0; i < Dim; ++i) vector[i] = uniform_number(generator);
  return field;
}

/// The fit of a run that overflowed before it could be judged: it grew at least as fast as its finite part.
GrowthFit explosion(const std::vector<double>& log_amplitude, int stride) {
  const double steps = stride * std::max(1.0, static_cast<double>(log_amplitude.size()) - 1.0);
  return {Trend::growing, (log_amplitude.back() - log_amplitude.front()) / steps, 0.0, 1.0, static_cast<long>(steps)};
}

/// Growth is that of a perturbation, which loads do not drive.
template <int Dim>
Body<Dim> without_loads(Body<Dim> body) {
  body.load.clear();
  return body;
}

/// Σ_a (λ + 2G)_a V_a, an energy: that of a strain of 1.
template <int Dim>
double energy_of_unit_strain(const Problem<Dim>& problem, const Body<Dim>& body) {
  double energy = 0.0;
  for (int a = 0; a < body.size(); ++a)
    energy += body.material_of(a).lame(problem.plane).p_wave_modulus() * body.volume[a];
  return energy;
}

template <int Dim>
void add_scaled(Field<Dim>& field, double factor, const Field<Dim>& other) {
  for (std::size_t a = 0; a < field.size(); ++a) field[a] += factor * other[a];
}

}  // namespace

template <int Dim>
GrowthRun<Dim>::GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, unsigned noise_seed)
    : GrowthRun(problem, body, noise<Dim>(body.size(), noise_seed)) {}

template <int Dim>
GrowthRun<Dim>::GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, const Field<Dim>& displacement)
    : GrowthRun(problem, without_loads(body), State<Dim>(body.size()).displacement, displacement) {}

template <int Dim>
GrowthRun<Dim>::GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, const Field<Dim>& equilibrium,
                          unsigned noise_seed)
    : GrowthRun(problem, body, equilibrium, noise<Dim>(body.size(), noise_seed)) {}

template <int Dim>
GrowthRun<Dim>::GrowthRun(const Problem<Dim>& problem, const Body<Dim>& body, const Field<Dim>& equilibrium,
                          const Field<Dim>& displacement)
    : simulation_(problem, body),
      energy_scale_(energy_of_unit_strain(problem, body)),
      largest_e_foldings_(problem.scheme.momentum_density == MomentumDensity::frozen ? linear_e_foldings
                                                                                     : nonlinear_e_foldings),
      equilibrium_(equilibrium),
      departure_(body.size()),
      seed_(body.size()) {
  seed_.displacement = displacement;
  simulation_.hold(seed_);
  double square = 0.0;
  for (const auto& s : seed_.displacement) square += s.squaredNorm() / static_cast<double>(body.size());
  if (!(amplitude(seed_) > smallest_strain * std::sqrt(square) / problem.kernel.smoothing_length()))
    throw InvalidInput("patch: no perturbation of it has a strain energy (zero-energy modes only); take a larger one");
  scale_to_seed(seed_);
}

template <int Dim>
const State<Dim>& GrowthRun<Dim>::departure(const State<Dim>& state) {
  departure_ = state;
  add_scaled<Dim>(departure_.displacement, -1.0, equilibrium_);
  return departure_;
}

template <int Dim>
double GrowthRun<Dim>::amplitude(const State<Dim>& departure) const {
  return std::sqrt(simulation_.strain_energy(departure) / energy_scale_);
}

template <int Dim>
void GrowthRun<Dim>::scale_to_seed(State<Dim>& departure) const {
  const double factor = seed_strain / amplitude(departure);
  for (auto& s : departure.displacement) s *= factor;
  for (auto& v : departure.velocity) v *= factor;
}

template <int Dim>
State<Dim> GrowthRun<Dim>::first_departure() const {
  if (!fastest_mode_) return seed_;
  State<Dim> first = *fastest_mode_;
  add_scaled<Dim>(first.displacement, noise_beside_mode, seed_.displacement);
  return first;
}

template <int Dim>
bool GrowthRun<Dim>::run(long end, double time_step, int stride, State<Dim>& state,
                         std::vector<double>& log_amplitude) {
  while (stride * static_cast<long>(log_amplitude.size() - 1) < end) {
    simulation_.advance(state, time_step, stride);
    const double next = std::log(amplitude(departure(state)));
    if (!std::isfinite(next)) return false;
    log_amplitude.push_back(next);
    if (next - log_amplitude.front() > largest_e_foldings_ && std::ssize(log_amplitude) > solver::fewest_amplitudes)
      return false;
  }
  return true;
}

template <int Dim>
GrowthFit GrowthRun<Dim>::operator()(double time_step, long horizon) {
  const int stride = static_cast<int>(std::max(1L, horizon / samples));
  State<Dim> state = first_departure();
  std::vector<double> log_amplitude{std::log(amplitude(state))};
  add_scaled<Dim>(state.displacement, 1.0, equilibrium_);
  GrowthFit fit{};
  for (long end = std::max(1L, horizon / first_look); end <= longest_run * horizon; end *= 2) {
    const bool goes_on = run(end, time_step, stride, state, log_amplitude);
    if (!goes_on && std::ssize(log_amplitude) <= solver::fewest_amplitudes) return explosion(log_amplitude, stride);
    if (goes_on && std::ssize(log_amplitude) <= solver::fewest_amplitudes) continue;
    fit = solver::judge_growth(log_amplitude, stride);
    if (!goes_on || (fit.trend == Trend::growing && fit.disagreement < settled)) break;
    if (end >= horizon && fit.trend != Trend::undecided) break;
  }
  if (fit.trend == Trend::growing) {
    fastest_mode_ = departure(state);
    scale_to_seed(*fastest_mode_);
  }
  return fit;
}

template class GrowthRun<1>;
template class GrowthRun<2>;
template class GrowthRun<3>;

}  // namespace sphstab::study
