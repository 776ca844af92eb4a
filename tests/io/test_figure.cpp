// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include <catch2/catch.hpp>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "io/figure.hpp"
#include "model/errors.hpp"

using namespace sphstab;
using namespace sphstab::io;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

Curve parabola(const std::string& label, CurveStyle style) {
  Curve curve{label, {}, style};
  for (int i = 1; i <= 10; ++i) curve.points.emplace_back(i, 0.5 * i * i);
  return curve;
}

LineFigure sample() {
  LineFigure figure;
  figure.title = "Critical time step";
  figure.x_label = "h / Δp";
  figure.y_label = "Δt c_p / Δp";
  figure.curves = {parabola("theory", CurveStyle::line), parabola("second theory", CurveStyle::dashed),
                   parabola("bisection", CurveStyle::points), parabola("both", CurveStyle::line_and_points)};
  figure.vertical_lines = {{1.3, "default h"}};
  figure.shades = {{1.0, 1.2, "too few"}};
  return figure;
}

/// 4 × 3 particles a length of 0.5 apart; values 0 … 11.
ParticleFigure particles() {
  ParticlePanel panel{.title = "(a) plate", .positions = {}};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 4; ++i) {
      panel.positions.emplace_back(0.5 * i, 0.5 * j);
      panel.values.push_back(4 * j + i);
    }
  return {.title = "Particles",
          .x_label = "x (m)",
          .y_label = "y (m)",
          .value_label = "von Mises stress (Pa)",
          .radius = 0.2,
          .panels = {panel}};
}

/// A marker as it stands in an SVG, in pixels.
struct Marker {
  double x, y, radius;
  std::string colour;
};

/// Filled circles are gnuplot's sixth marker, unfilled ones its fifth.
std::vector<Marker> markers(const std::string& svg, const std::string& id) {
  const std::regex pattern("'#" + id +
                           "' transform='translate\\(([\\d.]+),([\\d.]+)\\) scale\\(([\\d.]+)\\)' color='(.*?)'");
  std::vector<Marker> found;
  for (std::sregex_iterator match(svg.begin(), svg.end(), pattern), end; match != end; ++match)
    found.push_back({std::stod((*match)[1]), std::stod((*match)[2]), std::stod((*match)[3]), (*match)[4]});
  return found;
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

/// An environment variable with another value for a while.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name), before_(::getenv(name)) { ::setenv(name, value, 1); }
  ~Environment() { ::setenv(name_, before_.c_str(), 1); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::string before_;
};

/// 3 × 2 cells of values 0 … 5.
MapFigure map() {
  return {.title = "Growth over the zone",
          .x_label = "k_x",
          .y_label = "k_y",
          .value_label = "growth rate",
          .x = {-1.0, 0.0, 1.0},
          .y = {0.0, 1.0},
          .values = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0},
          .blank_label = "stable",
          .outlines = {{"zone", {{-1.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}}}}};
}

/// Where the picture of the cells stands, in pixels, and its PNG in base 64.
struct Picture {
  double x, y, width, height;
  std::string data;
};

Picture picture(const std::string& svg) {
  const std::regex pattern("<image x='([\\d.]+)' y='([\\d.]+)' width='([\\d.]+)' height='([\\d.]+)'");
  std::smatch match;
  REQUIRE(std::regex_search(svg, match, pattern));
  const auto begin = svg.find("base64,", match.position());
  REQUIRE(begin != std::string::npos);
  return {std::stod(match[1]), std::stod(match[2]), std::stod(match[3]), std::stod(match[4]),
          svg.substr(begin, svg.find("'", begin) - begin)};
}

}  // namespace

TEST_CASE("a figure is a whole SVG with every label", "[fast]") {
  const std::string svg = render_svg(sample());
  CHECK_THAT(svg, Contains("<svg") && EndsWith("</svg>\n\n"));
  for (const auto* label : {"Critical time step", "h / Δp", "Δt c_p / Δp", "theory", "second theory", "bisection",
                            "both", "default h", "too few"})
    CHECK_THAT(svg, Contains(">" + std::string(label) + "<"));
}

TEST_CASE("the same figure has the same bytes", "[fast]") { CHECK(render_svg(sample()) == render_svg(sample())); }

TEST_CASE("another number or another label makes another figure", "[fast]") {
  const std::string svg = render_svg(sample());
  LineFigure moved = sample(), renamed = sample(), logarithmic = sample();
  moved.curves[0].points[4].second *= 1.1;
  renamed.curves[2].label = "Bisection";
  logarithmic.y_log = true;
  CHECK(render_svg(moved) != svg);
  CHECK(render_svg(renamed) != svg);
  CHECK(render_svg(logarithmic) != svg);
}

