// SPDX-License-Identifier: MIT
// Forces, stresses and energies of finite strain; its runs are in test_finite_strain_runs.cpp.
#include <catch2/catch.hpp>
#include <functional>

#include "solver/finite_strain_cases.hpp"
#include "solver/mueller_rotation.hpp"
#include "solver/step_jacobian.hpp"

using namespace sphstab;
using namespace sphstab::solver;
using namespace sphstab::solver::test;

namespace {

/// Two nested sums of at most 60 neighbours each, multiplied by N of edges, of at most 10 times the bulk's: 4 · 60 · 10
/// · 2.2e-16.
constexpr double rounding = 6e-13;
/// The same with the unit roundoff 6e-8 of float, where random signs keep it near the square root: 10 · √240 · 6e-8.
constexpr double float_rounding = 1e-5;
/// An observed order differs from the integer by the next term of the error, of a few per cent.
constexpr double order_margin = 0.1;

using Long = long double;
using Space = Tensor<3, Long>;

/// P of a deformation gradient of space.
using Law = std::function<Space(const Space& F, const Material&)>;

/// Saint Venant-Kirchhoff as the paper prints it, with the bulk modulus and a trace over three dimensions.
Space second_piola(const Space& F, const Material& material) {
  const Long K = material.bulk_modulus(), G = material.shear_modulus();
  const Space E = 0.5L * (F.transpose() * F - Space::Identity());
  return 2 * G * (E - E.trace() / 3 * Space::Identity()) + K * E.trace() * Space::Identity();
}

Space neo_hookean_second_piola(const Space& F, const Material& material) {
  const Long K = material.bulk_modulus(), G = material.shear_modulus();
  const Space inverse = (F.transpose() * F).inverse();
  return G * (Space::Identity() - inverse) + (K - 2 * G / 3) * std::log(F.determinant()) * inverse;
}

Space linear_stress(const Space& F, const Material& material) {
  const Long K = material.bulk_modulus(), G = material.shear_modulus();
  const Space e = 0.5L * (F + F.transpose()) - Space::Identity();
  return 2 * G * (e - e.trace() / 3 * Space::Identity()) + K * e.trace() * Space::Identity();
}

Law law_of(const Scheme& scheme) {
  if (scheme.formulation == Formulation::total_lagrangian_corotated)
    return
        [](const Space& F, const Material& made_of) { return Space(mueller_rotation(F) * second_piola(F, made_of)); };
  if (scheme.elastic_law == ElasticLaw::neo_hookean)
    return [](const Space& F, const Material& made_of) { return Space(F * neo_hookean_second_piola(F, made_of)); };
  return [](const Space& F, const Material& made_of) { return Space(F * second_piola(F, made_of)); };
}

/// Sums of Sec. 2.3 over all particles, in space and in long double: what is not modelled is stretched by 1.
template <int Dim>
Field<Dim> plain_accelerations(const Problem<Dim>& problem, const Body<Dim>& body, const State<Dim>& state,
                               const Law& law) {
  using Place = Vector<3, Long>;
  const int n = body.size();
  const auto in_space = [](const Vector<Dim>& y) {
    Place place = Place::Zero();
    place.template head<Dim>() = y.template cast<Long>();
    return place;
  };
  const auto grad_W = [&](int i, int j) -> Place {
    const Place r = in_space(body.position[i] - body.position[j]);
    const double distance = static_cast<double>(r.norm());
    if (i == j || distance >= problem.kernel.support()) return Place::Zero();
    return static_cast<Long>(problem.kernel.slope(distance)) / r.norm() * r;
  };
  Space out_of_plane = Space::Identity();
  out_of_plane.diagonal().template head<Dim>().setZero();

  std::vector<Space> N(n), P(n);
  for (int i = 0; i < n; ++i) {
    Space sum = out_of_plane, F = out_of_plane;
    for (int j = 0; j < n; ++j)
      sum += body.volume[j] * in_space(body.position[j] - body.position[i]) * grad_W(i, j).transpose();
    N[i] = sum.inverse();
    const auto place = [&](int k) -> Place {
      return in_space(problem.deformation_gradient * body.position[k]) + in_space(state.displacement[k]);
    };
    for (int j = 0; j < n; ++j) F += body.volume[j] * (place(j) - place(i)) * (N[i] * grad_W(i, j)).transpose();
    P[i] = law(F, body.material_of(i));
  }
  Field<Dim> result(n);
  for (int i = 0; i < n; ++i) {
    Place force = Place::Zero();
    for (int j = 0; j < n; ++j) force += body.volume[j] * (P[j] * N[j] + P[i] * N[i]) * grad_W(i, j);
    result[i] = Place(force / body.material_of(i).density()).template head<Dim>().template cast<double>();
    if (!body.load.empty()) result[i] += body.load[i];
    if (problem.scheme.damping) result[i] -= problem.scheme.damping->rate * state.velocity[i];
    if (!body.clamped.empty())
      for (int axis = 0; axis < Dim; ++axis)
        if (body.clamped[i][axis]) result[i][axis] = 0.0;
  }
  return result;
}

template <int Dim>
constexpr int side = Dim == 1   ? 9
                     : Dim == 2 ? 5
                                : 3;

/// Far from rest: a rotation, a stretch and disorder on both.
template <int Dim>
State<Dim> far_state(const Problem<Dim>& problem, const Body<Dim>& body) {
  return carried<Dim>(problem, body, random_state_of(body, 0.04, 7), large_deformation<Dim>());
}

template <int Dim>
void check_against_plain_sums() {
  for (auto scheme : finite_strain_schemes)
    for (const bool based : {false, true}) {
      if (based) scheme.damping = some_damping;
      Problem<Dim> problem = finite_strain_problem<Dim>(scheme);
      if (based) problem.deformation_gradient = turn<Dim>(0.5) * stretch<Dim>();
      const auto free = disordered_block(problem, side<Dim>);
      for (const auto& body : {free, clamped_and_loaded(free)}) {
        INFO(Dim << " dimensions, " << describe(scheme) << ", based " << based << ", clamped "
                 << !body.clamped.empty());
        const bool far = !based && body.clamped.empty();  // clamps hold where the base state is
        const State<Dim> state = far ? far_state(problem, body) : random_state_of(body, 0.04, 7);
        FiniteStrainSimulation<Dim> simulation(problem, body);
        const auto expected = plain_accelerations(problem, body, state, law_of(scheme));
        const auto computed = accelerations_of<Dim>(simulation, state);
        CHECK(largest_force<Dim>(body, difference<Dim>(computed, expected)) / largest_force<Dim>(body, expected) <
              rounding);
      }
    }
}

template <int Dim>
void check_uniform_deformations() {
  Problem<Dim> problem = finite_strain_problem<Dim>(pk1);
  problem.deformation_gradient = stretch<Dim>();
  const auto body = disordered_block(problem, side<Dim>);
  const FiniteStrainSimulation<Dim> simulation(problem, body);
  const State<Dim> rest(body.size());
  for (const Tensor<Dim>& A : {Tensor<Dim>(Tensor<Dim>::Identity()), large_deformation<Dim>()})
    for (int a = 0; a < body.size(); ++a)
      CHECK((simulation.deformation_gradient(carried<Dim>(problem, body, rest, A), a) - A * stretch<Dim>()).norm() <
            rounding);
}

template <int Dim>
void check_rigid_motion() {
  for (const auto& scheme : finite_strain_schemes) {
    const auto problem = finite_strain_problem<Dim>(scheme);
    const auto body = disordered_block(problem, side<Dim>);
    FiniteStrainSimulation<Dim> simulation(problem, body);
    for (const double angle : {0.0, 1e-3, 1.0, 2.0, 3.1415926, -2.5}) {
      INFO(describe(scheme) << ", " << Dim << " dimensions, angle " << angle);
      State<Dim> moved = carried<Dim>(problem, body, State<Dim>(body.size()), turn<Dim>(angle));
      for (auto& s : moved.displacement) s += Vector<Dim>::Constant(1.7);
      CHECK(largest_force<Dim>(body, accelerations_of<Dim>(simulation, moved)) < rounding * force_scale(body));
      for (int a = 0; a < body.size(); ++a)
        CHECK(simulation.stress(moved, a).norm() < rounding * force_scale(body) * spacing);
    }
  }
}

template <int Dim>
void check_that_forces_turn_along() {
  for (const auto& scheme : finite_strain_schemes) {
    const auto problem = finite_strain_problem<Dim>(scheme);
    const auto body = disordered_block(problem, side<Dim>);
    FiniteStrainSimulation<Dim> simulation(problem, body);
    const auto state = random_state_of(body, 0.04, 7);
    const Tensor<Dim> Q = turn<Dim>(2.2);
    const auto turned = carried<Dim>(problem, body, state, Q);
    auto expected = accelerations_of<Dim>(simulation, state);
    for (auto& y : expected) y = Q * y;
    CHECK(largest_force<Dim>(body, difference<Dim>(accelerations_of<Dim>(simulation, turned), expected)) <
          rounding * force_scale(body));
    CHECK(simulation.strain_energy(turned) == Approx(simulation.strain_energy(state)).epsilon(rounding));
    CHECK((simulation.stress(turned, 1) - Q * simulation.stress(state, 1) * Q.transpose()).norm() <
          rounding * force_scale(body));
    CHECK(simulation.von_mises_stress(turned, 1) == Approx(simulation.von_mises_stress(state, 1)).epsilon(rounding));
  }
}

/// The largest |m_a F_a + ∂W/∂x_a| over the largest |m_a F_a|.
template <int Dim>
double distance_from_a_potential(const Scheme& scheme) {
  const auto problem = finite_strain_problem<Dim>(scheme);
  const auto body = disordered_block(problem, side<Dim>);
  const auto state = far_state(problem, body);
  const auto accelerations = accelerations_of(problem, body, state);
  const FiniteStrainSimulation<Dim, std::complex<double>> simulation(problem, body);
  State<Dim, std::complex<double>> carrying(body.size());
  for (int a = 0; a < body.size(); ++a)
    carrying.displacement[a] = state.displacement[a].template cast<std::complex<double>>();
  double distance = 0.0, largest = 0.0;
  for (int a = 0; a < body.size(); ++a)
    for (int i = 0; i < Dim; ++i) {
      auto& s = carrying.displacement[a][i];
      s.imag(1e-30);
      const double force = body.mass(a) * accelerations[a][i];
      distance = std::max(distance, std::abs(force + simulation.strain_energy(carrying).imag() / 1e-30));
      largest = std::max(largest, std::abs(force));
      s.imag(0.0);
    }
  return distance / largest;
}

/// Accelerations of a small displacement to first order, against those of linear elasticity with corrected gradients.
template <int Dim>
void check_small_strain() {
  for (const auto& scheme : finite_strain_schemes) {
    const auto problem = finite_strain_problem<Dim>(scheme);
    const auto body = disordered_block(problem, side<Dim>);
    const auto state = random_state_of(body, 1.0, 7);
    const auto simulation = make_simulation<Dim, std::complex<double>>(problem, body);
    const auto derivative = acceleration_derivative(*simulation, state.displacement);
    const auto expected = plain_accelerations<Dim>(problem, body, state, linear_stress);
    INFO(Dim << " dimensions, " << describe(scheme));
    CHECK(largest_force<Dim>(body, difference<Dim>(derivative, expected)) / largest_force<Dim>(body, expected) <
          rounding);
  }
}

/// How far the two schemes are apart when strains are of the order of `strain`.
double distance_of_schemes(double strain) {
  const auto problem = finite_strain_problem<2>(corotated);
  const auto body = disordered_block(problem, side<2>);
  const auto state = random_state_of(body, strain * spacing, 7);
  return largest_force<2>(body, difference<2>(accelerations_of(problem, body, state),
                                              accelerations_of(finite_strain_problem<2>(pk1), body, state)));
}

/// Three particles in a line, and one where it is put.
template <int Dim>
Body<Dim> body_of(const Problem<Dim>& problem, const std::vector<Vector<Dim>>& position) {
  Body<Dim> body{.position = position,
                 .volume = std::vector<double>(position.size(), 1.0),
                 .materials = {problem.material},
                 .material = std::vector<int>(position.size(), 0),
                 .pairs = find_pairs(position, problem.kernel.support())};
  return body;
}

template <int Dim>
void check_refusal(const Problem<Dim>& problem, const Body<Dim>& body, const std::string& message) {
  CHECK_THROWS_WITH((FiniteStrainSimulation<Dim>(problem, body)), Catch::Contains(message));
}

}  // namespace

