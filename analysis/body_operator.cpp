// SPDX-License-Identifier: MIT
#include "analysis/body_operator.hpp"

#include <algorithm>
#include <limits>

namespace sphstab::analysis {
namespace {

/// N_a.
template <int Dim>
double normalisation(const Problem<Dim>& problem, const Body<Dim>& body, int a) {
  if (problem.scheme.kernel_normalisation == KernelNormalisation::none) return 1.0;
  double N = body.volume[a] * problem.kernel.value(0.0);
  for (int p = body.pairs.first[a]; p < body.pairs.first[a + 1]; ++p)
    N += body.volume[body.pairs.neighbour[p]] * problem.kernel.value(body.pairs.separation[p].norm());
  return N;
}

}  // namespace

template <int Dim>
BodyOperator<Dim>::BodyOperator(const Problem<Dim>& problem, const Body<Dim>& body)
    : body_(body),
      root_inverse_mass_(Eigen::VectorXd::Zero(body.size() * Dim)),
      displacement_(body.size()),
      stress_(body.size()) {
  require_total_lagrangian(problem.scheme, "the spectrum of a body");
  if (problem.scheme.momentum_density == MomentumDensity::equation_of_state &&
      !problem.displacement_gradient.isZero(0.0))
    throw InvalidInput(
        "density_in_momentum: equation-of-state with a displacement_gradient is for infinite lattices, bodies take "
        "frozen");
  std::vector<LameConstants> lame;
  for (const Material& material : body.materials) lame.push_back(material.lame(problem.plane));

  const auto& pairs = body.pairs;
  gradient_.reserve(pairs.neighbour.size());
  for (int a = 0; a < body.size(); ++a) {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (int p = pairs.first[a]; p < pairs.first[a + 1]; ++p) {
      const Vector<Dim>& r_ab = pairs.separation[p];
      const double distance = r_ab.norm();
      gradient_.push_back(body.volume[pairs.neighbour[p]] * problem.kernel.slope(distance) / distance * r_ab);
      sum += gradient_.back();
    }
    own_gradient_.push_back(-sum);
    const double N = normalisation(problem, body, a);
    const auto& [lambda, shear_modulus, volume_factor] = lame[body.material[a]];
    moduli_.push_back({shear_modulus / N, lambda / N});
    for (int i = 0; i < Dim; ++i) {
      if (!body.clamped.empty() && body.clamped[a][i]) continue;
      root_inverse_mass_[a * Dim + i] = 1.0 / std::sqrt(body.mass(a) * N);
      unknowns_.push_back(a * Dim + i);
    }
  }
}

template <int Dim>
void BodyOperator<Dim>::apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  const int particles = body_.size();
  const int* const first = body_.pairs.first.data();
  const int* const neighbour = body_.pairs.neighbour.data();
  for (int a = 0; a < particles; ++a)
    displacement_[a] = root_inverse_mass_.template segment<Dim>(a * Dim).cwiseProduct(x.template segment<Dim>(a * Dim));
  for (int a = 0; a < particles; ++a) {
    const Vector<Dim> s_a = displacement_[a];
    Tensor<Dim> sum = Tensor<Dim>::Zero();
    for (int p = first[a]; p < first[a + 1]; ++p)
      sum.noalias() += (displacement_[neighbour[p]] - s_a) * gradient_[p].transpose();
    stress_[a] = moduli_[a].shear * (sum + sum.transpose()) + moduli_[a].lambda * sum.trace() * Tensor<Dim>::Identity();
  }
  for (int a = 0; a < particles; ++a) {
    const Tensor<Dim> sigma_a = stress_[a];
    Vector<Dim> force = Vector<Dim>::Zero();
    for (int p = first[a]; p < first[a + 1]; ++p) force.noalias() += (stress_[neighbour[p]] + sigma_a) * gradient_[p];
    y.template segment<Dim>(a * Dim) =
        -body_.volume[a] * root_inverse_mass_.template segment<Dim>(a * Dim).cwiseProduct(force);
  }
}

/// The blocks of S that couple a particle b to every c ≥ `from`, b's components in rows.
template <int Dim>
class BodyOperator<Dim>::Row {
 public:
  explicit Row(const BodyOperator& op) : op_(op), body_(op.body_), block_(body_.size(), Tensor<Dim>::Zero()) {}

  /// Visits (c, block) in ascending order.
  template <class Visit>
  void visit(int b, int from, const Visit& visit) {
    const auto& pairs = body_.pairs;
    add_strain_of(b, op_.own_gradient_[b], from);
    for (int p = pairs.first[b]; p < pairs.first[b + 1]; ++p) {
      const int a = pairs.neighbour[p];
      add_strain_of(a, -body_.volume[b] / body_.volume[a] * op_.gradient_[p], from);  // V_b ∇_a W_ab
    }
    std::sort(others_.begin(), others_.end());
    others_.erase(std::unique(others_.begin(), others_.end()), others_.end());
    for (const int c : others_) {
      visit(c, block_[c]);
      block_[c].setZero();
    }
    others_.clear();
  }