TEST_CASE("curves differ by dash as well as by colour", "[fast]") {
  LineFigure figure;
  for (int i = 0; i < 3; ++i) figure.curves.push_back(parabola("curve", CurveStyle::line));
  const std::string svg = render_svg(figure);
  CHECK(count(svg, "stroke-dasharray") == 2);
  CHECK(count(svg, "stroke-dasharray='16.0,5.0'") == 1);
  for (const auto* colour : {"rgb(  0, 114, 178)", "rgb(213,  94,   0)", "rgb(  0, 158, 115)"})
    CHECK_THAT(svg, Contains(colour));
}

TEST_CASE("text is printed as it is, whatever it would mean to a shell, to gnuplot or to XML", "[fast]") {
  LineFigure figure = sample();
  figure.title = "it's \"`echo run`\" $HOME {x}_2^3 @y \\n 50%\nset output";
  figure.curves[0].label = "a_b & <c>";
  const std::string svg = render_svg(figure);
  CHECK_THAT(svg, Contains(">it's \"`echo run`\" $HOME {x}_2^3 @y \\n 50% set output<"));
  CHECK_THAT(svg, Contains(">a_b &amp; &lt;c><"));
}

TEST_CASE("labels can stand in place of the numbers of the x axis", "[fast]") {
  LineFigure figure;
  figure.curves = {parabola("", CurveStyle::line)};
  figure.x_ticks = {{1, "Γ"}, {5, "X"}, {10, "M"}};
  const std::string svg = render_svg(figure);
  for (const auto* label : {"Γ", "X", "M"}) CHECK_THAT(svg, Contains(">" + std::string(label) + "<"));
}

TEST_CASE("a point that is not finite is a gap in its curve", "[fast]") {
  LineFigure figure;
  figure.curves = {parabola("", CurveStyle::line)};
  const std::string whole = render_svg(figure);
  figure.curves[0].points[4].second = std::numeric_limits<double>::quiet_NaN();
  CHECK(count(render_svg(figure), " M") == count(whole, " M") + 1);
}

TEST_CASE("a figure without a point to draw is a fault that repeats what gnuplot says", "[fast]") {
  LineFigure figure;
  figure.curves = {{"", {{1.0, std::numeric_limits<double>::quiet_NaN()}}}};
  CHECK_THROWS_WITH(render_svg(figure), StartsWith("gnuplot: ") && Contains("undefined"));
}

TEST_CASE("particles stand where they are, of their size, along axes of equal units", "[fast]") {
  constexpr double pixel = 0.02;  // gnuplot writes hundredths
  const std::string svg = render_svg(particles());
  const auto drawn = markers(svg, "gpPt6");
  REQUIRE(drawn.size() == 12);
  const double spacing = drawn[1].x - drawn[0].x;
  CHECK(spacing > 50.0);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 4; ++i) {
      CHECK(drawn[4 * j + i].x == Approx(drawn[0].x + i * spacing).margin(4 * pixel));
      CHECK(drawn[4 * j + i].y == Approx(drawn[0].y - j * spacing).margin(4 * pixel));  // y points up
      CHECK(drawn[4 * j + i].radius == Approx(0.2 / 0.5 * spacing).margin(2 * pixel));
    }
  for (const auto* label : {"Particles", "(a) plate", "x (m)", "y (m)", "von Mises stress (Pa)"})
    CHECK_THAT(svg, Contains(">" + std::string(label) + "<"));
  CHECK(render_svg(particles()) == svg);
}

TEST_CASE("the colour of a particle follows its value", "[fast]") {
  const std::string lowest = "rgb( 68,   1,  84)", highest = "rgb(253, 231,  37)";  // the ends of the palette
  ParticleFigure figure = particles();
  auto drawn = markers(render_svg(figure), "gpPt6");
  REQUIRE(drawn.size() == 12);
  CHECK(drawn.front().colour == lowest);
  CHECK(drawn.back().colour != lowest);
  figure.value_range = {0.0, 11.0};
  drawn = markers(render_svg(figure), "gpPt6");
  CHECK(drawn.back().colour == highest);
  figure.value_range = {-11.0, 0.0};
  CHECK(markers(render_svg(figure), "gpPt6").front().colour == highest);
  figure.panels[0].values.clear();
  const std::string plain = render_svg(figure);
  for (const auto& marker : markers(plain, "gpPt6")) CHECK(marker.colour == "rgb(213,  94,   0)");
  CHECK_THAT(plain, !Contains("von Mises"));  // no colour bar
}

