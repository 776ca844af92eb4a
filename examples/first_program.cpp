// SPDX-License-Identifier: MIT
// The critical time step of a total-Lagrangian SPH solid: in theory, then by running the solver on a free plate.
#include <cstdio>
#include <variant>

#include "analysis/critical_step.hpp"
#include "study/step_comparison.hpp"

using namespace sphstab;

int main() {
  const double spacing = 1e-3;  // m
  Problem<2> problem{.lattice = Lattice<2>(LatticeKind::square, spacing),
                     .kernel = Kernel<2>(KernelFamily::wendland_c2, 1.5 * spacing),
                     .material = Material::from_young_modulus(7800.0, 210e9, 0.3)};  // steel, SI units

  const auto limit = analysis::BulkModes(problem).limit();
  const auto* stable = std::get_if<analysis::ConditionallyStable<2>>(&limit);
  if (stable == nullptr) return 1;
  std::printf("infinite lattice:        %.6e s, between %.17g and %.17g\n", stable->critical_time_step,
              stable->bracket.low, stable->bracket.high);
  std::printf("critical wave length:    %.3f spacings\n",
              6.283185307179586 / stable->mode.wave_vector.norm() / spacing);

  const auto plate = study::compare_step<2>(problem, free_plate<2>(problem, {20, 10}), {.tolerance = 1e-6});
  std::printf("20 x 10 plate, run:      %.6e s\n", plate.run.critical_time_step.value());
  std::printf("20 x 10 plate, theory:   %.6e s\n", plate.theory.critical_time_step.value());

  problem.scheme.kernel_normalisation = KernelNormalisation::sum;
  const auto normalised = study::compare_step<2>(problem, free_plate<2>(problem, {20, 10}), {.tolerance = 1e-6});
  std::printf("the same, normalised:    %.6e s, %.3f of the infinite lattice\n",
              normalised.run.critical_time_step.value(),
              normalised.run.critical_time_step.value() / stable->critical_time_step);
}
