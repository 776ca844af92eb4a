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

/// In units of spacing, density and sound speed near 1 entries of E are of order 1 to 10; both sides are sums of up to
/// some 100 terms with a few roundings each, of a curvature that W(0)/h² exceeds tenfold: 100 · 10 · 2.2e-16.
constexpr double rounding = 3e-13;
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