 private:
  /// The part of the strain energy of a, of which b's gradient is g_b:
  /// (V_a/N_a) (G [(g_b·g_c) I + g_c g_bᵀ] + λ g_b g_cᵀ).
  void add_strain_of(int a, const Vector<Dim>& g_b, int from) {
    const double shear = body_.volume[a] * op_.moduli_[a].shear, lambda = body_.volume[a] * op_.moduli_[a].lambda;
    const auto add = [&](int c, const Vector<Dim>& g_c) {
      if (c < from) return;
      others_.push_back(c);
      block_[c] +=
          shear * (g_b.dot(g_c) * Tensor<Dim>::Identity() + g_c * g_b.transpose()) + lambda * g_b * g_c.transpose();
    };
    add(a, op_.own_gradient_[a]);
    for (int q = body_.pairs.first[a]; q < body_.pairs.first[a + 1]; ++q)
      add(body_.pairs.neighbour[q], op_.gradient_[q]);
  }

  const BodyOperator& op_;
  const Body<Dim>& body_;
  std::vector<Tensor<Dim>> block_;
  std::vector<int> others_;
};

template <int Dim>
Eigen::SparseMatrix<double> BodyOperator<Dim>::matrix() const {
  std::vector<int> unknown(components(), -1);
  for (int i = 0; i < static_cast<int>(unknowns_.size()); ++i) unknown[unknowns_[i]] = i;
  Eigen::SparseMatrix<double> lower(unknowns_.size(), unknowns_.size());
  std::vector<std::pair<int, Tensor<Dim>>> blocks;
  Row row(*this);
  for (int b = 0; b < body_.size(); ++b) {
    blocks.clear();
    row.visit(b, b, [&](int c, const Tensor<Dim>& block) { blocks.emplace_back(c, block); });
    for (int j = b * Dim; j < (b + 1) * Dim; ++j) {
      if (unknown[j] < 0) continue;
      lower.startVec(unknown[j]);
      for (const auto& [c, block] : blocks)
        for (int i = c * Dim; i < (c + 1) * Dim; ++i)
          if (i >= j && unknown[i] >= 0)
            lower.insertBack(unknown[i], unknown[j]) =
                root_inverse_mass_[j] * block(j % Dim, i % Dim) * root_inverse_mass_[i];
    }
  }
  lower.finalize();
  return lower;
}

template <int Dim>
Eigen::MatrixXd BodyOperator<Dim>::places() const {
  Eigen::MatrixXd places(Dim, unknowns_.size());
  for (std::size_t i = 0; i < unknowns_.size(); ++i) places.col(i) = body_.position[unknowns_[i] / Dim];
  return places;
}

template <int Dim>
double BodyOperator<Dim>::norm_bound() const {
  double largest = 0.0;
  Row row(*this);
  for (int b = 0; b < body_.size(); ++b) {
    Vector<Dim> sums = Vector<Dim>::Zero();
    row.visit(b, 0, [&](int c, const Tensor<Dim>& block) {
      sums += block.cwiseAbs() * root_inverse_mass_.template segment<Dim>(c * Dim);
    });
    largest = std::max(largest, sums.cwiseProduct(root_inverse_mass_.template segment<Dim>(b * Dim)).maxCoeff());
  }
  return largest + rounding();
}

template <int Dim>
double BodyOperator<Dim>::rounding() const {
  const auto& pairs = body_.pairs;
  // Row sums of M⁻¹|S|, |S| with every term positive: a bound on the norm, as that matrix is symmetric in M.
  std::vector<Tensor<Dim>> stress;
  int most_neighbours = 0;
  for (int a = 0; a < body_.size(); ++a) {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (int p = pairs.first[a]; p < pairs.first[a + 1]; ++p) sum += 2.0 * gradient_[p].cwiseAbs();
    const Tensor<Dim> strain = Vector<Dim>::Ones() * sum.transpose();
    stress.push_back(moduli_[a].shear * (strain + strain.transpose()) +
                     std::abs(moduli_[a].lambda) * sum.sum() * Tensor<Dim>::Identity());
    most_neighbours = std::max(most_neighbours, pairs.first[a + 1] - pairs.first[a]);
  }
  double norm = 0.0;
  for (int a = 0; a < body_.size(); ++a) {
    Vector<Dim> force = Vector<Dim>::Zero();
    for (int p = pairs.first[a]; p < pairs.first[a + 1]; ++p)
      force += (stress[pairs.neighbour[p]] + stress[a]) * gradient_[p].cwiseAbs();
    const auto weight = root_inverse_mass_.template segment<Dim>(a * Dim).cwiseAbs2();
    norm = std::max(norm, body_.volume[a] * weight.cwiseProduct(force).maxCoeff());
  }
  constexpr int of_one_term = 16;  // products, the stress, the two roots of the masses
  return (2 * most_neighbours + of_one_term) * std::numeric_limits<double>::epsilon() * norm;
}

template class BodyOperator<1>;
template class BodyOperator<2>;
template class BodyOperator<3>;

}  // namespace sphstab::analysis
