// SPDX-License-Identifier: MIT
#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <numbers>

#include "solver/updated_cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Two evaluations of sums of at most 60 terms, each with some ten roundings of 1.1e-16.
constexpr double rounding = 1e-13;

/// One step as interface.md words it, with the rates of PaperEquations. F0 and D0 of the predictor-corrector are given.
UpdatedState<2> step_of_the_interface(const PaperEquations<2>& paper, Integrator integrator, double dt,
                                      UpdatedState<2> s, const UpdatedRates<2>& first) {
  const auto add = [](auto& to, double factor, const auto& field) {
    for (std::size_t a = 0; a < to.size(); ++a) to[a] += factor * field[a];
  };
  const auto drift = [&] {
    const auto rates = paper.rates(s);
    add(s.position, dt, paper.smoothed(s));
    add(s.density, dt, rates.density);
    add(s.deviatoric_stress, dt, rates.deviatoric_stress);
  };
  switch (integrator) {
    case Integrator::leapfrog:
      add(s.velocity, dt, paper.accelerations(s));
      drift();
      return s;
    case Integrator::verlet:
      add(s.velocity, 0.5 * dt, paper.accelerations(s));
      drift();
      add(s.velocity, 0.5 * dt, paper.accelerations(s));
      return s;
    case Integrator::predictor_corrector:
    case Integrator::predictor_corrector_pec:
      add(s.position, dt, paper.smoothed(s));
      add(s.position, 0.5 * dt * dt, first.acceleration);
      add(s.velocity, dt, first.acceleration);
      add(s.density, dt, first.density);
      add(s.deviatoric_stress, dt, first.deviatoric_stress);
      const auto rates = paper.rates(s);
      s.stored = rates;
      for (const auto& [factor, of] : {std::pair(0.5 * dt, &rates), std::pair(-0.5 * dt, &first)}) {
        add(s.velocity, factor, of->acceleration);
        add(s.density, factor, of->density);
        add(s.deviatoric_stress, factor, of->deviatoric_stress);
      }
      return s;
  }
  return s;
}

double relative_difference_of_states(const UpdatedState<2>& found, const UpdatedState<2>& expected) {
  return std::max({relative_difference(found.position, expected.position),
                   relative_difference(found.velocity, expected.velocity),
                   relative_difference(found.density, expected.density),
                   relative_difference(found.deviatoric_stress, expected.deviatoric_stress)});
}

constexpr int line = 16;

/// sin kx of the particles of the chain for a number of waves along it.
Eigen::VectorXd sine(int waves) {
  return (2.0 * std::numbers::pi * waves / line * Eigen::ArrayXd::LinSpaced(line, 0, line - 1)).sin();
}

/// A chain that starts as the standing wave v = amplitude · sin kx; a dual amplitude of 0 + ε makes it infinitesimal.
template <class Scalar>
struct StandingWave {
  explicit StandingWave(const Problem<1>& problem) : simulation(problem, LatticeIndex<1>(line)) {}

  UpdatedState<1, Scalar> initial(const Scalar& amplitude, int waves = 1) const {
    auto state = simulation.base_state();
    for (int a = 0; a < line; ++a) state.velocity[a][0] = amplitude * sine(waves)[a];
    return state;
  }

  UpdatedSimulation<1, Scalar> simulation;
};

/// The derivative of a state, or the state itself, as a vector.
Eigen::VectorXd numbers_of(const UpdatedState<1, Dual>& state) {
  return flat_state(state).unaryExpr([](const Dual& x) { return x.derivative; });
}
Eigen::VectorXd numbers_of(const UpdatedState<1>& state) { return flat_state(state); }

/// What a run on the chain is like.
struct Choice {
  Integrator integrator;
  double pressure = 0.0;
  bool xsph = false, viscosity = false;
  int waves = 1;

  Problem<1> problem() const {
    Problem<1> problem = updated_problem<1>();
    problem.integrator = integrator;
    problem.pressure = pressure;
    if (xsph) problem.scheme.xsph = Xsph{0.5};
    if (viscosity) problem.scheme.viscosity = Viscosity{0.5, 0.1};
    return problem;
  }
};

enum class Velocity { of_the_state, of_the_half_step };

/// log2 of the ratio of differences between runs with Δt, Δt/2 and Δt/4 to one time. Velocities of the half step start
/// half a kick back and are brought forward by it at the end.
template <class Scalar>
double observed_order(const Choice& choice, const Scalar& amplitude, Velocity velocity = Velocity::of_the_state) {
  const auto end = [&](int steps) {
    StandingWave<Scalar> wave(choice.problem());
    auto state = wave.initial(amplitude, choice.waves);
    const double dt = 4.0 / steps;
    const auto shift_velocity = [&](double by) {
      if (velocity == Velocity::of_the_state) return;
      Field<1, Scalar> F(line);
      wave.simulation.place(state.position);
      wave.simulation.forces(state, F);
      for (int a = 0; a < line; ++a) state.velocity[a] += Scalar(by) * F[a];
    };
    shift_velocity(-0.5 * dt);
    REQUIRE(!wave.simulation.advance(state, dt, steps));
    shift_velocity(0.5 * dt);
    state.stored = UpdatedRates<1, Scalar>(0);
    return numbers_of(state);
  };
  const Eigen::VectorXd coarse = end(400), middle = end(800), fine = end(1600);
  return std::log2((coarse - middle).norm() / (middle - fine).norm());
}

