// SPDX-License-Identifier: MIT
#include "study/growth_answer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/dispersion.hpp"
#include "analysis/growth.hpp"
#include "analysis/lattice_sums.hpp"
#include "analysis/updated_lagrangian.hpp"
#include "model/brillouin_zone.hpp"
#include "study/ellipticity_answer.hpp"
#include "study/json_values.hpp"
#include "study/title.hpp"

namespace sphstab::study {
namespace {

/// Points of a figure along each axis.
constexpr int points_across = 201;

/// The problem with the artificial stress of another ε, which is as the other keys say even where there is none.
template <int Dim>
Problem<Dim> problem_with_epsilon(Case input, double epsilon) {
  input.set("artificial_stress_epsilon", epsilon);
  return make_problem<Dim>(input);
}

template <int Dim>
double tension_modulus_factor(const Problem<Dim>& problem) {
  return analysis::UpdatedLagrangian<Dim>(problem).tension_modulus_factor();
}

Json time_to_grow(double factor, double rate) { return rate > 0.0 ? Json(std::log(factor) / rate) : Json(); }

template <int Dim>
Json range_of(const Problem<Dim>& problem) {
  const auto range = analysis::growth_range(problem);
  return {{"verdict", range.growth_rate > 0.0 ? "unstable" : "stable"},
          {"growth_rate", range.growth_rate},
          {"e_folding_time", time_to_grow(std::numbers::e, range.growth_rate)},
          {"doubling_time", time_to_grow(2.0, range.growth_rate)},
          {"critical_mode", mode_json<Dim>(range.fastest)},
          {"omega_squared_min", range.omega_squared_min},
          {"omega_squared_max", range.omega_squared_max}};
}

template <int Dim>
Json one_sided_states(Problem<Dim> problem) {
  Json states;
  for (const auto& [side, name] : Names<ZeroStressSide>::table) {
    problem.scheme.artificial_stress->zero_side = side;
    const Json range = range_of(problem);
    for (const auto key : {"growth_rate", "omega_squared_min", "omega_squared_max"})
      states[std::string(name)][key] = range[key];
  }
  return states;
}

/// Which ε stabilise, and the price of the smallest.
template <int Dim>
void add_cure(Json& answer, const Case& input, const Progress& progress) {
  Json intervals = Json::array();
  for (const auto& interval : analysis::stabilising_epsilon(problem_with_epsilon<Dim>(input, 1.0), progress))
    intervals.push_back({interval.from, interval.to});
  const Json smallest = intervals.empty() ? Json() : intervals[0][0];
  answer["stabilising_epsilon"] = std::move(intervals);
  answer["smallest_stabilising_epsilon"] = smallest;
  answer["smallest_tension_modulus_factor"] =
      smallest.is_null() ? Json() : Json(tension_modulus_factor(problem_with_epsilon<Dim>(input, smallest)));
}

template <int Dim>
Json growth_answer(const Case& input, const Request& request) {
  const auto problem = make_problem<Dim>(input);
  Json answer = range_of(problem);
  if (is_finite_strain(problem.scheme.formulation)) answer["ellipticity"] = ellipticity_answer(problem);
  if (problem.scheme.damping) answer["note"] = "of the forces alone, damping_rate left out; dt has the rate with it";
  if (problem.scheme.viscosity) answer["note"] = "of the forces alone, viscosity left out";
  if (problem.scheme.formulation != Formulation::updated_lagrangian) return answer;
  const auto& artificial = problem.scheme.artificial_stress;
  answer["artificial_stress_epsilon"] = artificial ? artificial->epsilon : 0.0;
  answer["tension_modulus_factor"] = tension_modulus_factor(problem);
  if (request.wants("growth_rate_without_artificial_stress"))
    answer["growth_rate_without_artificial_stress"] =
        artificial ? analysis::growth_range(problem_with_epsilon<Dim>(input, 0.0)).growth_rate
                   : answer["growth_rate"].get<double>();
  if (request.wants("one_sided") && analysis::has_one_sided_states(problem))
    answer["one_sided"] = one_sided_states(problem);
  const auto weight =
      from_name<ArtificialStressWeight>("artificial_stress_weight", input.required_word("artificial_stress_weight"));
  const bool curable = analysis::has_weight(problem.kernel, problem.lattice.spacing(), weight);
  if (curable && (request.wants("stabilising_epsilon") || request.wants("smallest_stabilising_epsilon") ||
                  request.wants("smallest_tension_modulus_factor")))
    add_cure<Dim>(answer, input, request.progress);
  return answer;
}

/// The growth rate at one k, in continuous time without damping and viscosity.
template <int Dim>
class GrowthRates {
 public:
  explicit GrowthRates(Problem<Dim> problem) : relation_(without_friction(std::move(problem))) {}

