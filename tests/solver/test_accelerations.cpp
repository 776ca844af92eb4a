// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solver/cases.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Two nested sums of at most 24 neighbours each, on both sides of a comparison: 4 · 24 · 2.2e-16.
constexpr double rounding = 2e-14;
/// The same count with the unit roundoff 6e-8 of float; random signs keep it near the square root: √480 · 6e-8.
constexpr double float_rounding = 2e-6;

/// Zhang's Eqs. 6-9 in their own letters, over all particles and all of their images.
class PaperSums {
 public:
  PaperSums(const Problem<2>& problem, const Body<2>& body, std::vector<Vector<2>> shifts)
      : problem_(problem), body_(body), shifts_(std::move(shifts)) {}

  Field<2> accelerations(const State<2>& state) const {
    const auto& H = problem_.displacement_gradient;
    const double mu = poisson_ratio, G = young_modulus / (1.0 + mu), rho0 = density;
    const bool plane_stress = problem_.plane == Plane::stress;
    const double gamma = mu * G / (plane_stress ? 1.0 - mu : 1.0 - 2.0 * mu);
    std::vector<Tensor<2>> sigma;
    std::vector<double> rho, N;
    for (int i = 0; i < body_.size(); ++i) {
      Tensor<2> epsilon = Tensor<2>::Zero();
      double W_sum = body_.volume[i] * problem_.kernel.value(0.0);
      for_each_partner(i, [&](int j, const Vector<2>& x_ij) {
        const Vector<2> s_ji = state.displacement[j] - state.displacement[i] - H * x_ij;
        const Vector<2> grad_W = gradient(x_ij);
        for (int alpha = 0; alpha < 2; ++alpha)
          for (int beta = 0; beta < 2; ++beta)
            epsilon(alpha, beta) += 0.5 * body_.volume[j] * (s_ji[beta] * grad_W[alpha] + s_ji[alpha] * grad_W[beta]);
        W_sum += body_.volume[j] * problem_.kernel.value(x_ij.norm());
      });
      N.push_back(problem_.scheme.kernel_normalisation == KernelNormalisation::sum ? W_sum : 1.0);
      epsilon /= N.back();
      const double in_plane = epsilon(0, 0) + epsilon(1, 1);
      const double out_of_plane = plane_stress ? -mu / (1.0 - mu) * in_plane : 0.0;
      sigma.push_back(gamma * in_plane * Tensor<2>::Identity() + G * epsilon);
      const bool frozen = problem_.scheme.momentum_density == MomentumDensity::frozen;
      rho.push_back(frozen ? rho0 : rho0 * std::exp(-in_plane - out_of_plane));
    }
    Field<2> result;
    for (int i = 0; i < body_.size(); ++i) {
      Vector<2> sum = Vector<2>::Zero();
      for_each_partner(i, [&](int j, const Vector<2>& x_ij) {
        const double m_j = rho0 * body_.volume[j];
        sum += m_j * (sigma[i] / (rho[i] * rho[i]) + sigma[j] / (rho[j] * rho[j])) * gradient(x_ij);
      });
      const double damping_rate = problem_.scheme.damping ? problem_.scheme.damping->rate : 0.0;
      result.push_back(sum / N[i] - damping_rate * state.velocity[i]);
    }
    return result;
  }

 private:
  Vector<2> gradient(const Vector<2>& x_ij) const { return problem_.kernel.slope(x_ij.norm()) * x_ij / x_ij.norm(); }

  template <class Visit>
  void for_each_partner(int i, const Visit& visit) const {
    const double reach =
        problem_.neighbour_rule == NeighbourRule::nearest ? 1.001 * spacing : problem_.kernel.support();
    for (int j = 0; j < body_.size(); ++j)
      for (const auto& shift : shifts_) {
        const Vector<2> x_ij = body_.position[i] - body_.position[j] - shift;
        if (x_ij.norm() > 1e-6 * spacing && x_ij.norm() < reach) visit(j, x_ij);
      }
  }

  const Problem<2>& problem_;
  const Body<2>& body_;
  std::vector<Vector<2>> shifts_;
};

/// All translations of a patch that can bring a particle into the support of another one.
std::vector<Vector<2>> translations(const Problem<2>& problem, const LatticeIndex<2>& cells) {
  const auto& a = problem.lattice.primitive_vectors();
  std::vector<Vector<2>> shifts;
  for (int n = -6; n <= 6; ++n)
    for (int m = -6; m <= 6; ++m) shifts.push_back(n * cells[0] * a.col(0) + m * cells[1] * a.col(1));
  return shifts;
}

