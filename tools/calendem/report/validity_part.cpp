// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/shown.h"
#include "report/plots.h"

#include <cmath>

#include "physics/inertial_number.h"
#include "report/tables.h"

namespace calendem::report {
namespace {

using nlohmann::json;

constexpr double kPerMille = 1000;
constexpr double kUnderLoad = 5; // MPa

struct RangeLimit {
  const char *column, *name, *colour, *dash;
};
const RangeLimit kLimits[] = {{"force_beyond_0.1_R", "beyond 0.1 R", "#0064b0", ""},
                              {"force_beyond_0.2_R", "beyond 0.2 R", "#c8500a", "9 4"},
                              {"force_beyond_0.3_R", "beyond 0.3 R", "#00845a", "2 3"}};

struct Kind {
  const char *key, *name;
};
const Kind kKinds[] = {{"all", "all"},
                       {"am_am", "active material – active material"},
                       {"am_cbd", "active material – CBD"},
                       {"cbd_cbd", "CBD – CBD"},
                       {"wall", "platen and collector"},
                       {"inside_bodies", "inside bodies, not in all"}};

struct ContactQuantity {
  const char *key;
  double factor;
  int decimals;
};
const ContactQuantity kContactQuantities[] = {
    {"contacts", 1, 0},
    {"force_nN", 1e-6, 2},
    {"overlap_mean", 1, 3},
    {"overlap_largest", 1, 3},
    {"contacts_beyond_0.1_R", kPercent, 1},
    {"contacts_beyond_0.2_R", kPercent, 1},
    {"contacts_beyond_0.3_R", kPercent, 1},
    {"force_beyond_0.1_R", kPercent, 1},
    {"force_beyond_0.2_R", kPercent, 1},
    {"force_beyond_0.3_R", kPercent, 1},
};

/// Column against pressure over the rows before the release; `from`: only above that pressure.
Series before_release(const Run &run, const char *column, double factor, double from) {
  Series series;
  const Curve &c = run.curve;
  for (const std::size_t row : c.compression())
    if (c["pressure_MPa"][row] > from) {
      series.x.push_back(c["pressure_MPa"][row]);
      series.y.push_back(factor * c[column][row]);
    }
  return series;
}

void set_look(Series &series, const std::vector<Run> &runs, std::size_t run, const char *colour) {
  series.colour = runs.size() == 1 ? colour : kSeriesColours[run % kSeriesColours.size()];
  series.symbol = runs.size() == 1 ? Symbol::none : kSeriesSymbols[run % kSeriesSymbols.size()];
}

} // namespace

Chart force_beyond_range(const std::vector<Run> &runs) {
  Chart chart;
  chart.id = "contact-range";
  chart.title = "Contact force beyond the range of the contact law";
  chart.x_label = "Pressure on the platen (MPa)";
  chart.y_label = "Share of the contact force (%)";
  chart.note =
      "Elastic normal forces of contacts whose overlap exceeds a fraction of R, as a share of all "
      "contacts except those inside bodies. R: smaller radius of the pair; at a wall, the radius "
      "of the sphere. Hertz' law requires contacts that are small compared with both spheres.";
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const RangeLimit &limit : kLimits)
      if (runs[i].curve.has(limit.column)) {
        Series series = before_release(runs[i], limit.column, kPercent, 0.0);
        series.name = prefix(runs, runs[i]) + limit.name;
        series.dash = limit.dash;
        set_look(series, runs, i, limit.colour);
        chart.series.push_back(std::move(series));
      }
  return chart;
}

Chart inertial_numbers(const std::vector<Run> &runs) {
  Chart chart;
  chart.id = "inertia";
  chart.title = "Inertial number and kinetic energy";
  chart.x_label = "Pressure on the platen (MPa)";
  chart.y_label = "Inertial number × 1000";
  chart.right_label = "Kinetic over elastic energy × 1000";
  chart.limits = {{kPerMille * kQuasiStaticInertialNumber, "quasi-static below"}};
  chart.note = "Inertial number: platen speed over gap × mean diameter of the primaries × (their "
               "density over pressure)^½, above 5 MPa before the release. Elastic energy: in bonds "
               "and contacts.";
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const bool kinetic : {false, true}) {
      const char *column = kinetic ? "kinetic_to_elastic" : "inertial_number";
      if (!runs[i].curve.has(column))
        continue;
      Series series = before_release(runs[i], column, kPerMille, kUnderLoad);
      series.name =
          prefix(runs, runs[i]) + (kinetic ? "kinetic over elastic (right)" : "inertial number");
      series.dash = kinetic ? "2 3" : "";
      series.right_axis = kinetic;
      set_look(series, runs, i, kinetic ? "#00845a" : "#0064b0");
      chart.series.push_back(std::move(series));
    }
  return chart;
}

json validity_table(const Run &run) {
  const json at_max = run.summary.value("/contact_range/at_max_pressure"_json_pointer, json());
  if (!at_max.is_object())
    return nullptr;
  json rows = json::array();
  for (const Kind &kind : kKinds) {
    const json of_kind = at_max.value(kind.key, json::object());
    json cells = json::array();
    for (const ContactQuantity &q : kContactQuantities) {
      const auto found = of_kind.find(q.key);
      const bool known = found != of_kind.end() && found->is_number();
      cells.push_back({{"value", known ? *found : json(nullptr)},
                       {"text", shown(known ? q.factor * found->get<double>() : NAN, q.decimals)}});
    }
    rows.push_back({{"name", kind.name}, {"cells", cells}});
  }
  return {{"rows", rows}};
}

} // namespace calendem::report
