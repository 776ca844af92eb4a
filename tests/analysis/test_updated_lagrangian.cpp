// SPDX-License-Identifier: MIT
// Rung 0 of `ul`: one step of the plain nonlinear scheme of support/plain_updated.hpp on a periodic patch, linearised
// by dual numbers along Bloch waves, against E(k): J U = U E(k) for every column of U = e^{ik·x}.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <functional>
#include <string>

#include "analysis/amplification.hpp"
#include "analysis/dispersion.hpp"
#include "support/plain_updated.hpp"

using namespace sphstab;
using namespace sphstab::analysis;
using namespace sphstab::test;

namespace {

/// In units of spacing, density and sound speed near 1 entries of E are of order 1 to 10, sums of up to 60 terms below
/// 1 with a few roundings each on both sides: 2 · 60 · 4 · 2.2e-16. Seen: below 1e-14.
constexpr double rounding = 1e-13;
constexpr double time_step = 0.31;

template <int Dim>
struct Case {
  std::string name;
  Problem<Dim> problem;
};

template <int Dim>
Problem<Dim> plain_problem(const Lattice<Dim>& lattice, KernelFamily kernel, double h_over_spacing) {
  Problem<Dim> problem{.lattice = lattice,
                       .kernel = Kernel<Dim>(kernel, h_over_spacing * lattice.spacing()),
                       .material = Material::from_sound_speed(0.9, 1.2, 0.37),
                       .integrator = Integrator::leapfrog};
  problem.scheme.formulation = Formulation::updated_lagrangian;
  return problem;
}

/// Stresses off the axes: one principal stress of σ = S above zero, one (in 3-D) near it, one below.
template <int Dim>
Tensor<Dim> mixed_stress() {
  Tensor<3> S;
  S << 0.05, 0.08, -0.02, 0.08, -0.03, 0.04, -0.02, 0.04, -0.06;
  return S.topLeftCorner<Dim, Dim>();
}

/// Every term of the scheme, one by one and all together.
template <int Dim>
std::vector<Case<Dim>> every_term(const std::string& name, const Problem<Dim>& plain) {
  std::vector<Case<Dim>> cases;
  const auto add = [&](const std::string& term, const std::function<void(Problem<Dim>&)>& change) {
    Problem<Dim> problem = plain;
    change(problem);
    cases.push_back({name + ", " + term, problem});
  };
  using P = Problem<Dim>;
  using Linearisation = ArtificialStressLinearisation;
  const ArtificialStress weak{.epsilon = 0.3}, steep{.epsilon = 0.7, .exponent = 2.6};
  const auto with = [](ArtificialStress stress, Linearisation linearisation,
                       ArtificialStressWeight weight = ArtificialStressWeight::kernel_ratio) {
    stress.linearisation = linearisation;
    stress.weight = weight;
    return stress;
  };
  const Tensor<Dim> I = Tensor<Dim>::Identity();
  add("no stress", [](P&) {});
  add("pressure", [](P& p) { p.pressure = 0.11; });
  add("suction", [](P& p) { p.pressure = -0.07; });
  add("nearest neighbours under pressure", [](P& p) {
    p.pressure = 0.11;
    p.neighbour_rule = NeighbourRule::nearest;
  });
  add("XSPH", [](P& p) { p.scheme.xsph = Xsph{0.5}; });
  add("viscosity", [](P& p) { p.scheme.viscosity = Viscosity{0.8, 0.1}; });
  add("viscosity, pressure and XSPH", [](P& p) {
    p.scheme.viscosity = Viscosity{1.3, 0.0};
    p.scheme.xsph = Xsph{0.4};
    p.pressure = 0.2;
  });
  add("deviatoric stress off the axes", [](P& p) { p.deviatoric_stress = mixed_stress<Dim>(); });
  for (const auto linearisation : {Linearisation::exact, Linearisation::frozen}) {
    const std::string how(name_of(linearisation));
    add("artificial stress of isotropic tension, " + how, [=](P& p) {
      p.pressure = -0.07;
      p.scheme.artificial_stress = with(weak, linearisation);
    });
    add("artificial stress of equal principal stresses made of P and S, " + how, [=](P& p) {
      p.pressure = -0.04;
      p.deviatoric_stress = 0.03 * I;
      p.scheme.artificial_stress = with(weak, linearisation);
    });
    add("artificial stress of a pressure, " + how, [=](P& p) {
      p.pressure = 0.2;
      p.deviatoric_stress = mixed_stress<Dim>();
      p.scheme.artificial_stress = with(weak, linearisation);
    });
    add("artificial stress of tension and compression off the axes, " + how, [=](P& p) {
      p.deviatoric_stress = mixed_stress<Dim>();
      p.scheme.artificial_stress = with(weak, linearisation);
    });
    add("artificial stress of all but one tension, " + how, [=](P& p) {
      p.pressure = -0.03;
      p.deviatoric_stress = mixed_stress<Dim>();
      p.scheme.artificial_stress = with(steep, linearisation);
    });
    add("artificial stress of tension along an axis, " + how, [=](P& p) {
      p.pressure = 0.04;
      p.deviatoric_stress(0, 0) = 0.1;
      p.scheme.artificial_stress = with(weak, linearisation);
    });
    add("artificial stress by distance, " + how, [=](P& p) {
      p.pressure = -0.01;
      p.deviatoric_stress = mixed_stress<Dim>();
      p.scheme.artificial_stress = with(weak, linearisation, ArtificialStressWeight::distance_ratio);
    });
    add("everything, " + how, [=](P& p) {
      p.pressure = 0.02;
      p.deviatoric_stress = mixed_stress<Dim>() + 0.01 * I;
      p.scheme.artificial_stress = with(steep, linearisation);
      p.scheme.xsph = Xsph{0.5};
      p.scheme.viscosity = Viscosity{0.6, 0.2};
    });
  }
  return cases;
}

Tensor<2> some_deformation() {
  Tensor<2> F;
  F << 1.05, 0.12, -0.04, 0.93;
  return F;
}

template <int Dim>
std::vector<Case<Dim>> every_case();

template <>
std::vector<Case<1>> every_case() {
  std::vector<Case<1>> cases;
  const Lattice<1> chain(LatticeKind::chain, 1.1);
  for (const auto& [kernel, h] : {std::pair(KernelFamily::cubic_spline, 1.0),
                                  {KernelFamily::quintic_spline, 1.3},
                                  {KernelFamily::wendland_c4, 1.4},
                                  {KernelFamily::gaussian, 0.9}})
    for (auto& one : every_term<1>("chain " + std::string(name_of(kernel)), plain_problem(chain, kernel, h)))
      cases.push_back(one);
  return cases;
}

template <>
std::vector<Case<2>> every_case() {
  const Tensor<2> oblique = (Tensor<2>() << 1.0, 0.3, 0.1, 0.9).finished();
  std::vector<Case<2>> cases;
  const auto add = [&](const std::string& name, const Lattice<2>& lattice, KernelFamily kernel, double h) {
    for (auto& one : every_term<2>(name, plain_problem(lattice, kernel, h))) cases.push_back(one);
  };
  add("square cubic", Lattice<2>(LatticeKind::square, 1.1), KernelFamily::cubic_spline, 1.0);
  add("hexagonal Wendland", Lattice<2>(LatticeKind::hexagonal, 1.1), KernelFamily::wendland_c2, 1.35);
  add("staggered sinc", Lattice<2>(LatticeKind::staggered, 1.1), KernelFamily::sinc_5, 1.2);
  add("custom quartic", Lattice<2>(oblique, 1.1), KernelFamily::quartic_spline, 0.9);
  add("deformed square cubic", Lattice<2>(LatticeKind::square, 1.1).deformed(some_deformation()),
      KernelFamily::cubic_spline, 1.3);
  return cases;
}

template <>
std::vector<Case<3>> every_case() {
  std::vector<Case<3>> cases;
  const auto add = [&](const std::string& name, LatticeKind lattice, KernelFamily kernel, double h) {
    for (auto& one : every_term<3>(name, plain_problem(Lattice<3>(lattice, 1.1), kernel, h))) cases.push_back(one);
  };
  add("cubic cubic", LatticeKind::cubic, KernelFamily::cubic_spline, 0.8);
  add("fcc Wendland", LatticeKind::fcc, KernelFamily::wendland_c2, 0.75);
  return cases;
}

/// Patches need not be larger than the support: a particle then meets its images.
template <int Dim>
LatticeIndex<Dim> patch();
template <>
LatticeIndex<1> patch() {
  return LatticeIndex<1>(7);
}
template <>
LatticeIndex<2> patch() {
  return {4, 3};
}
template <>
LatticeIndex<3> patch() {
  return {2, 2, 3};
}

/// A generic mode, and one at the boundary of the zone in the first direction.
template <int Dim>
std::vector<LatticeIndex<Dim>> modes();
template <>
std::vector<LatticeIndex<1>> modes() {
  return {LatticeIndex<1>(1), LatticeIndex<1>(3)};
}
template <>
std::vector<LatticeIndex<2>> modes() {
  return {{1, 1}, {2, 0}, {3, -1}};
}
template <>
std::vector<LatticeIndex<3>> modes() {
  return {{1, 0, 1}, {1, 1, -1}};
}

/// The largest entry of J U − U E: the step of `stepped` about its base state, against the amplification matrix of
/// `problem`.
template <int Dim>
double step_error(const Problem<Dim>& problem, const Problem<Dim>& stepped, const LatticeIndex<Dim>& mode) {
  const PlainUpdatedScheme<Dim, Dual> scheme(stepped, patch<Dim>());
  const Vector<Dim> k = admitted_wave_vector(problem.lattice, patch<Dim>(), mode);
  const ComplexMatrix E = amplification_matrix(problem, k, time_step);
  const bool stores = problem.integrator == Integrator::predictor_corrector_pec;
  REQUIRE(E.rows() == plain_state_size<Dim> + (stores ? plain_rates_size<Dim> : 0));
  double worst = 0.0;
  for (int column = 0; column < E.cols(); ++column) {
    auto state = scheme.base_state();
    for (int a = 0; a < scheme.size(); ++a) set_slope<Dim>(state[a], column, std::polar(1.0, k.dot(scheme.site(a))));
    scheme.advance(state, time_step);
    for (int a = 0; a < scheme.size(); ++a) {
      const Eigen::VectorXcd expected = std::polar(1.0, k.dot(scheme.site(a))) * E.col(column);
      worst = std::max(worst, (slopes<Dim>(state[a], stores) - expected).template lpNorm<Eigen::Infinity>());
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("the dual numbers of the plain scheme are the limit of differences of its steps", "[fast]") {
  // Central differences of a map with third derivatives of order 100: (1e-5)² · 100 / 6, and 1e-15 / 1e-5.
  constexpr double difference_step = 1e-5, difference_tolerance = 1e-8;
  auto problem =
      every_term<2>("", plain_problem(Lattice<2>(LatticeKind::hexagonal, 1.1), KernelFamily::quintic_spline, 0.9))
          .back()
          .problem;
  problem.scheme.artificial_stress->linearisation = ArtificialStressLinearisation::exact;
  for (const auto& [integrator, name] : Names<Integrator>::table) {
    INFO(name);
    problem.integrator = integrator;
    const PlainUpdatedScheme<2, Dual> dual(problem, patch<2>());
    const PlainUpdatedScheme<2, double> real(problem, patch<2>());
    auto derivative = dual.base_state();
    derivative[0].y[0].slope = 0.8;
    derivative[0].v[1].slope = -0.5;
    derivative[0].rho.slope = 0.3;
    derivative[0].S(0, 0).slope = 0.4;
    dual.advance(derivative, time_step);
    const auto stepped = [&](double shift) {
      auto state = real.base_state();
      state[0].y[0] += 0.8 * shift;
      state[0].v[1] -= 0.5 * shift;
      state[0].rho += 0.3 * shift;
      state[0].S(0, 0) += 0.4 * shift;
      real.advance(state, time_step);
      return state;
    };
    const auto above = stepped(difference_step), below = stepped(-difference_step);
    for (std::size_t a = 0; a < above.size(); ++a)
      for (int i : {0, 1}) {
        const auto close = [&](double high, double low, const Dual& exact) {
          CHECK(std::abs((high - low) / (2.0 * difference_step) - exact.slope) < difference_tolerance);
        };
        close(above[a].y[i], below[a].y[i], derivative[a].y[i]);
        close(above[a].v[i], below[a].v[i], derivative[a].v[i]);
        close(above[a].rho, below[a].rho, derivative[a].rho);
        close(above[a].S(0, i), below[a].S(0, i), derivative[a].S(0, i));
      }
  }
}

TEMPLATE_TEST_CASE_SIG("rung 0: one step of Gray's scheme is its amplification matrix, term by term and all together",
                       "[fast]", ((int Dim), Dim), 1, 2, 3) {
  for (auto& [name, problem] : every_case<Dim>())
    for (const auto& [integrator, integrator_name] : Names<Integrator>::table)
      for (const auto& mode : modes<Dim>()) {
        INFO(name << ", " << integrator_name << ", mode " << mode.transpose());
        problem.integrator = integrator;
        CHECK(step_error<Dim>(problem, problem, mode) < rounding);
      }
}

TEMPLATE_TEST_CASE_SIG("rung 0: a principal stress of exactly zero is linearised from the side that is asked for",
                       "[fast]", ((int Dim), Dim), 1, 2, 3) {
  // The plain scheme stands this far on that side; 1e-15 of the other stresses is what that costs.
  constexpr double off_zero = 1e-15;
  Tensor<Dim> tension = Tensor<Dim>::Zero(), both = Tensor<Dim>::Zero();
  if (Dim > 1) tension(0, 0) = both(0, 0) = 0.1;
  if (Dim > 2) both(1, 1) = -0.07;
  for (const auto side : {ZeroStressSide::compression, ZeroStressSide::tension})
    for (const Tensor<Dim>& stress : {Tensor<Dim>(Tensor<Dim>::Zero()), tension, Tensor<Dim>(-tension), both}) {
      auto problem = plain_problem<Dim>(Lattice<Dim>(lattices_of(Dim).back(), 1.1), KernelFamily::quintic_spline, 0.7);
      problem.deviatoric_stress = stress;
      problem.scheme.artificial_stress = ArtificialStress{.epsilon = 0.4, .zero_side = side};
      auto stepped = problem;
      stepped.deviatoric_stress += (side == ZeroStressSide::tension ? off_zero : -off_zero) * Tensor<Dim>::Identity();
      INFO(name_of(side) << ", stress " << stress.diagonal().transpose());
      for (const auto& mode : modes<Dim>()) CHECK(step_error<Dim>(problem, stepped, mode) < rounding);
    }
}

TEMPLATE_TEST_CASE_SIG("rung 0: the dynamical matrix is that of the rates of Gray's scheme", "[fast]", ((int Dim), Dim),
                       1, 2, 3) {
  // d²y/dt² = κ (F_y y + F_q q) with dq/dt = D_v v and dy/dt = κ v: M = −κ F_y − F_q D_v.
  constexpr int rates_size = plain_rates_size<Dim>, state_size = plain_state_size<Dim>;
  for (const auto& [name, problem] : every_case<Dim>())
    for (const auto& mode : modes<Dim>()) {
      if (problem.scheme.viscosity) continue;
      INFO(name << ", mode " << mode.transpose());
      const PlainUpdatedScheme<Dim, Dual> scheme(problem, patch<Dim>());
      const Vector<Dim> k = admitted_wave_vector(problem.lattice, patch<Dim>(), mode);
      Eigen::MatrixXcd rates(rates_size, state_size), smoothed(Dim, state_size);
      for (int column = 0; column < state_size; ++column) {
        auto state = scheme.base_state();
        for (int a = 0; a < scheme.size(); ++a)
          set_slope<Dim>(state[a], column, std::polar(1.0, k.dot(scheme.site(a))));
        rates.col(column) = slopes<Dim>(scheme.rates(state)[0]);
        for (int i = 0; i < Dim; ++i) smoothed(i, column) = scheme.smoothed_velocities(state)[0][i].slope;
      }
      const Eigen::MatrixXcd kappa = smoothed.middleCols(Dim, Dim), F_y = rates.topLeftCorner(Dim, Dim),
                             F_q = rates.topRightCorner(Dim, rates_size - Dim),
                             D_v = rates.block(Dim, Dim, rates_size - Dim, Dim);
      const Eigen::MatrixXcd M = -kappa * F_y - F_q * D_v;
      CHECK((dynamical_matrix<Dim>(problem, k).template cast<std::complex<double>>() - M).norm() < rounding);
    }
}

TEMPLATE_TEST_CASE_SIG(
    "the waves of Gray's scheme are the eigenvalues of its dynamical matrix and travel as they "
    "differ",
    "[fast]", ((int Dim), Dim), 1, 2, 3) {
  // Central differences of ω, whose third derivative grows to some 100 where two branches come close: (1e-5)² · 100,
  // and of ω, 1e-13, the rounding over 1e-5.
  constexpr double difference_step = 1e-5, difference_tolerance = 5e-8;
  // Of eigenvalues of M that nearly coincide, of their sums and products.
  constexpr double eigenvalue_rounding = 1e-12;
  int travelling = 0;
  for (const auto& [name, problem] : every_case<Dim>()) {
    if (problem.scheme.viscosity) continue;
    INFO(name);
    const DispersionRelation<Dim> relation(problem);
    const Vector<Dim> k = Vector<3>(0.83, 0.41, -0.57).head<Dim>();
    const auto branches = relation(k);
    const Tensor<Dim> M = dynamical_matrix<Dim>(problem, k);
    std::complex<double> sum = 0.0, product = 1.0;
    for (const auto& branch : branches) {
      sum += branch.omega_squared;
      product *= branch.omega_squared;
      CHECK(std::abs(branch.growth_rate - std::abs(std::sqrt(branch.omega_squared).imag())) < eigenvalue_rounding);
    }
    CHECK(std::abs(sum - M.trace()) < eigenvalue_rounding);
    CHECK(std::abs(product - M.determinant()) < eigenvalue_rounding);
    for (int b = 0; b < Dim; ++b) {
      if (!branches[b].group_velocity) continue;
      ++travelling;
      for (int axis = 0; axis < Dim; ++axis) {
        const auto omega = [&](double shift) {
          return std::sqrt(relation(k + shift * Vector<Dim>::Unit(axis))[b].omega_squared).real();
        };
        const double slope = (omega(difference_step) - omega(-difference_step)) / (2.0 * difference_step);
        CHECK(std::abs((*branches[b].group_velocity)[axis] - slope) < difference_tolerance);
      }
    }
  }
  CHECK(travelling > 10);
}

TEST_CASE("the waves of Gray's scheme flutter where artificial stress couples them", "[fast]") {
  // theory.md §3 from the Jacobian of a nonlinear step of another implementation, to its last digit.
  constexpr double last_digit = 1e-4;
  auto problem = plain_problem(Lattice<2>(LatticeKind::staggered, 1.0), KernelFamily::cubic_spline, 1.2);
  problem.material = Material::from_sound_speed(1.0, 1.0, 0.3);
  problem.pressure = -0.05;
  problem.scheme.xsph = Xsph{0.5};
  problem.scheme.artificial_stress = ArtificialStress{.epsilon = 0.5};
  const auto branches = DispersionRelation<2>(problem)(std::numbers::pi * Vector<2>(0.4, 1.1333));
  for (int b : {0, 1}) {
    CHECK(branches[b].branch == Branch::coupled);
    CHECK(branches[b].omega_squared.real() == Approx(0.0930).margin(last_digit));
    CHECK(branches[b].omega_squared.imag() == Approx(b == 0 ? -0.0039 : 0.0039).margin(last_digit));
    CHECK(branches[b].growth_rate == Approx(0.0064).margin(last_digit));
  }
}

TEMPLATE_TEST_CASE_SIG("the eigenvalues of a step of Gray's scheme are the roots of its characteristic polynomial",
                       "[fast]", ((int Dim), Dim), 1, 2, 3) {
  // Σ λᵖ = tr Eᵖ for every p up to the size of E makes them so (Newton), and neither side minds multiple eigenvalues:
  // the roundings of products of up to 23 matrices of norm up to 3.
  constexpr double power_rounding = 1e-11;
  for (auto& [name, problem] : every_case<Dim>())
    for (const auto& [integrator, integrator_name] : Names<Integrator>::table) {
      INFO(name << ", " << integrator_name);
      problem.integrator = integrator;
      const Vector<Dim> k = Vector<3>(0.83, 0.41, -0.57).head<Dim>();
      const ComplexMatrix E = amplification_matrix(problem, k, time_step);
      const ModeSpectrum spectrum = mode_spectrum(problem, k, time_step);
      REQUIRE(spectrum.eigenvalues.size() == static_cast<std::size_t>(E.rows()));
      ComplexMatrix power = ComplexMatrix::Identity(E.rows(), E.cols());
      for (int p = 1; p <= E.rows(); ++p) {
        power = power * E;
        std::complex<double> sum = 0.0;
        for (const auto lambda : spectrum.eigenvalues) sum += std::pow(lambda, p);
        CHECK(std::abs(sum - power.trace()) < power_rounding);
      }
      double radius = 0.0;
      for (const auto lambda : spectrum.eigenvalues) radius = std::max(radius, std::abs(lambda));
      CHECK(spectrum.spectral_radius == radius);
    }
}

TEST_CASE("the state of Gray's scheme is named in order", "[fast]") {
  using Names = std::vector<std::string>;
  const auto names = []<int Dim>(Problem<Dim> problem, Integrator integrator) {
    problem.integrator = integrator;
    return state_names(problem);
  };
  const auto chain = plain_problem(Lattice<1>(LatticeKind::chain, 1.0), KernelFamily::cubic_spline, 1.3);
  const auto square = plain_problem(Lattice<2>(LatticeKind::square, 1.0), KernelFamily::cubic_spline, 1.3);
  const auto cubic = plain_problem(Lattice<3>(LatticeKind::cubic, 1.0), KernelFamily::cubic_spline, 1.3);
  CHECK(names(chain, Integrator::verlet) == Names{"x", "vx", "rho", "Sxx"});
  CHECK(names(square, Integrator::predictor_corrector) == Names{"x", "y", "vx", "vy", "rho", "Sxx", "Syy", "Sxy"});
  CHECK(names(square, Integrator::predictor_corrector_pec) ==
        Names{"x", "y", "vx", "vy", "rho", "Sxx", "Syy", "Sxy", "Fx", "Fy", "drho", "dSxx", "dSyy", "dSxy"});
  CHECK(names(cubic, Integrator::leapfrog) ==
        Names{"x", "y", "z", "vx", "vy", "vz", "rho", "Sxx", "Syy", "Szz", "Sxy", "Syz", "Sxz"});
}

TEST_CASE("a step of Gray's scheme is power-bounded where nothing grows and nothing drifts", "[fast]") {
  const auto square = plain_problem(Lattice<2>(LatticeKind::square, 1.0), KernelFamily::cubic_spline, 1.3);
  const auto chain = plain_problem(Lattice<1>(LatticeKind::chain, 1.0), KernelFamily::cubic_spline, 1.0);
  const Vector<2> generic(0.9, 0.4), boundary(std::numbers::pi, 0.0);
  const Vector<1> edge(std::numbers::pi), inner(1.3);
  const auto bounded = []<int Dim>(Problem<Dim> problem, Integrator integrator, const Vector<Dim>& k, double dt) {
    problem.integrator = integrator;
    return mode_spectrum(problem, k, dt).power_bounded;
  };
  auto pressed = chain, pulled = chain, viscous = chain;
  pressed.pressure = 0.1;
  pulled.pressure = -0.1;
  viscous.scheme.viscosity = Viscosity{1.0, 0.1};
  for (const auto integrator : {Integrator::leapfrog, Integrator::verlet}) {
    INFO(name_of(integrator));
    CHECK(bounded(square, integrator, generic, 0.3));
    CHECK_FALSE(bounded(square, integrator, boundary, 0.3));  // it drifts: A = 0
    CHECK(bounded(pressed, integrator, edge, 0.3));           // B > 0 pushes back
    CHECK_FALSE(bounded(pulled, integrator, edge, 0.3));      // … or away
    const double omega = std::sqrt(dynamical_matrix<1>(chain, inner)(0, 0));
    CHECK(bounded(chain, integrator, inner, 1.99 / omega));
    CHECK_FALSE(bounded(chain, integrator, inner, 2.0 / omega));  // a double λ = −1
    CHECK_FALSE(bounded(chain, integrator, inner, 2.01 / omega));
  }
  for (const auto integrator : {Integrator::predictor_corrector, Integrator::predictor_corrector_pec}) {
    INFO(name_of(integrator));
    CHECK_FALSE(bounded(square, integrator, generic, 0.3));
    CHECK_FALSE(bounded(chain, integrator, inner, 0.1));
    CHECK(bounded(viscous, integrator, inner, 0.1));
  }
  // Without stress rates (A = 0) it is velocity Verlet.
  const double omega = std::sqrt(dynamical_matrix<1>(pressed, edge)(0, 0));
  CHECK(bounded(pressed, Integrator::predictor_corrector, edge, 1.99 / omega));
  CHECK_FALSE(bounded(pressed, Integrator::predictor_corrector, edge, 2.01 / omega));
}
