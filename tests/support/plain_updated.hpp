// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "model/lattice_index.hpp"
#include "model/problem.hpp"
#include "support/dual.hpp"

/// Gray, Monaghan & Swift's scheme written out as plainly as the paper has it, particle by particle on a periodic patch
/// of the lattice, for any scalar: with Dual numbers it is its own linearisation, with doubles it runs. The oracle of
/// analysis/updated_lagrangian and analysis/step_matrix, which it shares nothing with but the nouns of model/.
namespace sphstab::test {

/// The rates of v, ρ and S: F, D and dS/dt.
template <int Dim, class Scalar>
struct PlainRates {
  Vector<Dim, Scalar> F = Vector<Dim, Scalar>::Zero();
  Scalar rho = 0.0;
  Tensor<Dim, Scalar> S = Tensor<Dim, Scalar>::Zero();
};

template <int Dim, class Scalar>
struct PlainParticle {
  Vector<Dim, Scalar> y = Vector<Dim, Scalar>::Zero();  ///< displacement from its site
  Vector<Dim, Scalar> v = Vector<Dim, Scalar>::Zero();
  Scalar rho;
  Tensor<Dim, Scalar> S;
  PlainRates<Dim, Scalar> stored = {};  ///< of the step before, for `predictor-corrector-pec`
};

template <int Dim, class Scalar>
using PlainState = std::vector<PlainParticle<Dim, Scalar>>;

template <int Dim, class Scalar>
Scalar trace(const Tensor<Dim, Scalar>& tensor) {
  Scalar sum = 0.0;
  for (int i = 0; i < Dim; ++i) sum += tensor(i, i);
  return sum;
}

inline double value_of(double x) { return x; }
inline double value_of(const Dual& x) { return x.value; }

/// adj(A), the transposed matrix of cofactors.
template <int Dim, class Scalar>
Tensor<Dim, Scalar> adjugate(const Tensor<Dim, Scalar>& A) {
  if constexpr (Dim == 1) return Tensor<1, Scalar>(Scalar(1.0));
  Tensor<Dim, Scalar> adjoint;
  if constexpr (Dim == 2) adjoint << A(1, 1), -A(0, 1), -A(1, 0), A(0, 0);
  if constexpr (Dim == 3)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int p = (j + 1) % 3, q = (j + 2) % 3, s = (i + 1) % 3, t = (i + 2) % 3;
        adjoint(i, j) = A(p, s) * A(q, t) - A(p, t) * A(q, s);
      }
  return adjoint;
}

/// l n nᵀ of a simple eigenvalue l of a symmetric tensor, given to rounding: one Newton step on det(A − l I) makes it
/// follow a perturbation of A, and n nᵀ = adj(A − l I) / tr adj(A − l I).
template <int Dim, class Scalar>
Tensor<Dim, Scalar> spectral_part(const Tensor<Dim, Scalar>& A, double eigenvalue) {
  const Tensor<Dim, Scalar> I = Tensor<Dim, Scalar>::Identity(), shifted = A - Scalar(eigenvalue) * I;
  const Tensor<Dim, Scalar> adjoint = adjugate<Dim, Scalar>(shifted);
  Scalar determinant = 0.0;
  for (int j = 0; j < Dim; ++j) determinant += shifted(0, j) * adjoint(j, 0);
  const Scalar l = eigenvalue + determinant / trace<Dim, Scalar>(adjoint);
  const Tensor<Dim, Scalar> projector = adjugate<Dim, Scalar>(A - l * I);
  return l / trace<Dim, Scalar>(projector) * projector;
}

/// σ₊: the principal axes of σ with its positive principal stresses. In up to three dimensions it is 0, σ, the part of
/// the one positive stress or σ less the part of the one that is not, so that equal ones need no axes.
template <int Dim, class Scalar>
Tensor<Dim, Scalar> positive_part(const Tensor<Dim, Scalar>& sigma) {
  Tensor<Dim> values;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) values(i, j) = value_of(sigma(i, j));
  const Vector<Dim> principal = Eigen::SelfAdjointEigenSolver<Tensor<Dim>>(values).eigenvalues();
  const auto positive = (principal.array() > 0.0).count();
  if (positive == 0) return Tensor<Dim, Scalar>::Zero();
  if (positive == Dim) return sigma;
  if (positive == 1) return spectral_part<Dim, Scalar>(sigma, principal[Dim - 1]);
  return sigma - spectral_part<Dim, Scalar>(sigma, principal[0]);
}

