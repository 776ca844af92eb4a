// SPDX-License-Identifier: MIT
#include "study/relaxation.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "solver/simulation.hpp"
#include "study/bodies.hpp"

using namespace sphstab;
using namespace sphstab::study;
using namespace sphstab::study::test;

namespace {

/// The tolerance of a relaxation, and ten of it: its error is estimated from the slowest mode alone.
constexpr double tolerance = 1e-10, agreement = 1e-9;
/// Eigenvalues below this part of the largest are those of rigid translations, 0 to the rounding of 200 rows.
constexpr double rounding_of_spectrum = 1e-13;

/// The sum of 64 loads of 10 that is subtracted is wrong by up to 64 · 10 · 2.2e-16 a particle, beside pulls of
/// order 1. Within 50/ω under a damping of 2ω a body drifts by 25/ω² of that: 4e-12 of the displacement 1/ω².
constexpr double rounding_of_fall = 1e-11;

/// −K of the running forces in the symmetric form of their inertia, taken column by column, with its eigenvectors.
class Modes {
 public:
  Modes(const Problem<2>& problem, const Body<2>& body) : body_(body) {
    Body<2> unloaded = body;
    unloaded.load.clear();
    solver::Simulation<2> simulation(problem, unloaded);
    for (int a = 0; a < body.size(); ++a) root_of_inertia_.push_back(std::sqrt(simulation.inertia(a)));
    const int size = 2 * body.size();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
    solver::Field<2> acceleration(body.size());
    for (int column = 0; column < size; ++column) {
      if (is_clamped(column)) continue;
      solver::State<2> state(body.size());
      state.displacement[column / 2][column % 2] = 1.0;
      simulation.accelerations(state, acceleration);
      for (int row = 0; row < size; ++row)
        matrix(row, column) =
            -acceleration[row / 2][row % 2] * root_of_inertia_[row / 2] / root_of_inertia_[column / 2];
    }
    solver_.compute(matrix);
  }

  double critical_step() const { return 2.0 / std::sqrt(solver_.eigenvalues().maxCoeff()); }

  double slowest_frequency() const {
    for (const double square : solver_.eigenvalues())
      if (square > smallest()) return std::sqrt(square);
    return 0.0;
  }

  /// Σ_k (φ_k · f) φ_k / ω_k² over all modes but rigid ones, scaled by √m: where the loads move the body to.
  Eigen::VectorXd equilibrium() const {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(solver_.eigenvalues().size());
    for (int i = 0; i < load.size(); ++i)
      if (!is_clamped(i)) load[i] = body_.load[i / 2][i % 2] * root_of_inertia_[i / 2];
    Eigen::VectorXd amplitude = solver_.eigenvectors().transpose() * load;
    for (int k = 0; k < load.size(); ++k)
      amplitude[k] = solver_.eigenvalues()[k] > smallest() ? amplitude[k] / solver_.eigenvalues()[k] : 0.0;
    return solver_.eigenvectors() * amplitude;
  }

  Eigen::VectorXd scaled(const solver::Field<2>& displacement) const {
    Eigen::VectorXd field(2 * body_.size());
    for (int i = 0; i < field.size(); ++i) field[i] = displacement[i / 2][i % 2] * root_of_inertia_[i / 2];
    return field;
  }

 private:
  bool is_clamped(int i) const { return !body_.clamped.empty() && body_.clamped[i / 2][i % 2]; }
  double smallest() const { return rounding_of_spectrum * solver_.eigenvalues().maxCoeff(); }

  const Body<2>& body_;
  std::vector<double> root_of_inertia_;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver_;
};

void check(const Problem<2>& problem, const Body<2>& body) {
  for (const auto normalisation : {KernelNormalisation::none, KernelNormalisation::sum})
    for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
      Problem<2> posed = problem;
      posed.scheme.kernel_normalisation = normalisation;
      posed.integrator = integrator;
      INFO(name_of(normalisation) << ", " << name_of(integrator));
      const Modes modes(posed, body);
      const auto found = relax(posed, body, {.time_step = 0.85 * modes.critical_step(), .tolerance = tolerance});
      CHECK(found.converged);
      CHECK(found.residual < tolerance);
      const Eigen::VectorXd expected = modes.equilibrium(), computed = modes.scaled(found.displacement);
      CHECK((computed - expected).norm() < agreement * expected.norm());
    }
}

