// SPDX-License-Identifier: MIT
#include "study/dispersion.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include "analysis/critical_step.hpp"
#include "io/case_input.hpp"
#include "model/band_path.hpp"

using namespace sphstab;
using Catch::Matchers::Contains;
using study::Json;

namespace {

constexpr double pi = std::numbers::pi;
/// A few roundings of numbers of order one.
constexpr double rounding = 1e-13;

Case case_of(Json keys) {
  keys.update({{"scheme", "tl-linear"}, {"young_modulus", 1.3}, {"poisson_ratio", 0.3}, {"density", 1.0}});
  Case input;
  io::set_from_json(input, keys);
  return input;
}

Json points_of(const Json& keys) { return study::dispersion_answer(case_of(keys), {})["points"]; }

double number(const Json& value) { return value; }

template <int Dim>
Vector<Dim> vector(const Json& components) {
  Vector<Dim> result;
  for (int i = 0; i < Dim; ++i) result[i] = components[i];
  return result;
}

/// The labelled points of an answer with their distances.
std::vector<std::pair<std::string, double>> labels_of(const Json& points) {
  std::vector<std::pair<std::string, double>> labels;
  for (const Json& point : points)
    if (point.contains("label")) labels.emplace_back(point["label"], point["distance"]);
  return labels;
}

/// Equibiaxial compression beyond the stability of the continuous equation.
const Json squeezed{{"density_in_momentum", "equation-of-state"}, {"displacement_gradient", {-0.45, 0, 0, -0.45}}};

}  // namespace

TEST_CASE("a wave vector gives one point with every key of the interface", "[fast]") {
  for (const int dimension : {1, 2, 3}) {
    const std::vector<double> k{0.9, 0.4, -0.2};
    const Json wave_vector = std::vector<double>(k.begin(), k.begin() + dimension);
    const Json points = points_of({{"dimension", dimension}, {"wave_vector", wave_vector}});
    REQUIRE(points.size() == 1);
    const Json& point = points[0];
    std::set<std::string> keys;
    for (const auto& [key, value] : point.items()) keys.insert(key);
    CHECK(keys == std::set<std::string>{"wave_vector", "omega_squared", "growth_rate", "phase_speed", "group_speed",
                                        "group_velocity", "branches"});
    CHECK(point["wave_vector"] == wave_vector);
    for (const char* list : {"omega_squared", "phase_speed", "group_speed", "group_velocity", "branches"})
      CHECK(point[list].size() == static_cast<std::size_t>(dimension));
    for (int i = 0; i < dimension; ++i) {
      const Json& square = point["omega_squared"][i];
      REQUIRE(square.size() == 2);
      CHECK(number(square[1]) == 0.0);
      if (i > 0) CHECK(number(point["omega_squared"][i - 1][0]) <= number(square[0]));
      CHECK(point["branches"][i] == (i + 1 == dimension ? "longitudinal" : "transverse"));
      double length_squared = 0.0;
      REQUIRE(point["group_velocity"][i].size() == static_cast<std::size_t>(dimension));
      for (const Json& component : point["group_velocity"][i]) length_squared += number(component) * number(component);
      CHECK(number(point["group_speed"][i]) == Approx(std::sqrt(length_squared)).epsilon(rounding));
      double k_squared = 0.0;
      for (const Json& component : wave_vector) k_squared += number(component) * number(component);
      CHECK(std::pow(number(point["phase_speed"][i]), 2) == Approx(number(square[0]) / k_squared).epsilon(rounding));
    }
    CHECK(point["growth_rate"] == 0.0);
  }
}

TEST_CASE("mode and box name Zhang's wave vector", "[fast]") {
  CHECK(points_of({{"mode", {3, -1}}, {"box", {12, 8}}, {"spacing", 0.5}})[0]["wave_vector"] ==
        points_of({{"wave_vector", {pi / 2.0, -pi / 4.0}}, {"spacing", 0.5}})[0]["wave_vector"]);
}

TEST_CASE("waves that do not travel have null for their speeds, and the fastest growth is told", "[fast]") {
  const Json still = points_of({{"wave_vector", {pi, 0.0}}})[0];
  for (const char* list : {"phase_speed", "group_speed", "group_velocity"})
    CHECK(still[list] == Json({nullptr, nullptr}));
  CHECK(still["omega_squared"] == Json({{0.0, 0.0}, {0.0, 0.0}}));

  Json keys = squeezed;
  keys["wave_vector"] = {1.0, 0.2};
  const Json growing = points_of(keys)[0];
  CHECK(growing["branches"] == Json({"longitudinal", "transverse"}));
  for (const char* list : {"phase_speed", "group_speed", "group_velocity"}) {
    CHECK(growing[list][0].is_null());
    CHECK_FALSE(growing[list][1].is_null());
  }
  CHECK(number(growing["growth_rate"]) == Approx(std::sqrt(-number(growing["omega_squared"][0][0]))).epsilon(rounding));
}

