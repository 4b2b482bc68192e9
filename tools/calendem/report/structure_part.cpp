// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/shown.h"
#include "report/plots.h"
#include "report/tables.h"
#include <algorithm>
#include <cmath>

namespace calendem::report {

namespace {

using nlohmann::json;

struct MomentLook {
  const char *moment, *shown, *colour, *dash;
  Symbol symbol;
};
const MomentLook kMoments[] = {{"before", "before", "#0064b0", "", Symbol::circle},
                               {"max", "at maximum pressure", "#c8321e", "9 4", Symbol::square},
                               {"after", "after relaxation", "#00845a", "2 3", Symbol::triangle}};

/// One series per run and moment; `value` of a row of structure.csv, NaN: no point.
template <typename Value>
void add_profiles(Chart &chart, const std::vector<Run> &runs, Value value) {
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (const auto &look : kMoments) {
      Column x, y;
      for (const StructureRow &row : runs[r].profile)
        if (const double v = value(row); row.moment == look.moment && std::isfinite(v)) {
          x.push_back(row.height);
          y.push_back(v);
        }
      if (!x.empty())
        add_line(chart, runs, r, look.shown, x, y, look.colour, look.dash).symbol = look.symbol;
    }
}

double at(const json &object, const std::string &pointer) {
  const json::json_pointer place(pointer);
  return object.contains(place) && object[place].is_number() ? object[place].get<double>() : NAN;
}

struct StructureQuantity {
  const char *name, *place;
  double factor;
  int decimals;
};
const StructureQuantity kStructureQuantities[] = {
    {"Pressure, MPa", "/pressure_MPa", 1, 1},
    {"Thickness, µm", "/thickness_um", 1, 2},
    {"Porosity total, %", "/porosity_total", kPercent, 2},
    {"Porosity macro, %", "/porosity_macro", kPercent, 2},
    {"Porosity nano, %", "/porosity_nano", kPercent, 2},
    {"Pore–solid area per volume, 1/µm", "/area_per_volume_1_um/pore_solid", 1, 3},
    {"Pore–AM area per volume, 1/µm", "/area_per_volume_1_um/pore_am", 1, 3},
    {"Bodies that a body touches", "/coordination/am_am", 1, 2},
    {"CBD spheres that a body touches", "/coordination/am_cbd", 1, 2},
    {"Bodies that a CBD sphere touches", "/coordination/cbd_am", 1, 2},
    {"Bodies seen in pieces", "/bodies_on_voxels/in_pieces", 1, 0},
    {"Tortuosity factor through the plane", "/tortuosity/tau_through_plane", 1, 2},
    {"Tortuosity factor in the plane", "/tortuosity/tau_in_plane", 1, 2}};

/// A tortuosity that could not be extrapolated is an upper bound.
std::string bound_of(const json &moment, const std::string &place) {
  const auto given = [&](const char *direction) {
    const json::json_pointer extrapolated(std::string("/tortuosity/") + direction +
                                          "/extrapolated");
    return moment.value(extrapolated, true);
  };
  if (place == "/tortuosity/tau_through_plane")
    return given("through_plane") ? "" : "≤ ";
  if (place == "/tortuosity/tau_in_plane")
    return given("in_plane_x") && given("in_plane_y") ? "" : "≤ ";
  return "";
}

} // namespace

Chart porosity_profiles(const std::vector<Run> &runs) {
  Chart chart{"profile-porosity", "Porosity through the thickness",
              "Height above the collector / thickness", "Macro porosity (%)"};
  add_profiles(chart, runs, [](const StructureRow &row) { return kPercent * row.macro; });
  chart.note = "Slices of about 1 µm. Before: the film as packed, up to the platen; the space "
               "above its rough surface counts as pore.";
  return chart;
}

Chart broken_profiles(const std::vector<Run> &runs) {
  Chart chart{"profile-broken", "Broken bonds through the thickness",
              "Height above the collector / thickness", "Broken bonds (% of the slice's)"};
  add_profiles(chart, runs, [](const StructureRow &row) {
    return row.moment == "before" || !(row.bonds > 0) ? NAN : kPercent * row.broken / row.bonds;
  });
  chart.note = "A bond belongs to the slice that contains its midpoint at that moment.";
  if (std::none_of(chart.series.begin(), chart.series.end(), [](const Series &s) {
        return std::any_of(s.y.begin(), s.y.end(), [](double y) { return y > 0; });
      }))
    chart.series.clear();
  return chart;
}

json structure_table(const Run &run) {
  if (!run.structure.is_object() || run.structure.empty())
    return nullptr;
  json table = {{"moments", json::array()}, {"rows", json::array()}};
  const json &moments = run.structure["moments"];
  for (const json &moment : moments)
    for (const auto &look : kMoments)
      if (moment.value("moment", "") == look.moment)
        table["moments"].push_back(look.shown);
  for (const StructureQuantity &q : kStructureQuantities) {
    json cells = json::array();
    bool any = false;
    for (const json &moment : moments) {
      const double value = at(moment, q.place);
      any = any || std::isfinite(value);
      cells.push_back({{"value", std::isfinite(value) ? json(value) : json(nullptr)},
                       {"text", (std::isfinite(value) ? bound_of(moment, q.place) : "") +
                                    shown(q.factor * value, q.decimals)}});
    }
    if (any)
      table["rows"].push_back({{"quantity", q.name}, {"cells", cells}});
  }
  return table;
}

Chart sphericities(const Run &run, bool single) {
  Chart chart{"shape", titled("Shape of the bodies", run, single), "Sphericity", "Bodies"};
  const auto found = run.electrode.find("sphericity_histogram");
  if (found == run.electrode.end() || !found->is_object())
    return chart;
  const double from = found->value("from", 0.0), step = found->value("step", 0.0);
  const auto count = found->value("count", std::vector<double>());
  Series bars;
  bars.mark = Mark::area;
  bars.colour = "#9ecae8";
  for (std::size_t k = 0; k < count.size(); ++k)
    for (const double x : {from + double(k) * step, from + double(k + 1) * step}) {
      bars.x.push_back(x);
      bars.y.push_back(count[k]);
      bars.base.push_back(0.0);
    }
  if (!bars.x.empty())
    chart.series.push_back(std::move(bars));
  chart.note = "Sphericity: surface of the sphere of equal volume, divided by the surface of the "
               "smooth shape that the primaries fill. The first bar includes all smaller values.";
  return chart;
}

} // namespace calendem::report
