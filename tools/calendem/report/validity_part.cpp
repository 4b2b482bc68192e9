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

/// A line of a column of the curve.
struct CurveLine {
  const char *column, *name, *colour, *dash;
};
const CurveLine kLimits[] = {{"force_beyond_0.1_R", "beyond 0.1 R", "#0064b0", ""},
                             {"force_beyond_0.2_R", "beyond 0.2 R", "#c8500a", "9 4"},
                             {"force_beyond_0.3_R", "beyond 0.3 R", "#00845a", "2 3"}};

const std::pair<CurveLine, bool> kInertia[] = { // and whether on the right axis
    {{"inertial_number", "inertial number", "#0064b0", ""}, false},
    {{"kinetic_to_elastic", "kinetic over elastic (right)", "#00845a", "2 3"}, true}};

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

/// A column against pressure over the rows before the release; `from`: only above that pressure.
Series &add_before_release(Chart &chart, const std::vector<Run> &runs, std::size_t i,
                           const CurveLine &of, double factor, double from) {
  const Curve &c = runs[i].curve;
  Column x, y;
  for (const std::size_t row : c.compression())
    if (c["pressure_MPa"][row] > from) {
      x.push_back(c["pressure_MPa"][row]);
      y.push_back(factor * c[of.column][row]);
    }
  return add_line(chart, runs, i, of.name, x, y, of.colour, of.dash);
}

} // namespace

Chart force_beyond_range(const std::vector<Run> &runs) {
  Chart chart{"contact-range", "Contact force beyond the range of the contact law",
              "Pressure on the platen (MPa)", "Share of the contact force (%)"};
  chart.note =
      "Elastic normal forces of contacts whose overlap exceeds a fraction of R, as a share of all "
      "contacts except those inside bodies. R: smaller radius of the pair; at a wall, the radius "
      "of the sphere. Hertz' law requires contacts that are small compared with both spheres; "
      "contacts that yield "
      "follow a law of their own, which the key results judge.";
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const CurveLine &limit : kLimits)
      if (runs[i].curve.has(limit.column))
        add_before_release(chart, runs, i, limit, kPercent, 0.0);
  return chart;
}

Chart inertial_numbers(const std::vector<Run> &runs) {
  Chart chart{"inertia", "Inertial number and kinetic energy", "Pressure on the platen (MPa)",
              "Inertial number × 1000", "Kinetic over elastic energy × 1000"};
  chart.limits = {{kPerMille * kQuasiStaticInertialNumber, "quasi-static below"}};
  chart.note = "Inertial number: platen speed over gap × mean diameter of the primaries × (their "
               "density over pressure)^½, above 5 MPa before the release. Elastic energy: in bonds "
               "and contacts.";
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const auto &[of, right] : kInertia)
      if (runs[i].curve.has(of.column))
        add_before_release(chart, runs, i, of, kPerMille, kUnderLoad).right_axis = right;
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