/// What the next terms of the error, ωΔt < 0.02 of the leading one, leave of an order.
constexpr double order_margin = 0.03;

/// An infinitesimal motion.
const Dual small(0.0, 1.0);

/// The amplitudes of a wave obey A_{n+2} = 2|λ| cos(phase) A_{n+1} − |λ|² A_n, once what stored rates add has died out:
/// |λ| − 1 and the phase a step, fitted to 200 steps.
std::pair<double, double> growth_and_phase(const Choice& choice, double dt) {
  StandingWave<Dual> wave(choice.problem());
  auto state = wave.initial(small);
  wave.simulation.advance(state, dt, 50);
  Eigen::VectorXd amplitude(200);
  for (double& A : amplitude) {
    A = 0.0;
    for (int a = 0; a < line; ++a) A += sine(1)[a] * state.velocity[a][0].derivative;
    wave.simulation.advance(state, dt);
  }
  Eigen::MatrixX2d before(198, 2);
  before << amplitude.segment(1, 198), amplitude.head(198);
  const Eigen::Vector2d recurrence = before.colPivHouseholderQr().solve(amplitude.tail(198));
  const double modulus = std::sqrt(-recurrence[1]);
  return {modulus - 1.0, std::acos(recurrence[0] / (2.0 * modulus))};
}

/// Of |λ| from amplitudes with errors of 1e-15, amplified by 1/phase² = 200 at most, as A_{n+2} − 2A_{n+1} + A_n.
constexpr double fit_error = 1e-12;

}  // namespace

TEST_CASE("ul: a step is what the interface says, term by term", "[fast]") {
  for (const auto integrator : updated_integrators) {
    Problem<2> problem = with_all_terms(updated_problem<2>());
    problem.integrator = integrator;
    UpdatedSimulation<2> simulation(problem, free_plate(problem, LatticeIndex<2>(5, 5)));
    const PaperEquations<2> paper(problem, masses(simulation));
    auto state = disturbed(simulation.base_state(), 0.05, 9);
    auto first = paper.rates(state);
    for (int step = 0; step < 3; ++step) {
      INFO(name_of(integrator) << ", step " << step);
      if (integrator == Integrator::predictor_corrector) first = paper.rates(state);
      const auto expected = step_of_the_interface(paper, integrator, 0.05, state, first);
      REQUIRE(!simulation.advance(state, 0.05));
      CHECK(relative_difference_of_states(state, expected) < rounding);
      first = expected.stored;
    }
  }
}

TEST_CASE("ul: many steps are single steps, bit by bit, and a step is a pure function of its state", "[fast]") {
  for (const auto integrator : updated_integrators)
    for (const bool viscous : {false, true}) {
      Problem<2> problem = with_all_terms(updated_problem<2>());
      problem.integrator = integrator;
      if (!viscous) problem.scheme.viscosity.reset();
      UpdatedSimulation<2> simulation(problem, LatticeIndex<2>(7, 7));
      auto together = disturbed(simulation.base_state(), 0.02, 10), one_by_one = together;
      simulation.advance(together, 0.05, 7);
      UpdatedSimulation<2> other(problem, LatticeIndex<2>(7, 7));
      for (int n = 0; n < 7; ++n) {
        UpdatedSimulation<2>(problem, LatticeIndex<2>(7, 7)).advance(one_by_one, 0.05);
        auto elsewhere = one_by_one;
        other.advance(elsewhere, 0.05);  // leaves no trace in the simulation but its list of neighbours
      }
      CHECK(flat_state(together) == flat_state(one_by_one));
    }
}

TEST_CASE("ul: each integrator evaluates forces, rates and places as often as it must", "[fast]") {
  struct Expected {
    Integrator integrator;
    bool viscous;
    long placements, forces, rates;
  };
  const int n = 10;
  for (const auto& expected :
       {Expected{Integrator::leapfrog, true, n, n, n}, Expected{Integrator::verlet, false, n + 1, n + 1, n},
        Expected{Integrator::verlet, true, n + 1, 2 * n, n},
        Expected{Integrator::predictor_corrector, true, n + 1, 2 * n, 2 * n},
        // one more of each to know the rates it starts from
        Expected{Integrator::predictor_corrector_pec, true, n + 2, n + 1, n + 1}}) {
    INFO(name_of(expected.integrator));
    StandingWave<double> wave(Choice{expected.integrator, 0.1, true, expected.viscous}.problem());
    auto state = wave.initial(1e-3);
    wave.simulation.advance(state, 0.01, n);
    CHECK(wave.simulation.work().placements == expected.placements);
    CHECK(wave.simulation.work().forces == expected.forces);
    CHECK(wave.simulation.work().rates == expected.rates);
  }
}

