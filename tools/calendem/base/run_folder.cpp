// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/run_folder.h"
#include "base/case.h"
#include "base/provenance.h"
#include "base/shown.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>

namespace calendem {

namespace {
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
} // namespace

std::map<std::string, std::string> recipe_in(const nlohmann::json &electrode) {
  std::map<std::string, std::string> out;
  const nlohmann::json recipe = electrode.value("recipe", nlohmann::json::object());
  for (const auto &[key, value] : recipe.items())
    if (value.is_string())
      out[key] = value;
  return out;
}

std::size_t Curve::row_of_max_pressure() const {
  const Column &pressure = (*this)["pressure_MPa"];
  return static_cast<std::size_t>(std::max_element(pressure.begin(), pressure.end()) -
                                  pressure.begin());
}

std::vector<Press> Curve::presses() const {
  const Column &pressure = (*this)["pressure_MPa"];
  std::vector<Press> found;
  for (std::size_t i = 0; i < rows(); ++i) {
    if (i == 0 || (stage[i - 1] == "relaxation" && stage[i] != "relaxation"))
      found.push_back({i, i});
    found.back().last = i;
    if (pressure[i] > pressure[found.back().top])
      found.back().top = i;
  }
  return found;
}

std::vector<std::size_t> Curve::compression() const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < rows(); ++i)
    if (stage[i] != "relaxation")
      found.push_back(i);
  return found;
}

std::vector<std::size_t> Curve::relaxation() const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < rows(); ++i)
    if (stage[i] == "relaxation") {
      if (found.empty() && i > 0)
        found.push_back(i - 1); // the turning point belongs to both branches
      found.push_back(i);
    }
  return found;
}

double at_first_crossing(const Curve &curve, double pressure_MPa, const std::string &name) {
  if (!curve.has(name))
    return kNaN;
  const Column &p = curve["pressure_MPa"];
  const Column &v = curve[name];
  const auto rows = curve.compression();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t i = rows[k];
    if (p[i] < pressure_MPa)
      continue;
    if (k == 0 || p[i] == p[rows[k - 1]])
      return v[i];
    const std::size_t before = rows[k - 1];
    const double share = (pressure_MPa - p[before]) / (p[i] - p[before]);
    return v[before] + share * (v[i] - v[before]);
  }
  return kNaN;
}

Column imbalance(const Curve &curve) {
  if (curve.has("pressure_difference"))
    return curve["pressure_difference"];
  Column out;
  for (std::size_t i = 0; i < curve.rows(); ++i)
    out.push_back(std::abs(curve["pressure_MPa"][i] - curve["pressure_bottom_MPa"][i]) /
                  curve["pressure_MPa"][i]);
  return out;
}

std::vector<std::size_t> first_loading(const Column &pressure, const std::vector<bool> &released) {
  std::vector<std::size_t> found;
  double largest = 0.0, borne = 0.0; // so far; before this press
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    if (i > 0 && released[i - 1] && !released[i])
      borne = largest;
    largest = std::max(largest, pressure[i]);
    if (!released[i] && pressure[i] > borne)
      found.push_back(i);
  }
  return found;
}

std::vector<std::size_t> first_loading(const Curve &curve) {
  std::vector<bool> released;
  for (const std::string &stage : curve.stage)
    released.push_back(stage == "relaxation");
  return first_loading(curve["pressure_MPa"], released);
}

double worst_imbalance(const Curve &curve, double threshold_MPa) {
  const Column difference = imbalance(curve);
  double worst = kNaN;
  for (const std::size_t i : first_loading(curve))
    if (curve["pressure_MPa"][i] > threshold_MPa)
      worst = std::fmax(worst, difference[i]);
  return worst;
}

Column picked(const Column &values, const std::vector<std::size_t> &rows, double factor) {
  Column out;
  out.reserve(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k > 0 && rows[k] != rows[k - 1] + 1)
      out.push_back(kNaN);
    out.push_back(factor * values[rows[k]]);
  }
  return out;
}

namespace {

using nlohmann::json;

constexpr std::size_t kLeastRows = 2;
const char *const kCollectAgain = "collect the run again with this version (calendem collect)";

/// A name without its unit, which is behind the last underscore.
std::string without_unit(const std::string &column) { return column.substr(0, column.rfind('_')); }

/// " (there is 'time_s', of another unit)"
std::string of_another_unit(const std::string &column, const CsvTable &table) {
  for (const std::string &other : table.header())
    if (without_unit(other) == without_unit(column) && column.find('_') != std::string::npos)
      return fmt::format(" (there is '{}', of another unit)", other);
  return "";
}

void check_numbers(const std::string &file, const std::vector<std::string> &columns,
                   const Curve &curve, Mistakes &mistakes) {
  for (const std::string &column : columns) {
    const Column &values = curve[column];
    const auto bad =
        std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
    if (bad != values.end())
      mistakes.add(file,
                   fmt::format("column {}, row {}: not a number", column, bad - values.begin() + 1),
                   "see log.liggghts for what went wrong, and run the case again");
  }
}

} // namespace

bool RunFolder::has(const std::string &name) const {
  return std::filesystem::exists(path_of(name));
}