TEST_CASE("finite strain: accelerations of disordered bodies of two materials are sums over all particles", "[fast]") {
  check_against_plain_sums<1>();
  check_against_plain_sums<2>();
  check_against_plain_sums<3>();
}

TEST_CASE("finite strain: the deformation gradient of a uniform deformation is exact, at edges too", "[fast]") {
  check_uniform_deformations<1>();
  check_uniform_deformations<2>();
  check_uniform_deformations<3>();
}

TEST_CASE("finite strain: a rigid motion by any angle gives no force and no stress", "[fast]") {
  check_rigid_motion<1>();
  check_rigid_motion<2>();
  check_rigid_motion<3>();
}

TEST_CASE("finite strain: forces and stresses turn with the body, energies do not change", "[fast]") {
  check_that_forces_turn_along<2>();
  check_that_forces_turn_along<3>();
}

TEST_CASE("the forces of tl-pk1 are the slopes of its energy, and those of tl-corotated are not", "[fast]") {
  for (const auto& scheme : {pk1, neo_hookean}) {
    CHECK(distance_from_a_potential<1>(scheme) < rounding);
    CHECK(distance_from_a_potential<2>(scheme) < rounding);
    CHECK(distance_from_a_potential<3>(scheme) < rounding);
  }
  CHECK(distance_from_a_potential<2>(corotated) > 0.01);
}

