// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/body_operator.hpp"
#include "analysis/rigid_motions.hpp"
#include "analysis/spectrum.hpp"
#include "tests/analysis/plain_finite_strain.hpp"

using namespace sphstab;
using namespace sphstab::analysis;
using Catch::Matchers::StartsWith;

namespace {

/// ω² relative to the largest: the residual that modes are converged to, squared over the gaps, and dense rounding.
constexpr double eigenvalue_tolerance = 1e-12;
/// Relative residual of the equilibrium; the displacement has it times the condition, some thousands.
constexpr double static_tolerance = 1e-8;
/// Its relative residual alone, in loads of 1 per mass.
constexpr double residual_of_balance = 1e-10;

struct Counts {
  int vibrations = 0, rigid = 0, zero_energy = 0;
};

Counts count(const std::vector<BodyMode>& modes) {
  Counts counts;
  for (const auto& mode : modes) {
    counts.vibrations += mode.kind == BodyModeKind::vibration;
    counts.rigid += mode.kind == BodyModeKind::rigid;
    counts.zero_energy += mode.kind == BodyModeKind::zero_energy;
  }
  return counts;
}

template <int Dim>
void check_against_dense(const Problem<Dim>& problem, const Body<Dim>& body, int modes) {
  const BodyOperator<Dim> op(problem, body);
  const Eigen::VectorXd expected = bodies::dense_eigenvalues(Eigen::MatrixXd(op.matrix()));
  const auto found = lowest_modes(problem, body, modes);
  REQUIRE(static_cast<int>(found.size()) == modes);
  for (int i = 0; i < modes; ++i) {
    CHECK(found[i].residual < 1e-6 * expected.maxCoeff());
    CHECK(std::abs(found[i].omega * found[i].omega - expected[i]) < eigenvalue_tolerance * expected.maxCoeff());
  }
}

/// 1 for a displacement that alternates from particle to particle, 0 for a constant one.
double alternation(const Eigen::VectorXd& s) {
  return (s.tail(s.size() - 1) - s.head(s.size() - 1)).squaredNorm() / (4.0 * s.squaredNorm());
}

}  // namespace

TEST_CASE("the lowest modes are those of the dense matrix, by dense and by sparse solution", "[fast]") {
  const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::sum);
  check_against_dense<2>(problem, bodies::mixed_block<2>(problem, {10, 8}, 0.2), 12);
  check_against_dense<2>(problem, bodies::block<2>(problem, {24, 20}, 0.2), 20);
  check_against_dense<2>(problem, bodies::mixed_block<2>(problem, {24, 20}, 0.2), 20);
  const auto in_space = bodies::problem<3>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::none);
  check_against_dense<3>(in_space, bodies::block<3>(in_space, {7, 6, 6}, 0.2), 15);
}

TEST_CASE("a free plate moves rigidly in three ways, a block in six, a clamped one in none", "[fast]") {
  const auto plane = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::sum);
  auto plate = bodies::block<2>(plane, {24, 20}, 0.1);
  CHECK(rigid_motions(plate).cols() == 3);
  const auto free = lowest_modes(plane, plate, 8);
  CHECK(count(free).rigid == 3);
  CHECK(count({free.begin(), free.begin() + 3}).rigid == 3);

  plate.clamped.assign(plate.position.size(), Directions<2>::Constant(false));
  plate.clamped[0][0] = true;  // what slides along x is held
  CHECK(rigid_motions(plate).cols() == 2);
  plate.clamped[0][1] = true;
  CHECK(rigid_motions(plate).cols() == 1);
  for (int a = 0; a < 48; ++a) plate.clamped[a].setConstant(true);
  CHECK(rigid_motions(plate).cols() == 0);
  CHECK(count(lowest_modes(plane, plate, 8)).rigid == 0);

  const auto space = bodies::problem<3>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::sum);
  const auto block = bodies::block<3>(space, {8, 6, 6}, 0.1);
  CHECK(rigid_motions(block).cols() == 6);
  CHECK(count(lowest_modes(space, block, 9)).rigid == 6);
}

