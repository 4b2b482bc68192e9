// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/study_page.h"
#include <algorithm>
#include <cctype>
#include <cmath>
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

std::string short_name(const std::string &key) {
  std::string name = key.substr(key.rfind('.') + 1);
  for (const char *unit : {"_MPa", "_GPa", "_m_s", "_um", "_us", "_mg_cm2", "_percent"})
    if (name.size() > std::string(unit).size() &&
        name.compare(name.size() - std::string(unit).size(), std::string::npos, unit) == 0)
      return name.substr(0, name.size() - std::string(unit).size());
  return name;
}

StudyTable::StudyTable(CsvTable table, const std::vector<std::string> &varied)
    : table_(std::move(table)) {
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
  for (const auto &[column, value] : group.settings)
    out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", short_name(column), value);
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

} // namespace calendem