TEST_CASE("finite strain: to first order, forces about rest are those of linear elasticity with corrected gradients",
          "[fast]") {
  check_small_strain<1>();
  check_small_strain<2>();
  check_small_strain<3>();
}

TEST_CASE("tl-corotated and tl-pk1 part in the second order of strain", "[fast]") {
  CHECK(std::abs(std::log2(distance_of_schemes(2e-3) / distance_of_schemes(1e-3)) - 2.0) < order_margin);
}

TEST_CASE("finite strain: a base state is the same as its displacement put into the state", "[fast]") {
  for (const auto& scheme : finite_strain_schemes) {
    Problem<2> problem = finite_strain_problem<2>(scheme);
    const auto body = disordered_block(problem, side<2>);
    const auto state = random_state_of(body, 0.04, 7);
    State<2> moved = state;
    const Tensor<2> F0 = large_deformation<2>();
    for (int a = 0; a < body.size(); ++a) moved.displacement[a] += (F0 - Tensor<2>::Identity()) * body.position[a];
    FiniteStrainSimulation<2> in_state(problem, body);
    problem.deformation_gradient = F0;
    FiniteStrainSimulation<2> in_base(problem, body);
    CHECK(largest_force<2>(body, difference<2>(accelerations_of<2>(in_base, state),
                                               accelerations_of<2>(in_state, moved))) < rounding * force_scale(body));
    CHECK(in_base.strain_energy(state) == Approx(in_state.strain_energy(moved)).epsilon(rounding));
    CHECK((in_base.stress(state, 2) - in_state.stress(moved, 2)).norm() < rounding * force_scale(body));
  }
}

