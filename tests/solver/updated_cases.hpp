// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "model/lattice_index.hpp"
#include "solver/updated_simulation.hpp"

/// Problems and states that the tests of the scheme `ul` share, and an independent reading of its equations.
namespace sphstab::solver::test {

inline constexpr double rho0 = 1.7, c0 = 1.2, mu = 0.6, dp = 0.8;

inline constexpr std::array<Integrator, 4> updated_integrators{
    Integrator::leapfrog, Integrator::verlet, Integrator::predictor_corrector, Integrator::predictor_corrector_pec};

template <int Dim>
Problem<Dim> updated_problem(double h_over_spacing = 1.3) {
  constexpr std::array rectangular{LatticeKind::chain, LatticeKind::square, LatticeKind::cubic};
  Problem<Dim> problem{.lattice = {rectangular[Dim - 1], dp},
                       .kernel = {KernelFamily::cubic_spline, h_over_spacing * dp},
                       .material = Material::from_sound_speed(rho0, c0, mu),
                       .scheme = {}};
  problem.scheme.formulation = Formulation::updated_lagrangian;
  return problem;
}

/// Artificial stress, XSPH and viscosity.
template <int Dim>
Problem<Dim> with_all_terms(Problem<Dim> problem) {
  problem.scheme.artificial_stress = ArtificialStress{.epsilon = 0.3};
  problem.scheme.xsph = Xsph{0.5};
  problem.scheme.viscosity = Viscosity{0.7, 0.1};
  return problem;
}

/// Every choice of terms and of their variants.
template <int Dim, class Visit>
void for_each_choice_of_terms(const Problem<Dim>& plain, const Visit& visit) {
  for (int terms = 0; terms < 8; ++terms)
    for (const auto weight : {ArtificialStressWeight::kernel_ratio, ArtificialStressWeight::distance_ratio})
      for (const auto pairs : {ViscousPairs::all, ViscousPairs::approaching})
        for (const auto rate : {DensityRate::masses, DensityRate::volumes}) {
          Problem<Dim> problem = with_all_terms(plain);
          problem.scheme.artificial_stress->weight = weight;
          if (!(terms & 1)) problem.scheme.artificial_stress.reset();
          if (!(terms & 2)) problem.scheme.xsph.reset();
          problem.scheme.viscosity->pairs = pairs;
          problem.scheme.density_rate = rate;
          if (!(terms & 4)) problem.scheme.viscosity.reset();
          visit(problem);
        }
}

/// Uniform in ±1, from a generator whose numbers the standard fixes.
class Noise {
 public:
  explicit Noise(unsigned seed) : generator_(seed) {}
  double operator()() { return 2.0 * static_cast<double>(generator_()) / 4294967295.0 - 1.0; }
  template <int Dim>
  Vector<Dim> vector() {
    Vector<Dim> v;
    for (int i = 0; i < Dim; ++i) v[i] = (*this)();
    return v;
  }
  template <int Dim>
  Tensor<Dim> symmetric() {
    Vector<symmetric_size<Dim>> components;
    for (int i = 0; i < symmetric_size<Dim>; ++i) components[i] = (*this)();
    return symmetric_tensor<Dim, double>(components);
  }

 private:
  std::mt19937 generator_;
};

/// Everything disturbed by `amplitude` of its own scale.
template <int Dim>
UpdatedState<Dim> disturbed(UpdatedState<Dim> state, double amplitude, unsigned seed) {
  Noise noise(seed);
  for (int a = 0; a < state.particles(); ++a) {
    state.position[a] += amplitude * dp * noise.vector<Dim>();
    state.velocity[a] += amplitude * c0 * noise.vector<Dim>();
    state.density[a] += amplitude * rho0 * noise();
    state.deviatoric_stress[a] += amplitude * rho0 * c0 * c0 * noise.symmetric<Dim>();
  }
  return state;
}

/// Gray, Monaghan & Swift once more, component by component over all pairs of particles and all images, with principal
/// axes from an eigen-solver.
template <int Dim>
class PaperEquations {
 public:
  PaperEquations(const Problem<Dim>& problem, std::vector<double> mass,
                 std::vector<Vector<Dim>> shifts = {Vector<Dim>::Zero()})
      : problem_(problem), mass_(std::move(mass)), shifts_(std::move(shifts)) {}

