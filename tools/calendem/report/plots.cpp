// SPDX-License-Identifier: GPL-2.0-or-later

#include "report/plots.h"
#include "base/shown.h"
#include <algorithm>
#include <cmath>
#include <utility>

#include "report/tables.h"

namespace calendem::report {

std::string prefix(const std::vector<Run> &runs, const Run &run) {
  return runs.size() == 1 ? "" : run.name + ": ";
}

namespace {

const char *const kBlue = "#0064b0", *const kRed = "#c8321e", *const kGreen = "#00845a";
const char *const kBlack = "#222222";
constexpr double kThreshold = 5;      // MPa: above it a run must be quasi-static ...
constexpr double kImbalanceLimit = 5; // ... to this many percent

using Rows = std::vector<std::size_t>;

struct Look {
  const char *colour;
  Symbol symbol;
};

/// Runs keep colour and symbol through all charts; a single run has no symbols.
Look look_of(const std::vector<Run> &runs, std::size_t i) {
  if (runs.size() == 1)
    return {nullptr, Symbol::none};
  return {kSeriesColours[i % kSeriesColours.size()], kSeriesSymbols[i % kSeriesSymbols.size()]};
}

Series line(const std::string &name, Column x, Column y, const char *colour,
            const std::string &dash, Look look) {
  Series series;
  series.name = name;
  series.x = std::move(x);
  series.y = std::move(y);
  series.colour = look.colour != nullptr ? look.colour : colour;
  series.dash = dash;
  series.symbol = look.symbol;
  return series;
}

Series paper_points(const std::string &name, Column x, Column y, Symbol symbol) {
  Series series;
  series.name = name;
  series.x = std::move(x);
  series.y = std::move(y);
  series.mark = Mark::points;
  series.symbol = symbol;
  series.colour = kBlack;
  return series;
}

Rows all_rows(const Curve &curve) {
  Rows rows(curve.rows());
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i] = i;
  return rows;
}

Chart pressure_displacement(const std::vector<Run> &runs) {
  Chart chart;
  chart.id = "pressure-displacement";
  chart.title = "Pressure and broken bonds against displacement";
  chart.x_label = "Displacement of the platen (µm)";
  chart.y_label = "Pressure on the platen (MPa)";
  chart.right_label = "Broken bonds (% of initial)";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Curve &c = runs[i].curve;
    const Look look = look_of(runs, i);
    const auto add = [&](const char *what, const Rows &rows, const char *column, double factor,
                         const char *colour, const char *dash) {
      chart.series.push_back(line(prefix(runs, runs[i]) + what, picked(c["displacement_um"], rows),
                                  picked(c[column], rows, factor), colour, dash, look));
    };
    add("compression", c.compression(), "pressure_MPa", 1, kBlue, "");
    if (!c.relaxation().empty())
      add("relaxation", c.relaxation(), "pressure_MPa", 1, kRed, "9 4");
    add("broken bonds (right)", all_rows(c), "broken_fraction", kPercent, kGreen, "2 3");
    chart.series.back().right_axis = true;
  }
  if (runs.size() > 1)
    return chart;
  Column x, y;
  for (const auto &point : paper_breaks()) {
    x.push_back(at_first_crossing(runs[0].curve, point.pressure_MPa, "displacement_um"));
    y.push_back(point.broken_percent);
  }
  chart.series.push_back(paper_points("paper, broken (right)", x, y, Symbol::diamond));
  chart.series.back().right_axis = true;
  chart.note =
      "The paper gives broken fractions at pressures (20, 90, 146 MPa); its points are drawn where "
      "this run first reaches the pressure.";
  return chart;
}

Chart breaks_by_pressure(const std::vector<Run> &runs) {
  Chart chart;
  chart.id = "breaks-pressure";
  chart.title = "Broken bonds against pressure";
  chart.x_label = "Pressure on the platen (MPa)";
  chart.y_label = "Broken bonds (% of initial)";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Curve &c = runs[i].curve;
    const auto add = [&](const char *what, const Rows &rows, const char *colour, const char *dash) {
      chart.series.push_back(line(prefix(runs, runs[i]) + what, picked(c["pressure_MPa"], rows),
                                  picked(c["broken_fraction"], rows, kPercent), colour, dash,
                                  look_of(runs, i)));
    };
    add("compression", c.compression(), kBlue, "");
    if (!c.relaxation().empty())
      add("relaxation", c.relaxation(), kRed, "9 4");
  }
  Column x, y;
  for (const auto &point : paper_breaks()) {
    x.push_back(point.pressure_MPa);
    y.push_back(point.broken_percent);
  }
  chart.series.push_back(paper_points("paper (simulation)", x, y, Symbol::diamond));
  return chart;
}