TEST_CASE("finite strain: a uniform base state of a patch gives no force", "[fast]") {
  for (const auto& scheme : finite_strain_schemes) {
    Problem<2> problem = finite_strain_problem<2>(scheme);
    problem.deformation_gradient = large_deformation<2>();
    const auto patch = periodic_patch(problem, LatticeIndex<2>(5, 4));
    CHECK(largest_force<2>(patch, accelerations_of(problem, patch, State<2>(patch.size()))) <
          rounding * force_scale(patch));
  }
}

TEST_CASE("finite strain: a stretched and turned block has the Cauchy stress and the energy of its principal stretches",
          "[fast]") {
  const Vector<2> l(1.3, 0.8);
  const double J = l.prod(), G = 2.3 / 2.6, lambda = 2.3 * 0.3 / (1.3 * 0.4);
  const Vector<2> E = 0.5 * (l.cwiseAbs2() - Vector<2>::Ones());
  const Vector<2> S = lambda * E.sum() * Vector<2>::Ones() + 2.0 * G * E;
  struct Expected {
    Scheme scheme;
    Vector<2> stress;
    double out_of_plane, energy;
  };
  const double W = 0.5 * lambda * E.sum() * E.sum() + G * E.squaredNorm();
  const double log_J = std::log(J);
  const Vector<2> neo_hookean_stress =
      (G * (l.cwiseAbs2() - Vector<2>::Ones()) + lambda * log_J * Vector<2>::Ones()) / J;
  for (const auto& [scheme, stress, out_of_plane, energy] :
       {Expected{corotated, S.cwiseProduct(l) / J, lambda * E.sum() / J, W},
        Expected{pk1, S.cwiseProduct(l.cwiseAbs2()) / J, lambda * E.sum() / J, W},
        Expected{neo_hookean, neo_hookean_stress, lambda * log_J / J,
                 0.5 * G * (l.squaredNorm() - 2.0) - G * log_J + 0.5 * lambda * log_J * log_J}}) {
    INFO(describe(scheme));
    const auto problem = finite_strain_problem<2>(scheme);
    Body<2> body = disordered_block(problem, side<2>);
    body.materials = {Material::from_young_modulus(density, 2.3, 0.3)};
    body.material.assign(body.size(), 0);
    const FiniteStrainSimulation<2> simulation(problem, body);
    const Tensor<2> Q = turn<2>(2.0);
    const auto state = carried<2>(problem, body, State<2>(body.size()), Q * l.asDiagonal());
    const double of_pairs = std::pow(stress[0] - stress[1], 2) + std::pow(stress[1] - out_of_plane, 2) +
                            std::pow(out_of_plane - stress[0], 2);
    double volume = 0.0;
    for (int a = 0; a < body.size(); ++a) {
      CHECK((simulation.stress(state, a) - Q * stress.asDiagonal() * Q.transpose()).norm() < rounding);
      CHECK(simulation.von_mises_stress(state, a) == Approx(std::sqrt(0.5 * of_pairs)).epsilon(rounding));
      CHECK(simulation.inertia(a) == Approx(density * body.volume[a]).epsilon(rounding));
      volume += body.volume[a];
    }
    CHECK(simulation.strain_energy(state) == Approx(volume * energy).epsilon(rounding));
  }
}

