// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <numbers>

#include "solver/updated_cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Some ten roundings of 1.1e-16.
constexpr double rounding = 1e-14;

/// The cubic spline in the plane with h = 1: W(1) = 10/(7π) / 4, W'(1) = −10/(7π) 3/4 (Gray et al., Eq. 3.4).
constexpr double W_1 = 10.0 / (28.0 * std::numbers::pi), dW_1 = -3.0 * W_1;
/// Diagonal neighbours: W(√2) = 10/(7π) (2 − √2)³/4, W'(√2) = −10/(7π) 3/4 (2 − √2)².
const double y = 2.0 - std::numbers::sqrt2;
const double W_d = W_1 * y * y * y, dW_d = dW_1 * y * y;

/// ρ0 = 1 and c0 = 2, so that P = 4 (ρ − 1); h = Δp = 1.
Problem<2> unit_problem() {
  Problem<2> problem{.lattice = {LatticeKind::square, 1.0},
                     .kernel = {KernelFamily::cubic_spline, 1.0},
                     .material = Material::from_sound_speed(1.0, 2.0, 0.5),
                     .scheme = {}};
  problem.scheme.formulation = Formulation::updated_lagrangian;
  return problem;
}

/// Particles of the masses 2, 3 and 5 with the densities 2, 1/2 and 1 at (0,0), (1,0) and (0,1); `count` of them.
struct FewParticles {
  explicit FewParticles(int count) {
    const Field<2> position{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
    const std::vector<double> mass{2.0, 3.0, 5.0}, density{2.0, 0.5, 1.0};
    body.materials = {problem.material};
    body.material.assign(count, 0);
    body.position.assign(position.begin(), position.begin() + count);
    body.volume.assign(mass.begin(), mass.begin() + count);  // at the reference density 1
    state.position = body.position;
    state.velocity.assign(count, Vector<2>::Zero());
    state.density.assign(density.begin(), density.begin() + count);
    state.deviatoric_stress.assign(count, Tensor<2>::Zero());
  }
  UpdatedRates<2> rates() {
    UpdatedSimulation<2> simulation(problem, body);
    return rates_of(simulation, state);
  }
  Problem<2> problem = unit_problem();
  Body<2> body;
  UpdatedState<2> state;
};

void check(const Vector<2>& found, const Vector<2>& expected) {
  INFO(found.transpose() << " for " << expected.transpose());
  CHECK((found - expected).norm() < rounding * (1.0 + expected.norm()));
}

}  // namespace

TEST_CASE("ul: two particles feel their stresses over squared densities", "[fast]") {
  FewParticles two(2);
  two.state.deviatoric_stress[0] << 1.0, 3.0, 3.0, -1.0;
  two.state.deviatoric_stress[1] << 0.5, -0.25, -0.25, 0.75;
  // P = 4 and −2: σ0 = (−3, 3; 3, −5), /4; σ1 = (2.5, −0.25; −0.25, 2.75), × 4. Their sum:
  const Vector<2> column(-3.0 / 4.0 + 10.0, 3.0 / 4.0 - 1.0);  // its first column
  // r_01 = (−1, 0): ∇_0 W = −W'(1) e_x.
  const auto rates = two.rates();
  check(rates.acceleration[0], 3.0 * column * -dW_1);
  check(rates.acceleration[1], 2.0 * column * dW_1);
}

TEST_CASE("ul: three particles add up", "[fast]") {
  FewParticles three(3);
  // P = 4, −2 and 0: −P/ρ² = −1, 8 and 0.
  const auto rates = three.rates();
  check(rates.acceleration[0], Vector<2>(3.0 * 7.0 * -dW_1, 5.0 * -1.0 * -dW_1));
  const Vector<2> from_1_to_2 = Vector<2>(-1.0, 1.0) / std::numbers::sqrt2;
  check(rates.acceleration[1], 2.0 * 7.0 * dW_1 * Vector<2>(1.0, 0.0) - 5.0 * 8.0 * dW_d * from_1_to_2);
  check(rates.acceleration[2], 2.0 * -1.0 * dW_1 * Vector<2>(0.0, 1.0) + 3.0 * 8.0 * dW_d * from_1_to_2);
}

TEST_CASE("ul: viscosity slows two particles that approach, and holds back two that part, unless it may not",
          "[fast]") {
  for (const double approach : {0.25, -0.25}) {
    FewParticles two(2);
    two.state.density = {1.0, 1.0};  // no stress
    two.problem.scheme.viscosity = Viscosity{0.5, 0.1};
    two.state.velocity = {{approach, 7.0}, {-approach, 7.0}};
    // v_01 · r_01 = −2 approach; α h c0 = 1; ρ̄ = 1; r² + (ηh)² = 1.01.
    const double Pi = -2.0 * approach / 1.01;
    const Vector<2> force(-dW_1 * Pi, 0.0);  // on 0, per mass of 1
    CHECK(force[0] * approach < 0.0);        // resists
    check(two.rates().acceleration[0], 3.0 * force);
    check(two.rates().acceleration[1], -2.0 * force);
    two.problem.scheme.viscosity->pairs = ViscousPairs::approaching;
    const auto one_sided = two.rates();
    check(one_sided.acceleration[0], approach > 0.0 ? Vector<2>(3.0 * force) : Vector<2>::Zero());
  }
  FewParticles uneven(2);
  uneven.problem.scheme.viscosity = Viscosity{0.5, 0.1};
  const auto still = uneven.rates();
  uneven.state.velocity[0] = {0.25, 0.0};
  // ρ̄ = 1.25.
  check(uneven.rates().acceleration[0] - still.acceleration[0], Vector<2>(3.0 * -0.25 / (1.25 * 1.01) * -dW_1, 0.0));
}

