// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/study_table.h"
#include "spec/csv_table.h"
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

const char *const kNumbers[] = {"max_pressure_MPa",
                                "broken_fraction_at_max",
                                "broken_fraction_after",
                                "porosity_initial",
                                "porosity_at_max",
                                "porosity_after_relaxation",
                                "thickness_at_max_um",
                                "thickness_after_relaxation_um",
                                "springback",
                                "bodies",
                                "cracked_bodies",
                                "bonds_initial",
                                "ranks",
                                "steps",
                                "wall_clock_s"};
const char *const kAtPressure[] = {"displacement_um", "thickness_um", "broken_fraction",
                                   "porosity_total"};

std::string text_of(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string number(double v) { return std::isfinite(v) ? fmt::format("{:.10g}", v) : ""; }

/// Values of `columns` where the compression first reaches `pressure`, linear between rows.
std::vector<double> at_pressure(const CsvTable &curve, double pressure) {
  std::vector<double> out(std::size(kAtPressure), std::nan(""));
  if (!curve.has("pressure_MPa") || !curve.has("stage"))
    return out;
  const std::vector<std::string> stage = curve.texts("stage");
  const std::vector<double> p = curve.numbers("pressure_MPa");
  for (std::size_t k = 1; k < p.size() && stage[k] == "compression"; ++k) {
    if (p[k] < pressure)
      continue;
    const double share = p[k] > p[k - 1] ? (pressure - p[k - 1]) / (p[k] - p[k - 1]) : 1.0;
    for (std::size_t c = 0; c < out.size(); ++c)
      if (curve.has(kAtPressure[c])) {
        const std::vector<double> v = curve.numbers(kAtPressure[c]);
        out[c] = v[k - 1] + share * (v[k] - v[k - 1]);
      }
    return out;
  }
  return out;
}

std::string results_of(const std::string &folder, const std::vector<double> &pressures) {
  const nlohmann::json s = nlohmann::json::parse(text_of(folder + "/summary.json"), nullptr, false);
  const CsvTable curve = CsvTable::parse(text_of(folder + "/curve.csv"));
  const bool finished = s.is_object() && s.value("finished", false);
  const auto value = [](const nlohmann::json &j, const char *key) {
    return j.contains(key) && j[key].is_number() ? j[key].get<double>() : std::nan("");
  };
  std::string out;
  for (const char *key : kNumbers)
    out += "," + number(finished ? value(s, key) : std::nan(""));
  const nlohmann::json quiet =
      finished ? s.value("quasi_static", nlohmann::json::object()) : nlohmann::json::object();
  out += "," + number(value(quiet, "pressure_difference_max_above_5_MPa"));
  for (const double p : pressures)
    for (const double v : finished ? at_pressure(curve, p)
                                   : std::vector<double>(std::size(kAtPressure), std::nan("")))
      out += "," + number(v);
  return out;
}

} // namespace

std::string study_table(const Study &study, const std::vector<RunState> &states,
                        const std::string &folder) {
  std::string out = "number,status,run,packing";
  for (const std::string &c : study.columns)
    out += "," + c;
  for (const char *key : kNumbers)
    out += std::string(",") + key;
  out += ",pressure_difference_max_above_5_MPa";
  for (const double p : study.at_pressure)
    for (const char *key : kAtPressure)
      out += fmt::format(",{}_at_{:g}_MPa", key, p);
  out += "\n";
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const RunState &s = states[k];
    out += fmt::format("{},{},{},{}", study.runs[k].number, s.status, s.run, s.packing);
    for (const std::string &v : study.runs[k].values)
      out += "," + v;
    out += results_of(folder + "/runs/" + s.run, study.at_pressure) + "\n";
  }
  return out;
}

} // namespace calendem
