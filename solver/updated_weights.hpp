// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "model/kernel.hpp"
#include "model/scheme.hpp"
#include "solver/dual.hpp"

/// Kernels and weights of many pairs at once, in blocks that stay in the cache and fill the registers.
namespace sphstab::solver {

/// Kernels are evaluated in double precision or with derivatives.
template <class Scalar>
using Wide = std::conditional_t<std::is_same_v<Scalar, float>, double, Scalar>;

inline constexpr int pairs_a_block = 256;

/// One number for each pair of a block, on the stack.
template <class Scalar>
using PairBlock = Eigen::Array<Wide<Scalar>, Eigen::Dynamic, 1, Eigen::ColMajor, pairs_a_block, 1>;

/// xⁿ, n ≥ 1.
template <class Block>
Block whole_power(const Block& x, int n) {
  Block power = x;
  for (int i = 1; i < n; ++i) power *= x;
  return power;
}

template <class Block>
struct KernelBlock {
  Block value;  ///< W(r)
  Block slope;  ///< W'(r)
};

/// W and W' at the distances r < support, with the accuracy of model/kernel.hpp. Splines and Wendland kernels are
/// summed from their truncated powers, both from the same powers; the others are evaluated one by one.
template <int Dim, class Block>
KernelBlock<Block> kernel_block(const Kernel<Dim>& kernel, const Block& r) {
  using Scalar = typename Block::Scalar;
  const auto powers = truncated_powers(kernel.family(), Dim);
  if (powers.empty())
    return {r.unaryExpr([&](const Scalar& x) { return kernel.value(x); }),
            r.unaryExpr([&](const Scalar& x) { return kernel.slope(x); })};
  const Block q = Scalar(1.0 / kernel.smoothing_length()) * r;
  KernelBlock<Block> sum{Block::Zero(r.size()), Block::Zero(r.size())};
  for (const auto& term : powers) {
    const Block base = (Scalar(term.knot) - q).max(Scalar(0));
    const Block power = Scalar(term.coefficient) * whole_power(base, term.exponent - 1);
    sum.value += power * base;
    sum.slope -= Scalar(term.exponent) * power;
  }
  sum.value *= Scalar(kernel.normalisation());
  sum.slope *= Scalar(kernel.normalisation() / kernel.smoothing_length());
  return sum;
}

/// φ = fⁿ of the artificial stress, f = W(r)/W(Δp) or r/Δp (Gray et al., Eqs. 3.12, 3.13; errata.md T3).
template <int Dim, class Block>
Block artificial_stress_weights(const ArtificialStress& artificial, const Kernel<Dim>& kernel, double spacing,
                                const Block& r, const Block& W) {
  using Scalar = typename Block::Scalar;
  const Block f = artificial.weight == ArtificialStressWeight::kernel_ratio ? Block(W / Scalar(kernel.value(spacing)))
                                                                            : Block(r / Scalar(spacing));
  const double n = artificial.exponent;
  if (n == std::floor(n) && n >= 1.0 && n <= 16.0) return whole_power(f, static_cast<int>(n));
  return f.unaryExpr([n](const Scalar& x) {
    using std::pow;
    return Scalar(pow(x, n));
  });
}

}  // namespace sphstab::solver