template <int Dim, class Scalar>
class PlainUpdatedScheme {
 public:
  using State = PlainState<Dim, Scalar>;
  using VectorS = Vector<Dim, Scalar>;
  using TensorS = Tensor<Dim, Scalar>;

  PlainUpdatedScheme(const Problem<Dim>& problem, const LatticeIndex<Dim>& patch) : problem_(problem) {
    const LatticeIndex<Dim> zero = LatticeIndex<Dim>::Zero();
    for_each_index<Dim>(zero, patch - LatticeIndex<Dim>::Ones(),
                        [this](const LatticeIndex<Dim>& n) { sites_.push_back(n); });
    // |n_i| ≤ |b_i| r / 2π for a site at distance r.
    LatticeIndex<Dim> reach;
    for (int i = 0; i < Dim; ++i)
      reach[i] = static_cast<int>(std::ceil(problem.lattice.reciprocal_vectors().col(i).norm() *
                                            problem.kernel.support() / (2.0 * std::numbers::pi)));
    for (int a = 0; a < size(); ++a)
      for_each_index<Dim>(-reach, reach, [&](const LatticeIndex<Dim>& n) {
        const Vector<Dim> r_ab = -problem.lattice.site(n);
        if (n == zero || r_ab.norm() >= problem.kernel.support() * (1.0 - tie_margin)) return;
        pairs_.push_back({a, image_in(patch, sites_[a] + n), r_ab});
      });
    if (problem.neighbour_rule == NeighbourRule::nearest) {
      double nearest = problem.kernel.support();
      for (const Pair& pair : pairs_) nearest = std::min(nearest, pair.r_ab.norm());
      std::erase_if(pairs_, [=](const Pair& pair) { return pair.r_ab.norm() > 1.0001 * nearest; });
    }
    const State base = base_state();
    base_artificial_stress_ = artificial_stress(base.front().rho, base.front().S);
  }

  int size() const { return static_cast<int>(sites_.size()); }
  Vector<Dim> site(int a) const { return problem_.lattice.site(sites_[a]); }

  State base_state() const {
    return State(sites_.size(), {.rho = base_density(), .S = problem_.deviatoric_stress.template cast<Scalar>()});
  }

  /// v̂, Eq. 3.6.
  std::vector<VectorS> smoothed_velocities(const State& state) const {
    std::vector<VectorS> smoothed;
    for (const auto& particle : state) smoothed.push_back(particle.v);
    if (!problem_.scheme.xsph) return smoothed;
    for (const auto& [a, b, r0] : pairs_) {
      const VectorS r = separation(state, a, b, r0);
      const Scalar mean_density = 0.5 * (state[a].rho + state[b].rho);
      const Scalar factor = problem_.scheme.xsph->epsilon * mass() / mean_density * problem_.kernel.value(length(r));
      smoothed[a] += factor * (state[b].v - state[a].v);
    }
    return smoothed;
  }

  /// F, D (Eq. 3.8) and dS/dt (Eqs. 2.3 and 3.10).
  std::vector<PlainRates<Dim, Scalar>> rates(const State& state) const {
    std::vector<PlainRates<Dim, Scalar>> rates(state.size());
    std::vector<TensorS> gradient(state.size(), TensorS::Zero());  // ∂v̂_i/∂x_j
    const auto smoothed = smoothed_velocities(state);
    for (const auto& [a, b, r0] : pairs_) {
      const VectorS r = separation(state, a, b, r0), v_ab = smoothed[a] - smoothed[b];
      const Scalar distance = length(r);
      const VectorS dW = problem_.kernel.slope(distance) / distance * r;
      rates[a].F += mass() * (pair_stress(state[a], state[b], r, distance) * dW);
      rates[a].rho += mass() * dot(v_ab, dW);
      gradient[a] -= mass() / state[b].rho * (v_ab * dW.transpose());
    }
    const double mu = problem_.material.shear_modulus();
    for (std::size_t a = 0; a < state.size(); ++a) {
      const TensorS strain = 0.5 * (gradient[a] + gradient[a].transpose());
      const TensorS spin = 0.5 * (gradient[a] - gradient[a].transpose());
      const TensorS third = Scalar(trace<Dim, Scalar>(strain) / 3.0) * TensorS::Identity();
      rates[a].S = 2.0 * mu * (strain - third) + state[a].S * spin.transpose() + spin * state[a].S;
    }
    return rates;
  }

