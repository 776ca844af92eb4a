// SPDX-License-Identifier: MIT
// What the spectrum about a deformed state says that grows, against the running solver.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/deformed_spectrum.hpp"
#include "ladder/finite_strain_cases.hpp"
#include "solver/total_lagrangian.hpp"

using namespace sphstab;

namespace {

/// Relative, of the growth: departures of up to 1e-5 spacings, and of those that decay e⁻²⁰.
constexpr double growth_tolerance = 1e-5;
/// Of a mode that turns: the mean square over n turns differs by a part 1/(4πn) at most, n is 10 to 20 here, and growth
/// is followed over 6 e-foldings.
constexpr double turning_tolerance = 1e-3;

/// A smooth displacement with strains of up to `strain` and rotations of as much.
solver::Field<2> bent(const Problem<2>& problem, const Body<2>& body, double strain) {
  const double spacing = problem.lattice.spacing();
  solver::Field<2> displacement;
  for (const Vector<2>& X : body.position) {
    const double x = 0.7 * X[0] / spacing, y = 0.5 * X[1] / spacing;
    displacement.push_back(strain * spacing *
                           Vector<2>(std::sin(x) - 0.8 * std::cos(y), std::sin(x + 1.0) - 0.8 * std::cos(y - 2.0)));
  }
  return displacement;
}

/// ln of the modulus of the growing eigenvalue of a leapfrog step, λ + 1/λ = 2 − ω²Δt².
double leapfrog_growth(std::complex<double> omega_squared, double time_step) {
  const std::complex<double> half_trace = 1.0 - 0.5 * omega_squared * time_step * time_step;
  const std::complex<double> root = std::sqrt(half_trace * half_trace - 1.0);
  return std::log(std::max(std::abs(half_trace + root), std::abs(half_trace - root)));
}

/// A free plate under the loads that hold it in a bent state.
struct HeldPlate {
  Problem<2> problem;
  Body<2> body;
  solver::Field<2> displacement;

  HeldPlate(const ladder::FiniteStrainScheme& scheme, const LatticeIndex<2>& particles, double strain)
      : problem(ladder::finite_strain_problem<2>(scheme, LatticeKind::square, KernelFamily::cubic_spline, 1.3)),
        body(free_plate<2>(problem, particles)),
        displacement(bent(problem, body, strain)) {
    solver::State<2> state(body.size());
    state.displacement = displacement;
    solver::Field<2> acceleration(body.size());
    solver::make_simulation(problem, body)->accelerations(state, acceleration);
    for (const Vector<2>& a : acceleration) body.load.push_back(-a);
  }

  analysis::DeformedSpectrum spectrum() const {
    analysis::DeformedBodyOperator<2> op(problem, body);
    op.set_state(analysis::components_of<2>(displacement));
    return analysis::deformed_spectrum(op);
  }

  /// Of what departs from the state as this mode, per step, by the mean squares in two windows of a tenth of an
  /// e-folding. Half of what starts at rest decays as fast as the other half grows: it is left behind first.
  double growth(const analysis::DeformedMode& mode, double time_step, double expected) const {
    constexpr double start = 1e-12, e_foldings_before = 10.0, e_foldings = 6.0, window = 0.1;
    const auto steps_of = [expected](double count) { return std::lround(count / expected); };
    const auto simulation = solver::make_simulation(problem, body);
    solver::State<2> state(body.size());
    for (int a = 0; a < body.size(); ++a)
      state.displacement[a] = displacement[a] + start * mode.vector.segment<2>(2 * a);
    const auto mean_departure = [&] {
      double squares = 0.0;
      for (long step = 0; step < steps_of(window); ++step) {
        simulation->advance(state, time_step);
        for (int a = 0; a < body.size(); ++a) squares += (state.displacement[a] - displacement[a]).squaredNorm();
      }
      return 0.5 * std::log(squares);
    };
    simulation->advance(state, time_step, steps_of(e_foldings_before));
    const double before = mean_departure();
    simulation->advance(state, time_step, steps_of(e_foldings) - steps_of(window));
    return (mean_departure() - before) / static_cast<double>(steps_of(e_foldings));
  }
};

}  // namespace

TEST_CASE("rung 5: a plate that loads hold in a bent state grows as its spectrum about that state says", "[ladder]") {
  for (const auto& scheme : ladder::finite_strain_schemes) {
    const HeldPlate plate(scheme, {9, 4}, 0.2);
    INFO(ladder::describe(plate.problem.scheme));
    const auto spectrum = plate.spectrum();
    REQUIRE(spectrum.growing);
    CHECK(spectrum.growing->omega_squared == spectrum.smallest.omega_squared);
    CHECK(spectrum.growing->omega_squared.real() < 0.0);
    const double time_step = 0.5 * *spectrum.step_of_largest;
    const double expected = leapfrog_growth(spectrum.growing->omega_squared, time_step);
    CHECK(plate.growth(*spectrum.growing, time_step, expected) == Approx(expected).epsilon(growth_tolerance));
  }
}

TEST_CASE("rung 5: R·S flutters in a bent plate, by a complex pair inside its spectrum, where F·S does not",
          "[ladder]") {
  const HeldPlate fluttering(ladder::finite_strain_schemes[0], {10, 10}, 0.08);
  const auto spectrum = fluttering.spectrum();
  REQUIRE(spectrum.growing);
  const std::complex<double> square = spectrum.growing->omega_squared;
  CHECK(square.imag() > 0.0);
  CHECK(square.real() > 0.1 * spectrum.largest.omega_squared.real());
  CHECK(square.real() < 0.9 * spectrum.largest.omega_squared.real());
  for (const double fraction : {0.3, 0.6}) {
    const double time_step = fraction * *spectrum.step_of_largest;
    const double expected = leapfrog_growth(square, time_step);
    CHECK(expected == Approx(spectrum.growth_rate * time_step).epsilon(0.1));
    CHECK(fluttering.growth(*spectrum.growing, time_step, expected) == Approx(expected).epsilon(turning_tolerance));
  }
  CHECK_FALSE(HeldPlate(ladder::finite_strain_schemes[1], {10, 10}, 0.08).spectrum().growing);
}