TEST_CASE("a path has as many points as asked, hits its labels exactly and spreads the others by length", "[fast]") {
  const double edge = pi, diagonal = std::sqrt(2.0) * pi;
  for (const int count : {4, 5, 17, 200}) {
    const Json points = points_of({{"path_points", count}});
    REQUIRE(points.size() == static_cast<std::size_t>(count));
    const auto labels = labels_of(points);
    REQUIRE(labels.size() == 4);
    const std::vector<std::pair<std::string, double>> expected{
        {"Γ", 0.0}, {"X", edge}, {"M", 2.0 * edge}, {"Γ", 2.0 * edge + diagonal}};
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(labels[i].first == expected[i].first);
      CHECK(labels[i].second == Approx(expected[i].second).epsilon(rounding));
    }
    for (const Json& point : points)
      if (point.contains("label")) {
        const auto named = band_path(Lattice<2>(LatticeKind::square, 1.0)).stretches.front();
        CHECK(std::any_of(named.begin(), named.end(), [&](const auto& symmetric) {
          return symmetric.label == point["label"] && symmetric.wave_vector == vector<2>(point["wave_vector"]);
        }));
      }
    double shortest = 1e300, longest = 0.0;
    for (int i = 1; i < count; ++i) {
      const double step = number(points[i]["distance"]) - number(points[i - 1]["distance"]);
      CHECK(step == Approx((vector<2>(points[i]["wave_vector"]) - vector<2>(points[i - 1]["wave_vector"])).norm())
                        .epsilon(rounding * count));
      shortest = std::min(shortest, step);
      longest = std::max(longest, step);
    }
    // No line of n steps has a longest one that a step of another line could shorten: its n − 1 would be longer.
    CHECK(longest <= 2.0 * shortest);
    if (count == 200) CHECK(longest <= 1.03 * shortest);  // some fifty steps a line
  }
}

TEST_CASE("a path given by labels respects its breaks", "[fast]") {
  const Json points = points_of({{"path", "G-X|M-G"}, {"path_points", 20}});
  REQUIRE(points.size() == 20);
  const auto labels = labels_of(points);
  REQUIRE(labels.size() == 4);
  CHECK(labels[1].first == "X");
  CHECK(labels[2].first == "M");
  CHECK(labels[1].second == Approx(pi).epsilon(rounding));
  CHECK(labels[2].second == labels[1].second);
  CHECK(labels[3].second == Approx((1.0 + std::sqrt(2.0)) * pi).epsilon(rounding));
}

TEST_CASE("a grid covers the zone once", "[fast]") {
  const Json points = points_of({{"lattice", "hexagonal"}, {"grid", {6, 4}}});
  REQUIRE(points.size() == 24);
  const Lattice<2> lattice(LatticeKind::hexagonal, 1.0);
  std::set<std::pair<int, int>> classes;
  for (const Json& point : points) {
    CHECK_FALSE(point.contains("distance"));
    const Vector<2> k = vector<2>(point["wave_vector"]);
    // k·a_i/2π = i_j/n_j up to whole numbers; and no reciprocal vector is nearer than Γ.
    const Vector<2> turns = lattice.primitive_vectors().transpose() * k / (2.0 * pi);
    const auto index = [](double turn, int count) {
      const double scaled = turn * count;
      CHECK(std::abs(scaled - std::round(scaled)) < rounding * count);
      return (static_cast<int>(std::round(scaled)) % count + count) % count;
    };
    classes.emplace(index(turns[0], 6), index(turns[1], 4));
    for (int m = -1; m <= 1; ++m)
      for (int n = -1; n <= 1; ++n)
        CHECK((k - lattice.reciprocal_vectors() * Vector<2>(m, n)).norm() >= k.norm() * (1.0 - rounding));
  }
  CHECK(classes.size() == 24);
}

TEST_CASE("the highest wave of a fine grid is below the certified maximum of the zone, and near it", "[fast]") {
  const auto modes = analysis::BulkModes<2>(make_problem<2>(case_of({})));
  const double limit = std::get<analysis::ConditionallyStable<2>>(modes.limit()).critical_time_step;
  double highest = 0.0;
  for (const Json& point : points_of({{"grid", {64, 64}}}))
    highest = std::max(highest, number(point["omega_squared"][1][0]));
  CHECK(std::sqrt(highest) * limit <= 2.0 * (1.0 + rounding));
  // The maximum is at most half a cell off in both directions, δ = √2 π/64 = 0.07; there ω is lower by ½ δ² |ω''|/ω,
  // and |ω''|/ω < 7, the square of the reach of the support.
  CHECK(std::sqrt(highest) * limit >= 2.0 * (1.0 - 0.02));
}