  /// One step of the problem's integrator.
  void advance(State& state, double dt) const {
    switch (problem_.integrator) {
      case Integrator::leapfrog: {
        kick(state, rates(state), dt);
        drift(state, dt);
        return;
      }
      case Integrator::verlet: {
        kick(state, rates(state), 0.5 * dt);
        drift(state, dt);
        kick(state, rates(state), 0.5 * dt);
        return;
      }
      case Integrator::predictor_corrector:
        predict_and_correct(state, rates(state), dt);
        return;
      case Integrator::predictor_corrector_pec: {
        std::vector<PlainRates<Dim, Scalar>> stored;
        for (const auto& particle : state) stored.push_back(particle.stored);
        const auto latest = predict_and_correct(state, stored, dt);
        for (std::size_t a = 0; a < state.size(); ++a) state[a].stored = latest[a];
        return;
      }
    }
  }

 private:
  struct Pair {
    int a, b;
    Vector<Dim> r_ab;  ///< of the sites
  };
  using Rates = std::vector<PlainRates<Dim, Scalar>>;

  /// The particle of the patch that this site is an image of.
  int image_in(const LatticeIndex<Dim>& patch, const LatticeIndex<Dim>& site) const {
    for (int b = 0; b < size(); ++b) {
      const LatticeIndex<Dim> shift = site - sites_[b];
      bool whole = true;
      for (int i = 0; i < Dim; ++i) whole = whole && shift[i] % patch[i] == 0;
      if (whole) return b;
    }
    return -1;
  }

  double sound_speed_squared() const { return problem_.material.bulk_modulus() / problem_.material.density(); }
  double base_density() const { return problem_.material.density() + problem_.pressure / sound_speed_squared(); }
  double mass() const { return base_density() * problem_.lattice.cell_volume(); }

  static Scalar dot(const VectorS& a, const VectorS& b) {
    Scalar sum = 0.0;
    for (int i = 0; i < Dim; ++i) sum += a[i] * b[i];
    return sum;
  }
  static Scalar length(const VectorS& r) {
    using std::sqrt;
    return sqrt(dot(r, r));
  }
  VectorS separation(const State& state, int a, int b, const Vector<Dim>& r0) const {
    return r0 + state[a].y - state[b].y;
  }

  /// σ = −P I + S with P of Eq. 2.7.
  TensorS stress(const Scalar& rho, const TensorS& S) const {
    return S - Scalar(sound_speed_squared() * (rho - problem_.material.density())) * TensorS::Identity();
  }

  /// R, Eqs. 6.4 to 6.7.
  TensorS artificial_stress(const Scalar& rho, const TensorS& S) const {
    if (!problem_.scheme.artificial_stress) return TensorS::Zero();
    return -problem_.scheme.artificial_stress->epsilon / (rho * rho) * positive_part<Dim, Scalar>(stress(rho, S));
  }

  /// The bracket of Eq. 3.12.
  TensorS pair_stress(const PlainParticle<Dim, Scalar>& a, const PlainParticle<Dim, Scalar>& b, const VectorS& r,
                      const Scalar& distance) const {
    using std::pow;
    TensorS sum = stress(a.rho, a.S) / Scalar(a.rho * a.rho) + stress(b.rho, b.S) / Scalar(b.rho * b.rho);
    if (const auto& viscosity = problem_.scheme.viscosity) {
      const double h = problem_.kernel.smoothing_length(), c0 = std::sqrt(sound_speed_squared());
      const Scalar softened = distance * distance + viscosity->eta * viscosity->eta * h * h;
      const Scalar Pi = viscosity->alpha * h * c0 * dot(VectorS(a.v - b.v), r) / (0.5 * (a.rho + b.rho) * softened);
      sum += Pi * TensorS::Identity();
    }
    if (const auto& artificial = problem_.scheme.artificial_stress) {
      const double spacing = problem_.lattice.spacing();
      const Scalar ratio = artificial->weight == ArtificialStressWeight::kernel_ratio
                               ? Scalar(problem_.kernel.value(distance) / problem_.kernel.value(spacing))
                               : Scalar(distance / spacing);
      const TensorS R = artificial->linearisation == ArtificialStressLinearisation::frozen
                            ? TensorS(2.0 * base_artificial_stress_)
                            : TensorS(artificial_stress(a.rho, a.S) + artificial_stress(b.rho, b.S));
      sum += pow(ratio, artificial->exponent) * R;
    }
    return sum;
  }

  static void kick(State& state, const Rates& rates, double dt) {
    for (std::size_t a = 0; a < state.size(); ++a) state[a].v += dt * rates[a].F;
  }

  /// r and q together by their rates at (r, v, q).
  void drift(State& state, double dt) const {
    const auto smoothed = smoothed_velocities(state);
    const auto rate = rates(state);
    for (std::size_t a = 0; a < state.size(); ++a) {
      state[a].y += dt * smoothed[a];
      state[a].rho += dt * rate[a].rho;
      state[a].S += dt * rate[a].S;
    }
  }