TEST_CASE("the perturbation energy counts strains of the base state alone: no translation, no rotation", "[fast]") {
  for (const auto& scheme : finite_strain_schemes) {
    Problem<3> problem = finite_strain_problem<3>(scheme);
    const Tensor<3> F0 = large_deformation<3>();
    problem.deformation_gradient = F0;
    const auto body = disordered_block(problem, side<3>);
    const FiniteStrainSimulation<3> simulation(problem, body);
    State<3> state(body.size());
    const auto energy_of = [&](const Tensor<3>& B) {
      for (int a = 0; a < body.size(); ++a) state.displacement[a] = B * body.position[a] + Vector<3>::Constant(0.7);
      return simulation.perturbation_energy(state);
    };
    CHECK(energy_of(Tensor<3>::Zero()) < rounding * rounding * force_scale(body));
    Tensor<3> spin;
    spin << 0.0, -0.3, 0.2, 0.3, 0.0, -0.1, -0.2, 0.1, 0.0;
    CHECK(energy_of(spin * F0) < rounding * rounding * force_scale(body));
    const Tensor<3> B = stretch<3>() * spin, e = 0.5 * (F0.transpose() * B + B.transpose() * F0);
    double expected = 0.0;
    for (int a = 0; a < body.size(); ++a) {
      const auto& made_of = body.material_of(a);
      const double lambda = made_of.bulk_modulus() - 2.0 / 3.0 * made_of.shear_modulus();
      expected += body.volume[a] * (0.5 * lambda * e.trace() * e.trace() + made_of.shear_modulus() * e.squaredNorm());
    }
    CHECK(energy_of(B) == Approx(expected).epsilon(rounding));
  }
}

