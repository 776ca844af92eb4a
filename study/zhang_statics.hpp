// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
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

/// Fields with one vector a particle, orthogonal in the masses ρ V N.
using Motions = std::vector<solver::Field<2>>;

/// The translations, and the motion that the scheme has in the place of the rotation: without a corrected gradient a
/// rotation is strain at the edges, and what meets next to no resistance is a rotation that differs from ring to ring.
/// A load in balance can still drive it.
Motions nearly_rigid_motions(const Problem<2>& problem, const Body<2>& body);

/// The field without its part along the motions.
solver::Field<2> without(const Motions& motions, const Problem<2>& problem, const Body<2>& body,
                         solver::Field<2> field);

/// By conjugate gradients (analysis/spectrum.hpp), and without its part along the motions.
RestState rest_by_theory(const Problem<2>& problem, const Body<2>& body, const Motions& motions = {});

/// By running with damping until the displacement is right to `running_tolerance` (study/relaxation.hpp).
RestState rest_by_running(const Problem<2>& problem, const Body<2>& body, const Motions& motions = {});
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

/// What is done about the edges: nothing; what the paper says, which divides the sums of Eqs. 7 and 9 by N; the same
/// with the load divided as well.
enum class Edge { plain, sums, sums_and_load };
inline constexpr std::array<Edge, 3> edges{Edge::plain, Edge::sums, Edge::sums_and_load};
inline constexpr std::array<std::string_view, 3> edge_names{"without", "with", "with, load too"};
inline constexpr std::array<KernelNormalisation, 3> normalisation_at{
    KernelNormalisation::none, KernelNormalisation::sum, KernelNormalisation::sum};
/// Of the first two in figures.
inline constexpr std::array<std::string_view, 2> names{"without normalisation", "with normalisation"};

using Points = std::vector<std::pair<double, double>>;
inline constexpr double millimetre = 1e-3;

/// In millimetres, where the particles are when displaced.
Points displaced(const Body<2>& body, const solver::Field<2>& displacement);
/// … and at first.
Points undisplaced(const Body<2>& body);

io::LineFigure line_figure(const std::string& title, const std::string& x_label, const std::string& y_label);

/// In millimetres, particles of 0.8 spacings.
io::ParticleFigure particle_figure(const std::string& title, const std::string& value_label = "");

/// A paragraph that shows the figure of that number.
std::string image(std::string_view caption, std::string_view number);

}  // namespace sphstab::study::zhang