  /// Eqs. 6.14 to 6.18; the rates at the predicted state.
  Rates predict_and_correct(State& state, const Rates& first, double dt) const {
    const auto smoothed = smoothed_velocities(state);
    for (std::size_t a = 0; a < state.size(); ++a) {
      state[a].y += dt * smoothed[a] + 0.5 * dt * dt * first[a].F;
      state[a].v += dt * first[a].F;
      state[a].rho += dt * first[a].rho;
      state[a].S += dt * first[a].S;
    }
    const Rates second = rates(state);
    for (std::size_t a = 0; a < state.size(); ++a) {
      state[a].v += 0.5 * dt * (second[a].F - first[a].F);
      state[a].rho += 0.5 * dt * (second[a].rho - first[a].rho);
      state[a].S += 0.5 * dt * (second[a].S - first[a].S);
    }
    return second;
  }

  const Problem<Dim> problem_;
  std::vector<LatticeIndex<Dim>> sites_;
  std::vector<Pair> pairs_;
  TensorS base_artificial_stress_;
};

/// Components of a particle's state and rates in the order of `state`: x…, v…, rho, Sxx…; and Fx…, drho, dSxx….
template <int Dim>
inline constexpr int plain_state_size = 2 * Dim + 1 + symmetric_size<Dim>;
template <int Dim>
inline constexpr int plain_rates_size = Dim + 1 + symmetric_size<Dim>;

template <int Dim>
Eigen::VectorXcd slopes(const PlainRates<Dim, Dual>& rates) {
  Eigen::VectorXcd column(plain_rates_size<Dim>);
  for (int i = 0; i < Dim; ++i) column[i] = rates.F[i].slope;
  column[Dim] = rates.rho.slope;
  for (int c = 0; c < symmetric_size<Dim>; ++c) {
    const auto [i, j] = symmetric_places<Dim>[c];
    column[Dim + 1 + c] = rates.S(i, j).slope;
  }
  return column;
}

template <int Dim>
void set_slope(PlainRates<Dim, Dual>& rates, int component, std::complex<double> slope) {
  if (component < Dim)
    rates.F[component].slope = slope;
  else if (component == Dim)
    rates.rho.slope = slope;
  else {
    const auto [i, j] = symmetric_places<Dim>[component - Dim - 1];
    rates.S(i, j).slope = slope;
    rates.S(j, i).slope = slope;
  }
}

/// Of y, v, ρ, S and, from plain_state_size on, of the stored rates.
template <int Dim>
void set_slope(PlainParticle<Dim, Dual>& particle, int component, std::complex<double> slope) {
  if (component < Dim) {
    particle.y[component].slope = slope;
  } else if (component < 2 * Dim) {
    particle.v[component - Dim].slope = slope;
  } else if (component == 2 * Dim) {
    particle.rho.slope = slope;
  } else if (component < plain_state_size<Dim>) {
    const auto [i, j] = symmetric_places<Dim>[component - 2 * Dim - 1];
    particle.S(i, j).slope = slope;
    particle.S(j, i).slope = slope;
  } else {
    set_slope<Dim>(particle.stored, component - plain_state_size<Dim>, slope);
  }
}

template <int Dim>
Eigen::VectorXcd slopes(const PlainParticle<Dim, Dual>& particle, bool with_stored_rates) {
  Eigen::VectorXcd column(plain_state_size<Dim>);
  for (int i = 0; i < Dim; ++i) column[i] = particle.y[i].slope, column[Dim + i] = particle.v[i].slope;
  column[2 * Dim] = particle.rho.slope;
  for (int c = 0; c < symmetric_size<Dim>; ++c) {
    const auto [i, j] = symmetric_places<Dim>[c];
    column[2 * Dim + 1 + c] = particle.S(i, j).slope;
  }
  if (!with_stored_rates) return column;
  Eigen::VectorXcd both(plain_state_size<Dim> + plain_rates_size<Dim>);
  both << column, slopes<Dim>(particle.stored);
  return both;
}

/// The wave vector Σ (m_i / N_i) b_i that the patch admits.
template <int Dim>
Vector<Dim> admitted_wave_vector(const Lattice<Dim>& lattice, const LatticeIndex<Dim>& patch,
                                 const LatticeIndex<Dim>& mode) {
  return lattice.reciprocal_vectors() *
         (mode.template cast<double>().array() / patch.template cast<double>().array()).matrix();
}

}  // namespace sphstab::test
