// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "diagnose/bank/bank_table.h"
#include "diagnose/inference/numerics.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

std::vector<std::string> columns_of(const BankSpec &spec) {
  std::vector<std::string> columns = {"recipe.seed"};
  for (const BankParameter &p : spec.parameters)
    columns.insert(columns.end(), p.keys.begin(), p.keys.end());
  for (const std::string &name : spec.effects)
    if (const Effect &e = find_effect(name); !e.instrument)
      for (const std::string &key : e.parameter.keys)
        columns.push_back(e.column(key));
  columns.push_back("case.platen.max_pressure_MPa");
  return columns;
}

std::vector<std::string> row_of(const BankSpec &spec, const BankPoint &point, double pressure) {
  std::vector<std::string> row = {fmt::format("{}", point.packing)};
  for (std::size_t k = 0; k < spec.parameters.size(); ++k)
    row.insert(row.end(), spec.parameters[k].keys.size(), fmt::format("{}", point.base[k]));
  for (const std::string &name : spec.effects)
    if (const Effect &e = find_effect(name); !e.instrument)
      row.insert(row.end(), e.parameter.keys.size(),
                 name == point.effect ? fmt::format("{}", point.value) : e.parameter.off);
  row.push_back(fmt::format("{}", pressure));
  return row;
}

Study filled(Study study, const std::vector<std::vector<std::string>> &rows) {
  Mistakes mistakes(study.file, 20);
  for (const std::string &name : study.columns)
    check_column(name, mistakes);
  mistakes.stop_if_any();
  add_runs(study, rows, mistakes);
  mistakes.stop_if_any();
  return study;
}

} // namespace

const char *const kFullCell = "full_cell";

double prior_value(double low, double high, Spread spread, double share) {
  const double v =
      spread == Spread::LogUniform ? low * std::pow(high / low, share) : low + share * (high - low);
  return std::stod(fmt::format("{:.4g}", v));
}

std::vector<BankPoint> bank_points(const BankSpec &spec) {
  std::vector<BankPoint> out;
  const auto shares =
      inference::sobol_points(int(spec.parameters.size()), spec.base_points, spec.seed);
  for (int k = 0; k < spec.base_points; ++k) {
    BankPoint p;
    p.base_point = k;
    p.packing = 1 + k % spec.packings;
    for (std::size_t d = 0; d < spec.parameters.size(); ++d)
      p.base.push_back(prior_value(spec.parameters[d].low, spec.parameters[d].high,
                                   spec.parameters[d].spread, shares(int(d), k)));
    out.push_back(p);
  }
  for (std::size_t e = 0; e < spec.effects.size(); ++e) {
    const Effect effect = effect_of(spec, spec.effects[e]);
    const int points = points_of(spec, effect.name);
    const auto amplitudes = inference::sobol_points(1, points, spec.seed + 1 + e);
    for (int k = 0; k < points && !effect.instrument; ++k) {
      BankPoint p = out[std::size_t(k)];
      p.effect = effect.name;
      p.value = prior_value(effect.parameter.low, effect.parameter.high, effect.parameter.spread,
                            amplitudes(0, k));
      out.push_back(p);
    }
  }
  return out;
}

Study bank_study(const BankSpec &spec, const std::vector<BankPoint> &points) {
  Study study;
  study.file = spec.file;
  study.name = spec.name;
  study.recipe_file = spec.recipe_file;
  study.case_file = spec.case_file;
  study.keep_all = false;
  study.columns = columns_of(spec);
  std::vector<std::vector<std::string>> rows;
  for (const BankPoint &p : points)
    for (const double pressure : spec.pressures)
      rows.push_back(row_of(spec, p, pressure));
  return filled(std::move(study), rows);
}

std::vector<BankPoint> full_cell_points(const BankSpec &spec) {
  std::vector<BankPoint> out;
  if (spec.full_cell.points > 0)
    out = bank_points(spec);
  out.resize(std::size_t(spec.full_cell.points));
  for (BankPoint &p : out)
    p.effect = kFullCell;
  return out;
}

Study full_cell_study(const BankSpec &spec, const std::vector<BankPoint> &points) {
  BankSpec full = spec;
  full.name = spec.name + ", full cell";
  full.recipe_file = spec.full_cell.recipe_file;
  full.case_file = spec.full_cell.case_file;
  full.effects.clear();
  for (BankParameter &p : full.parameters)
    p.keys.erase(
        std::remove_if(p.keys.begin(), p.keys.end(),
                       [](const std::string &key) { return key.rfind("recipe.", 0) == 0; }),
        p.keys.end());
  return bank_study(full, points);
}

} // namespace calendem