TEST_CASE(
    "ul: small motions without viscosity are integrated to second order, by leapfrog with velocities of half steps",
    "[fast]") {
  for (const double pressure : {0.1, 0.0, -0.1}) {
    INFO("pressure " << pressure);
    const auto order = [&](Integrator integrator, bool xsph, Velocity velocity = Velocity::of_the_state) {
      return observed_order(Choice{integrator, pressure, xsph}, small, velocity);
    };
    for (const bool xsph : {false, true}) {
      CHECK(std::abs(order(Integrator::leapfrog, xsph, Velocity::of_the_half_step) - 2.0) < order_margin);
      CHECK(std::abs(order(Integrator::leapfrog, xsph) - 1.0) < order_margin);
      CHECK(std::abs(order(Integrator::verlet, xsph) - 2.0) < order_margin);
    }
    CHECK(std::abs(order(Integrator::predictor_corrector, false) - 2.0) < order_margin);
    CHECK(std::abs(order(Integrator::predictor_corrector_pec, false) - 2.0) < order_margin);
  }
}

TEST_CASE("ul: XSPH leaves the predictor-correctors first order, because their drift adds forces that are not smoothed",
          "[fast]") {
  for (const auto integrator : {Integrator::predictor_corrector, Integrator::predictor_corrector_pec})
    CHECK(std::abs(observed_order(Choice{integrator, 0.1, true, false, line / 4}, small) - 1.0) < 3.0 * order_margin);
}

TEST_CASE("ul: with viscosity the predictor-correctors stay second order, and Verlet's half kicks become first order",
          "[fast]") {
  CHECK(std::abs(observed_order(Choice{Integrator::verlet, 0.1, false, true}, small) - 1.0) < order_margin);
  for (const auto integrator : {Integrator::predictor_corrector, Integrator::predictor_corrector_pec})
    CHECK(std::abs(observed_order(Choice{integrator, 0.1, false, true}, small) - 2.0) < order_margin);
}

TEST_CASE("ul: finite motions are integrated to second order by the predictor-correctors alone", "[fast]") {
  const double finite = 0.2;
  for (const auto integrator : {Integrator::predictor_corrector, Integrator::predictor_corrector_pec})
    CHECK(std::abs(observed_order(Choice{integrator, 0.1}, finite) - 2.0) < order_margin);
  // Leapfrog and Verlet take the gradients and densities of their drifts from its beginning.
  CHECK(std::abs(observed_order(Choice{Integrator::verlet, 0.1}, finite) - 1.0) < order_margin);
  CHECK(std::abs(observed_order(Choice{Integrator::leapfrog, 0.1}, finite, Velocity::of_the_half_step) - 1.0) <
        order_margin);
}

TEST_CASE("ul: Verlet retraces small motions when velocities are reversed, and finite ones not", "[fast]") {
  const auto distance_from_start = [](const auto& amplitude) {
    using Scalar = std::decay_t<decltype(amplitude)>;
    StandingWave<Scalar> wave(Choice{Integrator::verlet, 0.1, true}.problem());
    const auto initial = wave.initial(amplitude);
    auto state = initial;
    for (int way = 0; way < 2; ++way) {
      wave.simulation.advance(state, 0.1, 50);
      for (auto& v : state.velocity) v = -v;
    }
    return (numbers_of(state) - numbers_of(initial)).norm();
  };
  CHECK(distance_from_start(small) < rounding * 100);
  CHECK(distance_from_start(0.2) > 1e-3);
}

TEST_CASE("ul: at zero stress the predictor-corrector grows by (wdt)^4/8 a step, and twice that with stored rates",
          "[fast]") {
  for (const auto integrator : {Integrator::predictor_corrector, Integrator::predictor_corrector_pec})
    for (const bool xsph : {false, true})
      for (const double dt : {0.4, 0.2, 0.1}) {
        const auto [growth, phase] = growth_and_phase(Choice{integrator, 0.0, xsph}, dt);
        INFO(name_of(integrator) << ", dt " << dt << ", phase a step " << phase);
        if (integrator == Integrator::predictor_corrector) {
          // λ = 1 + iz − z²/2, z = ωΔt: tan(phase) = z/(1 − z²/2) and |λ|² = 1 + z⁴/4.
          const double t = std::tan(phase), z = (std::sqrt(1.0 + 2.0 * t * t) - 1.0) / t;
          CHECK(growth == Approx(std::sqrt(1.0 + std::pow(z, 4) / 4.0) - 1.0).epsilon(fit_error / std::pow(z, 4)));
          CHECK(growth == Approx(std::pow(z, 4) / 8.0).epsilon(std::pow(z, 2)));
        } else {
          CHECK(growth == Approx(std::pow(phase, 4) / 4.0).epsilon(3.0 * std::pow(phase, 2)));
        }
      }
}
