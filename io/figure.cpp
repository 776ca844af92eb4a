// SPDX-License-Identifier: MIT
#include "io/figure.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "model/errors.hpp"

namespace sphstab::io {
namespace {

/// The palette of Okabe and Ito, told apart by colour-blind readers, without its yellow, too light for a line on white.
constexpr std::array<std::string_view, 7> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                  "#000000", "#E69F00", "#56B4E9"};
/// Dashes of `line`, in lengths of stroke and gap; `dashed` has one of its own.
constexpr std::array<std::string_view, 5> strokes{"solid", "(16,5)", "(16,5,3,5)", "(3,4)", "(16,5,3,5,3,5)"};
constexpr std::string_view dashed_stroke = "(8,6)";
/// Pixels; the legend stands below the diagram, one label a line.
constexpr int height_of_diagram = 480, height_of_label = 23;
/// Filled and open circle, square, triangle, diamond: gnuplot's point types.
constexpr std::array<int, 8> markers{7, 4, 9, 12, 5, 6, 13, 8};

/// Colours of values, from dark to light.
constexpr std::string_view palette = "0 '#440154', 1 '#3B528B', 2 '#21918C', 3 '#5EC962', 4 '#FDE725'";

template <class List>
auto cycled(const List& list, std::size_t i) {
  return list[i % list.size()];
}

/// A gnuplot string that stands for `text`: in single quotes nothing is special but the quote.
std::string quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + "'";
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "NaN"; }

std::string style_of(const Curve& curve, std::size_t i) {
  const auto colour = cycled(colours, i);
  const auto marker = fmt::format("pointtype {} pointsize 0.8 linewidth 1.5", cycled(markers, i));
  switch (curve.style) {
    case CurveStyle::line:
      return fmt::format("lines dashtype {} linewidth 2 linecolor rgb '{}'", cycled(strokes, i), colour);
    case CurveStyle::dashed:
      return fmt::format("lines dashtype {} linewidth 2 linecolor rgb '{}'", dashed_stroke, colour);
    case CurveStyle::points:
      return fmt::format("points {} linecolor rgb '{}'", marker, colour);
    case CurveStyle::line_and_points:
      return fmt::format("linespoints {} dashtype {} linecolor rgb '{}'", marker, cycled(strokes, i), colour);
  }
  return {};
}

std::string axes(const LineFigure& figure) {
  std::string script;
  if (!figure.title.empty()) script += fmt::format("set title {} noenhanced\n", quoted(figure.title));
  script += fmt::format("set xlabel {} noenhanced\nset ylabel {} noenhanced\n", quoted(figure.x_label),
                        quoted(figure.y_label));
  if (figure.x_log) script += "set logscale x\nset format x '10^{%T}'\n";
  if (figure.y_log) script += "set logscale y\nset format y '10^{%T}'\n";
  if (!figure.x_ticks.empty()) {
    script += "set xtics noenhanced (";
    for (const auto& tick : figure.x_ticks) script += fmt::format("{} {}, ", quoted(tick.label), number(tick.x));
    script += ")\n";
  }
  return script;
}

std::string marks(const LineFigure& figure) {
  std::string script;
  for (const auto& shade : figure.shades)
    script += fmt::format(
        "set object rectangle from {0},graph 0 to {1},graph 1 behind fillstyle solid noborder fillcolor rgb '#E8E8E8'\n"
        "set label {2} at {0},graph 1.025 noenhanced textcolor rgb '#606060'\n",
        number(shade.from), number(shade.to), quoted(shade.label));
  for (const auto& line : figure.vertical_lines)
    script += fmt::format(
        "set arrow from {0},graph 0 to {0},graph 1 nohead front linewidth 1.2 dashtype (2,3) linecolor rgb '#404040'\n"
        "set label {1} at {0},graph 0.96 offset 0.5,0 noenhanced front textcolor rgb '#404040'\n",
        number(line.x), quoted(line.label));
  return script;
}

/// The points of a curve as the data block of that name and number.
std::string data_of(std::string_view name, const Curve& curve, std::size_t i) {
  std::string data = fmt::format("${}{} << end_of_{}\n", name, i, name);
  for (const auto& [x, y] : curve.points) data += fmt::format("{} {}\n", number(x), number(y));
  return data + fmt::format("end_of_{}\n", name);
}

std::string curves(const LineFigure& figure) {
  std::string data, plot;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    const Curve& curve = figure.curves[i];
    data += data_of("curve", curve, i);
    plot += fmt::format("{}$curve{} using 1:2 with {} {}", i == 0 ? "plot " : ", ", i, style_of(curve, i),
                        curve.label.empty() ? "notitle" : "title " + quoted(curve.label) + " noenhanced");
  }
  return data + plot + "\n";
}