Chart porosity_by_pressure(const std::vector<Run> &runs) {
  Chart chart;
  chart.id = "porosity-pressure";
  chart.title = "Porosity against pressure";
  chart.x_label = "Pressure on the platen (MPa)";
  chart.y_label = "Porosity (%)";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Curve &c = runs[i].curve;
    const auto add = [&](const char *what, const char *column, const char *colour,
                         const char *dash) {
      const Rows rows = all_rows(c);
      chart.series.push_back(line(prefix(runs, runs[i]) + what, picked(c["pressure_MPa"], rows),
                                  picked(c[column], rows, kPercent), colour, dash,
                                  look_of(runs, i)));
    };
    add("total", "porosity_total", kBlue, "");
    add("macro", "porosity_macro", kGreen, "9 4");
    if (!runs[i].summary.contains("porosity_after_relaxation") ||
        !runs[i].summary["porosity_after_relaxation"].is_number())
      continue;
    const double after = runs[i].summary["porosity_after_relaxation"].get<double>() * kPercent;
    const double top = c["pressure_MPa"][c.row_of_max_pressure()];
    chart.series.push_back(paper_points(prefix(runs, runs[i]) + "total after relaxation", {top},
                                        {after}, Symbol::square));
    chart.series.back().colour = chart.series[chart.series.size() - 3].colour;
  }
  Column x, y, sd;
  for (const auto &point : paper_porosity()) {
    x.push_back(point.pressure_MPa);
    y.push_back(point.porosity_percent);
    sd.push_back(point.sd_percent);
  }
  chart.series.push_back(
      paper_points("Table 1, total after relaxation ± s.d.", x, y, Symbol::circle));
  chart.series.back().y_error = sd;
  chart.note = "Lines: under load, in compression and release. Points: after relaxation, at the "
               "maximum pressure of the run; only these can be compared with Table 1.";
  return chart;
}

Chart both_pressures(const std::vector<Run> &runs) {
  Chart chart;
  chart.id = "top-bottom";
  chart.title = "Pressure on platen and collector";
  chart.x_label = "Time (µs)";
  chart.y_label = "Pressure (MPa)";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Curve &c = runs[i].curve;
    chart.series.push_back(line(prefix(runs, runs[i]) + "platen (top)", c["time_us"],
                                c["pressure_MPa"], kBlue, "", look_of(runs, i)));
    chart.series.push_back(line(prefix(runs, runs[i]) + "collector (bottom)", c["time_us"],
                                c["pressure_bottom_MPa"], kRed, "5 4", look_of(runs, i)));
  }
  chart.note = "Where the two are equal, no stress wave carries the load. The next chart shows "
               "their difference and the limit for a quasi-static run.";
  return chart;
}

Chart quasi_static_check(const std::vector<Run> &runs) {
  Chart chart;
  chart.id = "imbalance";
  chart.title = "Quasi-static check";
  chart.x_label = "Pressure on the platen (MPa)";
  chart.y_label = "|P top − P bottom| / P top (%)";
  chart.limits = {{kImbalanceLimit, "limit 5 % above 5 MPa"}};
  chart.y_top = 2 * kImbalanceLimit;
  chart.note =
      "Both pressures are averaged over 0.5 µs, or over the curve's own window if that is "
      "longer; stress waves after a burst of breaks are shorter. The limit is for loads that the "
      "film has not borne before: neither a release nor the way back to its pressure.";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Curve &c = runs[i].curve;
    const Column difference = imbalance(c);
    const auto add = [&](const char *what, const Rows &rows, const char *colour, const char *dash) {
      Rows loaded;
      for (const std::size_t row : rows)
        if (c["pressure_MPa"][row] > kThreshold) {
          loaded.push_back(row);
          chart.y_top = std::max(chart.y_top, std::min(kPercent * difference[row], kPercent));
        }
      chart.series.push_back(line(prefix(runs, runs[i]) + what, picked(c["pressure_MPa"], loaded),
                                  picked(difference, loaded, kPercent), colour, dash,
                                  look_of(runs, i)));
    };
    add("compression", c.compression(), kBlue, "");
    if (!c.relaxation().empty())
      add("relaxation", c.relaxation(), kRed, "5 4");
  }
  return chart;
}

