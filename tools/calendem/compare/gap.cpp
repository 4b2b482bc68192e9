// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/gap.h"
#include "compare/observables.h"
#include "report/page.h"
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

namespace calendem {

Condition with_loading_of_recipe(const Experiment &e, const Condition &c,
                                 std::vector<std::string> &not_said) {
  constexpr double kKnown = 0.03; // a loading that nobody measured
  Condition out = c;
  out.loading_mg_cm2 = Measured{e.recipe.loading, kKnown * e.recipe.loading};
  not_said.push_back(fmt::format("{}: its mass or loading is not given; taken is the recipe's {:g} "
                                 "mg/cm2 within {:g} %. Weigh the sample.",
                                 c.id, e.recipe.loading, 100.0 * kKnown));
  return out;
}

namespace {

constexpr double kFalseAlarm = 0.05; // of the whole table

/// Values of an observable, one per packing: runs of one packing are averaged first.
struct Packings {
  std::vector<double> values;
  double mean = 0.0, squares = 0.0; ///< squares: sum of squared deviations
};

Packings per_packing(const std::vector<const SimulatedRun *> &runs,
                     const std::function<double(const SimulatedRun &)> &value) {
  std::map<std::string, std::vector<double>> by_electrode;
  for (const SimulatedRun *r : runs)
    by_electrode[r->electrode_hash].push_back(value(*r));
  Packings out;
  for (const auto &[electrode, values] : by_electrode) {
    double sum = 0.0;
    for (double v : values)
      sum += v;
    out.values.push_back(sum / values.size());
    out.mean += out.values.back();
  }
  out.mean /= out.values.size();
  for (double v : out.values)
    out.squares += (v - out.mean) * (v - out.mean);
  return out;
}

struct Entry {
  Residual row;
  Packings packings;
};

/// Scatter between packings, pooled over the conditions of an observable.
void pool_seeds(std::vector<Entry> &entries, int &degrees_of_freedom) {
  const auto of = [](const Entry &e) { return std::pair(e.row.observable, e.row.stage); };
  std::map<std::pair<std::string, std::string>, std::pair<double, int>> pooled;
  for (const Entry &e : entries) {
    pooled[of(e)].first += e.packings.squares;
    pooled[of(e)].second += static_cast<int>(e.packings.values.size()) - 1;
  }
  int fewest = -1;
  for (Entry &e : entries) {
    const auto [squares, df] = pooled[of(e)];
    e.row.sd_seeds = df > 0 ? std::sqrt(squares / df / e.packings.values.size()) : std::nan("");
    if (df > 0)
      fewest = fewest < 0 ? df : std::min(fewest, df);
  }
  degrees_of_freedom = fewest;
}

/// |z| that one of n rows crosses by chance in kFalseAlarm of all tables (Sidak); Student's t where
/// the scatter was estimated.
double threshold(int rows, int degrees_of_freedom) {
  const double tail = 0.5 * (1.0 - std::pow(1.0 - kFalseAlarm, 1.0 / rows));
  if (degrees_of_freedom > 0)
    return quantile(complement(boost::math::students_t(degrees_of_freedom), tail));
  return quantile(complement(boost::math::normal(), tail));
}

void finish(Gap &gap) {
  int judged = 0;
  for (Residual &r : gap.rows) {
    r.sd = std::hypot(r.sd_measurement, std::isnan(r.sd_seeds) ? 0.0 : r.sd_seeds, r.sd_pressure);
    r.z = r.sd > 0.0 ? r.residual / r.sd : std::nan("");
    judged += r.sd > 0.0;
    gap.chi2 += r.sd > 0.0 ? r.z * r.z : 0.0;
  }
  gap.threshold = threshold(std::max(1, judged), gap.degrees_of_freedom);
  for (Residual &r : gap.rows) {
    r.share = r.sd > 0.0 && gap.chi2 > 0.0 ? r.z * r.z / gap.chi2 : 0.0;
    r.significant = r.sd > 0.0 && std::fabs(r.z) > gap.threshold;
  }
  gap.p_value =
      judged > 0 ? cdf(complement(boost::math::chi_squared(double(judged)), gap.chi2)) : 1.0;
  const auto size = [](const Residual &r) { return r.sd > 0.0 ? std::fabs(r.z) : -1.0; };
  std::stable_sort(gap.rows.begin(), gap.rows.end(),
                   [&size](const Residual &a, const Residual &b) { return size(a) > size(b); });
}

void say(Gap &gap) {
  for (const Residual &r : gap.rows)
    if (r.significant)
      gap.said.push_back(in_words(to_json(r), "the simulation"));
    else if (r.sd > 0.0)
      gap.not_said.push_back(fmt::format(
          "{}, {}: a difference of {} is not significant; the detection limit here is {}.",
          r.condition, r.observable, shown_difference(std::fabs(r.residual), r.unit),
          shown_difference(gap.threshold * r.sd, r.unit)));
    else
      gap.not_said.push_back(fmt::format(
          "{}, {}: without a standard deviation it cannot be said whether a difference of {} is "
          "one. Give {{ value = ..., sd = ... }}, or runs of several packings.",
          r.condition, r.observable, shown_difference(std::fabs(r.residual), r.unit)));
  if (gap.degrees_of_freedom < 0)
    gap.not_said.push_back(
        "Scatter between packings is not known: every condition has one packing. All z are upper "
        "bounds. Pack the recipe with other seeds (at least 5) and run them too.");
}

/// A change measured and simulated between conditions: free of a common offset.
void say_changes(Gap &gap) {
  for (std::size_t a = 0; a < gap.rows.size(); ++a)
    for (std::size_t b = 0; b < gap.rows.size(); ++b) {
      const Residual &x = gap.rows[a], &y = gap.rows[b];
      if (x.observable != y.observable || x.stage != y.stage || !(x.condition < y.condition))
        continue;
      const double change = y.measured - x.measured,
                   sd = std::hypot(y.sd_measurement, x.sd_measurement);
      gap.said.push_back(fmt::format(
          "{} → {}, {}: measured {} ± {}, simulated {}{}.", x.condition, y.condition, x.observable,
          shown(change, "{:+.3g}"), shown(sd, "{:.2g}"),
          shown(y.simulated - x.simulated, "{:+.3g}"),
          std::fabs(change) < 3.0 * sd ? "; the measured change itself is below 3 of its standard "
                                         "deviations and carries little information"
                                       : ""));
    }
}

std::string why_none(const Observable &o, const std::vector<const SimulatedRun *> &runs) {
  for (const SimulatedRun *r : runs)
    if (o.why_none && !std::isfinite(o.simulated(*r)))
      return o.why_none(*r);
  return "";
}

void say_no_run(const Condition &c, Gap &gap) {
  gap.not_said.push_back(fmt::format(
      "{}: no run has its {}; nothing is said about it.", c.id,
      by_pressure(c) ? fmt::format("pressure of {:g} MPa", c.max_pressure_MPa->value)
      : c.control == "roll_gap"
          ? "roll gap: it is set beside runs of a platen, so give max_pressure_MPa as the gap "
            "was converted into it"
          : c.control));
}

/// Micrometres of one film are no micrometres of a cell of another loading.
bool other_film(const Experiment &e, const std::vector<const SimulatedRun *> &runs) {
  constexpr double kSame = 0.02;
  const double film = solid_thickness_um(e, e.recipe.loading);
  return std::any_of(runs.begin(), runs.end(), [&](const SimulatedRun *r) {
    return std::fabs(r->solid_column / film - 1.0) > kSame;
  });
}

/// A row for everything that was measured on the condition and that its runs have a value for.
void add_entries(const Experiment &experiment, const Condition &c,
                 const std::vector<const SimulatedRun *> &mine, std::vector<Entry> &entries,
                 Gap &gap) {
  if (c.control == "roll_gap")
    gap.not_said.push_back(
        fmt::format("{}: it was pressed under a roll, the runs under a platen to the pressure that "
                    "the roll's gap was converted into. What a nip does besides is taken for a gap "
                    "of the model; calendem run with platen.control = \"roll_gap\" shows how much "
                    "that is.",
                    c.id));
  if (!c.pressing.empty())
    gap.not_said.push_back(fmt::format("{}: it was pressed in a way of its own (\"{}\"); whether "
                                       "its runs were is not checked.",
                                       c.id, c.pressing));
  const bool in_um = !c.curve.empty() || c.thickness_after_um || c.thickness_at_max_um;
  std::vector<Observable> observables =
      observables_of(experiment,
                     in_um && !loading_of(experiment, c) && other_film(experiment, mine)
                         ? with_loading_of_recipe(experiment, c, gap.not_said)
                         : c,
                     gap.not_said);
  const auto on_images = image_observables_of(experiment, c, gap.not_said);
  observables.insert(observables.end(), on_images.begin(), on_images.end());
  std::map<std::string, std::vector<std::string>> without; // by the reason
  for (const Observable &o : observables) {
    Entry e;
    e.packings = per_packing(mine, o.simulated);
    e.row.observable = o.name;
    e.row.stage = o.stage;
    e.row.condition = c.id;
    e.row.unit = o.unit;
    e.row.measured = o.measured;
    e.row.sd_measurement =
        std::hypot(std::hypot(o.sd, o.by_loading), std::hypot(o.by_drift, o.by_zero));
    e.row.simulated = e.packings.mean;
    e.row.residual = e.row.simulated - o.measured;
    e.row.packings = static_cast<int>(e.packings.values.size());
    if (by_pressure(c))
      e.row.sd_pressure = std::fabs(per_packing(mine, o.slope).mean) * c.max_pressure_MPa->sd;
    if (std::isfinite(e.row.residual))
      entries.push_back(e);
    else
      without[why_none(o, mine)].push_back(o.name);
  }
  for (const auto &[why, names] : without)
    gap.not_said.push_back(fmt::format("{}: the runs have no value for {}{}", c.id,
                                       fmt::join(names, "; "), why.empty() ? "." : ": " + why));
}

/// Runs that were not used, or whose electrode or settings make them something else.
void say_of_runs(const Experiment &experiment, const std::vector<SimulatedRun> &runs,
                 const std::set<const SimulatedRun *> &used, Gap &gap) {
  for (const SimulatedRun &r : runs)
    if (!used.count(&r))
      gap.not_said.push_back(
          fmt::format("{} belongs to no condition ({} {:g}).", r.folder, r.control, r.target));
  for (const SimulatedRun *r : used)
    if (const auto differs = other_electrode(experiment.recipe.settings.all(), r->recipe);
        !differs.empty())
      gap.not_said.insert(gap.not_said.begin(),
                          fmt::format("{}: its electrode is not the experiment's; {}. What differs "
                                      "by that is no gap of the model.",
                                      r->folder, fmt::join(differs, "; ")));
  for (const SimulatedRun *r : used)
    if (!r->imposed.empty())
      gap.not_said.push_back(fmt::format("{}: the nanoporosity of CBD is {}. Its porosities are no "
                                         "prediction of the model.",
                                         r->folder, r->imposed));
}

} // namespace

Gap find_gap(const Experiment &experiment, const std::vector<SimulatedRun> &runs) {
  Gap gap;
  gap.experiment = experiment.name;
  std::vector<Entry> entries;
  std::set<const SimulatedRun *> used;
  for (const Condition &c : experiment.conditions) {
    std::vector<const SimulatedRun *> mine;
    for (const SimulatedRun &r : runs)
      if (belongs(r, c))
        mine.push_back(&r);
    used.insert(mine.begin(), mine.end());
    const auto other = std::find_if(mine.begin(), mine.end(), [&](const SimulatedRun *r) {
      return r->way != mine.front()->way;
    });
    if (other != mine.end())
      gap.not_said.push_back(fmt::format(
          "{}: its runs were pressed in different ways ({}: {}; {}: {}); nothing is said about it. "
          "Give those of one way.",
          c.id, mine.front()->folder, mine.front()->way, (*other)->folder, (*other)->way));
    else if (mine.empty())
      say_no_run(c, gap);
    else
      add_entries(experiment, c, mine, entries, gap);
  }
  if (entries.empty())
    throw Failure(kBadInput,
                  "nothing of '{}' can be compared with these runs. A run belongs to a condition "
                  "when its platen has the condition's control and target within 2 %.{}",
                  experiment.name, as_list(gap.not_said));
  say_of_runs(experiment, runs, used, gap);
  pool_seeds(entries, gap.degrees_of_freedom);
  for (const Entry &e : entries)
    gap.rows.push_back(e.row);
  finish(gap);
  say(gap);
  say_changes(gap);
  return gap;
}

extern const char *const kGapHtml;
namespace {

nlohmann::json table(const nlohmann::json &gap) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto &r : gap["where"])
    rows.push_back({{"condition", r["condition"]},
                    {"observable", r["observable"]},
                    {"stage", r["stage"]},
                    {"unit", shown_unit(r["unit"])},
                    {"measured", shown(r["measured"], "{:.4g}")},
                    {"simulated", shown(r["simulated"], "{:.4g}")},
                    {"packings", r["packings"]},
                    {"residual", shown(r["residual"], "{:+.3g}")},
                    {"sd_measurement", shown(r["sd_measurement"], "{:.2g}")},
                    {"sd_seeds", shown(r["sd_seeds"], "{:.2g}")},
                    {"sd_pressure", shown(r["sd_pressure"], "{:.2g}")},
                    {"z", shown(r["z"], "{:+.1f}")},
                    {"share", shown(100.0 * r["share"].get<double>(), "{:.0f}")},
                    {"verdict", r["significant"] ? "beyond noise" : "within noise"}});
  return rows;
}

} // namespace

