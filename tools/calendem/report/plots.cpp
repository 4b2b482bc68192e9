// SPDX-License-Identifier: GPL-2.0-or-later

#include "report/plots.h"
#include "base/shown.h"
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "report/tables.h"

namespace calendem::report {

namespace {

const char *const kBlue = "#0064b0", *const kRed = "#c8321e", *const kGreen = "#00845a";
const char *const kBlack = "#222222";
constexpr double kThreshold = 5;      // MPa: above it a run must be quasi-static ...
constexpr double kImbalanceLimit = 5; // ... to this many percent

using Rows = std::vector<std::size_t>;

Rows all_rows(const Curve &curve) {
  Rows rows(curve.rows());
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

/// A column against another in compression and on release, times a factor.
void add_branches(Chart &chart, const std::vector<Run> &runs, std::size_t i, const char *x,
                  const char *y, double factor) {
  const Curve &c = runs[i].curve;
  const auto add = [&](const char *what, const Rows &rows, const char *colour, const char *dash) {
    add_line(chart, runs, i, what, picked(c[x], rows), picked(c[y], rows, factor), colour, dash);
  };
  add("compression", c.compression(), kBlue, "");
  if (!c.relaxation().empty())
    add("relaxation", c.relaxation(), kRed, "9 4");
}

bool any_of_paper(const std::vector<Run> &runs) {
  return std::any_of(runs.begin(), runs.end(), [](const Run &run) { return is_of_paper(run); });
}

Chart pressure_displacement(const std::vector<Run> &runs) {
  Chart chart{"pressure-displacement", "Pressure and broken bonds against displacement",
              "Displacement of the platen (µm)", "Pressure on the platen (MPa)",
              "Broken bonds (% of initial)"};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Curve &c = runs[i].curve;
    add_branches(chart, runs, i, "displacement_um", "pressure_MPa", 1);
    add_line(chart, runs, i, "broken bonds (right)", c["displacement_um"],
             picked(c["broken_fraction"], all_rows(c), kPercent), kGreen, "2 3")
        .right_axis = true;
  }
  if (runs.size() > 1 || !is_of_paper(runs[0]))
    return chart;
  Series paper = breaks_of_paper("paper, broken (right)");
  for (double &x : paper.x)
    x = at_first_crossing(runs[0].curve, x, "displacement_um");
  paper.right_axis = true;
  chart.series.push_back(std::move(paper));
  chart.note =
      "The paper gives broken fractions at pressures (20, 90, 146 MPa); its points are drawn where "
      "this run first reaches the pressure.";
  return chart;
}

Chart breaks_by_pressure(const std::vector<Run> &runs) {
  Chart chart{"breaks-pressure", "Broken bonds against pressure", "Pressure on the platen (MPa)",
              "Broken bonds (% of initial)"};
  for (std::size_t i = 0; i < runs.size(); ++i)
    add_branches(chart, runs, i, "pressure_MPa", "broken_fraction", kPercent);
  if (any_of_paper(runs))
    chart.series.push_back(breaks_of_paper("paper (simulation)"));
  return chart;
}

Chart porosity_by_pressure(const std::vector<Run> &runs) {
  Chart chart{"porosity-pressure", "Porosity against pressure", "Pressure on the platen (MPa)",
              "Porosity (%)"};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Curve &c = runs[i].curve;
    const auto add = [&](const char *what, const char *column, const char *colour,
                         const char *dash) {
      return add_line(chart, runs, i, what, c["pressure_MPa"],
                      picked(c[column], all_rows(c), kPercent), colour, dash);
    };
    const std::string colour = add("total", "porosity_total", kBlue, "").colour;
    add("macro", "porosity_macro", kGreen, "9 4");
    Column pressure, after;
    for (const nlohmann::json &press : presses_of(runs[i]))
      if (const double released = number_in(press, "porosity_released"); std::isfinite(released)) {
        pressure.push_back(number_in(press, "pressure_MPa"));
        after.push_back(kPercent * released);
      }
    if (!after.empty()) {
      add_line(chart, runs, i, "total after relaxation", pressure, after, colour.c_str(), "");
      chart.series.back().mark = Mark::points;
      chart.series.back().symbol = Symbol::square;
    }
  }
  chart.note = "Lines: under load, in compression and release. Squares: after relaxation, at the "
               "pressure of the press.";
  if (any_of_paper(runs)) {
    chart.series.push_back(porosity_of_paper("Table 1, total after relaxation ± s.d."));
    chart.note += " Only these can be compared with Table 1.";
  }
  return chart;
}

Chart both_pressures(const std::vector<Run> &runs) {
  Chart chart{"top-bottom", "Pressure on platen and collector", "Time (µs)", "Pressure (MPa)"};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Curve &c = runs[i].curve;
    add_line(chart, runs, i, "platen (top)", c["time_us"], c["pressure_MPa"], kBlue, "");
    add_line(chart, runs, i, "collector (bottom)", c["time_us"], c["pressure_bottom_MPa"], kRed,
             "5 4");
  }
  chart.note = "Where the two are equal, no stress wave carries the load. The next chart shows "
               "their difference and the limit for a quasi-static run.";
  return chart;
}