TEST_CASE("finite strain: single precision tracks double precision", "[fast]") {
  for (const auto& scheme : finite_strain_schemes) {
    const auto problem = finite_strain_problem<3>(scheme);
    const auto body = disordered_block(problem, side<3>);
    const auto state = far_state(problem, body);
    State<3, float> single(body.size());
    for (int a = 0; a < body.size(); ++a) single.displacement[a] = state.displacement[a].cast<float>();
    FiniteStrainSimulation<3, float> simulation(problem, body);
    Field<3, float> acceleration(body.size());
    simulation.accelerations(single, acceleration);
    Field<3> converted;
    for (const auto& y : acceleration) converted.push_back(y.cast<double>());
    const auto expected = accelerations_of(problem, body, state);
    CHECK(largest_force<3>(body, difference<3>(converted, expected)) <
          float_rounding * largest_force<3>(body, expected));
  }
}

TEST_CASE("a particle whose neighbours lie in a plane, in a line or nowhere is named", "[fast]") {
  const Vector<2> along(0.3 * spacing, 0.7 * spacing);
  const auto flat = finite_strain_problem<2>(corotated);
  const std::vector<Vector<2>> line{Vector<2>::Zero(), along, 2.0 * along, Vector<2>(1.5, 0.2)};
  CHECK_NOTHROW(FiniteStrainSimulation<2>(flat, body_of<2>(flat, line)));
  check_refusal<2>(flat, body_of<2>(flat, {line.begin(), line.begin() + 3}),
                   "body: particle 0 at [0, 0] has its neighbours in a line: its gradients cannot be corrected");
  check_refusal<2>(flat, body_of<2>(flat, {line[0], line[1], line[3], Vector<2>(9.0, 0.5)}),
                   "body: particle 3 at [9, 0.5] has no neighbours");
  const auto bar = finite_strain_problem<1>(pk1);
  check_refusal<1>(bar, body_of<1>(bar, {Vector<1>(0.0), Vector<1>(0.5), Vector<1>(9.0)}),
                   "body: particle 2 at [9] has no neighbours");
  const auto space = finite_strain_problem<3>(pk1);
  check_refusal<3>(space, body_of<3>(space, {Vector<3>::Zero(), Vector<3>(0.5, 0.1, 0.7), Vector<3>(0.1, 0.7, 0.3)}),
                   "body: particle 0 at [0, 0, 0] has its neighbours in a plane");
}

TEST_CASE("each solver refuses the schemes of the others", "[fast]") {
  const auto plain = plain_problem();
  const auto body = free_plate(plain, LatticeIndex<2>(4, 4));
  check_refusal<2>(plain, body, "scheme: this solver runs tl-corotated and tl-pk1, not tl-linear");
  Problem<2> problem = plain;
  problem.scheme.formulation = Formulation::updated_lagrangian;
  check_refusal<2>(problem, body, "scheme: this solver runs tl-corotated and tl-pk1, not ul");
  CHECK_THROWS_WITH((make_simulation<2>(problem, body)), Catch::Contains("scheme: this solver runs tl-linear, not ul"));
  for (const auto& scheme : finite_strain_schemes) {
    problem.scheme = scheme;
    CHECK_THROWS_WITH((Simulation<2>(problem, body)), Catch::Contains("scheme: this solver runs tl-linear, not tl-"));
  }
  problem.scheme = neo_hookean;
  problem.scheme.formulation = Formulation::total_lagrangian_corotated;
  check_refusal<2>(problem, body, "elastic_law: tl-corotated runs saint-venant-kirchhoff, not neo-hookean");
  problem.scheme = corotated;
  problem.plane = Plane::stress;
  check_refusal<2>(problem, body, "plane: finite strain is plane strain, not stress");
}