const json &RunFolder::object(const std::string &name) {
  const auto [at, first] = objects_.try_emplace(name);
  if (first)
    at->second = json::parse(text_of_file(path_of(name)), nullptr, false);
  if (!at->second.is_object())
    at->second = nullptr;
  return at->second;
}

const json &RunFolder::object(const std::string &name, Mistakes &mistakes) {
  const json &found = object(name);
  if (!has(name))
    mistakes.add(path_of(name), "missing", "give a folder made by calendem run");
  else if (found.is_null())
    mistakes.add(path_of(name), "cut or damaged: it holds no JSON object", "run the case again");
  return found;
}

double RunFolder::number(const std::string &key, Mistakes &mistakes) {
  const json &summary = object("summary.json");
  if (summary.is_object() && summary.contains(key) && summary[key].is_number())
    return summary[key];
  mistakes.add(path_of("summary.json"), fmt::format("it has no number '{}'", key), kCollectAgain);
  return 0.0;
}

const CsvTable &RunFolder::table(const std::string &name) {
  const auto [at, first] = tables_.try_emplace(name);
  if (first)
    at->second = CsvTable::parse(text_of_file(path_of(name)));
  return at->second;
}

bool RunFolder::has_columns(const std::string &name, const std::vector<std::string> &columns,
                            Mistakes &mistakes) {
  if (const std::string wrong = table(name).ambiguous(); !wrong.empty())
    mistakes.add(path_of(name), "it " + wrong, kCollectAgain);
  std::vector<std::string> missing;
  for (const std::string &column : columns)
    if (!table(name).has(column))
      missing.push_back(column + of_another_unit(column, table(name)));
  if (!missing.empty())
    mistakes.add(path_of(name), fmt::format("columns missing: {}", fmt::join(missing, ", ")),
                 kCollectAgain);
  return missing.empty() && table(name).ambiguous().empty();
}

bool RunFolder::rows_are_whole(const std::string &name, Mistakes &mistakes, Mistakes &notes) {
  bool whole = true;
  for (const int line : table(name).bad_lines()) {
    const std::string what = fmt::format("line {} is cut short or has cells too many", line);
    if (line == table(name).last_line() && !unfinished().empty()) {
      notes.add(path_of(name), what + "; it is left out: the run was still writing it",
                "continue the run with calendem run --resume");
      continue;
    }
    mistakes.add(path_of(name), what, "run the case again");
    whole = false;
  }
  return whole;
}

std::map<std::string, Column> RunFolder::columns(const std::string &name,
                                                 const std::vector<std::string> &columns,
                                                 Mistakes &mistakes) {
  std::map<std::string, Column> out;
  Mistakes notes;
  if (has_columns(name, columns, mistakes) && rows_are_whole(name, mistakes, notes))
    for (const std::string &column : columns)
      out[column] = table(name).numbers(column);
  return out;
}

Curve RunFolder::curve(const std::vector<std::string> &columns, Mistakes &mistakes,
                       Mistakes &notes) {
  const std::string name = "curve.csv", file = path_of(name);
  if (!has(name)) {
    const bool raw = has("curve_raw.csv");
    mistakes.add(
        file, raw ? "missing, though curve_raw.csv is there: the run was interrupted" : "missing",
        raw ? "continue with calendem run CASE.toml -o DIR --resume"
            : "give a folder made by calendem run");
    return {};
  }
  std::vector<std::string> due = columns;
  due.push_back("stage");
  if (!has_columns(name, due, mistakes) || !rows_are_whole(name, mistakes, notes))
    return {};
  const CsvTable &rows = table(name);
  if (rows.rows() < kLeastRows) {
    mistakes.add(file, fmt::format("{} rows, at least {} are needed", rows.rows(), kLeastRows),
                 "continue the run with calendem run --resume");
    return {};
  }
  Curve out;
  out.stage = rows.texts("stage");
  for (const std::string &column : rows.header())
    if (column != "stage")
      out.columns[column] = rows.numbers(column);
  check_numbers(file, columns, out, mistakes);
  return out;
}

double RunFolder::inverse_tortuosity(const std::string &moment) {
  const json &structure = object("structure.json");
  const json moments = structure.is_null() ? json() : structure.value("moments", json::array());
  for (const json &m : moments)
    if (m.value("moment", "") == moment) {
      const json through = m.value("/tortuosity/through_plane"_json_pointer, json::object());
      return number_in(through, "effective_diffusivity") / number_in(through, "porosity");
    }
  return kNaN;
}

Settings RunFolder::settings() const {
  Mistakes mistakes(path_of("case.toml"));
  const Settings out = read_toml(mistakes.file(), FileKind::Case, case_keys(), mistakes);
  mistakes.stop_if_any();
  return out;
}

std::string RunFolder::unfinished() {
  const json &summary = object("summary.json");
  if (summary.is_null())
    return has("summary.json") ? "summary.json is cut or damaged" : "summary.json is missing";
  return summary.value("finished", false) ? ""
                                          : summary.value("stopped_because", "no reason is given");
}

void RunFolder::must_be_finished(Mistakes &mistakes) {
  if (object("summary.json", mistakes).is_null())
    return;
  if (const std::string why = unfinished(); !why.empty())
    mistakes.add(folder_, fmt::format("the run is not finished ({})", why),
                 "continue with calendem run --resume");
}

} // namespace calendem
