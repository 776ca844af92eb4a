// SPDX-License-Identifier: MIT
#include "study/zhang_statics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "analysis/spectrum.hpp"
#include "solver/simulation.hpp"
#include "solver/stress.hpp"
#include "study/relaxation.hpp"
#include "study/rigid_motion.hpp"
#include "study/zhang_cases.hpp"

namespace sphstab::study::zhang {
namespace {

using solver::Field;

/// Part of the critical step at which a body is relaxed (RelaxationOptions::time_step).
constexpr double step_fraction = 0.85;

constexpr int rigid_motions_of_a_plane = 3;

Field<2> to_field(const Eigen::VectorXd& components) {
  Field<2> field;
  for (int a = 0; 2 * a < components.size(); ++a) field.emplace_back(components.segment<2>(2 * a));
  return field;
}

RestState state_of(const Problem<2>& problem, const Body<2>& body, const Motions& motions,
                   const Field<2>& displacement) {
  const solver::Simulation<2> simulation(problem, body);
  solver::State<2> state(body.size());
  state.displacement = remove_rigid_motion(body, without(motions, problem, body, displacement));
  RestState rest{state.displacement, {}, {}};
  for (int a = 0; a < body.size(); ++a) {
    rest.strain.push_back(simulation.strain(state, a));
    rest.von_mises.push_back(simulation.von_mises_stress(state, a));
  }
  return rest;
}

}  // namespace

Motions nearly_rigid_motions(const Problem<2>& problem, const Body<2>& body) {
  Motions motions;
  for (const auto& mode : analysis::lowest_modes(problem, body, rigid_motions_of_a_plane))
    if (mode.kind == analysis::BodyModeKind::rigid) motions.push_back(to_field(mode.displacement));
  return motions;
}

Field<2> without(const Motions& motions, const Problem<2>& problem, const Body<2>& body, Field<2> field) {
  const solver::Simulation<2> simulation(problem, body);
  for (const auto& motion : motions) {
    double along = 0.0, square = 0.0;
    for (int a = 0; a < body.size(); ++a) {
      along += simulation.inertia(a) * motion[a].dot(field[a]);
      square += simulation.inertia(a) * motion[a].squaredNorm();
    }
    for (int a = 0; a < body.size(); ++a) field[a] -= along / square * motion[a];
  }
  return field;
}

RestState rest_by_theory(const Problem<2>& problem, const Body<2>& body, const Motions& motions) {
  return state_of(problem, body, motions, to_field(analysis::static_displacement(problem, body)));
}

RestState rest_by_running(const Problem<2>& problem, const Body<2>& body, const Motions& motions) {
  const auto limit = analysis::body_limit(problem, body, {.bound = analysis::BoundKind::norm_bound});
  const auto found =
      relax(problem, body, {.time_step = step_fraction * limit.critical_time_step, .tolerance = running_tolerance});
  return state_of(problem, body, motions, found.displacement);
}

RestState rest_of(const Body<2>& body, const std::function<ElasticState(const Vector<2>&)>& elastic_state) {
  RestState rest;
  for (const auto& x : body.position) {
    const ElasticState state = elastic_state(x);
    Tensor<3> stress = Tensor<3>::Zero();
    stress.topLeftCorner<2, 2>() = state.stress;
    rest.displacement.push_back(state.displacement);
    rest.strain.push_back(state.strain);
    rest.von_mises.push_back(solver::von_mises_stress(stress));
  }
  rest.displacement = remove_rigid_motion(body, rest.displacement);
  return rest;
}

RestErrors errors(const RestState& found, const RestState& expected, const std::vector<int>& particles) {
  double square = 0.0, whole = 0.0, largest = 0.0, most = 0.0;
  double stress_square = 0.0, stress_whole = 0.0, stress_largest = 0.0, stress_most = 0.0;
  for (const int a : particles) {
    const double error = (found.displacement[a] - expected.displacement[a]).norm();
    const double stress_error = std::abs(found.von_mises[a] - expected.von_mises[a]);
    square += error * error;
    whole += expected.displacement[a].squaredNorm();
    largest = std::max(largest, error);
    most = std::max(most, expected.displacement[a].norm());
    stress_square += stress_error * stress_error;
    stress_whole += expected.von_mises[a] * expected.von_mises[a];
    stress_largest = std::max(stress_largest, stress_error);
    stress_most = std::max(stress_most, expected.von_mises[a]);
  }
  return {.displacement = std::sqrt(square / whole),
          .largest_displacement = largest / most,
          .von_mises = std::sqrt(stress_square / stress_whole),
          .largest_von_mises = stress_largest / stress_most};
}

RestErrors errors(const RestState& found, const RestState& expected) {
  std::vector<int> all(expected.von_mises.size());
  std::iota(all.begin(), all.end(), 0);
  return errors(found, expected, all);
}

std::vector<double> kernel_sums(const Problem<2>& problem, const Body<2>& body) {
  std::vector<double> sums;
  for (int a = 0; a < body.size(); ++a) {
    double N = body.volume[a] * problem.kernel.value(0.0);
    for (int pair = body.pairs.first[a]; pair < body.pairs.first[a + 1]; ++pair)
      N += body.volume[body.pairs.neighbour[pair]] * problem.kernel.value(body.pairs.separation[pair].norm());
    sums.push_back(N);
  }
  return sums;
}

Body<2> with_normalised_load(const Problem<2>& problem, Body<2> body) {
  if (problem.scheme.kernel_normalisation == KernelNormalisation::none) return body;
  const auto N = kernel_sums(problem, body);
  for (int a = 0; a < body.size(); ++a) body.load[a] /= N[a];
  return body;
}

Points displaced(const Body<2>& body, const Field<2>& displacement) {
  Points points;
  for (int a = 0; a < body.size(); ++a) {
    const Vector<2> x = (body.position[a] + displacement[a]) / millimetre;
    points.emplace_back(x[0], x[1]);
  }
  return points;
}

io::LineFigure line_figure(const std::string& title, const std::string& x_label, const std::string& y_label) {
  io::LineFigure figure;
  figure.title = title;
  figure.x_label = x_label;
  figure.y_label = y_label;
  return figure;
}

io::ParticleFigure particle_figure(const std::string& title, const std::string& value_label) {
  return {.title = title,
          .x_label = "x [mm]",
          .y_label = "y [mm]",
          .value_label = value_label,
          .radius = 0.4 * particle_spacing / millimetre,
          .panels = {}};
}

std::string image(std::string_view caption, std::string_view number) {
  return fmt::format("![{}](figure_{}.svg)\n\n", caption, number);
}

Points undisplaced(const Body<2>& body) { return displaced(body, Field<2>(body.size(), Vector<2>::Zero())); }

}  // namespace sphstab::study::zhang
