// SPDX-License-Identifier: MIT
#pragma once

#include "model/names.hpp"

namespace sphstab {
namespace analysis {

/// The branch of a wave. In a strained base state the longitudinal polarisation is `coupling` D of AcousticForm, not
/// quite along D; the transverse ones are normal to D, two of them in 3-D. In `ul` and finite strain the polarisation
/// decides, the nearer to k or to its normal. A complex pair of `ul` is coupled: neither.
enum class Branch { longitudinal, transverse, coupled };

}  // namespace analysis

template <>
struct Names<analysis::Branch> {
  static constexpr std::array<Named<analysis::Branch>, 3> table{{{analysis::Branch::longitudinal, "longitudinal"},
                                                                 {analysis::Branch::transverse, "transverse"},
                                                                 {analysis::Branch::coupled, "coupled"}}};
};

}  // namespace sphstab