nlohmann::ordered_json to_json(const Gap &gap) {
  nlohmann::ordered_json where = nlohmann::ordered_json::array();
  for (const Residual &r : gap.rows) {
    where.push_back(to_json(static_cast<const Place &>(r)));
    where.back().update({{"measured", r.measured},
                         {"simulated", r.simulated},
                         {"packings", r.packings},
                         {"sd_measurement", r.sd_measurement},
                         {"sd_seeds", or_null(r.sd_seeds)},
                         {"sd_pressure", r.sd_pressure}});
  }
  nlohmann::ordered_json out =
      new_gap(gap.experiment, where, gap.threshold, gap.degrees_of_freedom);
  out["chi2"] = or_null(gap.chi2);
  out["p_value"] = gap.p_value;
  out["said"] = gap.said;
  out["not_said"] = gap.not_said;
  return out;
}

std::string gap_page(const nlohmann::ordered_json &ordered) {
  const nlohmann::json gap = ordered;
  report::Page page{kGapHtml, ordered};
  page.values = {{"table", table(gap)},
                 {"map", heat_map(gap["where"], gap["threshold"])},
                 {"threshold_text", shown(gap["threshold"], "{:.2f}")},
                 {"chi2_text", shown(gap["chi2"], "{:.1f}")},
                 {"p_text", shown(gap["p_value"], "{:.2g}")},
                 {"rows_text", fmt::format("{}", gap["where"].size())}};
  return report::to_html(page);
}

