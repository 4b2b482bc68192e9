// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/tables.h"
#include "base/csv_table.h"
#include "base/shown.h"
#include "report/page.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <limits>
#include <regex>

namespace calendem::report {

namespace {

using nlohmann::json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kImbalanceThreshold = 5; // MPa
/// A run compares with a row of Table 1 when its maximum pressure is this close to the row's.
constexpr double kSamePressure = 0.02;

double number_in(const json &object, const char *key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : kNaN;
}

json or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json figure(const char *label, double value, const char *unit, int decimals,
            const std::string &remark = "") {
  return {{"label", label},
          {"value", or_null(value)},
          {"unit", std::isfinite(value) ? unit : ""},
          {"text", shown(value, decimals)},
          {"remark", remark}};
}

double max_pressure(const Run &run) {
  return run.curve["pressure_MPa"][run.curve.row_of_max_pressure()];
}

double porosity_after(const Run &run) {
  return kPercent * number_in(run.summary, "porosity_after_relaxation");
}

json cell(const Run &run, double value, double paper) {
  const double difference = value - paper;
  std::string signed_text = shown(difference, 2);
  if (signed_text.front() == '-')
    signed_text.replace(0, 1, "−");
  else if (difference > 0)
    signed_text.insert(0, "+");
  return {{"run", run.name},
          {"value", or_null(value)},
          {"difference", or_null(difference)},
          {"text", shown(value, 2)},
          {"difference_text", signed_text}};
}

template <typename Value>
json row(const std::vector<Run> &runs, const std::string &quantity, double pressure, double paper,
         double sd, Value value_of) {
  json cells = json::array();
  for (const auto &run : runs)
    cells.push_back(cell(run, value_of(run), paper));
  const std::string spread = std::isfinite(sd) ? " ± " + shown(sd, 2) : "";
  return {{"quantity", quantity},
          {"pressure_MPa", or_null(pressure)},
          {"paper", or_null(paper)},
          {"paper_sd", or_null(sd)},
          {"cells", cells},
          {"pressure_text", shown(pressure, 0)},
          {"paper_text", shown(paper, sd == sd ? 2 : 1) + spread}};
}

json porosity_row(const std::vector<Run> &runs, const MeasuredPorosity &point) {
  const double p = point.pressure_MPa;
  if (p == 0)
    return row(runs, "Total porosity before calendering, %", p, point.porosity_percent,
               point.sd_percent,
               [](const Run &run) { return kPercent * run.curve["porosity_total"].front(); });
  return row(runs, "Total porosity after relaxation, %", p, point.porosity_percent,
             point.sd_percent, [p](const Run &run) {
               const bool same = std::abs(max_pressure(run) - p) <= kSamePressure * p;
               return same ? porosity_after(run) : kNaN;
             });
}

json loaded_row(const std::vector<Run> &runs, double pressure) {
  return row(runs, "Total porosity under load, %", pressure, kNaN, kNaN, [=](const Run &run) {
    const double most = max_pressure(run); // of the rows: the largest may lie between two
    const bool same = std::abs(most - pressure) <= kSamePressure * pressure;
    return kPercent * at_first_crossing(run.curve, same ? std::min(pressure, most) : pressure,
                                        "porosity_total");
  });
}

json breaks_row(const std::vector<Run> &runs, const PublishedBreaks &point) {
  return row(runs, "Broken bonds, % of initial", point.pressure_MPa, point.broken_percent, kNaN,
             [&](const Run &run) {
               return kPercent *
                      at_first_crossing(run.curve, point.pressure_MPa, "broken_fraction");
             });
}

bool ends_with(const std::string &text, const std::string &end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

json fact(std::string name, const json &value) {
  static const std::pair<const char *, const char *> kUnits[] = {{"_MPa", "MPa"},
                                                                 {"_GPa", "GPa"},
                                                                 {"_kPa", "kPa"},
                                                                 {"_um2", "µm²"},
                                                                 {"_um3", "µm³"},
                                                                 {"_um", "µm"},
                                                                 {"_us", "µs"},
                                                                 {"_fJ", "fJ"},
                                                                 {"_mg_cm2", "mg/cm²"},
                                                                 {"_percent", "%"},
                                                                 {"_m_s", "m/s"},
                                                                 {"_J_m3", "J/m³"},
                                                                 {"_g_cm3", "g/cm³"},
                                                                 {"_per_second", "1/s"},
                                                                 {"_nN", "nN"},
                                                                 {"_seconds", "s"},
                                                                 {"_s", "s"}};
  std::string unit;
  // the unit of a threshold is not that of the value: "difference above 5 MPa"
  static const std::regex threshold("_(above|below|at)_[0-9.]+_[a-zA-Z0-9]+$");
  const bool of_threshold = std::regex_search(name, threshold);
  for (const auto &[suffix, shown_as] : kUnits)
    if (!of_threshold && ends_with(name, suffix)) {
      unit = shown_as;
      name.resize(name.size() - std::string(suffix).size());
      break;
    }
  std::replace(name.begin(), name.end(), '_', ' ');
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (value.is_number_float()) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.5g", value.get<double>());
    text = digits;
  } else if (value.is_boolean()) {
    text = value.get<bool>() ? "yes" : "no";
  }
  return {{"name", name}, {"value", value}, {"text", text}, {"unit", unit}};
}

void collect_facts(const json &object, const std::string &prefix,
                   const std::vector<std::string> &left_out, json &facts) {
  for (const auto &[key, value] : object.items()) {
    if (std::find(left_out.begin(), left_out.end(), key) != left_out.end())
      continue;
    const std::string name = prefix.empty() ? key : prefix + ": " + key;
    if (value.is_object())
      collect_facts(value, name, {}, facts);
    else
      facts.push_back(fact(name, value));
  }
}

} // namespace

std::string shown(double value, int decimals) {
  if (!std::isfinite(value))
    return "–";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

json headline_of(const Run &run) {
  const Curve &c = run.curve;
  const std::size_t top = c.row_of_max_pressure();
  const json &s = run.summary;
  const double cracked = number_in(s, "cracked_bodies"), bodies = number_in(s, "bodies");
  const std::string of_bodies = std::isfinite(bodies) ? "of " + shown(bodies, 0) : "";
  const double bonds = number_in(s, "bonds_initial");
  const double springback = number_in(s, "springback");
  json figures = json::array();
  figures.push_back(figure("Maximum pressure", max_pressure(run), "MPa", 1));
  figures.push_back(
      figure("Total porosity before", kPercent * c["porosity_total"].front(), "%", 1));
  figures.push_back(
      figure("Total porosity at maximum", kPercent * c["porosity_total"][top], "%", 1));
  figures.push_back(figure("Total porosity after relaxation", porosity_after(run), "%", 1));
  figures.push_back(
      figure("Thickness after relaxation", number_in(s, "thickness_after_relaxation_um"), "µm", 1));
  figures.push_back(figure("Springback", kPercent * springback, "%", 1));
  figures.push_back(figure("Bonds broken at maximum", kPercent * c["broken_fraction"][top], "%", 1,
                           std::isfinite(bonds) ? "of " + shown(bonds, 0) : ""));
  figures.push_back(figure("Cracked bodies", cracked, "", 0, of_bodies));
  if (s.contains("imposed"))
    figures.push_back(figure("CBD nanoporosity", kPercent * number_in(s["imposed"], "final"), "%",
                             1, s["imposed"].value("what", "imposed")));
  figures.push_back(figure("Largest |P top − P bottom| / P",
                           kPercent * worst_imbalance(c, kImbalanceThreshold), "%", 1,
                           "above 5 MPa; limit 5 %"));
  const json range = s.value("/contact_range/at_max_pressure/all"_json_pointer, json());
  if (range.is_object())
    figures.push_back(figure("Contact force beyond 0.2 R",
                             kPercent * number_in(range, "force_beyond_0.2_R"), "%", 1,
                             "overlap, at maximum pressure"));
  return figures;
}

json comparison_of(const std::vector<Run> &runs) {
  json rows = json::array();
  for (const auto &point : paper_porosity())
    rows.push_back(porosity_row(runs, point));
  for (const auto &point : paper_porosity())
    if (point.pressure_MPa > 0)
      rows.push_back(loaded_row(runs, point.pressure_MPa));
  for (const auto &point : paper_breaks())
    rows.push_back(breaks_row(runs, point));
  return {{"rows", rows}};
}

std::string comparison_text(const json &comparison) {
  const auto text = [](const json &row, const char *key) { return row[key].get<std::string>(); };
  const json &rows = comparison["rows"];
  std::string out = fmt::format("{:<39}{:>7}{:>15}", "", "at MPa", "paper");
  if (!rows.empty())
    for (const json &c : rows[0]["cells"])
      out += fmt::format("{:>18}", text(c, "run"));
  out += '\n';
  for (const json &r : rows) {
    out += fmt::format("{:<39}{:>7}{:>15}", text(r, "quantity"), text(r, "pressure_text"),
                       text(r, "paper_text"));
    for (const json &c : r["cells"]) {
      const bool compared = c["difference"].is_number();
      out += fmt::format("{:>18}", text(c, "text") +
                                       (compared ? " (" + text(c, "difference_text") + ")" : ""));
    }
    out += '\n';
  }
  return out;
}

json facts_of(const json &object, const std::vector<std::string> &left_out) {
  json facts = json::array();
  if (object.is_object())
    collect_facts(object, "", left_out, facts);
  return facts;
}

std::vector<MeasuredPorosity> paper_porosity() {
  const CsvTable table = CsvTable::parse(embedded::kTable1);
  const auto pressure = table.numbers("pressure_MPa");
  const auto porosity = table.numbers("porosity_percent");
  const auto sd = table.numbers("porosity_sd_percent");
  std::vector<MeasuredPorosity> points;
  for (std::size_t i = 0; i < pressure.size(); ++i)
    points.push_back({pressure[i], porosity[i], sd[i]});
  return points;
}

std::vector<PublishedBreaks> paper_breaks() {
  const CsvTable table = CsvTable::parse(embedded::kPaperBonds);
  const auto pressure = table.numbers("pressure_MPa");
  const auto broken = table.numbers("broken_percent");
  std::vector<PublishedBreaks> points;
  for (std::size_t i = 0; i < pressure.size(); ++i)
    points.push_back({pressure[i], broken[i]});
  return points;
}

} // namespace calendem::report