TEST_CASE("with renormalised gradients rotations are as free as translations, and a couple drives what nothing holds",
          "[fast]") {
  const auto plane = bodies::finite_strain_problem<2>(bodies::finite_strain_schemes[0]);
  auto plate = bodies::block<2>(plane, {24, 20}, 0.1);
  check_against_dense<2>(plane, plate, 8);
  const double largest = BodyOperator<2>(plane, plate).norm_bound();
  const auto modes = lowest_modes(plane, plate, 8);
  CHECK(count({modes.begin(), modes.begin() + 3}).rigid == 3);
  for (int i = 0; i < 3; ++i) CHECK(modes[i].omega * modes[i].omega < eigenvalue_tolerance * largest);

  plate.load.assign(plate.position.size(), Vector<2>::Zero());
  plate.load[0] = {0.0, -1.0};
  plate.load[23] = {0.0, 1.0};
  CHECK_THROWS_WITH(static_displacement(plane, plate), "load: its couple turns a part of the body that nothing holds");

  const Vector<2> along = (plate.position[23] - plate.position[0]).normalized();
  plate.load[0] = -along;
  plate.load[23] = along;
  const Eigen::VectorXd s = static_displacement(plane, plate);
  BodyOperator<2> op(plane, plate);
  Eigen::VectorXd x = s.cwiseQuotient(op.root_inverse_mass()), force(op.components());
  op.apply(x, force);
  force = op.displacement(force);  // M⁻¹ S s, the load
  CHECK((force.segment<2>(0) + along).norm() < residual_of_balance);
  CHECK((force.segment<2>(46) - along).norm() < residual_of_balance);
  CHECK(force.norm() == Approx(std::sqrt(2.0)).epsilon(residual_of_balance));
}

TEST_CASE("the vibrations of a free chain are those of a bar, between the zero-energy modes", "[fast]") {
  // ω_n = n π c / L. What the ends lack of their neighbours makes the bar about two particles shorter.
  constexpr double of_the_ends = 0.03;
  const auto problem = bodies::problem<1>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::none);
  const double c = std::sqrt(problem.material.lame(problem.plane).p_wave_modulus() / problem.material.density());
  int n = 0;
  for (const auto& mode : lowest_modes(problem, bodies::block<1>(problem, LatticeIndex<1>(100)), 15))
    if (mode.kind == BodyModeKind::vibration)
      CHECK(mode.omega == Approx(++n * std::acos(-1.0) * c / 100.0).epsilon(of_the_ends));
  CHECK(n == 5);
}

TEST_CASE("the bending of a cantilever is a vibration, though its strains are small beside a trace of alternation",
          "[fast]") {
  // Slow bending is within a fifth of Euler and Bernoulli's 1.8751² √(E'/12ρ) H/L²; what lies between bends is not
  // felt.
  constexpr double of_slender_beams = 0.2;
  const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::sum);
  auto beam = bodies::block<2>(problem, {40, 8});
  beam.clamped.assign(beam.position.size(), Directions<2>::Constant(false));
  for (int a = 0; a < beam.size(); ++a) beam.clamped[a].setConstant(beam.position[a][0] < 1.5);
  const auto modes = lowest_modes(problem, beam, 10);
  const double nu = problem.material.poisson_ratio();
  const double modulus = problem.material.young_modulus() / (1.0 - nu * nu);
  const double bending = 3.5160 * std::sqrt(modulus / (12.0 * problem.material.density())) * 8.0 / (38.0 * 38.0);
  CHECK(modes.front().kind == BodyModeKind::vibration);
  CHECK(modes.front().omega == Approx(bending).epsilon(of_slender_beams));
  CHECK(count(modes).vibrations == 1);
}

TEST_CASE("parts that do not touch move rigidly each for itself", "[fast]") {
  const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::sum);
  auto body = bodies::block<2>(problem, {20, 20}, 0.1);
  for (auto& x : body.position)
    if (x[0] > 9.5) x[0] += 10.0;
  body.pairs = find_pairs(body.position, problem.kernel.support());
  CHECK(connected_parts(body.pairs).size() == 2);
  CHECK(count(lowest_modes(problem, body, 8)).rigid == 6);
}

TEST_CASE("the waves of a chain that alternate come back to low frequencies as zero-energy modes", "[fast]") {
  const auto problem = bodies::problem<1>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::none);
  for (const int particles : {100, 700}) {  // dense and sparse
    const auto modes = lowest_modes(problem, bodies::block<1>(problem, LatticeIndex<1>(particles)), 21);
    CHECK(count(modes).rigid == 1);
    CHECK(modes.front().kind == BodyModeKind::rigid);
    CHECK(count(modes).zero_energy > 5);
    CHECK(count(modes).vibrations > 5);
    for (const auto& mode : modes)
      CHECK((mode.kind == BodyModeKind::zero_energy) == (alternation(mode.displacement) > 0.5));
  }
}

