// SPDX-License-Identifier: MIT
#pragma once

#include "model/tensor.hpp"

namespace sphstab {

/// Calls visit(n) for every index with low_i ≤ n_i ≤ high_i, the first component running fastest.
template <int Dim, class Visit>
void for_each_index(const LatticeIndex<Dim>& low, const LatticeIndex<Dim>& high, const Visit& visit) {
  if ((low.array() > high.array()).any()) return;
  LatticeIndex<Dim> n = low;
  for (;;) {
    visit(n);
    int axis = 0;
    while (axis < Dim && n[axis] == high[axis]) n[axis] = low[axis], ++axis;
    if (axis == Dim) return;
    ++n[axis];
  }
}

}  // namespace sphstab