  /// (3.1), (3.12).
  Field<Dim> accelerations(const UpdatedState<Dim>& state) const {
    std::vector<Tensor<Dim>> sigma, R;
    for (int a = 0; a < state.particles(); ++a) {
      Tensor<Dim> stress = state.deviatoric_stress[a];
      for (int i = 0; i < Dim; ++i) stress(i, i) -= c0 * c0 * (state.density[a] - rho0);
      sigma.push_back(stress);
      R.push_back(Tensor<Dim>::Zero());
      if (const auto& artificial = problem_.scheme.artificial_stress) {
        const Eigen::SelfAdjointEigenSolver<Tensor<Dim>> axes(stress);
        for (int axis = 0; axis < Dim; ++axis) {
          const double principal = axes.eigenvalues()[axis];
          if (principal > 0.0)
            R[a] -= artificial->epsilon * principal / (state.density[a] * state.density[a]) *
                    axes.eigenvectors().col(axis) * axes.eigenvectors().col(axis).transpose();
        }
      }
    }
    Field<Dim> dv(state.particles(), Vector<Dim>::Zero());
    const double h = problem_.kernel.smoothing_length();
    for_each_pair(state, [&](int a, int b, const Vector<Dim>& r_ab) {
      const double r = r_ab.norm();
      double Pi = 0.0;
      if (const auto& viscosity = problem_.scheme.viscosity) {
        const double vr = (state.velocity[a] - state.velocity[b]).dot(r_ab);
        const double mean = 0.5 * (state.density[a] + state.density[b]);
        Pi = viscosity->alpha * h * c0 * vr / (mean * (r * r + std::pow(viscosity->eta * h, 2)));
        if (viscosity->pairs == ViscousPairs::approaching && vr > 0.0) Pi = 0.0;
      }
      double phi = 0.0;
      if (const auto& artificial = problem_.scheme.artificial_stress)
        phi = std::pow(artificial->weight == ArtificialStressWeight::kernel_ratio
                           ? problem_.kernel.value(r) / problem_.kernel.value(dp)
                           : r / dp,
                       artificial->exponent);
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) {
          const double dW = problem_.kernel.slope(r) * r_ab[j] / r;
          dv[a][i] += mass_[b] *
                      (sigma[a](i, j) / std::pow(state.density[a], 2) + sigma[b](i, j) / std::pow(state.density[b], 2) +
                       (i == j ? Pi : 0.0) + (R[a](i, j) + R[b](i, j)) * phi) *
                      dW;
        }
    });
    return dv;
  }

  /// (3.6).
  Field<Dim> smoothed(const UpdatedState<Dim>& state) const {
    Field<Dim> v = state.velocity;
    if (!problem_.scheme.xsph) return v;
    for_each_pair(state, [&](int a, int b, const Vector<Dim>& r_ab) {
      v[a] += problem_.scheme.xsph->epsilon * mass_[b] / (0.5 * (state.density[a] + state.density[b])) *
              (state.velocity[b] - state.velocity[a]) * problem_.kernel.value(r_ab.norm());
    });
    return v;
  }

