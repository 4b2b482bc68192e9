// SPDX-License-Identifier: GPL-2.0-or-later
// Fills a text template from JSON: a subset of Mustache.
//   {{key}}            value, HTML-escaped        {{{key}}}  value as it is
//   {{#key}}…{{/key}}  once per array element, or once if the value is an object, true or not empty
//   {{^key}}…{{/key}}  only if the value is missing, false or empty
//   {{.}}              the element itself
// A key is searched from the innermost section outwards.
#ifndef CALENDEM_REPORT_PAGE_TEMPLATE_H
#define CALENDEM_REPORT_PAGE_TEMPLATE_H

#include <string>

#include <nlohmann/json.hpp>

namespace calendem::report {

/// Throws std::logic_error when a section is not closed (a mistake in the template, not of the
/// user).
std::string fill_template(const std::string &text, const nlohmann::json &values);

/// Text as HTML and SVG may hold it, in elements and attributes.
std::string escaped(const std::string &text);

/// JSON text that may stand in a <script>: no string of it can open or close an element.
std::string in_script(std::string json);

} // namespace calendem::report

#endif
