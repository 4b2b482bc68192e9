// SPDX-License-Identifier: GPL-2.0-or-later
// Fills a text template from JSON: a subset of Mustache.
//   {{key}}            value, HTML-escaped        {{{key}}}  value as it is
//   {{#key}}…{{/key}}  once per array element, or once if the value is an object, true or not empty
//   {{^key}}…{{/key}}  only if the value is missing, false or empty
//   {{.}}              the element itself
//   {{> part}}         the file part.html of this folder, put in when the program is built
// A key is searched from the innermost section outwards.
#ifndef CALENDEM_REPORT_PAGE_TEMPLATE_H
#define CALENDEM_REPORT_PAGE_TEMPLATE_H

#include <nlohmann/json.hpp>
#include <string>

namespace calendem::report {

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