  /// (3.8) or (3.9), (3.10), (2.3).
  UpdatedRates<Dim> rates(const UpdatedState<Dim>& state) const {
    const Field<Dim> v = smoothed(state);
    UpdatedRates<Dim> rates(state.particles());
    std::vector<Tensor<Dim>> gradient(state.particles(), Tensor<Dim>::Zero());  // (i, j): ∂v_j/∂x_i as printed
    for_each_pair(state, [&](int a, int b, const Vector<Dim>& r_ab) {
      const Vector<Dim> grad_W = problem_.kernel.slope(r_ab.norm()) / r_ab.norm() * r_ab;
      const double by_mass =
          problem_.scheme.density_rate == DensityRate::masses ? 1.0 : state.density[a] / state.density[b];
      rates.density[a] += by_mass * mass_[b] * (v[a] - v[b]).dot(grad_W);
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j)
          gradient[a](i, j) -= mass_[b] / state.density[b] * (v[a][j] - v[b][j]) * grad_W[i];
    });
    for (int a = 0; a < state.particles(); ++a) {
      const auto& S = state.deviatoric_stress[a];
      const auto& G = gradient[a];
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) {
          double rate = 2.0 * mu * (0.5 * (G(j, i) + G(i, j)) - (i == j ? G.trace() / 3.0 : 0.0));
          for (int k = 0; k < Dim; ++k)
            rate += S(i, k) * 0.5 * (G(k, j) - G(j, k)) + 0.5 * (G(k, i) - G(i, k)) * S(k, j);
          rates.deviatoric_stress[a](i, j) = rate;
        }
    }
    rates.acceleration = accelerations(state);
    return rates;
  }

 private:
  template <class Visit>
  void for_each_pair(const UpdatedState<Dim>& state, const Visit& visit) const {
    for (int a = 0; a < state.particles(); ++a)
      for (int b = 0; b < state.particles(); ++b)
        for (const auto& shift : shifts_) {
          const Vector<Dim> r_ab = state.position[a] - state.position[b] - shift;
          if (r_ab.norm() > 0.0 && r_ab.norm() < problem_.kernel.support()) visit(a, b, r_ab);
        }
  }

  Problem<Dim> problem_;
  std::vector<double> mass_;
  std::vector<Vector<Dim>> shifts_;
};

template <int Dim>
std::vector<double> masses(const UpdatedSimulation<Dim>& simulation) {
  std::vector<double> mass;
  for (int a = 0; a < simulation.particles(); ++a) mass.push_back(simulation.mass(a));
  return mass;
}

/// All translations of a box of these cells that can bring a particle into the support of another one.
template <int Dim>
std::vector<Vector<Dim>> box_translations(const Problem<Dim>& problem, const LatticeIndex<Dim>& cells) {
  std::vector<Vector<Dim>> shifts;
  LatticeIndex<Dim> farthest;
  for (int axis = 0; axis < Dim; ++axis) farthest[axis] = 1 + 6 / cells[axis];
  for_each_index<Dim>(-farthest, farthest, [&](const LatticeIndex<Dim>& n) {
    shifts.push_back(problem.lattice.site(n.cwiseProduct(cells)));
  });
  return shifts;
}

/// F, D and v̂ of a state.
template <int Dim, class Scalar>
UpdatedRates<Dim, Scalar> rates_of(UpdatedSimulation<Dim, Scalar>& simulation, const UpdatedState<Dim, Scalar>& state) {
  UpdatedRates<Dim, Scalar> rates(state.particles());
  simulation.place(state.position);
  simulation.forces(state, rates.acceleration);
  simulation.rates(state, simulation.smoothed(state), rates);
  return rates;
}

template <class Values>
double greatest_norm(const Values& values) {
  double norm = 0.0;
  for (const auto& x : values) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(x)>>)
      norm = std::max(norm, std::abs(static_cast<double>(x)));
    else
      norm = std::max(norm, static_cast<double>(x.norm()));
  }
  return norm;
}

/// The greatest difference of two fields in terms of the greatest value of the second, at least `scale`.
template <class Values>
double relative_difference(Values values, const Values& expected, double scale = 0.0) {
  for (std::size_t a = 0; a < values.size(); ++a) values[a] -= expected[a];
  return greatest_norm(values) / std::max(greatest_norm(expected), scale);
}

}  // namespace sphstab::solver::test
