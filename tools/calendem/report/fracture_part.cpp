// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/shown.h"
#include "report/plots.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace calendem::report {
namespace {

using Columns = std::map<std::string, Column>;

Chart axes(const char *id, const std::string &title, const char *x_label, const char *y_label) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.x_label = x_label;
  chart.y_label = y_label;
  return chart;
}

Series points(const std::string &name, const char *colour, Symbol symbol) {
  Series series;
  series.name = name;
  series.mark = Mark::points;
  series.colour = colour;
  series.symbol = symbol;
  return series;
}

struct Measure {
  const char *column, *name, *colour, *dash;
};

/// One line per run and measure over the rows of compression and dwell.
std::vector<Series> against_pressure(const std::vector<Run> &runs,
                                     const std::vector<Measure> &measures, bool per_body) {
  std::vector<Series> all;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Columns &c = runs[r].fracture.cracks;
    if (c.empty() || c.at("pressure_MPa").empty())
      continue;
    const Column &p = c.at("pressure_MPa");
    const std::size_t rows = std::max_element(p.begin(), p.end()) - p.begin() + 1;
    for (const Measure &m : measures) {
      Series line;
      line.name = (runs.size() == 1 ? "" : runs[r].name + ": ") + m.name;
      line.colour = runs.size() == 1 ? m.colour : kSeriesColours[r % kSeriesColours.size()];
      line.dash = m.dash;
      for (std::size_t i = 0; i < rows; ++i) {
        const double bodies = c.at("bodies_with_bonds")[i];
        const double value = c.at(m.column)[i];
        line.x.push_back(p[i]);
        line.y.push_back(per_body ? (bodies > 0 ? kPercent * value / bodies : 0.0) : value);
      }
      all.push_back(std::move(line));
    }
  }
  return all;
}

std::string titled(const std::string &title, const Run &run, bool single) {
  return single ? title : title + ": " + run.name;
}

/// Apart and whole bodies as two kinds of points; x and y of a row of bodies.csv.
template <typename X, typename Y> std::vector<Series> body_points(const Run &run, X x_of, Y y_of) {
  const Columns &b = run.fracture.bodies;
  Series whole = points("whole", "#0064b0", Symbol::circle),
         apart = points("apart", "#c8321e", Symbol::diamond);
  if (b.empty())
    return {};
  for (std::size_t i = 0; i < b.at("body").size(); ++i) {
    if (!(b.at("bonds")[i] > 0))
      continue;
    Series &series = b.at("fragments")[i] > 1 ? apart : whole;
    series.x.push_back(x_of(b, i));
    series.y.push_back(y_of(b, i));
  }
  std::vector<Series> out;
  for (Series *series : {&whole, &apart})
    if (!series->x.empty())
      out.push_back(std::move(*series));
  return out;
}

} // namespace

Chart cracked_by_pressure(const std::vector<Run> &runs) {
  Chart chart = axes("cracked-pressure", "Cracked particles against pressure",
                     "Pressure on the platen (MPa)", "Secondary particles (%)");
  chart.series =
      against_pressure(runs,
                       {{"bodies_apart", "apart: more than one fragment", "#00845a", "2 3"},
                        {"bodies_cracked", "cracked: apart and 8 % broken", "#c8321e", ""},
                        {"bodies_split", "split: largest below 90 %", "#0064b0", "9 4"}},
                       true);
  chart.note =
      "Secondary particles that have bonds, up to the maximum pressure. The paper's tomograms show "
      "intact particles at 80 MPa and obvious cracks in some of them at 150 MPa.";
  return chart;
}

Chart crack_surface(const std::vector<Run> &runs) {
  Chart chart = axes("crack-surface", "Crack surface against pressure",
                     "Pressure on the platen (MPa)", "Surface (µm²)");
  chart.series =
      against_pressure(runs,
                       {{"crack_surface_um2", "all broken bonds", "#c8321e", ""},
                        {"parted_surface_um2", "between different fragments", "#0064b0", "9 4"}},
                       false);
  chart.note = "Each broken bond counts as one face of its lattice cell; a crack opens twice this "
               "area of new surface.";
  return chart;
}