namespace {

/// A square of the map: how far, and which way; never by colour alone.
std::string colour_of(double z, double threshold) {
  if (std::fabs(z) <= threshold)
    return "#eef1f4";
  const bool strong = std::fabs(z) > 2.0 * threshold;
  return z > 0.0 ? (strong ? "#e58a6f" : "#f5c9b8") : (strong ? "#6ea6d8" : "#bcd9f2");
}

nlohmann::json square(const nlohmann::json &r, double threshold) {
  const double z = r["z"].is_number() ? r["z"].get<double>() : INFINITY;
  const std::string unit = unit_of_difference(r["unit"]);
  return {{"text", fmt::format("{}{} (z\u00a0{})", shown(r["residual"], "{:+.3g}"),
                               unit.empty() ? "" : "\u00a0" + unit, shown(r["z"], "{:+.1f}"))},
          {"colour", colour_of(z, threshold)}};
}

void add(std::vector<std::string> &list, const std::string &name) {
  if (std::find(list.begin(), list.end(), name) == list.end())
    list.push_back(name);
}

} // namespace

nlohmann::json heat_map(const nlohmann::json &where, double threshold,
                        const std::vector<std::string> &conditions) {
  std::vector<std::string> columns = conditions, others, observables;
  std::map<std::pair<std::string, std::string>, nlohmann::json> squares;
  for (const auto &row : where) {
    const std::string o = fmt::format("{}: {}", row["stage"].get<std::string>(),
                                      row["observable"].get<std::string>());
    add(observables, o);
    add(others, row["condition"]);
    squares[{o, row["condition"]}] = square(row, threshold);
  }
  std::sort(others.begin(), others.end());
  for (const std::string &c : others)
    add(columns, c);
  nlohmann::json out = {{"conditions", columns}, {"rows", nlohmann::json::array()}};
  for (const std::string &o : observables) {
    nlohmann::json row = {{"observable", o}, {"cells", nlohmann::json::array()}};
    for (const std::string &c : columns) {
      const auto hit = squares.find({o, c});
      row["cells"].push_back(hit == squares.end()
                                 ? nlohmann::json{{"text", "–"}, {"colour", "#ffffff"}}
                                 : hit->second);
    }
    out["rows"].push_back(row);
  }
  return out;
}

} // namespace calendem