/// Pulled apart at its left and right ends, most in the middle.
Body<2> pulled(Body<2> plate, int side) {
  plate.load.assign(plate.size(), Vector<2>::Zero());
  for (int a = 0; a < plate.size(); ++a) {
    const double pull = 0.5 + std::min(plate.site[a][1], side - 1 - plate.site[a][1]);
    if (plate.site[a][0] == 0) plate.load[a][0] = -pull;
    if (plate.site[a][0] == side - 1) plate.load[a][0] = pull;
  }
  return plate;
}

}  // namespace

TEST_CASE("a clamped beam comes to rest where the modes of its forces put it", "[fast]") {
  const Problem<2> problem = plain_problem();
  check(problem, loaded(clamped_at_left(free_plate(problem, LatticeIndex<2>(12, 4))), {0.0, -1.0}));
}

TEST_CASE("a free plate that is pulled apart comes to rest, with its slow zero-energy modes", "[fast]") {
  const Problem<2> problem = plain_problem();
  const Body<2> plate = pulled(free_plate(problem, LatticeIndex<2>(10, 10)), 10);
  check(problem, plate);
  check(problem, jittered(plate, problem, 3));
}

TEST_CASE("a loaded beam of two materials comes to rest", "[fast]") {
  const Problem<2> problem = plain_problem();
  check(problem, loaded(clamped_at_left(of_two_materials(free_plate(problem, LatticeIndex<2>(8, 3)), 8)), {0.1, -1.0}));
}

TEST_CASE("what only makes a free body fall is left out, and its mass centre stays", "[fast]") {
  const Problem<2> problem = plain_problem();
  const Body<2> still = pulled(free_plate(problem, LatticeIndex<2>(8, 8)), 8);
  Body<2> falling = still;
  for (auto& load : falling.load) load += Vector<2>(0.7, -9.8);
  const RelaxationOptions options{.time_step = 0.85 * Modes(problem, still).critical_step()};
  const auto expected = relax(problem, still, options), found = relax(problem, falling, options);
  Vector<2> centre = Vector<2>::Zero();
  double largest = 0.0;
  for (int a = 0; a < still.size(); ++a) {
    CHECK((found.displacement[a] - expected.displacement[a]).norm() < agreement * found.displacement[a].norm());
    centre += found.displacement[a] / still.size();
    largest = std::max(largest, found.displacement[a].norm());
  }
  CHECK(centre.norm() < rounding_of_fall * largest);
}

TEST_CASE("a damping rate of the scheme is kept, and twice the slowest frequency is nearly what is found", "[fast]") {
  Problem<2> problem = plain_problem();
  const Body<2> beam = loaded(clamped_at_left(free_plate(problem, LatticeIndex<2>(12, 4))), {0.0, -1.0});
  const Modes modes(problem, beam);
  const RelaxationOptions options{.time_step = 0.85 * modes.critical_step()};
  const auto adapted = relax(problem, beam, options);
  CHECK(adapted.damping_rate == Approx(2.0 * modes.slowest_frequency()).epsilon(0.05));
  problem.scheme.damping = Damping{2.0 * modes.slowest_frequency()};
  const auto given = relax(problem, beam, options);
  CHECK(given.damping_rate == problem.scheme.damping->rate);
  CHECK(given.converged);
  CHECK(adapted.steps < 2 * given.steps);
}

TEST_CASE("relaxation says when it has not come to rest", "[fast]") {
  const Problem<2> problem = plain_problem();
  const Body<2> beam = loaded(clamped_at_left(free_plate(problem, LatticeIndex<2>(12, 4))), {0.0, -1.0});
  const double critical_step = Modes(problem, beam).critical_step();
  const auto stopped = relax(problem, beam, {.time_step = 0.85 * critical_step, .largest_steps = 100});
  CHECK_FALSE(stopped.converged);
  CHECK(stopped.steps == 100);
  CHECK(stopped.residual > tolerance);
  CHECK_FALSE(relax(problem, beam, {.time_step = 1.2 * critical_step}).converged);
}

TEST_CASE("a body without loads is at rest", "[fast]") {
  const Problem<2> problem = plain_problem();
  const auto found = relax(problem, free_plate(problem, LatticeIndex<2>(4, 4)), {.time_step = 0.1});
  CHECK(found.converged);
  CHECK(found.steps == 0);
}