struct Ledger {
  const char *column, *name, *colour, *dash;
  double sign = -1.0; // 1: it was put in
};
const Ledger kLedger[] = {
    {"work_platen_fJ", "work of the platen", "#222222", "", 1.0},
    {"work_elongation_fJ", "work of the elongation", "#666666", "12 3", 1.0},
    {"strain_fJ", "elastic, in bonds", "#0064b0", "9 4"},
    {"contact_elastic_fJ", "elastic, in contacts", "#5a9bd4", "3 3"},
    {"cohesion_fJ", "cohesion", "#6b8e23", "5 2 1 2"},
    {"work_bonds_lost_fJ", "lost in breaks", "#c8321e", "2 3"},
    {"damped_fJ", "damped", "#00845a", "9 3 2 3"},
    {"friction_fJ", "friction", "#a8508c", "6 3"},
    {"kinetic_fJ", "kinetic", "#8a6d00", "14 4"},
};

Chart energy_ledger(const Run &run, bool single) {
  Chart chart;
  chart.title = single ? "Energy ledger" : "Energy ledger: " + run.name;
  chart.x_label = "Time (µs)";
  chart.y_label = "Energy (nJ)";
  constexpr double kNanojoule = 1e-6; // from fJ
  const Look plain{nullptr, Symbol::none};
  Column rest;
  for (const auto &entry : kLedger) {
    if (!run.curve.has(entry.column))
      continue;
    Column energy = picked(run.curve[entry.column], all_rows(run.curve), kNanojoule);
    if (std::none_of(energy.begin(), energy.end(), [](double e) { return std::isfinite(e); }))
      continue; // measured by nothing in this run
    // A packed film has elastic energy already.
    const double before = energy.front();
    for (double &e : energy)
      e -= before;
    if (rest.empty())
      rest = energy; // the first entry is what was put in
    else
      for (std::size_t k = 0; k < rest.size(); ++k)
        rest[k] += entry.sign * energy[k];
    chart.series.push_back(
        line(entry.name, run.curve["time_us"], std::move(energy), entry.colour, entry.dash, plain));
  }
  if (chart.series.size() > 1 && run.curve.has(kLedger[0].column)) {
    chart.series.push_back(line("rest", run.curve["time_us"], rest, "#777777", "1 5", plain));
    chart.note = "Counted from the first row. Rest: work of the platen minus all other terms "
                 "shown, that is, terms without a column in curve.csv and the error of the ledger.";
  }
  return chart;
}

struct BreakMode {
  const char *column, *name, *colour;
  Hatch hatch;
};
const BreakMode kModes[] = {{"broken_tension", "tension", "#9ecae8", Hatch::solid},
                            {"broken_bending", "bending", "#f3c48b", Hatch::rising},
                            {"broken_shear", "shear", "#a9d8b8", Hatch::dots},
                            {"broken_torsion", "torsion", "#e2b6d3", Hatch::falling}};

Chart break_modes(const Run &run, bool single) {
  Chart chart;
  chart.title = single ? "Broken bonds by mode" : "Broken bonds by mode: " + run.name;
  chart.x_label = "Time (µs)";
  chart.y_label = "Broken bonds (stacked)";
  Column base(run.curve.rows(), 0.0);
  for (const auto &mode : kModes) {
    Column top = base;
    for (std::size_t i = 0; i < top.size(); ++i)
      top[i] += run.curve[mode.column][i];
    Series series =
        line(mode.name, run.curve["time_us"], top, mode.colour, "", {nullptr, Symbol::none});
    series.mark = Mark::area;
    series.hatch = mode.hatch;
    series.base = base;
    chart.series.push_back(std::move(series));
    base = std::move(top);
  }
  chart.note = "Mode of a break: the largest of the four contributions to its stress.";
  return chart;
}

} // namespace

std::vector<Chart> plots_of(const std::vector<Run> &runs) {
  std::vector<Chart> charts{pressure_displacement(runs), breaks_by_pressure(runs),
                            porosity_by_pressure(runs), both_pressures(runs),
                            quasi_static_check(runs)};
  for (Chart chart : {force_beyond_range(runs), inertial_numbers(runs), cracked_by_pressure(runs),
                      crack_surface(runs), porosity_profiles(runs), broken_profiles(runs)})
    if (!chart.series.empty())
      charts.push_back(std::move(chart));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Chart energy = energy_ledger(runs[i], runs.size() == 1);
    energy.id = "energy-" + std::to_string(i + 1);
    if (!energy.series.empty())
      charts.push_back(std::move(energy));
    charts.push_back(break_modes(runs[i], runs.size() == 1));
    charts.back().id = "modes-" + std::to_string(i + 1);
    for (Chart chart :
         {thresholds(runs[i], runs.size() == 1), fragments(runs[i], runs.size() == 1),
          broken_by_depth(runs[i], runs.size() == 1), one_body(runs[i], runs.size() == 1),
          sphericities(runs[i], runs.size() == 1)})
      if (!chart.series.empty()) {
        chart.id += "-" + std::to_string(i + 1);
        charts.push_back(std::move(chart));
      }
  }
  return charts;
}

} // namespace calendem::report