void check_against_paper_sums(const Problem<2>& problem, const Body<2>& body, const std::vector<Vector<2>>& shifts) {
  INFO(describe(problem) << ", " << body.size() << " particles");
  const State<2> state = random_state(body.size(), 0.1, 7);
  const Field<2> expected = PaperSums(problem, body, shifts).accelerations(state);
  Simulation<2> simulation(problem, body);
  Field<2> acceleration(body.size());
  simulation.accelerations(state, acceleration);
  CHECK(largest_difference(acceleration, expected) < rounding * std::max(largest(expected), young_modulus / density));
}

Field<2> accelerations_of(const Problem<2>& problem, const Body<2>& body, const State<2>& state) {
  Simulation<2> simulation(problem, body);
  Field<2> acceleration(body.size());
  simulation.accelerations(state, acceleration);
  return acceleration;
}

Vector<2> weighted_sum(const Field<2>& field, const std::vector<double>& weight) {
  Vector<2> sum = Vector<2>::Zero();
  for (std::size_t a = 0; a < field.size(); ++a) sum += weight[a] * field[a];
  return sum;
}

double sum_of_norms(const Field<2>& field) {
  double sum = 0.0;
  for (const auto& y : field) sum += y.norm();
  return sum;
}

/// Two particles on the x-axis, with volumes that differ so that a for b shows.
struct TwoParticles {
  Problem<2> problem = plain_problem();
  double V_0 = 0.5, V_1 = 0.75;
  double slope = problem.kernel.slope(spacing);
  Body<2> body{.position = {{0.0, 0.0}, {spacing, 0.0}},
               .volume = {V_0, V_1},
               .materials = {problem.material},
               .material = {0, 0},
               .pairs = {{0, 1, 2}, {1, 0}, {{-spacing, 0.0}, {spacing, 0.0}}}};
};

}  // namespace

TEST_CASE("accelerations on periodic patches are the sums of the paper over all images", "[fast]") {
  for (const auto lattice : {LatticeKind::square, LatticeKind::hexagonal, LatticeKind::staggered})
    for (const auto& problem : all_variants(plain_problem(lattice)))
      for (const auto& cells : {LatticeIndex<2>(7, 6), LatticeIndex<2>(3, 4), LatticeIndex<2>(2, 1)})
        check_against_paper_sums(problem, periodic_patch(problem, cells), translations(problem, cells));
}

TEST_CASE("accelerations of four nearest neighbours are the sums of the paper", "[fast]") {
  const LatticeIndex<2> cells(5, 4);
  for (auto& problem : all_variants(plain_problem())) {
    problem.neighbour_rule = NeighbourRule::nearest;
    check_against_paper_sums(problem, periodic_patch(problem, cells), translations(problem, cells));
  }
}

TEST_CASE("accelerations on free plates are the sums of the paper", "[fast]") {
  for (const auto& problem : all_variants(plain_problem()))
    check_against_paper_sums(problem, uneven_plate(problem, LatticeIndex<2>(7, 5)), {Vector<2>::Zero()});
}

TEST_CASE("two particles that are pulled apart attract each other as worked out by hand", "[fast]") {
  const TwoParticles two;
  const auto lame = two.problem.material.lame(Plane::strain);
  State<2> state(2);
  const Vector<2> delta(0.01, 0.02);
  state.displacement[1] = delta;
  // g_01 = −V_1 W' e_x, so ε_xx = V_1 |W'| δ_x and ε_xy = ½ V_1 |W'| δ_y; for particle 1 with V_0.
  const double pull = std::abs(two.slope) / density * (two.V_0 + two.V_1) * std::abs(two.slope);
  const Vector<2> per_volume(pull * (lame.lambda + 2.0 * lame.shear_modulus) * delta[0],
                             pull * lame.shear_modulus * delta[1]);

  const Field<2> plain = accelerations_of(two.problem, two.body, state);
  CHECK((plain[0] - two.V_1 * per_volume).norm() < rounding * per_volume.norm());
  CHECK((plain[1] + two.V_0 * per_volume).norm() < rounding * per_volume.norm());

  Problem<2> uniform = two.problem;
  uniform.scheme.momentum_density = MomentumDensity::equation_of_state;
  Body<2> equal = two.body;
  equal.volume = {two.V_0, two.V_0};
  // Equal volumes, equal strains: ρ = ρ0 exp(−V |W'| δ_x) in both, and σ/ρ² grows by exp(2 V |W'| δ_x).
  const double growth = std::exp(2.0 * two.V_0 * std::abs(two.slope) * delta[0]);
  const Field<2> lighter = accelerations_of(uniform, equal, state);
  const Vector<2> expected = growth * two.V_0 * (2.0 * two.V_0) / (two.V_0 + two.V_1) * per_volume;
  CHECK((lighter[0] - expected).norm() < rounding * expected.norm());

  Problem<2> normalised = two.problem;
  normalised.scheme.kernel_normalisation = KernelNormalisation::sum;
  const double N = two.V_0 * (two.problem.kernel.value(0.0) + two.problem.kernel.value(spacing));
  const Vector<2> divided = two.V_0 * (2.0 * two.V_0) / (two.V_0 + two.V_1) / (N * N) * per_volume;
  CHECK((accelerations_of(normalised, equal, state)[0] - divided).norm() < rounding * divided.norm());
}

