// SPDX-License-Identifier: GPL-2.0-or-later
// The points of a bank, and the runs that they need.
#include "base/case.h"
#include "base/messages.h"
#include "diagnose/bank/bank_table.h"
#include "inference/numerics.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <tuple>

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
  return columns;
}

std::string effect_value(const BankPoint &point, const Effect &effect) {
  const auto also = point.also.find(effect.name);
  if (also != point.also.end())
    return fmt::format("{}", also->second);
  return effect.name == point.effect ? fmt::format("{}", point.value) : effect.parameter.off;
}

std::vector<std::string> row_of(const BankSpec &spec, const BankPoint &point) {
  std::vector<std::string> row = {fmt::format("{}", point.packing)};
  for (std::size_t k = 0; k < spec.parameters.size(); ++k)
    row.insert(row.end(), spec.parameters[k].keys.size(), fmt::format("{}", point.base[k]));
  for (const std::string &name : spec.effects)
    if (const Effect &e = find_effect(name); !e.instrument)
      row.insert(row.end(), e.parameter.keys.size(), effect_value(point, e));
  return row;
}

void check_columns(const Study &study) {
  Mistakes mistakes(study.file, 20);
  for (const std::string &name : study.columns)
    check_column(name, mistakes);
  mistakes.stop_if_any();
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
    p.base_point = spec.first_point + k;
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
  for (const ChosenRun &c : spec.chosen) {
    out.push_back(out[std::size_t(c.base_point - spec.first_point)]);
    out.back().effect = c.effect;
    out.back().value = c.value;
  }
  return out;
}

std::vector<PressedPoint> pressed(const std::vector<BankPoint> &points,
                                  const std::vector<Pressing> &pressings) {
  std::vector<PressedPoint> out;
  for (const BankPoint &point : points)
    for (const Pressing &pressing : pressings)
      out.push_back({point, pressing, ""});
  return out;
}

Pressing to_pressure(double pressure, const Pressing &settings) {
  Pressing out = settings;
  out.emplace_back("platen.max_pressure_MPa", fmt::format("{}", pressure));
  return out;
}

PressingColumns columns_of(const std::vector<Pressing> &pressings, const BankSpec &spec) {
  const Settings of_case = read_case(spec.case_file, read_recipe(spec.recipe_file));
  std::map<std::string, std::string> usual; // of the keys that any of them has
  for (const Pressing &pressing : pressings)
    for (const auto &[key, value] : pressing)
      usual.emplace(key, of_case.text(key));
  PressingColumns out;
  for (const auto &[key, value] : usual)
    out.names.push_back("case." + key);
  for (const Pressing &pressing : pressings) {
    std::map<std::string, std::string> values = usual;
    for (const auto &[key, value] : pressing)
      values[key] = value;
    out.rows.emplace_back();
    for (const auto &[key, value] : values)
      out.rows.back().push_back(value);
  }
  return out;
}

namespace {

std::vector<PressedPoint> to_pressures(const std::vector<BankPoint> &points,
                                       const std::vector<double> &pressures,
                                       const BankPressing &how = {}) {
  std::vector<Pressing> pressings;
  for (const double pressure : pressures)
    pressings.push_back(to_pressure(pressure, how.settings));
  std::vector<PressedPoint> out = pressed(points, pressings);
  for (PressedPoint &p : out)
    p.name = how.name;
  return out;
}

} // namespace

std::vector<PressedPoint> bank_runs(const BankSpec &spec) {
  const std::vector<BankPoint> all = bank_points(spec);
  const auto chosen = all.end() - std::ptrdiff_t(spec.chosen.size());
  const std::vector<BankPoint> points(all.begin(), chosen);
  std::vector<PressedPoint> out = to_pressures(points, spec.pressures);
  for (const BankPressing &how : spec.pressings) {
    std::vector<BankPoint> first;
    for (const BankPoint &p : points)
      if (p.base_point - spec.first_point <
          (p.effect.empty() ? how.base_points : how.effect_points))
        first.push_back(p);
    for (const PressedPoint &p : to_pressures(first, how.pressures, how))
      out.push_back(p);
  }
  for (const PressedPoint &p : to_pressures({chosen, all.end()}, spec.pressures))
    out.push_back(p);
  return out;
}

Study pressed_study(const BankSpec &spec, const std::vector<PressedPoint> &runs) {
  Study study;
  study.file = spec.file;
  study.name = spec.name;
  study.recipe_file = spec.recipe_file;
  study.case_file = spec.case_file;
  study.keep_all = false;
  study.measured = spec.tortuosity;
  study.columns = columns_of(spec);
  check_columns(study);
  std::vector<Pressing> pressings;
  for (const PressedPoint &run : runs)
    pressings.push_back(run.pressing);
  const PressingColumns pressed = columns_of(pressings, spec);
  study.columns.insert(study.columns.end(), pressed.names.begin(), pressed.names.end());
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    rows.push_back(row_of(spec, runs[k].point));
    rows.back().insert(rows.back().end(), pressed.rows[k].begin(), pressed.rows[k].end());
  }
  Mistakes mistakes(study.file, 20);
  add_runs(study, rows, mistakes);
  mistakes.stop_if_any();
  return study;
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

std::vector<PressedPoint> full_cell_runs(const BankSpec &spec) {
  std::vector<double> pressures = spec.pressures;
  for (const BankPressing &how : spec.pressings)
    if (how.name.empty())
      pressures.insert(pressures.end(), how.pressures.begin(), how.pressures.end());
  return to_pressures(full_cell_points(spec), pressures);
}

Study full_cell_study(const BankSpec &spec, const std::vector<PressedPoint> &runs) {
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
  return pressed_study(full, runs);
}

std::vector<PressedPoint> runs_beside(const BankSpec &spec, std::vector<PressedPoint> runs,
                                      const std::vector<BankRow> &rows) {
  using Place = std::tuple<std::string, int, std::string>; // effect, base point, way of pressing
  std::multimap<Place, const BankRow *> had;
  for (const BankRow &row : rows)
    had.emplace(Place(row.point.effect, row.point.base_point, row.run.pressing), &row);
  const auto is_there = [&](const PressedPoint &run) {
    const BankPoint &p = run.point;
    const auto [first, last] = had.equal_range(Place(p.effect, p.base_point, run.name));
    return std::any_of(first, last, [&](const auto &at) {
      const BankRow &row = *at.second;
      if (!same_pressure(row.run.target, std::stod(run.pressing.back().second)))
        return false;
      if (row.point.base != p.base || row.point.value != p.value || row.point.packing != p.packing)
        throw Failure(kBadInput,
                      fmt::format("the table's run of {} beside base point {} has other parameters "
                                  "than that of {}: it is the table of another bank.",
                                  p.effect.empty() ? "the base model" : p.effect, p.base_point,
                                  spec.file));
      return true;
    });
  };
  runs.erase(std::remove_if(runs.begin(), runs.end(), is_there), runs.end());
  return runs;
}

} // namespace calendem
