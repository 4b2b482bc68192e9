// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers of JSON objects; numbers and units as a reader writes them: on pages and in sentences.
#ifndef CALENDEM_BASE_SHOWN_H
#define CALENDEM_BASE_SHOWN_H

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace calendem {

inline constexpr double kPercent = 100.0; ///< shares are kept as fractions and shown in percent

/// The number of that name; NaN where there is none.
double number_in(const nlohmann::json &object, const std::string &name);
/// JSON has no number that is not finite.
nlohmann::json or_null(double number);

/// A JSON number in that format: with a minus, not a hyphen, and a power of ten instead of an
/// exponent ("4.1·10⁻⁸"); a dash where it is none.
std::string shown(const nlohmann::json &number, const char *format);

/// The format with the decimals that give an error two digits: 27.8 ± 2.5, 27.75 ± 0.23; four digits where it is none.
std::string format_by_error(const nlohmann::json &error);

/// Numbers that stand side by side, all with the decimals that give the largest three digits: "28.0",
/// "32.2". If less than two digits of another were left, each has three of its own.
std::vector<std::string> shown_alike(const std::vector<double> &numbers);

/// A name that ends in a unit, in words: "porosity before" and " %" for "porosity_before_percent". The
/// unit of a threshold is none of the value's: "difference above 5 MPa".
struct NameAndUnit {
  std::string name, unit; ///< the unit with the blank before it; empty: none is known
};
NameAndUnit in_words(const std::string &name);

/// A unit of our files: "µm" for "um".
std::string shown_unit(const std::string &unit);

/// Differences of percent are points; a fraction has none.
std::string unit_of_difference(const std::string &unit);
std::string shown_difference(double value, const std::string &unit);

} // namespace calendem

#endif