std::string script_of(const LineFigure& figure) {
  const auto labelled = std::count_if(figure.curves.begin(), figure.curves.end(),
                                      [](const Curve& curve) { return !curve.label.empty(); });
  return fmt::format(
             "set encoding utf8\n"
             "set terminal svg size 840,{} dynamic font 'sans-serif,15' background rgb '#FFFFFF'\n"
             "set border 3 linecolor rgb '#404040'\n"
             "set tics nomirror out scale 0.6\n"
             "set grid linetype 1 linewidth 0.6 linecolor rgb '#D8D8D8'\n"
             "set key below left vertical maxcols 1 reverse Left samplen 3.5\n",
             height_of_diagram + height_of_label * labelled) +
         axes(figure) + marks(figure) + curves(figure);
}

/// Pixels: the axes of a panel stand in an area of this width, with this space around it and around the whole.
constexpr double width_of_area = 340, left_of_area = 100, right_of_area = 130, below_area = 70, above_area = 40,
                 height_of_title = 30;
/// The height of the area is at most this times its width.
constexpr double tallest_area = 1.5;
constexpr int font_size = 13;
/// Pixels: gnuplot makes points of size 1 of this radius.
constexpr double radius_of_point = 3.0 / 8.0 * font_size;

using Points = std::vector<std::pair<double, double>>;

/// The smallest rectangle that holds the circles of all particles.
struct Extent {
  double x_low = std::numeric_limits<double>::infinity(), x_high = -x_low, y_low = x_low, y_high = -x_low;

  void add(const Points& centres, double radius) {
    for (const auto& [x, y] : centres) {
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      x_low = std::min(x_low, x - radius), x_high = std::max(x_high, x + radius);
      y_low = std::min(y_low, y - radius), y_high = std::max(y_high, y + radius);
    }
  }
  double width() const { return x_high - x_low; }
  double height() const { return y_high - y_low; }
};

Extent extent_of(const ParticlePanel& panel, double radius) {
  Extent extent;
  extent.add(panel.positions, 2.0 * radius);
  extent.add(panel.circles, 2.0 * radius);
  return extent;
}

/// Where the panels stand on the page, in pixels. A row is as high as its highest panel.
struct Layout {
  int columns;
  double title;
  std::vector<double> heights;  ///< of the areas of each row

  explicit Layout(const ParticleFigure& figure)
      : columns(std::min(static_cast<int>(figure.panels.size()), figure.columns)),
        title(figure.title.empty() ? 0.0 : height_of_title) {
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
      if (i % columns == 0) heights.push_back(0.0);
      const Extent extent = extent_of(figure.panels[i], figure.radius);
      const double height = width_of_area * std::min(extent.height() / extent.width(), tallest_area);
      heights.back() = std::max(heights.back(), height);
    }
  }
  double width() const { return columns * (left_of_area + width_of_area + right_of_area); }
  double height() const { return top(0) + above_area + title; }
  /// Of the area of a row, above the lower edge of the page.
  double top(int row) const {
    double below = 0.0;
    for (std::size_t i = row; i < heights.size(); ++i) below += above_area + heights[i] + below_area;
    return below - above_area;
  }
};

