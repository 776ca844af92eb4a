// SPDX-License-Identifier: MIT
#pragma once

namespace sphstab::solver::test {

/// How often this program has called operator new so far.
long allocations();

}  // namespace sphstab::solver::test