TEST_CASE("circles and arrows are drawn beside particles, in panels of their own", "[fast]") {
  ParticleFigure figure = particles();
  figure.panels.push_back(figure.panels[0]);
  figure.panels.push_back(figure.panels[0]);
  figure.panels[1].circles = {{0.25, 0.0}, {3.0, 1.0}};
  const std::string svg = render_svg(figure);
  const auto drawn = markers(svg, "gpPt6"), circles = markers(svg, "gpPt5");
  REQUIRE(drawn.size() == 36);
  REQUIRE(circles.size() == 2);
  CHECK(circles[0].x == Approx((drawn[12].x + drawn[13].x) / 2).margin(0.05));
  CHECK(circles[1].x > drawn[15].x);  // the axes reach as far as the circles
  CHECK(drawn[12].x > drawn[3].x);    // second column
  CHECK(drawn[24].y > drawn[0].y);    // second row, below
  CHECK(drawn[24].x == drawn[0].x);
  figure.panels[2].arrows.assign(12, {0.1, 0.1});
  CHECK(count(render_svg(figure), "<path") > count(svg, "<path"));
}

TEST_CASE("a tall row of particles fits onto the page", "[fast]") {
  ParticleFigure figure = particles();
  for (int j = 0; j < 12; ++j) figure.panels[0].positions[j] = {0.0, 0.5 * j};
  const auto drawn = markers(render_svg(figure), "gpPt6");
  REQUIRE(drawn.size() == 12);
  for (const auto& marker : drawn) CHECK(marker.y > marker.radius);
  CHECK(drawn[0].radius == Approx(0.2 / 5.5 * (drawn[0].y - drawn[11].y)).margin(0.05));
}

TEST_CASE("particles that are not finite are left out", "[fast]") {
  ParticleFigure figure = particles();
  const auto whole = markers(render_svg(figure), "gpPt6");
  figure.panels[0].positions[5].first = std::numeric_limits<double>::infinity();
  figure.panels[0].values[6] = std::numeric_limits<double>::quiet_NaN();
  const auto drawn = markers(render_svg(figure), "gpPt6");
  REQUIRE(drawn.size() == 10);
  CHECK(drawn.back().x == whole.back().x);
}

TEST_CASE("a map has its cells, its outlines and every label", "[fast]") {
  const std::string svg = render_svg(map());
  CHECK_THAT(svg, Contains("<svg") && EndsWith("</svg>\n\n"));
  for (const auto* label : {"Growth over the zone", "k_x", "k_y", "growth rate", "stable", "zone"})
    CHECK_THAT(svg, Contains(">" + std::string(label) + "<"));
  CHECK(render_svg(map()) == svg);
  const std::string data = picture(svg).data;
  MapFigure changed = map();
  changed.values[4] = 1.0;
  CHECK(picture(render_svg(changed)).data != data);
  changed = map();
  changed.value_range = {0.0, 50.0};
  CHECK(picture(render_svg(changed)).data != data);
  changed = map();
  changed.outlines[0].points[2].second = 0.5;
  const std::string moved = render_svg(changed);
  CHECK(picture(moved).data == data);
  CHECK(moved != svg);
}

TEST_CASE("a cell that is not finite leaves the hatching of its label", "[fast]") {
  MapFigure figure = map();
  const std::string whole = render_svg(figure);
  figure.values[1] = std::numeric_limits<double>::quiet_NaN();
  CHECK(picture(render_svg(figure)).data != picture(whole).data);
  figure.values.assign(6, std::numeric_limits<double>::quiet_NaN());
  const std::string blank = render_svg(figure);  // neither cells nor a colour bar
  CHECK_THAT(blank, !Contains("<image") && !Contains("growth rate") && Contains(">stable<") && Contains(">zone<"));
}

TEST_CASE("the cells of a map can have equal units", "[fast]") {
  constexpr double pixel = 0.02;  // gnuplot writes hundredths
  MapFigure figure = map();
  figure.equal_units = true;
  const Picture square = picture(render_svg(figure));
  CHECK(square.width / 3.0 == Approx(square.height / 2.0).margin(pixel));
  figure.equal_units = false;
  const Picture stretched = picture(render_svg(figure));
  CHECK(stretched.height > 1.1 * square.height);
}

TEST_CASE("a missing gnuplot is named with the package that brings it", "[fast]") {
  const Environment empty("PATH", "/nowhere");
  CHECK_THROWS_WITH(render_svg(sample()), Contains("gnuplot: not found") && Contains("gnuplot-nox"));
}
