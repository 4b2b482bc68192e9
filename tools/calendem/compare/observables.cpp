// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/observables.h"
#include "report/csv_table.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace calendem {
namespace {

constexpr double kSameTarget = 0.02;
constexpr double kCurveShares[] = {0.1, 0.25, 0.5, 0.75}; // of the maximum pressure

double none(const SimulatedRun &) { return 0.0; }

/// h/h_solid after relaxation from thickness and mass (or loading): free of the samples' different
/// loadings. Empty if one of them is missing.
std::optional<Observable> thickness_ratio(const Experiment &e, const Condition &c) {
  if (!c.thickness_after_um || !(c.mass_mg || c.loading_mg_cm2))
    return std::nullopt;
  const Measured &load = c.mass_mg ? *c.mass_mg : *c.loading_mg_cm2;
  const double loading = c.mass_mg ? coating_loading_mg_cm2(e, *c.mass_mg) : load.value;
  const double thickness = coating_thickness_um(e, *c.thickness_after_um);
  const double ratio = 1.0 / (1.0 - total_porosity(e, loading, thickness));
  // relative: of the coating's thickness, of the coating's loading
  const double per_mass =
      c.mass_mg ? (coating_loading_mg_cm2(e, {load.value + 1.0, 0.0, load.includes_foil}) - loading)
                : 1.0;
  const double of_h = c.thickness_after_um->sd / thickness, of_w = load.sd * per_mass / loading;
  Observable o = {"thickness over solid thickness", "relaxation", "", ratio,
                  ratio * std::hypot(of_h, of_w),   {},           {}};
  o.simulated = [](const SimulatedRun &r) { return r.thickness_after / r.solid_column; };
  o.slope = [](const SimulatedRun &r) {
    return r.porosity_slope * std::pow(r.thickness_after / r.solid_column, 2);
  };
  return o;
}

void porosity_after(const Experiment &e, const Condition &c, std::vector<Observable> &out,
                    std::vector<std::string> &not_said) {
  const std::optional<Observable> ratio = thickness_ratio(e, c);
  if (c.porosity_after_percent) {
    Observable o = {"total porosity",
                    "relaxation",
                    "%",
                    c.porosity_after_percent->value,
                    c.porosity_after_percent->sd,
                    {},
                    {}};
    o.simulated = [](const SimulatedRun &r) { return 100.0 * r.porosity_after; };
    o.slope = [](const SimulatedRun &r) { return 100.0 * r.porosity_slope; };
    out.push_back(o);
    if (ratio)
      not_said.push_back(fmt::format(
          "{}: mass and thickness give a porosity of {:.2f} ± {:.2f} %, stated are {:.2f} %. They "
          "are one measurement: only the stated porosity is compared.",
          c.id, 100.0 * (1.0 - 1.0 / ratio->measured),
          100.0 * ratio->sd / (ratio->measured * ratio->measured), o.measured));
  } else if (ratio) {
    out.push_back(*ratio);
  }
}

void under_load(const Experiment &e, const Condition &c, std::vector<Observable> &out) {
  if (c.control != "pressure" && c.max_pressure_MPa)
    out.push_back({"maximum pressure", "compression", "MPa", c.max_pressure_MPa->value,
                   c.max_pressure_MPa->sd, [](const SimulatedRun &r) { return r.max_pressure; },
                   none});
  if (c.control == "pressure" && c.thickness_at_max_um) {
    const double h = coating_thickness_um(e, *c.thickness_at_max_um);
    out.push_back({"thickness", "compression", "um", h, c.thickness_at_max_um->sd,
                   [](const SimulatedRun &r) { return r.thickness_at_max; },
                   [](const SimulatedRun &r) {
                     return r.porosity_slope * r.thickness_at_max / (1.0 - r.porosity_at_max);
                   }});
  }
  if (c.cracked_bodies_fraction)
    out.push_back({"cracked bodies", "compression", "fraction", c.cracked_bodies_fraction->value,
                   c.cracked_bodies_fraction->sd,
                   [](const SimulatedRun &r) { return r.cracked_fraction; }, none});
}

/// Displacement at shares of the curve's largest pressure.
void along_curve(const Condition &c, std::vector<Observable> &out) {
  if (c.curve.empty())
    return;
  std::ifstream in(c.curve);
  const auto table = report::CsvTable::parse(
      {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
  const auto d = table.numbers("displacement_um"), p = table.numbers("pressure_MPa");
  std::vector<double> pressure, displacement;
  for (std::size_t k = 0; k < p.size(); ++k)
    if (pressure.empty() || p[k] > pressure.back()) {
      pressure.push_back(p[k]);
      displacement.push_back(d[k]);
    }
  if (pressure.size() < 2)
    return;
  const double relative =
      c.max_pressure_MPa ? c.max_pressure_MPa->sd / c.max_pressure_MPa->value : 0.0;
  for (const double share : kCurveShares) {
    const double at = share * pressure.back();
    const auto slope = [at](const SimulatedRun &r) {
      return (displacement_at(r.pressure, r.displacement, 1.05 * at) -
              displacement_at(r.pressure, r.displacement, 0.95 * at)) /
             (0.1 * at);
    };
    // a calibration error is a share of each pressure, not of the largest
    out.push_back(
        {fmt::format("displacement at {:.0f} MPa", at), "compression", "um",
         displacement_at(pressure, displacement, at), 0.0,
         [at](const SimulatedRun &r) { return displacement_at(r.pressure, r.displacement, at); },
         [slope, at, relative, &c](const SimulatedRun &r) {
           return relative > 0.0 ? slope(r) * at * relative / c.max_pressure_MPa->sd : 0.0;
         }});
  }
}

bool near(double a, double b) { return std::fabs(a - b) <= kSameTarget * std::fabs(b); }

} // namespace

std::vector<Observable> observables_of(const Experiment &e, const Condition &c,
                                       std::vector<std::string> &not_said) {
  std::vector<Observable> out;
  porosity_after(e, c, out, not_said);
  under_load(e, c, out);
  along_curve(c, out);
  for (const Observable &o : out)
    if (!(o.sd > 0.0))
      not_said.push_back(fmt::format("{}: {} has no standard deviation; the measurement counts as "
                                     "exact.",
                                     c.id, o.name));
  return out;
}

bool belongs(const SimulatedRun &r, const Condition &c) {
  if (c.control == "pressure" && c.max_pressure_MPa)
    return r.control == "pressure" && near(r.target, c.max_pressure_MPa->value);
  if (c.control == "displacement" && c.displacement_um)
    return r.control == "displacement" && near(r.target, c.displacement_um->value);
  if (c.control == "thickness" && c.thickness_at_max_um)
    return r.control == "thickness" && near(r.target, c.thickness_at_max_um->value);
  return false;
}

} // namespace calendem
