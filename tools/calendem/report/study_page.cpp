// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/study_page.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "base/registry.h"
#include "base/run_folder.h"
#include "base/shown.h"
#include "effects/effects.h"
#include "report/page.h"
#include "report/tables.h"
#include "simulate/collect.h"
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <set>

namespace calendem {

namespace {

const char *const kSeed = "recipe.seed";

/// Each text as the number of the first row that holds the same.
std::vector<std::size_t> pattern(const std::vector<std::string> &texts) {
  std::vector<std::size_t> out;
  for (const std::string &t : texts)
    out.push_back(std::size_t(std::find(texts.begin(), texts.end(), t) - texts.begin()));
  return out;
}

/// The value with which an effect of the case does not act: 0 GPa of a yield pressure would be taken
/// for butter.
bool is_off(const std::string &column, const std::string &value) {
  const std::string key = column.substr(column.find('.') + 1);
  return key.rfind("effects.", 0) == 0 &&
         std::any_of(effects().begin(), effects().end(), [&](const Effect &e) {
           const std::vector<std::string> &keys = e.parameter.keys;
           return std::find(keys.begin(), keys.end(), key) != keys.end() &&
                  std::strtod(value.c_str(), nullptr) == std::stod(e.parameter.off);
         });
}

} // namespace

MeanAndSd mean_and_sd(const std::vector<double> &values) {
  MeanAndSd s;
  double sum = 0.0, squares = 0.0;
  for (const double v : values)
    if (std::isfinite(v)) {
      sum += v;
      ++s.n;
    }
  s.mean = s.n > 0 ? sum / s.n : std::numeric_limits<double>::quiet_NaN();
  for (const double v : values)
    squares += std::isfinite(v) ? (v - s.mean) * (v - s.mean) : 0.0;
  s.sd = s.n > 1 ? std::sqrt(squares / (s.n - 1)) : 0.0;
  return s;
}

StudyTable::StudyTable(CsvTable table, const std::vector<std::string> &varied, bool of_paper)
    : table_(std::move(table)), of_paper_(of_paper) {
  const std::vector<std::string> status = table_.texts("status");
  for (std::size_t k = 0; k < status.size(); ++k)
    if (status[k] == "done")
      finished_.push_back(k);
  std::set<std::vector<std::size_t>> seen;
  for (const std::string &column : varied)
    if (column != kSeed && seen.insert(pattern(table_.texts(column))).second)
      settings_.push_back(column);
}

std::vector<std::string> StudyTable::numeric_settings() const {
  std::vector<std::string> out;
  for (const std::string &column : settings_) {
    const std::vector<double> values = table_.numbers(column);
    std::set<double> different(values.begin(), values.end());
    const bool all =
        std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (all && different.size() > 1)
      out.push_back(column);
  }
  return out;
}

std::vector<StudyGroup> StudyTable::groups(const std::vector<std::string> &apart) const {
  std::vector<StudyGroup> out;
  for (const std::size_t row : finished_) {
    StudyGroup group;
    for (const std::string &column : settings_)
      if (std::find(apart.begin(), apart.end(), column) == apart.end())
        group.settings[column] = table_.texts(column)[row];
    auto at = std::find_if(out.begin(), out.end(),
                           [&](const StudyGroup &g) { return g.settings == group.settings; });
    if (at == out.end())
      at = out.insert(out.end(), group);
    at->rows.push_back(row);
  }
  return out;
}

std::string StudyTable::label(const StudyGroup &group) {
  std::string out;
  for (const auto &[column, value] : group.settings) {
    const auto [name, unit] = in_words(last_part(column));
    out += (out.empty() ? "" : ", ") + name;
    out += is_off(column, value) ? " off" : fmt::format(" = {}{}", value, unit);
  }
  return out;
}

std::vector<double> StudyTable::numbers(const StudyGroup &group, const std::string &column) const {
  const std::vector<double> all = table_.numbers(column);
  std::vector<double> out;
  for (const std::size_t row : group.rows)
    out.push_back(all[row]);
  return out;
}

std::vector<std::string> StudyTable::texts(const StudyGroup &group,
                                           const std::string &column) const {
  const std::vector<std::string> all = table_.texts(column);
  std::vector<std::string> out;
  for (const std::size_t row : group.rows)
    out.push_back(all[row]);
  return out;
}

MeanAndSd StudyTable::mean_and_sd(const StudyGroup &group, const std::string &column) const {
  return calendem::mean_and_sd(numbers(group, column));
}

std::vector<double> StudyTable::pressures(const std::string &name) const {
  std::vector<double> out;
  const std::string begin = name + "_at_";
  for (const std::string &column : table_.header())
    if (column.rfind(begin, 0) == 0 &&
        std::isdigit(static_cast<unsigned char>(column[begin.size()])))
      out.push_back(std::stod(column.substr(begin.size())));
  return out;
}

extern const char *const kStudyHtml;
namespace {

std::string shown(const MeanAndSd &s, double factor, const char *format) {
  if (s.n == 0)
    return "–";
  const std::string mean = fmt::format(fmt::runtime(format), factor * s.mean);
  return s.n < 2 ? mean
                 : fmt::format("{} ± {}", mean, fmt::format(fmt::runtime(format), factor * s.sd));
}

/// Measured porosity less simulated, where the run's maximum is one of Table 1's.
std::string porosity_distance(const StudyTable &table, const StudyGroup &group) {
  const MeanAndSd top = table.mean_and_sd(group, "max_pressure_MPa"),
                  after = table.mean_and_sd(group, "porosity_after_relaxation");
  for (const report::MeasuredPorosity &p : report::paper_porosity())
    if (p.pressure_MPa > 0.0 && std::fabs(top.mean - p.pressure_MPa) < 0.02 * p.pressure_MPa)
      return fmt::format("{:+.1f}", 100.0 * after.mean - p.porosity_percent);
  return "–";
}

nlohmann::json row_of(const StudyTable &table, const StudyGroup &group) {
  nlohmann::json cells = nlohmann::json::array();
  for (const std::string &column : table.settings())
    cells.push_back(is_off(column, group.settings.at(column)) ? "off" : group.settings.at(column));
  cells.push_back(fmt::format("{}", group.rows.size()));
  cells.push_back(shown(table.mean_and_sd(group, "max_pressure_MPa"), 1.0, "{:.1f}"));
  for (const double p : table.pressures("broken_fraction"))
    cells.push_back(shown(table.mean_and_sd(group, fmt::format("broken_fraction_at_{:g}_MPa", p)),
                          100.0, "{:.1f}"));
  if (table.of_paper()) {
    const double far = distance_to_paper(table, group);
    cells.push_back(std::isfinite(far) ? fmt::format("{:.1f}", far) : "–");
  }
  cells.push_back(shown(table.mean_and_sd(group, "porosity_at_max"), 100.0, "{:.1f}"));
  cells.push_back(shown(table.mean_and_sd(group, "porosity_after_relaxation"), 100.0, "{:.1f}"));
  if (table.of_paper())
    cells.push_back(porosity_distance(table, group));
  cells.push_back(shown(table.mean_and_sd(group, "springback"), 100.0, "{:.1f}"));
  const MeanAndSd difference = table.mean_and_sd(group, "pressure_difference_max_above_5_MPa");
  cells.push_back(shown(difference, 100.0, "{:.1f}") +
                  (difference.mean > kQuasiStatic ? " !" : ""));
  return {{"cells", cells}};
}

nlohmann::json head(const StudyTable &table) {
  nlohmann::json out = nlohmann::json::array();
  for (const std::string &column : table.settings())
    out.push_back(setting_in_words(column));
  out.push_back("packings");
  out.push_back("maximum pressure (MPa)");
  for (const double p : table.pressures("broken_fraction"))
    out.push_back(fmt::format("broken at {:g} MPa (%)", p));
  if (table.of_paper())
    out.push_back("broken: distance from paper (points)");
  for (const char *name : {"porosity at maximum (%)", "porosity after relaxation (%)"})
    out.push_back(name);
  if (table.of_paper())
    out.push_back("minus Table 1 (points)");
  for (const char *name : {"springback (%)", "pressure difference (%)"})
    out.push_back(name);
  return out;
}

} // namespace

double distance_to_paper(const StudyTable &table, const StudyGroup &group) {
  double sum = 0.0;
  int n = 0;
  for (const double p : table.pressures("broken_fraction"))
    for (const report::PublishedBreaks &b : report::paper_breaks())
      if (std::fabs(b.pressure_MPa - p) < 0.5) {
        const MeanAndSd s = table.mean_and_sd(group, fmt::format("broken_fraction_at_{:g}_MPa", p));
        sum += std::pow(100.0 * s.mean - b.broken_percent, 2);
        ++n;
      }
  return n > 0 ? std::sqrt(sum / n) : std::nan("");
}

std::string study_page(const StudyTable &table, const std::vector<report::Chart> &charts,
                       const nlohmann::json &description) {
  report::Page page{kStudyHtml, description, nlohmann::json::object(), charts};
  nlohmann::json rows = nlohmann::json::array();
  for (const StudyGroup &group : table.groups())
    rows.push_back(row_of(table, group));
  page.json["finished"] = table.finished();
  page.json["of_paper"] = table.of_paper();
  page.json["table"] = {{"head", head(table)}, {"rows", rows}};
  return report::to_html(page);
}

/// The recipes of a study differ at most in what is no other electrode: its cell, its seed.
bool are_of_paper(const std::vector<std::string> &runs, const std::string &folder) {
  return std::all_of(runs.begin(), runs.end(), [&](const std::string &run) {
    RunFolder its(folder + "/runs/" + run);
    return report::is_of_paper(its.object("electrode.json"));
  });
}

void draw_study(const std::vector<std::string> &columns, const std::string &folder) {
  if (!std::filesystem::exists(folder + "/study.csv"))
    throw Failure(kBadInput, "{} holds no study.csv. Make it with calendem study.", folder);
  const nlohmann::json description =
      nlohmann::json::parse(text_of_file(folder + "/study.json"), nullptr, false);
  if (!description.is_object() || !description.contains("provenance"))
    throw Failure(
        kBadInput,
        "{}/study.json is missing or damaged. Make it again with calendem study ... --table.",
        folder);
  const CsvTable csv = CsvTable::parse(text_of_file(folder + "/study.csv"));
  const StudyTable table(csv, columns, are_of_paper(csv.texts("run"), folder));
  const auto curve = [&](const std::string &run) {
    return RunFolder(folder + "/runs/" + run).table("curve.csv");
  };
  write_file(folder + "/study.html", study_page(table, study_charts(table, curve), description));
  fmt::print("page: {}/study.html\n", folder);
}

} // namespace calendem