TEST_CASE("a plate keeps its momentum, unless its sums are normalised", "[fast]") {
  for (const auto momentum_density : {MomentumDensity::frozen, MomentumDensity::equation_of_state}) {
    Problem<2> problem = plain_problem();
    problem.scheme.momentum_density = momentum_density;
    problem.displacement_gradient = some_displacement_gradient();
    const auto body = uneven_plate(problem, LatticeIndex<2>(8, 7));
    const State<2> state = random_state(body.size(), 0.1, 3);

    const Field<2> plain = accelerations_of(problem, body, state);
    CHECK(weighted_sum(plain, body.volume).norm() < rounding * sum_of_norms(plain));

    // Dividing the sum of a by N_a leaves Σ_a N_a m_a v_a constant, and breaks Σ_a m_a v_a at the edges by per cents.
    std::vector<double> NV;
    for (int a = 0; a < body.size(); ++a) {
      double N = body.volume[a] * problem.kernel.value(0.0);
      for (int b = 0; b < body.size(); ++b)
        if (b != a) N += body.volume[b] * problem.kernel.value((body.position[a] - body.position[b]).norm());
      NV.push_back(N * body.volume[a]);
    }
    problem.scheme.kernel_normalisation = KernelNormalisation::sum;
    const Field<2> normalised = accelerations_of(problem, body, state);
    CHECK(weighted_sum(normalised, NV).norm() < rounding * sum_of_norms(normalised));
    CHECK(weighted_sum(normalised, body.volume).norm() > 0.01 * sum_of_norms(normalised));
  }
}

TEST_CASE("a rigid translation gives no force and no energy, exactly", "[fast]") {
  for (auto& problem : all_variants(plain_problem())) {
    if (!problem.displacement_gradient.isZero()) continue;
    INFO(describe(problem));
    for (const auto& body :
         {free_plate(problem, LatticeIndex<2>(5, 4)), periodic_patch(problem, LatticeIndex<2>(5, 4))}) {
      Simulation<2> simulation(problem, body);
      State<2> state(body.size());
      for (auto& s : state.displacement) s = Vector<2>(0.3, -1.7);
      Field<2> acceleration(body.size());
      simulation.accelerations(state, acceleration);
      CHECK(largest(acceleration) == 0.0);
      CHECK(simulation.strain_energy(state) == 0.0);
    }
  }
}

TEST_CASE("a uniform base strain is uniform on a patch and gives no force", "[fast]") {
  const Tensor<2> H = some_displacement_gradient();
  for (const auto lattice : {LatticeKind::square, LatticeKind::hexagonal})
    for (const auto momentum_density : {MomentumDensity::frozen, MomentumDensity::equation_of_state}) {
      Problem<2> problem = plain_problem(lattice);
      problem.scheme.momentum_density = momentum_density;
      problem.displacement_gradient = H;
      const auto body = periodic_patch(problem, LatticeIndex<2>(6, 5));
      const Simulation<2> simulation(problem, body);
      const State<2> rest(body.size());
      // On lattices with four- or sixfold symmetry −Σ V r_ab ⊗ ∇W = c I with c = −½ Σ V r W'(r).
      double c = 0.0;
      for (const auto& b : lattice_neighbours(problem.lattice, problem.kernel.support(), NeighbourRule::support))
        c -= 0.5 * problem.lattice.cell_volume() * b.distance * problem.kernel.slope(b.distance);
      CHECK(c == Approx(1.0).margin(0.05));  // the sum is a quadrature of 1
      for (int a = 0; a < body.size(); ++a)
        CHECK((simulation.strain(rest, a) - c * 0.5 * (H + H.transpose())).norm() < rounding * H.norm());
      CHECK(largest(accelerations_of(problem, body, rest)) < rounding * H.norm() * young_modulus / (density * spacing));
    }
}