TEST_CASE("contradictory and oversized requests are refused by name", "[fast]") {
  CHECK_THROWS_WITH(points_of({{"wave_vector", {1, 0}}, {"grid", {4, 4}}}), "wave_vector: cannot be given with grid");
  CHECK_THROWS_WITH(points_of({{"wave_vector", {1, 0}}, {"path", "G-X"}}), "wave_vector: cannot be given with path");
  CHECK_THROWS_WITH(points_of({{"grid", {4, 4}}, {"path_points", 30}}), "grid: cannot be given with path_points");
  CHECK_THROWS_WITH(points_of({{"wave_vector", {1, 0}}, {"mode", {1, 1}}}), "wave_vector: cannot be given with mode");
  CHECK_THROWS_WITH(points_of({{"box", {4, 4}}}), "wave_vector: missing (or mode with box)");
  CHECK_THROWS_WITH(points_of({{"grid", {4, 4, 4}}}), "grid: has 3 components, but 2 are needed");
  CHECK_THROWS_WITH(points_of({{"grid", {1001, 200}}}), "grid: 1001,200 multiply to more than 200000");
  CHECK_THROWS_WITH(points_of({{"path_points", 3}}),
                    "path_points: 3 is not at least 4, the labelled points of the path");
  for (const Json& keys :
       {Json{{"wave_vector", {1, 0}}}, Json{{"grid", {4, 4}}}, Json{{"mode", {1, 1}}, {"box", {4, 4}}}})
    CHECK_THROWS_WITH(study::band_figure(case_of(keys)),
                      "figure: shows the bands along a path, and cannot be given with " + keys.begin().key());
}

TEST_CASE("rows have plain columns that say what the points say", "[fast]") {
  const Json answer = study::dispersion_answer(case_of({{"dimension", 3}, {"path_points", 40}}), {});
  const Json rows = study::dispersion_rows(answer);
  REQUIRE(rows.size() == 40);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Json &row = rows[i], &point = answer["points"][i];
    for (const auto& [key, value] : row.items()) CHECK_FALSE(value.is_structured());
    CHECK(row.size() == 3 + 2 + 1 + 3 * 8);
    CHECK(row["ky"] == point["wave_vector"][1]);
    CHECK(row["distance"] == point["distance"]);
    CHECK(row["label"].is_null() != point.contains("label"));
    CHECK(row["growth_rate"] == point["growth_rate"]);
    CHECK(row["branch_3"] == point["branches"][2]);
    CHECK(row["omega_squared_1"] == point["omega_squared"][0][0]);
    CHECK(row["omega_squared_3_im"] == point["omega_squared"][2][1]);
    CHECK(row["phase_speed_2"] == point["phase_speed"][1]);
    CHECK(row["group_speed_3"] == point["group_speed"][2]);
    const Json& velocity = point["group_velocity"][2];
    CHECK(row["group_velocity_3_z"] == (velocity.is_null() ? Json() : velocity[2]));
  }
  const Json in_plane = study::dispersion_rows(study::dispersion_answer(case_of({{"wave_vector", {1, 0}}}), {}));
  CHECK(in_plane[0].size() == 2 + 1 + 2 * 7);
}

