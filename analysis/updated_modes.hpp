// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "analysis/critical_step.hpp"
#include "model/problem.hpp"

namespace sphstab::analysis {

/// The modes of `ul`, over the whole Brillouin zone or at given wave vectors, and what follows from them for any step.
template <int Dim>
class UpdatedModes {
 public:
  explicit UpdatedModes(const Problem<Dim>& problem);
  UpdatedModes(const Problem<Dim>& problem, std::vector<Vector<Dim>> wave_vectors);

  StepLimit<Dim> limit() const;

  /// Largest spectral radius of E.
  double spectral_radius(double time_step) const;

  /// The largest Δt such that no smaller one has a spectral radius above 1 + growth_per_step. Nothing where every Δt
  /// qualifies, or none does. Throws InvalidInput (`tolerated_growth_per_step`) if negative.
  std::optional<double> step_for_growth(double growth_per_step) const;

 private:
  Problem<Dim> problem_;
};

extern template class UpdatedModes<1>;
extern template class UpdatedModes<2>;
extern template class UpdatedModes<3>;

}  // namespace sphstab::analysis
