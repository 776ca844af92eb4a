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

std::string curves(const LineFigure& figure) {
  std::string data, plot;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    const Curve& curve = figure.curves[i];
    data += fmt::format("$curve{} << end_of_curve\n", i);
    for (const auto& [x, y] : curve.points) data += fmt::format("{} {}\n", number(x), number(y));
    data += "end_of_curve\n";
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

}  // namespace

std::string render_svg(const LineFigure& figure) {
  const File in = scratch_file(), out = scratch_file(), messages = scratch_file();
  std::fputs(script_of(figure).c_str(), in.get());
  std::rewind(in.get());
  if (run_gnuplot(in, out, messages) != 0) throw std::runtime_error("gnuplot: " + contents(messages));
  return contents(out);
}

}  // namespace sphstab::io
