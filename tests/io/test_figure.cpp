// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include <catch2/catch.hpp>
#include <limits>
#include <string>

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

TEST_CASE("a missing gnuplot is named with the package that brings it", "[fast]") {
  const Environment empty("PATH", "/nowhere");
  CHECK_THROWS_WITH(render_svg(sample()), Contains("gnuplot: not found") && Contains("gnuplot-nox"));
}
