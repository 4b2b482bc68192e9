// SPDX-License-Identifier: GPL-2.0-or-later
// A chart as data, and its drawing as SVG. Linear axes; a second y axis on the right when a series
// asks for it. Every series differs from the others by dash, marker or hatch as well as by colour.
#ifndef CALENDEM_REPORT_CHART_H
#define CALENDEM_REPORT_CHART_H

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace calendem::report {

enum class Mark { line, points, area }; ///< area: filled between `base` and `y`
enum class Symbol { none, circle, square, triangle, diamond };
enum class Hatch { solid, rising, falling, dots };

/// Looks that series take in turn: Okabe-Ito, darkened where needed for thin lines on white.
inline constexpr std::array kSeriesColours = {"#0064b0", "#c8500a", "#00845a",
                                              "#a8508c", "#8a6d00", "#222222"};
inline constexpr std::array kSeriesSymbols = {Symbol::circle, Symbol::square, Symbol::triangle,
                                              Symbol::diamond};

struct Series {
  std::string name; ///< legend entry; empty = none
  std::vector<double> x, y;
  Mark mark = Mark::line;
  std::string colour = "#000000";
  std::string dash;             ///< SVG dash pattern, empty = solid
  Symbol symbol = Symbol::none; ///< on a line: a few symbols along it
  Hatch hatch = Hatch::solid;   ///< of an area
  bool right_axis = false;
  std::vector<double> base;    ///< lower edge of an area
  std::vector<double> y_error; ///< half length of error bars, empty = none
};

struct Limit { ///< a horizontal line with a label, on the left axis
  double y;
  std::string label;
};

struct Chart {
  std::string id; ///< unique in a page; prefix of the ids in the SVG
  std::string title;
  std::string x_label, y_label, right_label; ///< with units
  std::vector<Series> series;
  std::vector<Limit> limits;
  std::string note;      ///< what the reader must know to read it
  double y_top = 0;      ///< upper end of the left axis; 0 = from the data
  bool from_zero = true; ///< the left axis; false: from the data, to see small differences
};

/// The drawing; sizes in CSS pixels, text in the font of the page.
std::string to_svg(const Chart &chart);

/// The drawing as a file of its own, with the page's style.
std::string to_svg_file(const Chart &chart);

/// The same chart as data, for report.json.
nlohmann::json to_json(const Chart &chart);

// A linear axis: range rounded outwards to ticks of 1, 2 or 5 times a power of ten.

struct Axis {
  double low = 0, high = 1; ///< in units of the data
  double step = 0.2;

  std::vector<double> ticks() const;
  std::string label(double tick) const; ///< as many decimals as the step needs
  /// Position between `begin` (for low) and `end` (for high).
  double place(double value, double begin, double end) const;
};

/// Axis that holds [low, high] with about `count` ticks. A range of no width is widened.
Axis axis_for(double low, double high, int count);

/// Smallest and largest finite value; `first` false when there is none.
struct Range {
  bool any = false;
  double low = 0, high = 0;
  void include(double value);
};

} // namespace calendem::report

#endif
