// SPDX-License-Identifier: MIT
// What the limits of the states that a body passes say of a large free vibration, and what they do not say.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>

#include "analysis/deformed_limit.hpp"
#include "ladder/finite_strain_cases.hpp"
#include "solver/total_lagrangian.hpp"
#include "study/bodies.hpp"

using namespace sphstab;

namespace {

/// A free plate of 6.4 × 6.4 that is thrown apart along one diagonal and together along the other; its slowest period
/// is about 20. Of size 1 it is strained by 0.2.
class Vibration {
 public:
  Vibration(const ladder::FiniteStrainScheme& scheme, Integrator integrator, double size) {
    problem_.scheme.formulation = scheme.formulation;
    problem_.scheme.elastic_law = scheme.law;
    problem_.integrator = integrator;
    body_ = free_plate<2>(problem_, {8, 8});
    simulation_ = solver::make_simulation(problem_, body_);
    state_ = solver::State<2>(body_.size());
    Tensor<2> velocity_gradient;
    velocity_gradient << 0.02, 0.15, 0.11, -0.03;
    const Vector<2> centre = 0.5 * body_.position.back();
    for (int a = 0; a < body_.size(); ++a) state_.velocity[a] = size * velocity_gradient * (body_.position[a] - centre);
  }

  /// Kinetic energy and W, which is the potential of tl-pk1 alone. Velocities of leapfrog belong half a step before
  /// their places.
  double energy(double time_step) {
    solver::State<2> centred = state_;
    if (problem_.integrator == Integrator::leapfrog) {
      solver::Field<2> force(body_.size());
      simulation_->accelerations(state_, force);
      for (int a = 0; a < body_.size(); ++a) centred.velocity[a] += 0.5 * time_step * force[a];
    }
    return simulation_->kinetic_energy(centred) + simulation_->strain_energy(centred);
  }

  /// The mean energy over so long, looked at every tenth step; infinite for a body that is torn: once it is tenfold.
  double mean_energy(double duration, double time_step) {
    const double start = energy(time_step);
    const long looks = std::lround(duration / time_step / 10.0);
    double sum = 0.0;
    for (long look = 0; look < looks; ++look) {
      simulation_->advance(state_, time_step, 10);
      const double now = energy(time_step);
      if (!(now < 10.0 * start)) return std::numeric_limits<double>::infinity();
      sum += now;
    }
    return sum / static_cast<double>(looks);
  }

  struct Limits {
    double rest;
    double least;
    double largest;
  };

  /// The critical steps of the states of this motion, followed with small steps.
  Limits limits() {
    analysis::DeformedBodyOperator<2> op(problem_, body_);
    const double rest = *analysis::deformed_limit(op).critical_time_step;
    double least = rest, largest = rest;
    for (int look = 0; look < 60; ++look) {
      simulation_->advance(state_, 0.2 * rest, 5);
      op.set_state(analysis::components_of<2>(state_.displacement));
      const double limit = *analysis::deformed_limit(op).critical_time_step;
      least = std::min(least, limit);
      largest = std::max(largest, limit);
    }
    return {rest, least, largest};
  }

 private:
  Problem<2> problem_ = study::test::plain_problem();
  Body<2> body_;
  std::unique_ptr<solver::TotalLagrangian<2>> simulation_;
  solver::State<2> state_{0};
};

constexpr auto corotated = ladder::finite_strain_schemes[0], saint_venant_kirchhoff = ladder::finite_strain_schemes[1],
               neo_hookean = ladder::finite_strain_schemes[2];

}  // namespace

TEST_CASE(
    "tl-pk1 keeps the energy of a large free vibration for a hundred periods at half of the least limit it passes",
    "[ladder]") {
  // What the steps keep differs from the energy by (ωΔt)²/8 of what a mode holds: (ωΔt)² is 1 for the fastest, and
  // hardly above 0.04 where energy goes.
  constexpr double kept = 0.04 / 8.0;
  for (const auto& scheme : {saint_venant_kirchhoff, neo_hookean})
    for (const auto& [integrator, name] : total_lagrangian_integrators) {
      INFO(name_of(scheme.law) << ", " << name);
      const double time_step = 0.5 * Vibration(scheme, integrator, 1.0).limits().least;
      Vibration run(scheme, integrator, 1.0);
      const double early = run.mean_energy(200.0, time_step);
      CHECK(run.mean_energy(1600.0, time_step) == Approx(early).epsilon(kept));
      CHECK(run.mean_energy(200.0, time_step) == Approx(early).epsilon(kept));
    }
}

TEST_CASE("a hundredth above the largest limit that it passes a vibration is torn within a hundred steps", "[ladder]") {
  for (const auto& scheme : ladder::finite_strain_schemes)
    for (const auto& [integrator, name] : total_lagrangian_integrators) {
      INFO(name_of(scheme.formulation) << ", " << name_of(scheme.law) << ", " << name);
      const auto limits = Vibration(scheme, integrator, 1.0).limits();
      CHECK(limits.least < 0.95 * limits.rest);
      CHECK(limits.largest > 1.01 * limits.rest);
      const double time_step = 1.01 * limits.largest;
      CHECK(std::isinf(Vibration(scheme, integrator, 1.0).mean_energy(100.0 * time_step, time_step)));
    }
}

TEST_CASE("where the fastest mode turns once in three steps a vibration of 4 % is torn, well below the limit",
          "[ladder]") {
  // λ³ = 1 at ωΔt = √3: forces of second order in that mode then push it alike at every third step.
  const double resonance = 0.5 * std::sqrt(3.0);
  for (const auto& [integrator, name] : total_lagrangian_integrators) {
    INFO(name);
    const double rest = Vibration(saint_venant_kirchhoff, integrator, 0.2).limits().rest;
    const auto is_torn = [rest, which = integrator](double fraction) {
      return std::isinf(Vibration(saint_venant_kirchhoff, which, 0.2).mean_energy(2000.0, fraction * rest));
    };
    CHECK_FALSE(is_torn(resonance - 0.03));
    CHECK(is_torn(resonance));
    CHECK_FALSE(is_torn(resonance + 0.03));
  }
}

TEST_CASE("R S, which has no potential, drives a large vibration however short the steps are, and F S does not",
          "[ladder]") {
  for (const double time_step : {0.04, 0.16}) {
    INFO("step " << time_step);
    const auto gain = [&](const ladder::FiniteStrainScheme& scheme) {
      Vibration run(scheme, Integrator::verlet, 1.0);
      const double start = run.energy(time_step);
      run.mean_energy(300.0, time_step);
      return run.mean_energy(300.0, time_step) / start;
    };
    CHECK(gain(corotated) > 1.5);
    CHECK(gain(saint_venant_kirchhoff) == Approx(1.0).epsilon(1e-3));
  }
}