TEST_CASE("a chain of nearest neighbours has the zero-energy modes of its sums, counted by hand", "[fast]") {
  // Two neighbours, ε_a ∝ s_{a+1} − s_{a−1} inside and s_{a+1} − s_a at the ends. All strains 0: s is 2-periodic
  // inside, and the ends make both constants equal: the translation alone. With one particle removed from either rule
  // it stays so.
  const auto chain = bodies::problem<1>(KernelFamily::cubic_spline, 0.65, KernelNormalisation::none);
  const auto modes = lowest_modes(chain, bodies::block<1>(chain, LatticeIndex<1>(30)), 2);
  CHECK(modes[0].kind == BodyModeKind::rigid);
  CHECK(modes[0].omega < 1e-6);
  CHECK(modes[1].omega > 1e-3);

  // Periodic patches of four neighbours and even sides: k = (π,0), (0,π), (π,π) with two directions each, beside two
  // translations.
  const auto plane = bodies::problem<2>(KernelFamily::cubic_spline, 0.65, KernelNormalisation::none);
  for (const LatticeIndex<2>& cells : {LatticeIndex<2>(6, 6), LatticeIndex<2>(20, 18)}) {
    const auto found = lowest_modes(plane, periodic_patch(plane, cells), 10);
    CHECK(std::count_if(found.begin(), found.end(), [](const BodyMode& mode) { return mode.omega < 1e-6; }) == 8);
    const auto counts = count({found.begin(), found.begin() + 8});
    CHECK(counts.rigid == 2);
    CHECK(counts.zero_energy == 6);
  }
}

TEST_CASE("modes are orthogonal in the mass, and their displacements satisfy the printed equations", "[fast]") {
  const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::sum);
  const auto body = bodies::mixed_block<2>(problem, {6, 5}, 0.2);
  const BodyOperator<2> op(problem, body);
  const Eigen::MatrixXd K = bodies::printed_operator(problem, body);
  for (const auto& mode : lowest_modes(problem, body, 5)) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(60);
    for (const int i : op.unknowns()) x[i] = mode.displacement[i] / op.root_inverse_mass()[i];
    CHECK((K * x - mode.omega * mode.omega * x).norm() < eigenvalue_tolerance * x.norm());
    CHECK(mode.displacement.head<2>().isZero(0.0));
  }
}

TEST_CASE("a clamped bar hangs as the printed equations want it", "[fast]") {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum}) {
    const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, normalisation);
    auto body = bodies::mixed_block<2>(problem, {6, 5}, 0.2);
    for (int a = 0; a < 6; ++a) body.clamped[a].setConstant(true);
    body.load.assign(30, Vector<2>(0.3, -1.0));
    const Eigen::VectorXd s = static_displacement(problem, body);
    const BodyOperator<2> op(problem, body);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(60), load = x;
    for (const int i : op.unknowns()) {
      x[i] = s[i] / op.root_inverse_mass()[i];
      load[i] = body.load[i / 2][i % 2] / op.root_inverse_mass()[i];
    }
    CHECK((bodies::printed_operator(problem, body) * x - load).norm() < static_tolerance * load.norm());
    CHECK(s.head<12>().isZero(0.0));
  }
}

TEST_CASE("a free body in balance is displaced without moving, and one that is driven is refused", "[fast]") {
  const auto problem = bodies::problem<2>(KernelFamily::cubic_spline, 1.3, KernelNormalisation::sum);
  auto body = bodies::block<2>(problem, {12, 12}, 0.2);
  const BodyOperator<2> op(problem, body);
  const Eigen::VectorXd mass = op.root_inverse_mass().cwiseAbs2().cwiseInverse();
  body.load.assign(144, Vector<2>::Zero());
  body.load[5] = Vector<2>(0.0, 1.0 / mass[10]);
  CHECK_THROWS_WITH(static_displacement(problem, body), StartsWith("load: it drives particle"));
  body.load[137] = Vector<2>(0.0, -1.0 / mass[274]);
  const Eigen::VectorXd s = static_displacement(problem, body);
  const Eigen::VectorXd momentum = mass.cwiseProduct(s);
  for (int i = 0; i < 2; ++i) {
    double sum = 0.0;
    for (int a = 0; a < 144; ++a) sum += momentum[2 * a + i];
    CHECK(std::abs(sum) < static_tolerance * momentum.cwiseAbs().sum());
  }
  CHECK(s[11] > s[275]);

  // A zero-energy mode that is driven has no equilibrium either.
  const auto four = bodies::problem<2>(KernelFamily::cubic_spline, 0.65, KernelNormalisation::none);
  auto patch = periodic_patch(four, {6, 6});
  for (int a = 0; a < 36; ++a) patch.load.push_back(Vector<2>(a % 2 == 0 ? 1.0 : -1.0, 0.0));
  CHECK_THROWS_WITH(static_displacement(four, patch), StartsWith("load: it drives a zero-energy mode"));

  auto equation_of_state = problem;
  equation_of_state.scheme.momentum_density = MomentumDensity::equation_of_state;
  CHECK_THROWS_AS(static_displacement(equation_of_state, body), InvalidInput);
  CHECK_THROWS_AS(lowest_modes(problem, body, 0), InvalidInput);
}
