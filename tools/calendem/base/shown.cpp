// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/shown.h"
#include "base/plain_text.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <regex>
#include <utility>

namespace calendem {

namespace {

std::string raised(int exponent) {
  static const char *const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(exponent)))
    out += digits[c - '0'];
  return out;
}

/// Place of a number's first digit: 1 for 28, 0 for 3, -1 for 0.5.
int place_of(double x) { return int(std::floor(std::log10(std::fabs(x)))); }

} // namespace

double number_in(const nlohmann::json &object, const std::string &name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_number() ? found->get<double>() : NAN;
}

nlohmann::json or_null(double number) {
  return std::isfinite(number) ? nlohmann::json(number) : nlohmann::json();
}

std::string shown(const nlohmann::json &number, const char *format) {
  if (!number.is_number())
    return "–";
  std::string text = fmt::format(fmt::runtime(format), number.get<double>());
  if (const auto e = text.find('e'); e != std::string::npos)
    text = text.substr(0, e) + "·10" + raised(std::stoi(text.substr(e + 1)));
  const bool is_zero =
      text.find('0') != std::string::npos && text.find_first_of("123456789") == std::string::npos;
  if (is_zero && text.find_first_of("+-") == 0)
    text.erase(0, 1); // zero has no sign
  if (text.front() == '-')
    text.replace(0, 1, "−");
  return text;
}

std::string format_by_error(const nlohmann::json &error) {
  const double sd = error.is_number() ? std::fabs(error.get<double>()) : 0.0;
  if (!std::isfinite(sd) || sd < 1e-6 || sd >= 1e6)
    return "{:.4g}";
  const int rounded = place_of(sd * 1.005); // 0.0996 is shown as 0.10
  return fmt::format("{{:.{}f}}", std::max(0, 1 - rounded));
}

std::vector<std::string> shown_alike(const std::vector<double> &numbers) {
  int most = 0, least = 0; // places of the first digits
  bool any = false;
  for (const double x : numbers)
    if (std::isfinite(x) && x != 0.0) {
      most = any ? std::max(most, place_of(x)) : place_of(x);
      least = any ? std::min(least, place_of(x)) : place_of(x);
      any = true;
    }
  const std::string alike = fmt::format("{{:.{}f}}", std::max(0, 2 - most));
  const bool fits = most - least < 2 && most > -4 && most < 4;
  std::vector<std::string> out;
  for (const double x : numbers)
    out.push_back(shown(or_null(x), fits ? alike.c_str() : "{:.3g}"));
  return out;
}

NameAndUnit in_words(const std::string &name) {
  static const std::pair<const char *, const char *> kUnits[] = {
      {"_MPa", "MPa"},   {"_GPa", "GPa"},     {"_kPa", "kPa"},        {"_um2", "µm²"},
      {"_um3", "µm³"},   {"_um", "µm"},       {"_us", "µs"},          {"_fJ", "fJ"},
      {"_nN", "nN"},     {"_percent", "%"},   {"_m_s", "m/s"},        {"_mg_cm2", "mg/cm²"},
      {"_J_m3", "J/m³"}, {"_g_cm3", "g/cm³"}, {"_per_second", "1/s"}, {"_seconds", "s"},
      {"_s", "s"}};
  static const std::regex threshold("_(above|below|at)_[0-9.]+_[a-zA-Z0-9]+$");
  NameAndUnit out = {name, ""};
  const bool of_threshold = std::regex_search(name, threshold);
  for (const auto &[ending, unit] : kUnits)
    if (!of_threshold && out.unit.empty() && ends(name, ending) && name != ending)
      out = {name.substr(0, name.rfind(ending)), std::string(" ") + unit};
  std::replace(out.name.begin(), out.name.end(), '_', ' ');
  return out;
}

std::string shown_unit(const std::string &unit) { return unit == "um" ? "µm" : unit; }

std::string unit_of_difference(const std::string &unit) {
  return unit == "%" ? "points" : unit == "fraction" ? "" : shown_unit(unit);
}

std::string shown_difference(double value, const std::string &unit) {
  const std::string of = unit_of_difference(unit);
  return shown(value, "{:.3g}") + (of.empty() ? "" : " " + of);
}

} // namespace calendem
