// SPDX-License-Identifier: MIT
// Zero-energy modes in the running solver: nothing resists them, so they drift, and they do no more than that.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/critical_step.hpp"
#include "analysis/gradient_symbol.hpp"
#include "ladder/cases.hpp"
#include "model/lattice_index.hpp"
#include "solver/bloch.hpp"
#include "solver/growth.hpp"
#include "solver/simulation.hpp"

using namespace sphstab;
using solver::Field;
using solver::State;

namespace {

/// Steps of a drift; at 0.9 of the limit ω_max t is then 180.
constexpr long drift_steps = 100;
/// Rounding of the forces, ε ω_max² |s| on average, integrated twice: ε (ω_max t)² / 6 of the displacement.
constexpr double drift_tolerance = 2e-12;
/// Rounding of a strain, in units of |s| / h.
constexpr double strain_rounding = 1e-14;

/// The wave vectors, in units of the reciprocal vectors, at which the symmetry of a lattice alone makes D vanish: where
/// k and −k are one, and where no direction is left alone by the operations that keep k (K of the hexagonal lattice, P
/// of bcc, W of fcc).
template <int Dim>
std::vector<Vector<Dim>> symmetric_points(LatticeKind lattice) {
  std::vector<Vector<Dim>> points;
  for_each_index<Dim>(LatticeIndex<Dim>::Zero(), LatticeIndex<Dim>::Ones(), [&](const LatticeIndex<Dim>& n) {
    if (!n.isZero()) points.push_back(0.5 * n.template cast<double>());
  });
  if constexpr (Dim == 2)
    if (lattice == LatticeKind::hexagonal)
      for (const double third : {1.0 / 3.0, 2.0 / 3.0}) points.emplace_back(third, 1.0 - third);
  if constexpr (Dim == 3) {
    if (lattice == LatticeKind::bcc)
      for (const double quarter : {0.25, 0.75}) points.push_back(Vector<3>::Constant(quarter));
    if (lattice == LatticeKind::fcc)
      for (const int first : {0, 1, 2})
        for (const int second : {1, 2}) {
          points.push_back(Vector<3>::Constant(0.5));
          points.back()[first] = 0.25;
          points.back()[(first + second) % 3] = 0.75;
        }
  }
  return points;
}

/// Four cells an axis admit halves and quarters, six of the hexagonal lattice halves and thirds.
template <int Dim>
LatticeIndex<Dim> patch_of_symmetric_points(LatticeKind lattice) {
  return LatticeIndex<Dim>::Constant(lattice == LatticeKind::hexagonal ? 6 : 4);
}

template <int Dim>
double time_step_below_limit(const Problem<Dim>& problem) {
  return 0.9 * std::get<analysis::ConditionallyStable<Dim>>(analysis::BulkModes(problem).limit()).critical_time_step;
}

/// v̂ cos(k·x + an angle at which no sublattice is at rest).
template <int Dim>
Field<Dim> velocity_of_mode(const Body<Dim>& patch, const Vector<Dim>& k) {
  const Vector<Dim> direction = Vector<3>(0.6, -0.9, 0.4).head<Dim>();
  Field<Dim> velocity;
  for (const auto& x : patch.position) velocity.push_back(std::cos(k.dot(x) + 0.7) * direction);
  return velocity;
}

/// √(strain energy / (p-wave modulus · volume)): a strain.
template <int Dim>
double strain_norm(const Problem<Dim>& problem, const solver::Simulation<Dim>& simulation, const State<Dim>& state) {
  const double volume = problem.lattice.cell_volume() * simulation.particles();
  return std::sqrt(simulation.strain_energy(state) / (problem.material.lame(problem.plane).p_wave_modulus() * volume));
}

/// The scheme without pre-stress, and in a tension that its equation of state feels.
template <int Dim>
std::vector<Problem<Dim>> unstressed_and_in_tension(LatticeKind lattice) {
  std::vector<Problem<Dim>> problems(2, ladder::basic_problem<Dim>(lattice, KernelFamily::cubic_spline, 1.27));
  problems[1].scheme.momentum_density = MomentumDensity::equation_of_state;
  problems[1].displacement_gradient = 0.1 * Tensor<Dim>::Identity();
  return problems;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("zero-energy modes drift linearly in the running solver, without strain energy", "[ladder]",
                       ((int Dim), Dim), 1, 2, 3) {
  for (const LatticeKind lattice : lattices_of(Dim))
    for (auto problem : unstressed_and_in_tension<Dim>(lattice))
      for (const auto& [integrator, integrator_name] : total_lagrangian_integrators) {
        problem.integrator = integrator;
        const auto patch = periodic_patch<Dim>(problem, patch_of_symmetric_points<Dim>(lattice));
        solver::Simulation<Dim> simulation(problem, patch);
        const double time_step = time_step_below_limit(problem), time = drift_steps * time_step;
        for (const auto& fractions : symmetric_points<Dim>(lattice)) {
          INFO(name_of(lattice) << " " << integrator_name << " k = " << fractions.transpose());
          State<Dim> state(patch.size());
          state.velocity = velocity_of_mode<Dim>(patch, problem.lattice.reciprocal_vectors() * fractions);
          const auto velocity = state.velocity;
          simulation.advance(state, time_step, drift_steps);
          double worst = 0.0, size = 0.0;
          for (int a = 0; a < patch.size(); ++a) {
            worst = std::max(worst, (state.displacement[a] - time * velocity[a]).norm());
            size = std::max(size, time * velocity[a].norm());
          }
          CHECK(worst < drift_tolerance * size);
          CHECK(strain_norm(problem, simulation, state) < strain_rounding * size / problem.kernel.smoothing_length());
        }
      }
}

TEMPLATE_TEST_CASE_SIG("a drift that dwarfs the noise beside it is no growth", "[ladder]", ((int Dim), Dim), 1, 2, 3) {
  constexpr int steps = 1200;
  constexpr double noise = 1e-9, drift_of_a_step = 1e-6;  // in spacings
  for (const LatticeKind lattice : lattices_of(Dim))
    for (const auto& problem : unstressed_and_in_tension<Dim>(lattice)) {
      INFO(name_of(lattice));
      const auto patch = periodic_patch<Dim>(problem, patch_of_symmetric_points<Dim>(lattice));
      solver::Simulation<Dim> simulation(problem, patch);
      const double time_step = time_step_below_limit(problem), spacing = problem.lattice.spacing();
      State<Dim> state(patch.size());
      const Vector<Dim> k = problem.lattice.reciprocal_vectors() * symmetric_points<Dim>(lattice).back();
      state.velocity = velocity_of_mode<Dim>(patch, k);
      for (auto& v : state.velocity) v *= drift_of_a_step * spacing / time_step;
      for (int a = 0; a < patch.size(); ++a)
        state.displacement[a] =
            noise * spacing * Vector<3>(std::sin(3 * a), std::cos(5 * a), std::sin(7 * a)).head<Dim>();
      std::vector<double> log_strain;
      for (int n = 0; n <= steps; ++n) {
        log_strain.push_back(std::log(strain_norm(problem, simulation, state)));
        simulation.advance(state, time_step);
      }
      CHECK(solver::judge_growth(log_strain).trend == solver::Trend::bounded);
      CHECK(state.displacement[0].norm() > 1e4 * noise * spacing);
    }
}

TEST_CASE("near an incommensurate zero of the staggered lattice the solver's frequencies vanish like the symbol",
          "[ladder]") {
  // No patch admits the zero itself. On patches of n × n cells the nearest wave vector is δ = O(1/n) away; there
  // |D| = |J δ| (1 + O(δ)), J the slope of D at the zero.
  for (const double h_over_spacing : {1.0, 1.5}) {
    const auto problem = ladder::basic_problem<2>(LatticeKind::staggered, KernelFamily::cubic_spline, h_over_spacing);
    const analysis::GradientSymbol<2> symbol(problem);
    Vector<2> turns = Vector<2>::Zero();
    for (const auto& k : analysis::zero_energy_modes(problem).wave_vectors) {
      const Vector<2> t = symbol.phases(k) / (2.0 * std::numbers::pi);
      if ((2.0 * t - Vector<2>((2.0 * t).array().round())).norm() > 0.1) turns = t;
    }
    REQUIRE(turns.norm() > 0.1);
    const Tensor<2> J = symbol.series().jet(2.0 * std::numbers::pi * turns).jacobian;
    const LameConstants lame = problem.material.lame(problem.plane);
    for (const int n : {13, 28, 56}) {
      INFO("h/spacing " << h_over_spacing << ", " << n << " × " << n << " cells");
      const Vector<2> admitted = (n * turns).array().round() / n;
      const Vector<2> delta = 2.0 * std::numbers::pi * (admitted - turns);
      const auto patch = periodic_patch<2>(problem, {n, n});
      const Tensor<2> M =
          -solver::bloch_acceleration_matrix<2>(problem, patch, problem.lattice.reciprocal_vectors() * admitted).real();
      const Vector<2> omega_squared = M.selfadjointView<Eigen::Lower>().eigenvalues();
      const double D = (J * delta).norm() / std::sqrt(problem.material.density());
      const double next_order = 3.0 * delta.norm();  // |∂²D| / |∂D| is about 3 in phases of so few neighbours
      CHECK(std::sqrt(omega_squared[0]) == Approx(std::sqrt(lame.shear_modulus) * D).epsilon(next_order));
      CHECK(std::sqrt(omega_squared[1]) == Approx(std::sqrt(lame.p_wave_modulus()) * D).epsilon(next_order));
    }
  }
}