  double operator()(const Vector<Dim>& wave_vector) const {
    double rate = 0.0;
    for (const auto& wave : relation_(wave_vector)) rate = std::max(rate, wave.growth_rate);
    return rate;
  }

 private:
  static Problem<Dim> without_friction(Problem<Dim> problem) {
    problem.scheme.damping.reset();
    problem.scheme.viscosity.reset();
    return problem;
  }

  analysis::DispersionRelation<Dim> relation_;
};

std::vector<double> equally_spaced(double low, double high) {
  std::vector<double> values;
  for (int i = 0; i < points_across; ++i) values.push_back(std::lerp(low, high, i / (points_across - 1.0)));
  return values;
}

io::LineFigure figure_of(const Problem<1>& problem) {
  const GrowthRates<1> rates(problem);
  const double edge = 0.5 * problem.lattice.reciprocal_vectors()(0, 0), spacing = problem.lattice.spacing();
  io::LineFigure figure;
  figure.title = "Growth on " + title_of(problem);
  figure.x_label = "k Δp / π";
  figure.y_label = "growth rate";
  figure.curves.emplace_back();
  for (const double k : equally_spaced(0.0, edge))
    figure.curves[0].points.emplace_back(k * spacing / std::numbers::pi, rates(Vector<1>(k)));
  return figure;
}

/// The corners of the first Brillouin zone one after the other, the first one again at the end, in π/Δp.
std::vector<std::pair<double, double>> zone_boundary(const Lattice<2>& lattice) {
  const IrreducibleWedge<2> whole(BrillouinZone<2>(lattice), {Tensor<2>::Identity()});
  auto corners = whole.vertices();
  std::sort(corners.begin(), corners.end(),
            [](const auto& a, const auto& b) { return std::atan2(a[1], a[0]) < std::atan2(b[1], b[0]); });
  corners.push_back(corners.front());
  std::vector<std::pair<double, double>> boundary;
  for (const auto& k : corners)
    boundary.emplace_back(k[0] * lattice.spacing() / std::numbers::pi, k[1] * lattice.spacing() / std::numbers::pi);
  return boundary;
}

io::LineFigure figure_of(const Problem<3>&) {
  throw InvalidInput("figure: growth is drawn over zones of one and two dimensions, not 3; dispersion draws a path");
}

}  // namespace

io::MapFigure growth_map(const Problem<2>& problem) {
  const GrowthRates<2> rates(problem);
  const double unit = std::numbers::pi / problem.lattice.spacing();
  const auto boundary = zone_boundary(problem.lattice);
  double widest = 0.0, highest = 0.0;
  for (const auto& [x, y] : boundary) {
    widest = std::max(widest, std::abs(x));
    highest = std::max(highest, std::abs(y));
  }
  io::MapFigure figure{.title = "Growth on " + title_of(problem),
                       .x_label = "k_x Δp / π",
                       .y_label = "k_y Δp / π",
                       .value_label = "growth rate",
                       .x = equally_spaced(-widest, widest),
                       .y = equally_spaced(-highest, highest),
                       .values = {},
                       .blank_label = "stable",
                       .outlines = {{"first Brillouin zone", boundary}},
                       .equal_units = true};
  for (const double y : figure.y)
    for (const double x : figure.x) {
      const double rate = rates(unit * Vector<2>(x, y));
      figure.values.push_back(rate > 0.0 ? rate : std::numeric_limits<double>::quiet_NaN());
    }
  return figure;
}

Json growth_answer(const Case& input, const Request& request) {
  return in_dimension(input, [&](auto dimension) { return growth_answer<dimension()>(input, request); });
}

std::variant<io::LineFigure, io::MapFigure> growth_figure(const Case& input) {
  return in_dimension(input, [&](auto dimension) -> std::variant<io::LineFigure, io::MapFigure> {
    if constexpr (dimension() == 2)
      return growth_map(make_problem<2>(input));
    else
      return figure_of(make_problem<dimension()>(input));
  });
}

}  // namespace sphstab::study
