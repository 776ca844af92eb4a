// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "model/body.hpp"

namespace sphstab::bodies {

template <int Dim>
Problem<Dim> problem(KernelFamily kernel, double h_over_spacing, KernelNormalisation normalisation) {
  constexpr LatticeKind kinds[] = {LatticeKind::chain, LatticeKind::square, LatticeKind::cubic};
  Problem<Dim> problem{.lattice = Lattice<Dim>(kinds[Dim - 1], 1.0),
                       .kernel = Kernel<Dim>(kernel, h_over_spacing),
                       .material = Material::from_young_modulus(1.7, 2.1, 0.35)};
  problem.scheme.kernel_normalisation = normalisation;
  return problem;
}

/// counts[0] × … particles of the cubic lattice, each moved by up to `jitter` spacings along each axis.
template <int Dim>
Body<Dim> block(const Problem<Dim>& problem, const LatticeIndex<Dim>& counts, double jitter = 0.0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-jitter, jitter);
  Body<Dim> body;
  body.materials = {problem.material};
  for (int n = 0; n < counts.prod(); ++n) {
    Vector<Dim> x;
    for (int axis = 0, rest = n; axis < Dim; rest /= counts[axis], ++axis) x[axis] = rest % counts[axis] + move(random);
    body.position.push_back(x);
    body.volume.push_back(1.0);
    body.material.push_back(0);
  }
  body.pairs = find_pairs(body.position, problem.kernel.support());
  return body;
}

/// The same with all that a body can have: volumes of their own, a second material a thousand times as dense in the
/// upper half, the first particles clamped, some in one direction only.
template <int Dim>
Body<Dim> mixed_block(const Problem<Dim>& problem, const LatticeIndex<Dim>& counts, double jitter, unsigned seed = 1) {
  Body<Dim> body = block(problem, counts, jitter, seed);
  body.materials.push_back(Material::from_young_modulus(1000.0 * problem.material.density(), 3.0, 0.4999));
  body.clamped.assign(body.position.size(), Directions<Dim>::Constant(false));
  for (int a = 0; a < body.size(); ++a) {
    body.material[a] = a >= body.size() / 2;
    body.volume[a] = 1.0 + 0.1 * std::sin(a);
  }
  body.clamped[0].setConstant(true);
  body.clamped[1][Dim - 1] = true;
  return body;
}

using Precise = boost::multiprecision::cpp_bin_float_50;

/// M^−½ S M^−½ over all components, clamped ones 0, by the equations of motion written out over all pairs of particles
/// with 50 digits; no list of neighbours, no symmetry is used:
///   ε_a = (1/N_a) sym Σ_b V_b (s_b − s_a) ⊗ ∇_a W_ab,  dv_a/dt = (1/(ρ_a N_a)) Σ_b V_b (σ_a + σ_b) ∇_a W_ab.
template <int Dim>
Eigen::MatrixXd printed_operator(const Problem<Dim>& problem, const Body<Dim>& body) {
  using PreciseVector = std::array<Precise, Dim>;
  using PreciseTensor = std::array<PreciseVector, Dim>;
  const int size = body.size();
  const auto gradient = [&](int a, int b) {
    PreciseVector r;
    Precise square = 0;
    for (int i = 0; i < Dim; ++i) {
      r[i] = Precise(body.position[a][i]) - Precise(body.position[b][i]);
      square += r[i] * r[i];
    }
    const Precise distance = sqrt(square);
    const bool near = a != b && distance < problem.kernel.support() * (1.0 - tie_margin);
    for (auto& component : r) component *= near ? problem.kernel.slope(distance) / distance : Precise(0);
    return r;
  };
  std::vector<Precise> N(size, 1);
  if (problem.scheme.kernel_normalisation == KernelNormalisation::sum)
    for (int a = 0; a < size; ++a) {
      N[a] = 0;
      for (int b = 0; b < size; ++b) {
        Precise square = 0;
        for (int i = 0; i < Dim; ++i) {
          const Precise r = Precise(body.position[a][i]) - Precise(body.position[b][i]);
          square += r * r;
        }
        N[a] += body.volume[b] * problem.kernel.value(Precise(sqrt(square)));
      }
    }
  const auto is_clamped = [&](int component) {
    return !body.clamped.empty() && body.clamped[component / Dim][component % Dim];
  };

  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size * Dim, size * Dim);
  for (int moved = 0; moved < size * Dim; ++moved) {
    if (is_clamped(moved)) continue;
    std::vector<PreciseTensor> stress(size);
    for (int a = 0; a < size; ++a) {
      PreciseTensor displacement_gradient{}, strain{};
      for (int b = 0; b < size; ++b) {
        if (a != moved / Dim && b != moved / Dim) continue;
        const Precise difference = (b == moved / Dim ? 1 : 0) - (a == moved / Dim ? 1 : 0);
        const PreciseVector dW = gradient(a, b);
        for (int j = 0; j < Dim; ++j)
          displacement_gradient[moved % Dim][j] += body.volume[b] * difference * dW[j] / N[a];
      }
      const Material& material = body.material_of(a);
      const Precise G = material.shear_modulus(), lambda = material.lame(problem.plane).lambda;
      Precise trace = 0;
      for (int i = 0; i < Dim; ++i) trace += displacement_gradient[i][i];
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) {
          strain[i][j] = (displacement_gradient[i][j] + displacement_gradient[j][i]) / 2;
          stress[a][i][j] = 2 * G * strain[i][j] + (i == j ? lambda * trace : Precise(0));
        }
    }
    const auto root_mass = [&](int component) {
      const int a = component / Dim;
      return sqrt(Precise(body.material_of(a).density()) * body.volume[a] * N[a]);
    };
    for (int a = 0; a < size; ++a) {
      PreciseVector acceleration{};
      for (int b = 0; b < size; ++b) {
        const PreciseVector dW = gradient(a, b);
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) acceleration[i] += body.volume[b] * (stress[a][i][j] + stress[b][i][j]) * dW[j];
      }
      for (int i = 0; i < Dim; ++i)
        if (!is_clamped(a * Dim + i))
          K(a * Dim + i, moved) = static_cast<double>(-acceleration[i] / (body.material_of(a).density() * N[a]) *
                                                      root_mass(a * Dim + i) / root_mass(moved));
    }
  }
  return K;
}

inline Eigen::VectorXd dense_eigenvalues(const Eigen::MatrixXd& matrix) {
  return matrix.selfadjointView<Eigen::Lower>().eigenvalues();
}

}  // namespace sphstab::bodies
