// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sphstab::io {

/// How a curve is drawn. Curves of one figure differ by colour, and by dash or marker as well.
enum class CurveStyle { line, dashed, points, line_and_points };

/// Points (x, y) in the order in which they are joined; a point that is not finite is a gap. A curve without a label
/// has no line in the legend.
struct Curve {
  std::string label;
  std::vector<std::pair<double, double>> points;
  CurveStyle style = CurveStyle::line;
};

/// A labelled place on the x axis.
struct Mark {
  double x;
  std::string label;
};

/// A shaded range of x behind the curves.
struct Shade {
  double from;
  double to;
  std::string label;
};

/// One diagram: curves over linear or logarithmic axes.
struct LineFigure {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool x_log = false;
  bool y_log = false;
  std::vector<Curve> curves;
  std::vector<Mark> x_ticks = {};         ///< in place of numbers, such as Γ, X, M along a path
  std::vector<Mark> vertical_lines = {};  ///< labelled at their upper end
  std::vector<Shade> shades = {};
};

/// The figure as an SVG drawn by gnuplot; the same figure always gives the same bytes. Text is printed as it is, not
/// read as markup. At least one point must be finite and, on a logarithmic axis, positive.
/// Throws InvalidInput if gnuplot is not installed.
std::string render_svg(const LineFigure& figure);

/// One picture of particles in a plane, all lists (x, y). Axes have equal units and reach as far as the particles.
struct ParticlePanel {
  std::string title;
  std::vector<std::pair<double, double>> positions;
  std::vector<double> values = {};                      ///< colour of each particle; empty: all the same
  std::vector<std::pair<double, double>> circles = {};  ///< unfilled, such as where a theory has the particles
  std::vector<std::pair<double, double>> arrows = {};   ///< from each particle, in units of x; empty: none
};

/// Panels beside and below each other.
struct ParticleFigure {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string value_label;  ///< beside the colour bars, which stand where there are values
  double radius;            ///< of the circle of a particle, in units of x
  std::vector<ParticlePanel> panels;
  int columns = 2;
  std::optional<std::pair<double, double>> value_range = {};  ///< of the colours; none: each panel has its own
};

/// The same for particles, some hundred bytes each. Those that are not finite are left out. Every panel must have one.
std::string render_svg(const ParticleFigure& figure);

/// A scalar over a rectangle as coloured cells.
struct MapFigure {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string value_label;     ///< beside the colour bar
  std::vector<double> x;       ///< centres of the cells, ascending and equally spaced, at least two
  std::vector<double> y;       ///< likewise
  std::vector<double> values;  ///< of cell (x_i, y_j) at i + j · size of x; one that is not finite leaves it hatched
  std::string blank_label;     ///< what the hatching means, in the legend; empty: no line there
  std::vector<Curve> outlines = {};  ///< black with a white seam over the cells, such as the boundary of a zone
  bool equal_units = false;          ///< whether a unit of x is as long as one of y
  std::optional<std::pair<double, double>> value_range = {};  ///< of the colours; none: that of the values
};

/// The same for a map. The picture of the cells is embedded.
std::string render_svg(const MapFigure& figure);

}  // namespace sphstab::io
