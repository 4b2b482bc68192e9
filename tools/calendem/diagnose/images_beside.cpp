// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/observables.h"
#include "diagnose/rerun.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace calendem {

namespace {

using nlohmann::ordered_json;

struct PackingMoments {
  double mean = 0.0, squares = 0.0; ///< squares: sum of squared deviations
  int count = 0;
};

PackingMoments packings_of(const std::vector<SimulatedRun> &runs, const Condition &c,
                           const std::function<double(const SimulatedRun &)> &value) {
  std::vector<double> values;
  for (const SimulatedRun &r : runs)
    if (pressed_as(r, c))
      values.push_back(value(r));
  PackingMoments out;
  out.count = int(values.size());
  for (const double v : values)
    out.mean += v / out.count;
  for (const double v : values)
    out.squares += (v - out.mean) * (v - out.mean);
  return out;
}

/// The first reason that a run has no value; empty: all have one.
std::string why_none(const Observable &o, const Condition &c,
                     const std::vector<ModelRuns> &models) {
  for (const ModelRuns &m : models)
    for (const SimulatedRun &r : m.runs)
      if (pressed_as(r, c) && !std::isfinite(o.simulated(r)))
        return o.why_none(r).empty()
                   ? "a run shows no such thing."
                   : o.why_none(r) + " Runs made before there was an image keep no frames: remove "
                                     "the folder rerun, and they are made again.";
  return "";
}

ordered_json row_of(const Observable &o, const Condition &c, const std::vector<ModelRuns> &models) {
  std::vector<PackingMoments> of;
  double squares = 0.0;
  int degrees = 0;
  for (const ModelRuns &m : models) {
    of.push_back(packings_of(m.runs, c, o.simulated));
    squares += of.back().squares; // packings scatter alike under all models
    degrees += of.back().count - 1;
  }
  ordered_json row = {{"condition", c.id},      {"name", o.name}, {"stage", o.stage},
                      {"measured", o.measured}, {"sd", o.sd},     {"unit", o.unit}};
  for (std::size_t m = 0; m < models.size(); ++m) {
    const double by_pressure =
        packings_of(models[m].runs, c, o.slope).mean * c.max_pressure_MPa->sd;
    const double of_mean = std::sqrt(squares / std::max(1, degrees) / of[m].count);
    const double sd = std::hypot(o.sd, of_mean, by_pressure);
    row[models[m].role] = {{"mean", of[m].mean}, {"sd", of_mean}};
    if (sd > 0.0)
      row[models[m].role]["off"] = (of[m].mean - o.measured) / sd;
  }
  return row;
}

} // namespace

bool has_images(const Condition &c) { return !c.labels_before.empty() || !c.labels_after.empty(); }

bool has_images_beside(const Experiment &e, const Condition &c) {
  return has_images(c) && c.max_pressure_MPa &&
         std::find(e.test.begin(), e.test.end(), c.id) != e.test.end();
}

ordered_json images_beside(const Experiment &e, const std::vector<ModelRuns> &models) {
  ordered_json rows = ordered_json::array();
  std::vector<std::string> without;
  for (const Condition &c : e.conditions) {
    const bool run_so = std::any_of(models.begin(), models.end(), [&](const ModelRuns &m) {
      return std::any_of(m.runs.begin(), m.runs.end(),
                         [&](const SimulatedRun &r) { return pressed_as(r, c); });
    });
    if (!has_images_beside(e, c) || !run_so) // that the bank lacks its pressing is said elsewhere
      continue;
    std::map<std::string, std::vector<std::string>> reasons;
    for (const Observable &o : image_observables_of(e, c, without))
      if (const std::string why = why_none(o, c, models); why.empty())
        rows.push_back(row_of(o, c, models));
      else
        reasons[why].push_back(o.name);
    for (const auto &[why, names] : reasons)
      without.push_back(
          fmt::format("{}: the runs have no value for {}: {}", c.id, fmt::join(names, "; "), why));
  }
  return {{"rows", rows}, {"without", without}};
}

} // namespace calendem
