// SPDX-License-Identifier: MIT
#include "analysis/body_operator.hpp"

#include <algorithm>
#include <limits>

namespace sphstab::analysis {

template <int Dim>
BodyOperator<Dim>::BodyOperator(const Problem<Dim>& problem, const Body<Dim>& body) : Base(problem, body) {
  if (problem.scheme.momentum_density == MomentumDensity::equation_of_state &&
      !problem.displacement_gradient.isZero(0.0))
    throw InvalidInput(
        "density_in_momentum: equation-of-state with a displacement_gradient is for infinite lattices, bodies take "
        "frozen");
  if (is_finite_strain(problem.scheme.formulation) && problem.deformation_gradient != Tensor<Dim>::Identity())
    throw InvalidInput("deformation_gradient: an operator about rest takes none");
  std::vector<LameConstants> lame;
  for (const Material& material : body.materials) lame.push_back(material.lame(problem.plane));
  const auto& pairs = body.pairs;
  for (int a = 0; a < body.size(); ++a) {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (int p = pairs.first[a]; p < pairs.first[a + 1]; ++p) sum += gradient_[p];
    own_gradient_.push_back(-sum);
    const double N = Base::normalisation_[a];
    const auto& [lambda, shear_modulus, volume_factor] = lame[body.material[a]];
    moduli_.push_back({shear_modulus / N, lambda / N});
  }
}

template <int Dim>
void BodyOperator<Dim>::apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  const auto stress = [this](int a, const Tensor<Dim>& gradient) -> Tensor<Dim> {
    return moduli_[a].shear * (gradient + gradient.transpose()) +
           moduli_[a].lambda * gradient.trace() * Tensor<Dim>::Identity();
  };
  if (renormalisation_.empty()) return Base::apply_with(stress, x, y);
  Base::apply_with(
      [&](int a, const Tensor<Dim>& gradient) -> Tensor<Dim> {
        return stress(a, gradient * renormalisation_[a]) * renormalisation_[a];
      },
      x, y);
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
  /// The part of the strain energy of a, of which b's gradient is g_b, N_a times `of_b` where it is renormalised:
  /// (V_a/N_a) (G [(g_b·g_c) I + g_c g_bᵀ] + λ g_b g_cᵀ).
  void add_strain_of(int a, const Vector<Dim>& of_b, int from) {
    const Vector<Dim> g_b = op_.renormalised(a, of_b);
    const double shear = body_.volume[a] * op_.moduli_[a].shear, lambda = body_.volume[a] * op_.moduli_[a].lambda;
    const auto add = [&](int c, const Vector<Dim>& of_c) {
      if (c < from) return;
      const Vector<Dim> g_c = op_.renormalised(a, of_c);
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
  std::vector<int> unknown(Base::components(), -1);
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
  // Row sums of M⁻¹|S|, |S| with every term positive: a bound on the norm, as that matrix is symmetric in M. The
  // rounding of N_a is at most that of its sum between two |N_a|, and what stands for N_a here is no less than |N_a|.
  std::vector<Tensor<Dim>> stress;
  int most_neighbours = 0;
  for (int a = 0; a < body_.size(); ++a) {
    Vector<Dim> sum = Vector<Dim>::Zero();
    Tensor<Dim> moments = Tensor<Dim>::Zero(), N = Tensor<Dim>::Identity();
    for (int p = pairs.first[a]; p < pairs.first[a + 1]; ++p) {
      sum += 2.0 * gradient_[p].cwiseAbs();
      moments += pairs.separation[p].cwiseAbs() * gradient_[p].cwiseAbs().transpose();
    }
    if (!renormalisation_.empty()) N = renormalisation_[a].cwiseAbs() * moments * renormalisation_[a].cwiseAbs();
    const Tensor<Dim> strain = Vector<Dim>::Ones() * (N * sum).transpose();
    stress.push_back((moduli_[a].shear * (strain + strain.transpose()) +
                      std::abs(moduli_[a].lambda) * strain.trace() * Tensor<Dim>::Identity()) *
                     N);
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
  const int sums = renormalisation_.empty() ? 2 : 4;
  return (sums * most_neighbours + of_one_term) * std::numeric_limits<double>::epsilon() * norm;
}

template class BodyOperator<1>;
template class BodyOperator<2>;
template class BodyOperator<3>;

}  // namespace sphstab::analysis