TEST_CASE("ul: artificial stress pushes apart by the tensions of both, weighted by the ratio of kernels or distances",
          "[fast]") {
  FewParticles three(3);
  const auto plain = three.rates();
  three.problem.scheme.artificial_stress = ArtificialStress{.epsilon = 0.5, .exponent = 2.0};
  // Principal stresses: −4 twice (none), 2 twice, 0 twice: R = 0, −0.5 · 2/0.25 = −4 and 0. φ is 1 at r = Δp.
  auto change = three.rates();
  check(change.acceleration[0] - plain.acceleration[0], Vector<2>(3.0 * -4.0 * -dW_1, 0.0));
  // Between 1 and 2, φ = (W(√2)/W(1))².
  const double phi = std::pow(W_d / W_1, 2);
  const Vector<2> from_1_to_2 = Vector<2>(-1.0, 1.0) / std::numbers::sqrt2;
  check(change.acceleration[2] - plain.acceleration[2], 3.0 * -4.0 * phi * dW_d * from_1_to_2);
  three.problem.scheme.artificial_stress->weight = ArtificialStressWeight::distance_ratio;
  change = three.rates();
  check(change.acceleration[2] - plain.acceleration[2], 3.0 * -4.0 * 2.0 * dW_d * from_1_to_2);
  // An exponent that is no whole number.
  three.problem.scheme.artificial_stress->exponent = 1.5;
  check(three.rates().acceleration[2] - plain.acceleration[2], 3.0 * -4.0 * std::pow(2.0, 0.75) * dW_d * from_1_to_2);
}

TEST_CASE("ul: two particles change density and stress by their relative velocity", "[fast]") {
  FewParticles two(2);
  two.state.velocity[0] = {0.5, 0.25};
  // Σ m_b v_ab · ∇_a W: v_01 = (0.5, 0.25), ∇_0 W = −W' e_x; for particle 1 both change sign.
  const auto masses = two.rates();
  CHECK(masses.density[0] == Approx(3.0 * 0.5 * -dW_1).epsilon(rounding));
  CHECK(masses.density[1] == Approx(2.0 * 0.5 * -dW_1).epsilon(rounding));
  two.problem.scheme.density_rate = DensityRate::volumes;
  const auto volumes = two.rates();
  CHECK(volumes.density[0] == Approx(2.0 * 6.0 * 0.5 * -dW_1).epsilon(rounding));
  CHECK(volumes.density[1] == Approx(0.5 * 1.0 * 0.5 * -dW_1).epsilon(rounding));
  // ∂v_x/∂x = 6 · −0.5 · −W' and ∂v_y/∂x = 6 · −0.25 · −W' at 0; a sixth at 1.
  for (const int a : {0, 1}) {
    const double volume = a == 0 ? 6.0 : 1.0;
    const double strain = volume * 0.5 * dW_1, half_shear = 0.5 * volume * 0.25 * dW_1;
    const Tensor<2> expected =
        (Tensor<2>() << 2.0 / 3.0 * strain, half_shear, half_shear, -1.0 / 3.0 * strain).finished();
    CHECK((masses.deviatoric_stress[a] - expected).norm() < rounding);  // 2μ = 1
    // With a stress, the spin ½(∂v_x/∂y − ∂v_y/∂x) = −half_shear turns it: Sxx grows by 2 Ω_xy Sxy, and so on.
    auto stressed = two;
    stressed.state.deviatoric_stress[a] << 0.0, 1.0, 1.0, 0.0;
    const Tensor<2> turned = (Tensor<2>() << -2.0 * half_shear, 0.0, 0.0, 2.0 * half_shear).finished();
    CHECK((stressed.rates().deviatoric_stress[a] - expected - turned).norm() < rounding);
  }
}

TEST_CASE("ul: XSPH moves each particle with an average, which density and stress follow", "[fast]") {
  FewParticles two(2);
  two.problem.scheme.xsph = Xsph{0.5};
  two.state.velocity[0] = {1.0, 2.0};
  UpdatedSimulation<2> simulation(two.problem, two.body);
  simulation.place(two.state.position);
  // ρ̄ = 1.25.
  const auto smoothed = simulation.smoothed(two.state);
  check(smoothed[0], (1.0 - 0.5 * 3.0 / 1.25 * W_1) * Vector<2>(1.0, 2.0));
  check(smoothed[1], 0.5 * 2.0 / 1.25 * W_1 * Vector<2>(1.0, 2.0));
  const double relative = 1.0 - 0.5 * 5.0 / 1.25 * W_1;
  CHECK(two.rates().density[0] == Approx(3.0 * relative * -dW_1).epsilon(rounding));
}

TEST_CASE("ul: particles at the end of their support do not feel each other", "[fast]") {
  FewParticles two(2);
  two.state.velocity[0] = {1.0, 2.0};
  two.state.position[1] = {2.0, 0.0};
  CHECK(two.rates().acceleration[0] == Vector<2>::Zero());
  CHECK(two.rates().density[1] == 0.0);
}
