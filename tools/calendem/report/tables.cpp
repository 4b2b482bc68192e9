// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/tables.h"
#include "base/csv_table.h"
#include "base/material_notes.h"
#include "base/recipe.h"
#include "base/shown.h"
#include "report/page.h"
#include "simulate/collect.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <map>

namespace calendem::report {

namespace {

using nlohmann::json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kImbalanceThreshold = 5; // MPa
constexpr const char *kTooWide = "Powder that the cell leaves out",
                     *kImbalance = "Largest |P top − P bottom| / P",
                     *kBeyondLaw = "Contact force beyond its law's range";
/// A run compares with a row of Table 1 when its maximum pressure is this close to the row's.
constexpr double kSamePressure = 0.02;
/// The paper's pressures are converted from gaps: at least 10 % uncertain.
constexpr double kPressureError = 0.1;
/// Scatter of the porosity over packings [points]: nine of them in docs/validation/demo.md.
constexpr double kPackingError = 1.0;

/// What the labels of the headline stand for.
std::string meaning_of(const std::string &label) {
  static const std::map<std::string, std::string> meanings = {
      {"Maximum pressure", "Largest pressure on the platen."},
      {"Total porosity before",
       "Pores between particles and nanopores inside carbon and binder, before pressing."},
      {"Total porosity at maximum", "Pores that are left under the largest pressure."},
      {"Total porosity after relaxation",
       "Pores that are left when the platen has lost contact with the film."},
      {"Thickness after relaxation", "Of the coating, without the foil."},
      {"Springback", "By how much the film grows on release, of its thickness under load."},
      {"Bonds broken at maximum", "Bonds inside particles, of those there were at first."},
      {"Cracked bodies",
       "Particles in two fragments or more, of whose bonds at least 8 % are broken."},
      {"CBD nanoporosity", "Pores inside carbon and binder, which the case imposed."},
      {kTooWide,
       "Particles of the powder that are wider than the cell can hold; smaller ones take their "
       "place. A larger cell holds more."},
      {kImbalance, "Platen and collector should carry the same pressure; rows in which they do not "
                   "are not quasi-static. A lower platen.speed_m_s helps."},
      {kBeyondLaw, "This part of the force between particles is carried by overlaps for which the "
                   "contact law was not compared with anything: it is extrapolated there."}};
  const auto found = meanings.find(label);
  return found == meanings.end() ? "" : found->second;
}

json figure(const char *label, double value, const char *unit, int decimals,
            const std::string &remark = "", double limit = kNaN) {
  return {{"label", label},
          {"value", or_null(value)},
          {"unit", std::isfinite(value) ? unit : ""},
          {"text", shown(value, decimals)},
          {"remark", remark},
          {"means", meaning_of(label)},
          {"exceeded", value > limit}};
}

double max_pressure(const Run &run) {
  return run.curve["pressure_MPa"][run.curve.row_of_max_pressure()];
}

/// A number of the press that went to this pressure [%]; NaN: there is none.
double of_press(const Run &run, double pressure, const char *key) {
  for (const json &press : presses_of(run))
    if (std::abs(number_in(press, "pressure_MPa") - pressure) <= kSamePressure * pressure)
      return kPercent * number_in(press, key);
  return kNaN;
}

std::string with_sign(double value, int decimals) {
  std::string text = shown(value, decimals);
  if (text.front() == '-')
    text.replace(0, 1, "−");
  else if (value > 0)
    text.insert(0, "+");
  return text;
}

json cell(const Run &run, double value, double paper) {
  const double difference = value - paper;
  return {{"run", run.name},
          {"value", or_null(value)},
          {"difference", or_null(difference)},
          {"text", shown(value, 2)},
          {"difference_text", with_sign(difference, 2)}};
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

/// Points of porosity by which one film presses differently if its pressure is 10 % wrong: from the
/// two pressed films of Table 1.
double sd_of_pressure() {
  const std::vector<MeasuredPorosity> table = paper_porosity();
  const MeasuredPorosity &low = table[1], &high = table[2];
  return kPressureError * (low.porosity_percent - high.porosity_percent) /
         std::log(high.pressure_MPa / low.pressure_MPa);
}

/// How many standard deviations, of measurement, pressure and packing together, the run is off.
void add_verdict(json &row) {
  const double sd = std::hypot(row["paper_sd"].get<double>(), sd_of_pressure(), kPackingError);
  for (json &c : row["cells"])
    if (c["difference"].is_number()) {
      const double z = c["difference"].get<double>() / sd;
      c["z"] = z;
      c["difference_text"] =
          fmt::format("{}: {} sd", c["difference_text"].get<std::string>(), with_sign(z, 1));
    }
}

json porosity_row(const std::vector<Run> &runs, const MeasuredPorosity &point) {
  const double p = point.pressure_MPa;
  if (p == 0)
    return row(runs, "Total porosity before calendering, %", p, point.porosity_percent,
               point.sd_percent,
               [](const Run &run) { return kPercent * run.curve["porosity_total"].front(); });
  json made =
      row(runs, "Total porosity after relaxation, %", p, point.porosity_percent, point.sd_percent,
          [p](const Run &run) { return of_press(run, p, "porosity_released"); });
  add_verdict(made);
  return made;
}

json loaded_row(const std::vector<Run> &runs, double pressure) {
  return row(runs, "Total porosity under load, %", pressure, kNaN, kNaN, [=](const Run &run) {
    const double of_its_press = of_press(run, pressure, "porosity_loaded");
    return std::isfinite(of_its_press)
               ? of_its_press
               : kPercent * at_first_crossing(run.curve, pressure, "porosity_total");
  });
}

/// In the paper's tomograms.
json cracked_row(const std::vector<Run> &runs, double pressure, const char *seen) {
  json made = row(runs, "Cracked particles, %", pressure, kNaN, kNaN,
                  [=](const Run &run) { return of_press(run, pressure, "cracked_fraction"); });
  made["paper_text"] = seen;
  return made;
}

json breaks_row(const std::vector<Run> &runs, const PublishedBreaks &point) {
  return row(runs, "Broken bonds, paper's model, %", point.pressure_MPa, point.broken_percent, kNaN,
             [&](const Run &run) {
               return kPercent *
                      at_first_crossing(run.curve, point.pressure_MPa, "broken_fraction");
             });
}

json fact(const std::string &name, const json &value) {
  const NameAndUnit words = in_words(name);
  const std::string text = value.is_string()         ? value.get<std::string>()
                           : value.is_number_float() ? fmt::format("{:.5g}", value.get<double>())
                           : value.is_boolean()      ? (value.get<bool>() ? "yes" : "no")
                                                     : value.dump();
  return {{"name", words.name},
          {"value", value},
          {"text", text},
          {"unit", words.unit.empty() ? "" : words.unit.substr(1)}};
}

void collect_facts(const json &object, const std::string &prefix,
                   const std::vector<std::string> &left_out, json &facts) {
  for (const auto &[key, value] : object.items()) {
    if (std::find(left_out.begin(), left_out.end(), key) != left_out.end())
      continue;
    const std::string name = prefix.empty() ? key : fmt::format("{}: {}", prefix, key);
    if (value.is_object())
      collect_facts(value, name, {}, facts);
    else
      facts.push_back(fact(name, value));
  }
}

} // namespace

std::string shown(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "–";
}

json presses_of(const Run &run) {
  if (run.summary.contains("presses"))
    return run.summary["presses"];
  const json whole = {
      {"pressure_MPa", or_null(max_pressure(run))},
      {"porosity_loaded", or_null(number_in(run.summary, "porosity_at_max"))},
      {"porosity_released", or_null(number_in(run.summary, "porosity_after_relaxation"))},
      {"cracked_fraction",
       or_null(number_in(run.summary, "cracked_bodies") / number_in(run.summary, "bodies"))}};
  return json::array({whole});
}

bool is_of_paper(const json &electrode) {
  if (!electrode.is_object())
    return true;
  std::map<std::string, std::string> paper;
  for (const Key &key : recipe_keys())
    paper[key.name] = key.fallback;
  return other_electrode(paper, recipe_in(electrode)).empty();
}

bool is_of_paper(const Run &run) { return is_of_paper(run.electrode); }

/// After the last press.
std::string share_of_bonded(const json &presses) {
  const double share = number_in(presses.back(), "cracked_fraction");
  return std::isfinite(share) ? shown(kPercent * share, 1) + " % of those that have bonds" : "";
}

json headline_of(const Run &run) {
  const Curve &c = run.curve;
  const std::size_t top = c.row_of_max_pressure();
  const json &s = run.summary;
  const auto percent = [&](const char *column, std::size_t row) {
    return kPercent * c[column][row];
  };
  const auto of_all = [&](const char *key) {
    const double all = number_in(s, key);
    return std::isfinite(all) ? "of " + shown(all, 0) : "";
  };
  json figures = {
      figure("Maximum pressure", max_pressure(run), "MPa", 1),
      figure("Total porosity before", percent("porosity_total", 0), "%", 1),
      figure("Total porosity at maximum", percent("porosity_total", top), "%", 1),
      figure("Total porosity after relaxation",
             kPercent * number_in(s, "porosity_after_relaxation"), "%", 1),
      figure("Thickness after relaxation", number_in(s, "thickness_after_relaxation_um"), "µm", 1),
      figure("Springback", kPercent * number_in(s, "springback"), "%", 1),
      figure("Bonds broken at maximum", percent("broken_fraction", top), "%", 1,
             of_all("bonds_initial")),
      figure("Cracked bodies", number_in(s, "cracked_bodies"), "", 0,
             share_of_bonded(presses_of(run)))};
  if (s.contains("imposed"))
    figures.push_back(figure("CBD nanoporosity", kPercent * number_in(s["imposed"], "final"), "%",
                             1, s["imposed"].value("what", "imposed")));
  if (run.electrode.contains(kCutOff))
    figures.push_back(figure(kTooWide, kPercent * number_in(run.electrode, kCutOff), "%", 0,
                             "of its volume; limit 20 %", kPercent * kCutOffWarned));
  figures.push_back(figure(kImbalance, kPercent * worst_imbalance(c, kImbalanceThreshold), "%", 1,
                           "above 5 MPa; limit 5 %", kPercent * kQuasiStatic));
  const json range = s.value("/contact_range/at_max_pressure/all"_json_pointer, json());
  if (range.is_object())
    figures.push_back(figure(kBeyondLaw, kPercent * number_in(range, "force_beyond_law"), "%", 1,
                             "at maximum pressure; limit 10 %", kPercent * kWarnedShare));
  return figures;
}

json comparison_of(const std::vector<Run> &all) {
  std::vector<Run> runs;
  std::copy_if(all.begin(), all.end(), std::back_inserter(runs),
               [](const Run &run) { return is_of_paper(run); });
  if (runs.empty())
    return nullptr;
  json rows = json::array();
  for (const auto &point : paper_porosity())
    rows.push_back(porosity_row(runs, point));
  for (const auto &point : paper_porosity())
    if (point.pressure_MPa > 0)
      rows.push_back(loaded_row(runs, point.pressure_MPa));
  rows.push_back(cracked_row(runs, 80, "few"));
  rows.push_back(cracked_row(runs, 150, "some"));
  for (const auto &point : paper_breaks())
    rows.push_back(breaks_row(runs, point));
  json compared = json::array();
  for (const Run &run : runs)
    compared.push_back({{"name", run.name}});
  return {{"rows", rows}, {"compared", compared}};
}

std::string comparison_text(const json &comparison) {
  if (comparison.is_null())
    return "";
  const auto text = [](const json &row, const char *key) { return row[key].get<std::string>(); };
  const json &rows = comparison["rows"];
  std::string out = fmt::format("{:<39}{:>7}{:>15}", "", "at MPa", "paper");
  if (!rows.empty())
    for (const json &c : rows[0]["cells"])
      out += fmt::format("{:>26}", text(c, "run"));
  out += '\n';
  for (const json &r : rows) {
    out += fmt::format("{:<39}{:>7}{:>15}", text(r, "quantity"), text(r, "pressure_text"),
                       text(r, "paper_text"));
    for (const json &c : r["cells"]) {
      const bool compared = c["difference"].is_number();
      out += fmt::format("{:>26}", text(c, "text") +
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
  std::vector<MeasuredPorosity> points;
  for (std::size_t i = 0; i < table.rows(); ++i)
    points.push_back({table.numbers("pressure_MPa")[i], table.numbers("porosity_percent")[i],
                      table.numbers("porosity_sd_percent")[i]});
  return points;
}

std::vector<PublishedBreaks> paper_breaks() {
  const CsvTable table = CsvTable::parse(embedded::kPaperBonds);
  std::vector<PublishedBreaks> points;
  for (std::size_t i = 0; i < table.rows(); ++i)
    points.push_back({table.numbers("pressure_MPa")[i], table.numbers("broken_percent")[i]});
  return points;
}

} // namespace calendem::report
