// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/figure.hpp"
#include "model/body.hpp"
#include "solver/state.hpp"
#include "study/appendix_b.hpp"

/// Loaded bodies at rest, by theory, by running and by elasticity, as the reports on Zhang's cases compare them.
namespace sphstab::study::zhang {

/// A body at rest: rigid motion removed from the displacement. Lists indexed by particle.
struct RestState {
  solver::Field<2> displacement;
  std::vector<Tensor<2>> strain;
  std::vector<double> von_mises;  ///< a pressure
};

/// By conjugate gradients (analysis/spectrum.hpp).
RestState rest_by_theory(const Problem<2>& problem, const Body<2>& body);

/// By running with damping until the displacement is right to `running_tolerance` (study/relaxation.hpp).
RestState rest_by_running(const Problem<2>& problem, const Body<2>& body);
inline constexpr double running_tolerance = 1e-9;

/// By elasticity, where the particles are.
RestState rest_of(const Body<2>& body, const std::function<ElasticState(const Vector<2>& position)>& elastic_state);

/// Relative: over the norm, or the largest value, of what is expected.
struct RestErrors {
  double displacement;          ///< ‖s − s₀‖ / ‖s₀‖, over all particles
  double largest_displacement;  ///< max |s − s₀| / max |s₀|
  double von_mises;
  double largest_von_mises;
};

/// Over the chosen particles.
RestErrors errors(const RestState& found, const RestState& expected, const std::vector<int>& particles);
RestErrors errors(const RestState& found, const RestState& expected);

/// N_a = Σ_b V_b W_ab, W(0) included, of every particle.
std::vector<double> kernel_sums(const Problem<2>& problem, const Body<2>& body);

/// The body with the load of each particle divided by its N, if the scheme normalises: the momentum equation divided by
/// N as a whole, not its sum alone.
Body<2> with_normalised_load(const Problem<2>& problem, Body<2> body);

using Points = std::vector<std::pair<double, double>>;
inline constexpr double millimetre = 1e-3;

/// In millimetres, where the particles are when displaced.
Points displaced(const Body<2>& body, const solver::Field<2>& displacement);
/// … and at first.
Points undisplaced(const Body<2>& body);

}  // namespace sphstab::study::zhang