Chart quasi_static_check(const std::vector<Run> &runs) {
  Chart chart{"imbalance", "Quasi-static check", "Pressure on the platen (MPa)",
              "|P top − P bottom| / P top (%)"};
  chart.limits = {{kImbalanceLimit, "limit 5 % above 5 MPa"}};
  chart.y_top = 2 * kImbalanceLimit;
  chart.note =
      "Both pressures are averaged over 0.5 µs, or over the curve's own window if that is "
      "longer; stress waves after a burst of breaks are shorter. The limit is for loads that the "
      "film has not borne before: neither a release nor the way back to its pressure.";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Column &p = runs[i].curve["pressure_MPa"], difference = imbalance(runs[i].curve);
    const Rows first = first_loading(runs[i].curve);
    Rows judged, others;
    for (std::size_t row = 0; row < p.size(); ++row)
      if (p[row] > kThreshold)
        (std::binary_search(first.begin(), first.end(), row) ? judged : others).push_back(row);
    const auto add = [&](const char *what, const Rows &rows, const char *colour, const char *dash) {
      for (const double y : add_line(chart, runs, i, what, picked(p, rows),
                                     picked(difference, rows, kPercent), colour, dash)
                                .y)
        chart.y_top = std::max(chart.y_top, std::min(y, kPercent));
    };
    add("first loading", judged, kBlue, "");
    if (!others.empty())
      add("release and way back", others, kRed, "5 4");
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
  Chart chart{"energy", titled("Energy ledger", run, single), "Time (µs)", "Energy (nJ)"};
  constexpr double kNanojoule = 1e-6; // from fJ
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
    chart.series.push_back(line_through(entry.name, run.curve["time_us"], std::move(energy),
                                        entry.colour, entry.dash));
  }
  if (chart.series.size() > 1 && run.curve.has(kLedger[0].column)) {
    chart.series.push_back(line_through("rest", run.curve["time_us"], rest, "#777777", "1 5"));
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
  Chart chart{"modes", titled("Broken bonds by mode", run, single), "Time (µs)",
              "Broken bonds (stacked)"};
  Column base(run.curve.rows(), 0.0);
  for (const auto &mode : kModes) {
    Column top = base;
    for (std::size_t i = 0; i < top.size(); ++i)
      top[i] += run.curve[mode.column][i];
    Series series = line_through(mode.name, run.curve["time_us"], top, mode.colour);
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

std::string titled(const std::string &title, const Run &run, bool single) {
  return single ? title : title + ": " + run.name;
}

Series &add_line(Chart &chart, const std::vector<Run> &runs, std::size_t i, const std::string &name,
                 Column x, Column y, const char *colour, const char *dash) {
  const bool single = runs.size() == 1;
  chart.series.push_back(
      line_through((single ? "" : runs[i].name + ": ") + name, std::move(x), std::move(y),
                   single ? colour : kSeriesColours[i % kSeriesColours.size()], dash));
  if (!single)
    chart.series.back().symbol = kSeriesSymbols[i % kSeriesSymbols.size()];
  return chart.series.back();
}

Series breaks_of_paper(const std::string &name) {
  Series series = points_at(name, {}, {}, kBlack, Symbol::diamond);
  for (const PublishedBreaks &point : paper_breaks()) {
    series.x.push_back(point.pressure_MPa);
    series.y.push_back(point.broken_percent);
  }
  return series;
}

Series porosity_of_paper(const std::string &name) {
  Series series = points_at(name, {}, {}, kBlack, Symbol::circle);
  for (const MeasuredPorosity &point : paper_porosity()) {
    series.x.push_back(point.pressure_MPa);
    series.y.push_back(point.porosity_percent);
    series.y_error.push_back(point.sd_percent);
  }
  return series;
}

std::vector<Chart> plots_of(const std::vector<Run> &runs) {
  std::vector<Chart> charts{pressure_displacement(runs), breaks_by_pressure(runs),
                            porosity_by_pressure(runs), both_pressures(runs),
                            quasi_static_check(runs)};
  const auto add = [&](Chart chart, const std::string &number) {
    chart.id += number;
    if (!chart.series.empty())
      charts.push_back(std::move(chart));
  };
  for (const Chart &chart :
       {force_beyond_range(runs), inertial_numbers(runs), cracked_by_pressure(runs),
        crack_surface(runs), porosity_profiles(runs), broken_profiles(runs)})
    add(chart, "");
  const bool single = runs.size() == 1;
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const Chart &chart :
         {energy_ledger(runs[i], single), break_modes(runs[i], single), thresholds(runs[i], single),
          fragments(runs[i], single), broken_by_depth(runs[i], single), one_body(runs[i], single),
          sphericities(runs[i], single)})
      add(chart, "-" + std::to_string(i + 1));
  return charts;
}

} // namespace calendem::report
