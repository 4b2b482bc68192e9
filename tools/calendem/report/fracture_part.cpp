// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/shown.h"
#include "report/plots.h"
#include "report/tables.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem::report {
namespace {

using Columns = std::map<std::string, Column>;

struct Measure {
  const char *column, *name, *colour, *dash;
};

/// One line per run and measure over the rows of compression and dwell.
void add_measures(Chart &chart, const std::vector<Run> &runs, const std::vector<Measure> &measures,
                  bool per_body) {
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Columns &c = runs[r].fracture.cracks;
    if (c.empty() || c.at("pressure_MPa").empty())
      continue;
    const Column &p = c.at("pressure_MPa"), &bodies = c.at("bodies_with_bonds");
    const auto end = std::max_element(p.begin(), p.end()) + 1;
    for (const Measure &m : measures) {
      Column value = c.at(m.column);
      value.resize(std::size_t(end - p.begin()));
      for (std::size_t i = 0; per_body && i < value.size(); ++i)
        value[i] = bodies[i] > 0 ? kPercent * value[i] / bodies[i] : 0.0;
      add_line(chart, runs, r, m.name, {p.begin(), end}, value, m.colour, m.dash).symbol =
          Symbol::none;
    }
  }
}

/// Apart and whole bodies as two kinds of points; x and y of a row of bodies.csv.
template <typename X, typename Y> std::vector<Series> body_points(const Run &run, X x_of, Y y_of) {
  const Columns &b = run.fracture.bodies;
  Series whole = points_at("whole", {}, {}, "#0064b0", Symbol::circle),
         apart = points_at("apart", {}, {}, "#c8321e", Symbol::diamond);
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
  Chart chart{"cracked-pressure", "Cracked particles against pressure",
              "Pressure on the platen (MPa)", "Secondary particles (%)"};
  add_measures(chart, runs,
               {{"bodies_apart", "apart: more than one fragment", "#00845a", "2 3"},
                {"bodies_cracked", "cracked: apart and 8 % broken", "#c8321e", ""},
                {"bodies_split", "split: largest below 90 %", "#0064b0", "9 4"}},
               true);
  chart.note = "Secondary particles that have bonds, up to the maximum pressure.";
  if (std::any_of(runs.begin(), runs.end(), [](const Run &run) { return is_of_paper(run); }))
    chart.note +=
        " The paper's tomograms show intact particles at 80 MPa and obvious cracks in some "
        "of them at 150 MPa.";
  return chart;
}

Chart crack_surface(const std::vector<Run> &runs) {
  Chart chart{"crack-surface", "Crack surface against pressure", "Pressure on the platen (MPa)",
              "Surface (µm²)"};
  add_measures(chart, runs,
               {{"crack_surface_um2", "all broken bonds", "#c8321e", ""},
                {"parted_surface_um2", "between different fragments", "#0064b0", "9 4"}},
               false);
  chart.note =
      "Each broken bond counts as the facet between its two primaries; a crack opens twice this "
      "area of new surface.";
  return chart;
}

Chart thresholds(const Run &run, bool single) {
  Chart chart{"thresholds",
              titled("Does the fraction of broken bonds identify a cracked particle?", run, single),
              "Threshold (% of a particle's bonds)", "Secondary particles (%)"};
  const Columns &t = run.fracture.thresholds;
  if (t.empty())
    return chart;
  const auto at = [&](const char *column, std::size_t i) { return t.at(column)[i]; };
  const Column &percent = t.at("threshold_percent");
  Column apart_missed, apart_wrong, split_missed, split_wrong;
  for (std::size_t i = 0; i < percent.size(); ++i) {
    const double above = at("above_apart", i) + at("above_whole", i),
                 all = above + at("below_apart", i) + at("below_whole", i);
    const auto share = [&](double bodies) { return all > 0 ? kPercent * bodies / all : 0.0; };
    apart_missed.push_back(share(at("below_apart", i)));
    apart_wrong.push_back(share(at("above_whole", i)));
    split_missed.push_back(share(at("below_split", i)));
    split_wrong.push_back(share(above - at("above_split", i)));
  }
  const auto nothing = [](const Column &y) {
    return std::all_of(y.begin(), y.end(), [](double share) { return share == 0.0; });
  };
  if (nothing(apart_missed) && nothing(apart_wrong) && nothing(split_missed) &&
      nothing(split_wrong))
    return chart;
  const auto add = [&](const char *name, const Column &y, const char *colour, Symbol symbol,
                       const char *dash) {
    chart.series.push_back(line_through(name, percent, y, colour, dash));
    chart.series.back().symbol = symbol;
  };
  add("apart, but below (false negative)", apart_missed, "#c8321e", Symbol::diamond, "");
  add("above, but not apart (false positive)", apart_wrong, "#0064b0", Symbol::circle, "2 3");
  add("split, but below", split_missed, "#8a6d00", Symbol::triangle, "9 4");
  add("above, but not split", split_wrong, "#00845a", Symbol::square, "5 2 1 2");
  chart.note =
      "At the end of the run. Apart: more than one fragment, chips included. Split: the largest "
      "fragment has less than 90 % of the primaries. The paper uses 8–12 %, elsewhere 13 %.";
  return chart;
}

Chart fragments(const Run &run, bool single) {
  Chart chart{"fragments", titled("Largest fragment of each particle", run, single),
              "Broken bonds of the particle (%)", "Largest fragment (% of the primaries)"};
  chart.series = body_points(
      run, [](const Columns &b, std::size_t i) { return kPercent * b.at("broken_fraction")[i]; },
      [](const Columns &b, std::size_t i) { return kPercent * b.at("largest_fragment")[i]; });
  return chart;
}

Chart broken_by_depth(const Run &run, bool single) {
  Chart chart{"depth", titled("Broken bonds of each particle by depth", run, single),
              "Depth below the surface before pressing (µm)", "Broken bonds of the particle (%)"};
  chart.series = body_points(
      run, [](const Columns &b, std::size_t i) { return b.at("depth_um")[i]; },
      [](const Columns &b, std::size_t i) { return kPercent * b.at("broken_fraction")[i]; });
  return chart;
}

Chart one_body(const Run &run, bool single) {
  const int body = studied_body(run);
  Chart chart{"one-body",
              titled(fmt::format("Particle {}: pressure and broken bonds", body), run, single),
              "Displacement of the platen (µm)", "Pressure on the platen (MPa)",
              "Broken bonds of the particle"};
  if (body == 0 || run.fracture.breaks.empty())
    return chart;
  std::vector<double> times;
  for (std::size_t i = 0; i < run.fracture.breaks.at("body").size(); ++i)
    if (std::lround(run.fracture.breaks.at("body")[i]) == body)
      times.push_back(run.fracture.breaks.at("time_us")[i]);
  std::sort(times.begin(), times.end());
  const std::vector<std::size_t> rows = run.curve.compression();
  const Column d = picked(run.curve["displacement_um"], rows);
  Column broken;
  for (const double time : picked(run.curve["time_us"], rows))
    broken.push_back(double(std::upper_bound(times.begin(), times.end(), time) - times.begin()));
  chart.series = {line_through("pressure on the electrode", d,
                               picked(run.curve["pressure_MPa"], rows), "#0064b0"),
                  line_through("its broken bonds (right)", d, broken, "#c8321e", "9 4")};
  chart.series.back().right_axis = true;
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
