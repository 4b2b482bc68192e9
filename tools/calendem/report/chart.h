// SPDX-License-Identifier: GPL-2.0-or-later
// A chart as data; chart.js draws it. Linear axes; a second y axis on the right when a series asks
// for it. Every series differs from the others by dash, marker or hatch as well as by colour.
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
  std::string id; ///< unique in a page; name of the files that are saved from it
  std::string title;
  std::string x_label, y_label, right_label; ///< with units
  std::vector<Series> series;
  std::vector<Limit> limits;
  std::string note;      ///< what the reader must know to read it
  double y_top = 0;      ///< upper end of the left axis; 0 = from the data
  bool from_zero = true; ///< the left axis; false: from the data, to see small differences
};

/// Numbers and looks; a value that is not finite is null.
nlohmann::json to_json(const Chart &chart);

} // namespace calendem::report

#endif
