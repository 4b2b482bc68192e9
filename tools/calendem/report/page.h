// SPDX-License-Identifier: GPL-2.0-or-later
// The one way to a page: the object it shows, what its template needs beside it, and its charts.
#ifndef CALENDEM_REPORT_PAGE_H
#define CALENDEM_REPORT_PAGE_H

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace calendem::report {

/// A chart is data; chart.js draws it. Linear axes; a second y axis on the right when a series asks
/// for it. Every series differs from the others by dash, marker or hatch as well as by colour.
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
  std::string x_label, y_label, right_label = ""; ///< with units
  std::vector<Series> series = {};
  std::vector<Limit> limits = {};
  std::string note = ""; ///< what the reader must know to read it
  double y_top = 0;      ///< upper end of the left axis; 0 = from the data
  bool from_zero = true; ///< the left axis; false: from the data, to see small differences
};

Series line_through(const std::string &name, std::vector<double> x, std::vector<double> y,
                    const std::string &colour, const std::string &dash = "");
Series points_at(const std::string &name, std::vector<double> x, std::vector<double> y,
                 const std::string &colour, Symbol symbol);

/// Numbers and looks; a value that is not finite is null.
nlohmann::json to_json(const Chart &chart);

struct Page {
  const char *html = nullptr;  ///< template, see fill_template
  nlohmann::ordered_json json; ///< the object that is shown; the template sees its members
  nlohmann::json values = nlohmann::json::object(); ///< texts and tables made from it, and pictures
  std::vector<Chart> charts = {};                   ///< the template's {{#charts}}; ids are unique
};

/// What the page holds for taking out: `json`, and the charts as its member "charts".
nlohmann::ordered_json data_of(const Page &page);

/// One file that needs no other and no network. {{> provenance}} shows the object's "provenance".
std::string to_html(const Page &page);

/// [{name, text}] of a provenance: nested names joined, files in the text before their hash.
nlohmann::json provenance_rows(const nlohmann::ordered_json &provenance);

/// Some of a page's charts as a section of a template: [{id, title, note}].
nlohmann::json places_of(const std::vector<Chart> &charts);

/// Fills a text template from JSON: a subset of Mustache.
///   {{key}}            value, HTML-escaped        {{{key}}}  value as it is
///   {{#key}}…{{/key}}  once per array element, or once if the value is an object, true or not empty
///   {{^key}}…{{/key}}  only if the value is missing, false or empty
///   {{.}}              the element itself
///   {{> part}}         the file part.html of this folder, put in when the program is built
/// A key is searched from the innermost section outwards.
/// Throws std::logic_error when a section is not closed (a mistake in the template, not of the
/// user).
std::string fill_template(const std::string &text, const nlohmann::json &values);

/// Text as HTML and SVG may hold it, in elements and attributes.
std::string escaped(const std::string &text);

/// JSON text that may stand in a <script>: no string of it can open or close an element.
std::string in_script(std::string json);

} // namespace calendem::report

// Text files of this folder, compiled in by CMakeLists.txt (embedded.cpp.in).
namespace calendem::report::embedded {

extern const char *const kPageCss;     ///< page.css
extern const char *const kPageScript;  ///< page.js
extern const char *const kChartScript; ///< chart.js
extern const char *const kD3;          ///< d3 of the distribution (libjs-d3, BSD licence)
extern const char *const kExplorer;    ///< explorer.js
extern const char *const kThree;       ///< three.js of the distribution (libjs-three, MIT licence)
extern const char *const kOrbitControls; ///< its controls
extern const char *const kTable1;        ///< reference/table1.csv
extern const char *const kPaperBonds;    ///< reference/paper_bonds.csv

} // namespace calendem::report::embedded

#endif