TEST_CASE("the band figure shows the frequencies of the answer beside those of the continuum", "[fast]") {
  // In units of c_p/Δp: ω of the answer times Δp/c_p, with c_p = √1.75 and Δp = 0.5.
  const Json keys{{"spacing", 0.5}, {"path", "G-X|M-G"}, {"path_points", 30}};
  const auto figure = study::band_figure(case_of(keys));
  const Json points = points_of(keys);
  const double unit = std::sqrt(1.75) / 0.5;
  REQUIRE(figure.curves.size() == 4);
  CHECK_THAT(figure.title,
             Contains("square lattice") && Contains("cubic-spline") && Contains("h = 1.3 Δp") && Contains("tl-linear"));
  double top = 0.0;
  for (const auto& [x, y] : figure.curves[0].points) top = std::fmax(top, y);
  for (std::size_t branch = 0; branch < 2; ++branch) {
    const auto &discrete = figure.curves[branch].points, &continuum = figure.curves[branch + 2].points;
    CHECK(figure.curves[branch].label == (branch == 0 ? "longitudinal" : "transverse"));
    CHECK(figure.curves[branch + 2].style == io::CurveStyle::dashed);
    REQUIRE(discrete.size() == points.size() + 2);  // a gap after each stretch
    std::size_t at = 0, shown = 0;
    for (std::size_t i = 0; i < discrete.size(); ++i) {
      if (std::isnan(discrete[i].second)) continue;
      const Json& point = points[at++];
      CHECK(discrete[i].first == number(point["distance"]));
      CHECK(discrete[i].second ==
            Approx(std::sqrt(number(point["omega_squared"][1 - branch][0])) / unit).epsilon(rounding).margin(rounding));
      const double exact =
          vector<2>(point["wave_vector"]).norm() * (branch == 0 ? std::sqrt(1.75) : std::sqrt(0.5)) / unit;
      CHECK(std::isnan(continuum[i].second) == (exact > top));
      if (exact > top) continue;
      CHECK(continuum[i].second == Approx(exact).epsilon(rounding));
      ++shown;
    }
    CHECK(at == points.size());
    CHECK(shown > 3);
  }
  REQUIRE(figure.x_ticks.size() == 3);
  CHECK(figure.x_ticks[1].label == "X|M");
  REQUIRE(figure.vertical_lines.size() == 3);
  CHECK(figure.vertical_lines[1].x == figure.x_ticks[1].x);
}

TEST_CASE("a branch that grows is drawn below zero", "[fast]") {
  Json keys = squeezed;
  keys["path_points"] = 31;
  keys["damping_rate"] = 0.3;
  const auto figure = study::band_figure(case_of(keys));
  const Json points = points_of(keys);
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(figure.curves[0].points[i].second ==
          Approx(-number(points[i]["growth_rate"]) / std::sqrt(1.75)).margin(rounding));
    CHECK(figure.curves[1].points[i].second >= 0.0);
  }
  CHECK_THAT(figure.title, Contains("strained"));
  CHECK_THAT(figure.y_label, Contains("growth"));
}

TEST_CASE("bands of ul stand in the order of omega squared, a coupled pair with frequency and growth", "[fast]") {
  Case input;
  io::set_from_json(input, {{"scheme", "ul"},
                            {"sound_speed", 1.0},
                            {"shear_modulus", 0.2},
                            {"pressure", -0.02},
                            {"deviatoric_stress", {0.08, -0.02, 0.06}},
                            {"path_points", 300}});
  const auto figure = study::band_figure(input);
  const Json points = study::dispersion_answer(input, {})["points"];
  const double unit = std::sqrt(1.0 + 4.0 / 3.0 * 0.2);
  REQUIRE(figure.curves.size() == 5);
  CHECK(figure.curves[2].label == "growth rate of a coupled pair");
  int coupled = 0, growing = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double growth = number(points[i]["growth_rate"]);
    for (std::size_t branch = 0; branch < 2; ++branch) {
      const Json& square = points[i]["omega_squared"][branch];
      const std::complex<double> omega = std::sqrt(std::complex<double>(number(square[0]), number(square[1])));
      const bool real = number(square[1]) == 0.0;
      coupled += !real;
      growing += real && number(square[0]) < 0.0;
      const double height = real && number(square[0]) < 0.0 ? -omega.imag() : omega.real();
      CHECK(figure.curves[branch].points[i].second == Approx(height / unit).margin(rounding));
      if (!real) CHECK(figure.curves[2].points[i].second == Approx(-growth / unit).epsilon(rounding));
      if (real) CHECK(std::isnan(figure.curves[2].points[i].second));
    }
  }
  CHECK(coupled > 4);
  CHECK(growing > 20);
  CHECK_THAT(figure.title, Contains("P = -0.02") && Contains("S = (0.08, -0.02, 0.06)"));
}

TEST_CASE("bands of ul at rest start along the s-waves and p-waves of the continuum", "[fast]") {
  Case input;
  io::set_from_json(input, {{"scheme", "ul"}, {"sound_speed", 1.0}, {"shear_modulus", 0.2}, {"path", "G-X"}});
  const auto figure = study::band_figure(input);
  REQUIRE(figure.curves.size() == 4);
  const double p_wave = std::sqrt(1.0 + 4.0 / 3.0 * 0.2), s_wave = std::sqrt(0.2);
  for (const auto& [curve, speed] : {std::pair(2, s_wave / p_wave), std::pair(3, 1.0)})
    for (std::size_t i = 0; i < 10; ++i) {
      const auto& [k, height] = figure.curves[curve].points[i];
      CHECK(height == Approx(speed * k).margin(rounding));
    }
}