TEST_CASE("a base state is the same as its displacement put into the state", "[fast]") {
  for (auto& problem : all_variants(plain_problem())) {
    INFO(describe(problem));
    const auto body = free_plate(problem, LatticeIndex<2>(6, 5));
    const Tensor<2> H = some_displacement_gradient();
    State<2> strained(body.size());
    for (int a = 0; a < body.size(); ++a) strained.displacement[a] = H * body.position[a];
    problem.displacement_gradient.setZero();
    const Field<2> in_state = accelerations_of(problem, body, strained);
    problem.displacement_gradient = H;
    const Field<2> in_base = accelerations_of(problem, body, State<2>(body.size()));
    CHECK(largest_difference(in_state, in_base) < rounding * largest(in_base));
  }
}

TEST_CASE("the strain energy is the work done against the forces", "[fast]") {
  for (const auto plane : {Plane::strain, Plane::stress}) {
    Problem<2> problem = plain_problem();
    problem.plane = plane;
    const auto body = uneven_plate(problem, LatticeIndex<2>(6, 5));
    const State<2> state = random_state(body.size(), 0.1, 11);
    // Forces are linear in s: the work from 0 to s is −½ Σ m a · s.
    const double work = -0.5 * mass_product(body, accelerations_of(problem, body, state), state.displacement);
    CHECK(work > 0.0);
    CHECK(Simulation<2>(problem, body).strain_energy(state) == Approx(work).epsilon(rounding));
  }
}

TEST_CASE("the strain energy leaves the base state out", "[fast]") {
  Problem<2> problem = plain_problem();
  const auto body = free_plate(problem, LatticeIndex<2>(6, 5));
  const State<2> state = random_state(body.size(), 0.1, 11);
  const double energy = Simulation<2>(problem, body).strain_energy(state);
  problem.displacement_gradient = some_displacement_gradient();
  CHECK(Simulation<2>(problem, body).strain_energy(state) == energy);
  CHECK(Simulation<2>(problem, body).strain_energy(State<2>(body.size())) == 0.0);
}

TEST_CASE("a checkerboard on the square lattice costs no energy and feels no force", "[fast]") {
  const Problem<2> problem = plain_problem();
  const auto body = periodic_patch(problem, LatticeIndex<2>(6, 4));
  Simulation<2> simulation(problem, body);
  State<2> state(body.size());
  for (int a = 0; a < body.size(); ++a)
    state.displacement[a] = Vector<2>(0.2, 0.1) * (body.site[a].sum() % 2 == 0 ? 1.0 : -1.0);
  Field<2> acceleration(body.size());
  simulation.accelerations(state, acceleration);
  CHECK(largest(acceleration) < rounding * 0.2 * young_modulus / (density * spacing * spacing));
  // Energy is quadratic in strains that are zero to rounding.
  CHECK(simulation.strain_energy(state) < rounding * rounding * body.size() * young_modulus);
}

TEST_CASE("single precision tracks double precision", "[fast]") {
  for (const auto& problem : all_variants(plain_problem())) {
    INFO(describe(problem));
    const auto body = free_plate(problem, LatticeIndex<2>(9, 8));
    const State<2> state = random_state(body.size(), 0.1, 5);
    State<2, float> single_state(body.size());
    for (int a = 0; a < body.size(); ++a) {
      single_state.displacement[a] = state.displacement[a].cast<float>();
      single_state.velocity[a] = state.velocity[a].cast<float>();
    }
    Simulation<2, float> single_simulation(problem, body);
    Field<2, float> single_acceleration(body.size());
    single_simulation.accelerations(single_state, single_acceleration);
    Field<2> converted;
    for (const auto& y : single_acceleration) converted.push_back(y.cast<double>());
    const Field<2> expected = accelerations_of(problem, body, state);
    CHECK(largest_difference(converted, expected) < float_rounding * largest(expected));
  }
}