/// 1, 2 or 5 times a power of ten: the smallest that makes at most so many steps of the length.
double tick_step(double length, double most = 4.0) {
  const double power = std::pow(10.0, std::floor(std::log10(length / most)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= length / most) return step * power;
  return 10.0 * power;
}

/// Ticks of the colours beside an area of that height, far enough apart for their labels.
std::string colour_ticks(const ParticleFigure& figure, const ParticlePanel& panel, double height) {
  auto range = figure.value_range.value_or(std::pair(0.0, 0.0));
  if (!figure.value_range && !panel.values.empty()) {
    const auto [low, high] = std::minmax_element(panel.values.begin(), panel.values.end());
    range = {*low, *high};
  }
  const double length = range.second - range.first;
  if (!(length > 0.0) || !std::isfinite(length)) return "set cbtics auto\n";
  constexpr double height_of_tick = 36.0;
  return fmt::format("set cbtics {}\n", tick_step(length, std::clamp(height / height_of_tick, 1.0, 4.0)));
}

/// The data of a panel: x y value arrow, and its circles.
std::string data_of(const ParticlePanel& panel, int i) {
  std::string data = fmt::format("$particles{} << end_of_particles\n", i);
  for (std::size_t a = 0; a < panel.positions.size(); ++a) {
    const auto [x, y] = panel.positions[a];
    const auto [dx, dy] = panel.arrows.empty() ? std::pair(0.0, 0.0) : panel.arrows[a];
    const double value = panel.values.empty() ? 0.0 : panel.values[a];
    if (std::isfinite(x) && std::isfinite(y) && std::isfinite(value))
      data += fmt::format("{} {} {} {} {}\n", x, y, value, number(dx), number(dy));
  }
  data += fmt::format("end_of_particles\n$circles{} << end_of_circles\n", i);
  for (const auto& [x, y] : panel.circles) data += fmt::format("{} {}\n", number(x), number(y));
  return data + "end_of_circles\n";
}

/// The axes of a panel: as large as its area allows, a unit of x being as long as one of y. Returns the pixels a unit.
double place(const Extent& extent, const Layout& layout, int i, std::string& script) {
  const int row = i / layout.columns;
  const double scale = std::min(width_of_area / extent.width(), layout.heights[row] / extent.height());
  const double left = (i % layout.columns) * (left_of_area + width_of_area + right_of_area) + left_of_area;
  const double top = layout.top(row);
  script += fmt::format(
      "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset bmargin at screen {}\n"
      "set xrange [{}:{}]\nset yrange [{}:{}]\nset xtics {}\nset ytics {}\n",
      left / layout.width(), (left + scale * extent.width()) / layout.width(), top / layout.height(),
      (top - scale * extent.height()) / layout.height(), extent.x_low, extent.x_high, extent.y_low, extent.y_high,
      tick_step(extent.width()), tick_step(extent.height()));
  return scale;
}

std::string plot_of(const ParticleFigure& figure, const Layout& layout, int i) {
  const ParticlePanel& panel = figure.panels[i];
  std::string script = fmt::format("set title {} noenhanced\n{} colorbox\n", quoted(panel.title),
                                   panel.values.empty() ? "unset" : "set");
  const Extent extent = extent_of(panel, figure.radius);
  const double scale = place(extent, layout, i, script);
  script += colour_ticks(figure, panel, scale * extent.height());
  const double size = scale * figure.radius / radius_of_point;
  script += fmt::format("plot $particles{} using 1:2{} with points pointtype 7 pointsize {} linecolor {} notitle", i,
                        panel.values.empty() ? "" : ":3", size, panel.values.empty() ? "rgb '#D55E00'" : "palette");
  if (!panel.circles.empty())
    script += fmt::format(
        ", $circles{} using 1:2 with points pointtype 6 pointsize {} linewidth 1 linecolor rgb '#000000' notitle", i,
        size);
  if (!panel.arrows.empty())
    script += fmt::format(
        ", $particles{} using 1:2:4:5 with vectors head filled linewidth 1.2 linecolor rgb '#000000' notitle", i);
  return script + "\n";
}

std::string script_of(const ParticleFigure& figure) {
  const Layout layout(figure);
  std::string script = fmt::format(
      "set encoding utf8\n"
      "set terminal svg size {:.0f},{:.0f} dynamic font 'sans-serif,{}' background rgb '#FFFFFF'\n"
      "set border linecolor rgb '#404040'\nset tics nomirror out scale 0.6\nset format '%g'\n"
      "set xlabel {} noenhanced\nset ylabel {} noenhanced\nset cblabel {} noenhanced\n"
      "set palette defined ({})\n",
      layout.width(), layout.height(), font_size, quoted(figure.x_label), quoted(figure.y_label),
      quoted(figure.value_label), palette);
  if (figure.value_range)
    script += fmt::format("set cbrange [{}:{}]\n", figure.value_range->first, figure.value_range->second);
  const int panels = static_cast<int>(figure.panels.size());
  for (int i = 0; i < panels; ++i) script += data_of(figure.panels[i], i);
  script += fmt::format("set multiplot title {} noenhanced\n", quoted(figure.title));
  for (int i = 0; i < panels; ++i) script += plot_of(figure, layout, i);
  return script + "unset multiplot\n";
}

/// The range of cells around these centres, as gnuplot writes one.
std::string range_of(const std::vector<double>& centres) {
  const double half = 0.5 * (centres.back() - centres.front()) / static_cast<double>(centres.size() - 1);
  return fmt::format("[{}:{}]", centres.front() - half, centres.back() + half);
}

/// Black over white: seen on any colour.
std::string outline_of(const Curve& curve, std::size_t i) {
  const bool points = curve.style == CurveStyle::points;
  const auto title = curve.label.empty() ? "notitle" : "title " + quoted(curve.label) + " noenhanced";
  if (points)
    return fmt::format(
        ", $outline{0} using 1:2 with points pointtype 7 pointsize 1.1 linecolor rgb '#FFFFFF' notitle"
        ", $outline{0} using 1:2 with points pointtype 6 pointsize 1.1 linewidth 2 linecolor rgb '#000000' {1}",
        i, title);
  const auto stroke = curve.style == CurveStyle::dashed ? dashed_stroke : strokes.front();
  return fmt::format(
      ", $outline{0} using 1:2 with lines linewidth 3.5 linecolor rgb '#FFFFFF' notitle"
      ", $outline{0} using 1:2 with lines dashtype {1} linewidth 1.5 linecolor rgb '#000000' {2}",
      i, stroke, title);
}

std::string script_of(const MapFigure& figure) {
  constexpr std::string_view hatched = "fillstyle pattern 4 noborder fillcolor rgb '#BBBBBB'";
  const bool any = std::any_of(figure.values.begin(), figure.values.end(), [](double v) { return std::isfinite(v); });
  std::string script = fmt::format(
      "set encoding utf8\n"
      "set terminal svg size 840,680 dynamic font 'sans-serif,15' background rgb '#FFFFFF'\n"
      "set border linecolor rgb '#404040'\nset tics nomirror out scale 0.6\nset size {}\n"
      "set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\nset cblabel {} noenhanced\n"
      "set palette defined ({})\nset xrange {}\nset yrange {}\n{} colorbox\n"
      "set key below left vertical maxcols 1 reverse Left samplen 3.5\n"
      "set object rectangle from graph 0,0 to graph 1,1 behind {}\n$cells << end_of_cells\n",
      figure.equal_units ? "ratio -1" : "noratio", quoted(figure.title), quoted(figure.x_label), quoted(figure.y_label),
      quoted(figure.value_label), palette, range_of(figure.x), range_of(figure.y), any ? "set" : "unset", hatched);
  if (figure.value_range)
    script.insert(0, fmt::format("set cbrange [{}:{}]\n", figure.value_range->first, figure.value_range->second));
  for (std::size_t j = 0; j < figure.y.size(); ++j) {
    for (std::size_t i = 0; i < figure.x.size(); ++i)
      script += fmt::format("{} {} {}\n", figure.x[i], figure.y[j], number(figure.values[i + j * figure.x.size()]));
    script += "\n";
  }
  script += "end_of_cells\n";
  for (std::size_t i = 0; i < figure.outlines.size(); ++i) script += data_of("outline", figure.outlines[i], i);
  script += any ? "plot $cells using 1:2:3 with image notitle" : "plot NaN notitle";
  for (std::size_t i = 0; i < figure.outlines.size(); ++i) script += outline_of(figure.outlines[i], i);
  if (!figure.blank_label.empty())
    script += fmt::format(", keyentry with boxes {} title {} noenhanced", hatched, quoted(figure.blank_label));
  return script + "\n";
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// A file without a name that goes when it is closed.
File scratch_file() {
  File file(std::tmpfile(), std::fclose);
  if (!file) throw std::system_error(errno, std::generic_category(), "temporary file");
  return file;
}

std::string contents(const File& file) {
  std::string text;
  std::rewind(file.get());
  for (int c = std::fgetc(file.get()); c != EOF; c = std::fgetc(file.get())) text += static_cast<char>(c);
  return text;
}

/// Runs gnuplot, its standard streams being files: it cannot block on us, nor we on it.
int run_gnuplot(const File& in, const File& out, const File& messages) {
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_adddup2(&streams, fileno(in.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&streams, fileno(out.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&streams, fileno(messages.get()), STDERR_FILENO);
  std::string program = "gnuplot", without_user_settings = "--default-settings";
  char* const arguments[] = {program.data(), without_user_settings.data(), nullptr};
  pid_t child = 0;
  const int refused = posix_spawnp(&child, program.c_str(), &streams, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&streams);
  if (refused == ENOENT)
    throw InvalidInput("gnuplot: not found; figures need it (Debian: apt-get install gnuplot-nox)");
  if (refused != 0) throw std::system_error(refused, std::generic_category(), "gnuplot");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// What gnuplot draws.
std::string drawn(const std::string& script) {
  const File in = scratch_file(), out = scratch_file(), messages = scratch_file();
  std::fputs(script.c_str(), in.get());
  std::rewind(in.get());
  if (run_gnuplot(in, out, messages) != 0) throw std::runtime_error("gnuplot: " + contents(messages));
  return contents(out);
}

}  // namespace

std::string render_svg(const LineFigure& figure) { return drawn(script_of(figure)); }

std::string render_svg(const ParticleFigure& figure) { return drawn(script_of(figure)); }

std::string render_svg(const MapFigure& figure) { return drawn(script_of(figure)); }

}  // namespace sphstab::io