Chart thresholds(const Run &run, bool single) {
  Chart chart =
      axes("thresholds",
           titled("Does the fraction of broken bonds identify a cracked particle?", run, single),
           "Threshold (% of a particle's bonds)", "Secondary particles (%)");
  const Columns &t = run.fracture.thresholds;
  if (t.empty())
    return chart;
  const auto at = [&](const char *column, std::size_t i) { return t.at(column)[i]; };
  Series apart_missed = points("apart, but below (false negative)", "#c8321e", Symbol::diamond),
         apart_wrong = points("above, but not apart (false positive)", "#0064b0", Symbol::circle),
         split_missed = points("split, but below", "#8a6d00", Symbol::triangle),
         split_wrong = points("above, but not split", "#00845a", Symbol::square);
  for (std::size_t i = 0; i < t.at("threshold_percent").size(); ++i) {
    const double above = at("above_apart", i) + at("above_whole", i),
                 all = above + at("below_apart", i) + at("below_whole", i);
    const auto add = [&](Series &series, double bodies) {
      series.x.push_back(at("threshold_percent", i));
      series.y.push_back(all > 0 ? kPercent * bodies / all : 0.0);
    };
    add(apart_missed, at("below_apart", i));
    add(apart_wrong, at("above_whole", i));
    add(split_missed, at("below_split", i));
    add(split_wrong, above - at("above_split", i));
  }
  const char *const dashes[] = {"", "2 3", "9 4", "5 2 1 2"};
  Series *const all[] = {&apart_missed, &apart_wrong, &split_missed, &split_wrong};
  for (int k = 0; k < 4; ++k) {
    all[k]->mark = Mark::line;
    all[k]->dash = dashes[k];
    chart.series.push_back(std::move(*all[k]));
  }
  chart.note =
      "At the end of the run. Apart: more than one fragment, chips included. Split: the largest "
      "fragment has less than 90 % of the primaries. The paper uses 8–12 %, elsewhere 13 %.";
  return chart;
}

Chart fragments(const Run &run, bool single) {
  Chart chart = axes("fragments", titled("Largest fragment of each particle", run, single),
                     "Broken bonds of the particle (%)", "Largest fragment (% of the primaries)");
  chart.series = body_points(
      run, [](const Columns &b, std::size_t i) { return kPercent * b.at("broken_fraction")[i]; },
      [](const Columns &b, std::size_t i) { return kPercent * b.at("largest_fragment")[i]; });
  return chart;
}

Chart broken_by_depth(const Run &run, bool single) {
  Chart chart =
      axes("depth", titled("Broken bonds of each particle by depth", run, single),
           "Depth below the surface before pressing (µm)", "Broken bonds of the particle (%)");
  chart.series = body_points(
      run, [](const Columns &b, std::size_t i) { return b.at("depth_um")[i]; },
      [](const Columns &b, std::size_t i) { return kPercent * b.at("broken_fraction")[i]; });
  return chart;
}

Chart one_body(const Run &run, bool single) {
  const int body = studied_body(run);
  Chart chart =
      axes("one-body",
           titled("Particle " + std::to_string(body) + ": pressure and broken bonds", run, single),
           "Displacement of the platen (µm)", "Pressure on the platen (MPa)");
  chart.right_label = "Broken bonds of the particle";
  if (body == 0 || run.fracture.breaks.empty())
    return chart;
  std::vector<double> times;
  for (std::size_t i = 0; i < run.fracture.breaks.at("body").size(); ++i)
    if (std::lround(run.fracture.breaks.at("body")[i]) == body)
      times.push_back(run.fracture.breaks.at("time_us")[i]);
  std::sort(times.begin(), times.end());
  Series pressure, broken;
  pressure.name = "pressure on the electrode";
  pressure.colour = "#0064b0";
  broken.name = "its broken bonds (right)";
  broken.colour = "#c8321e";
  broken.dash = "9 4";
  broken.right_axis = true;
  for (const std::size_t row : run.curve.compression()) {
    const double d = run.curve["displacement_um"][row];
    pressure.x.push_back(d);
    pressure.y.push_back(run.curve["pressure_MPa"][row]);
    broken.x.push_back(d);
    broken.y.push_back(double(
        std::upper_bound(times.begin(), times.end(), run.curve["time_us"][row]) - times.begin()));
  }
  chart.series = {std::move(pressure), std::move(broken)};
  chart.note =
      "The particle with the most broken bonds, in compression, like the paper's Figure 5b.";
  return chart;
}

int studied_body(const Run &run) {
  const Columns &b = run.fracture.bodies;
  if (b.empty() || b.at("broken").empty())
    return 0;
  const Column &broken = b.at("broken");
  const auto most = std::max_element(broken.begin(), broken.end());
  return *most > 0 ? static_cast<int>(b.at("body")[most - broken.begin()]) : 0;
}

} // namespace calendem::report
