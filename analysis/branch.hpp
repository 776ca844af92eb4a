// SPDX-License-Identifier: MIT
#pragma once

#include "model/names.hpp"

namespace sphstab {
namespace analysis {

/// The branch of a wave. In a strained base state the longitudinal polarisation is `coupling` D of AcousticForm, not
/// quite along D; the transverse ones are normal to D, two of them in 3-D.
enum class Branch { longitudinal, transverse };

}  // namespace analysis

template <>
struct Names<analysis::Branch> {
  static constexpr std::array<Named<analysis::Branch>, 2> table{
      {{analysis::Branch::longitudinal, "longitudinal"}, {analysis::Branch::transverse, "transverse"}}};
};

}  // namespace sphstab
