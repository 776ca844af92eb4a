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

/// True for one of each pair n, −n, the one whose last component that is not zero is positive; false for 0.
template <int Dim>
bool in_upper_half(const LatticeIndex<Dim>& n) {
  int axis = Dim - 1;
  while (axis > 0 && n[axis] == 0) --axis;
  return n[axis] > 0;
}

}  // namespace sphstab
