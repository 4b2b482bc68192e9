// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/observables.h"
#include "compare/measured_curve.h"
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr double kSameTarget = 0.02;
// Shares of the maximum pressure; the release is compared at the same, less the first: there the
// film parts from the platen, and how it does is the press's affair too.
constexpr double kCurveShares[] = {0.1, 0.25, 0.5, 0.75};

double none(const SimulatedRun &) { return 0.0; }
double percent(const SimulatedRun &) { return kPercent; }
Derivative value_of(double SimulatedRun::*member, double unit = 1.0) {
  return [member, unit](const SimulatedRun &r) { return unit * r.*member; };
}

/// h/h_solid: free of the samples' different loadings. `of`: the run's thickness.
Observable thickness_ratio(const Experiment &e, const Measured &thickness, const Measured &loading,
                           const char *stage, double SimulatedRun::*of) {
  const double h = coating_thickness_um(e, thickness);
  const double ratio = h / solid_thickness_um(e, loading.value);
  const auto simulated = [of](const SimulatedRun &r) { return r.*of / r.solid_column; };
  const auto per_porosity = [simulated](const SimulatedRun &r) { // of 1/(1 - porosity)
    return std::pow(simulated(r), 2);
  };
  Observable o = {"thickness over solid thickness", stage,     "", ratio,
                  ratio * thickness.sd / h,         simulated, {}};
  o.by_loading = -ratio * loading.sd / loading.value;
  o.per_porosity = per_porosity;
  o.slope = [per_porosity](const SimulatedRun &r) { return r.porosity_slope * per_porosity(r); };
  return o;
}

/// In um: the sample's loading is not known. `of`, `porosity`: the run's.
Observable thickness_in_um(const Experiment &e, const Measured &thickness, const char *stage,
                           double SimulatedRun::*of, double SimulatedRun::*porosity) {
  const auto per_porosity = [of, porosity](const SimulatedRun &r) {
    return r.*of / (1.0 - r.*porosity);
  };
  Observable o = {"thickness",  stage,        "um", coating_thickness_um(e, thickness),
                  thickness.sd, value_of(of), {}};
  o.per_porosity = per_porosity;
  o.slope = [per_porosity](const SimulatedRun &r) { return r.porosity_slope * per_porosity(r); };
  return o;
}

std::string without_loading(const Condition &c, const std::string &what) {
  return fmt::format("{}: without a mass or a loading of this sample its {} compared in µm, as if "
                     "it carried the recipe's.",
                     c.id, what);
}

/// Loading of a sample of that thickness and porosity [mg/cm2].
double loading_by(const Experiment &e, const Measured &thickness, const Measured &porosity) {
  return coating_thickness_um(e, thickness) * (1.0 - 0.01 * porosity.value) /
         solid_thickness_um(e, 1.0);
}

void porosity_before(const Condition &c, std::vector<Observable> &out) {
  if (!c.porosity_before_percent)
    return;
  out.push_back({"total porosity before", kBefore, "%", c.porosity_before_percent->value,
                 c.porosity_before_percent->sd, value_of(&SimulatedRun::porosity_initial, kPercent),
                 none});
  out.back().per_initial_porosity = percent;
}

void porosity_after(const Experiment &e, const Condition &c, std::vector<Observable> &out,
                    std::vector<std::string> &not_said) {
  const std::optional<Measured> loading = loading_of(e, c);
  std::optional<Observable> ratio;
  if (c.thickness_after_um && loading)
    ratio = thickness_ratio(e, *c.thickness_after_um, *loading, "relaxation",
                            &SimulatedRun::thickness_after);
  if (!c.porosity_after_percent) {
    if (ratio)
      out.push_back(*ratio);
    else if (c.thickness_after_um) {
      out.push_back(thickness_in_um(e, *c.thickness_after_um, "relaxation",
                                    &SimulatedRun::thickness_after, &SimulatedRun::porosity_after));
      not_said.push_back(without_loading(c, "thickness is"));
    }
    return;
  }
  Observable o = {"total porosity",
                  "relaxation",
                  "%",
                  c.porosity_after_percent->value,
                  c.porosity_after_percent->sd,
                  value_of(&SimulatedRun::porosity_after, kPercent),
                  value_of(&SimulatedRun::porosity_slope, kPercent)};
  o.per_porosity = percent;
  out.push_back(o);
  if (ratio)
    not_said.push_back(fmt::format(
        "{}: mass and thickness give a porosity of {:.2f} ± {:.2f} %, stated are {:.2f} %. They "
        "are one measurement: only the stated porosity is compared.",
        c.id, 100.0 * (1.0 - 1.0 / ratio->measured),
        100.0 * std::hypot(ratio->sd, ratio->by_loading) / (ratio->measured * ratio->measured),
        o.measured));
  else if (c.thickness_after_um)
    not_said.push_back(fmt::format(
        "{}: thickness_after_um is not compared, because the porosity is stated too. Together they "
        "mean a loading of {:.3g} mg/cm²; give mass_mg or loading_mg_cm2 to check one by the "
        "other.",
        c.id, loading_by(e, *c.thickness_after_um, *c.porosity_after_percent)));
}

void under_load(const Experiment &e, const Condition &c, std::vector<Observable> &out,
                std::vector<std::string> &not_said) {
  if (!by_pressure(c) && c.max_pressure_MPa)
    out.push_back({"maximum pressure", "compression", "MPa", c.max_pressure_MPa->value,
                   c.max_pressure_MPa->sd, value_of(&SimulatedRun::max_pressure), none});
  const std::optional<Measured> loading = loading_of(e, c);
  if (by_pressure(c) && c.thickness_at_max_um && loading) {
    out.push_back(thickness_ratio(e, *c.thickness_at_max_um, *loading, "compression",
                                  &SimulatedRun::thickness_at_max));
  } else if (by_pressure(c) && c.thickness_at_max_um) {
    out.push_back(thickness_in_um(e, *c.thickness_at_max_um, "compression",
                                  &SimulatedRun::thickness_at_max, &SimulatedRun::porosity_at_max));
    not_said.push_back(without_loading(c, "thickness is"));
  }
  if (c.cracked_bodies_fraction)
    out.push_back({"cracked bodies", "compression", "fraction", c.cracked_bodies_fraction->value,
                   c.cracked_bodies_fraction->sd, value_of(&SimulatedRun::cracked_fraction), none});
  if (c.pressure_left_percent) {
    out.push_back({"pressure left", kDwell, "%", c.pressure_left_percent->value,
                   c.pressure_left_percent->sd, value_of(&SimulatedRun::pressure_left, kPercent),
                   none});
    out.back().why_none = [](const SimulatedRun &) { return "its platen does not rest"; };
  }
  if (c.cbd_nanoporosity_after_percent)
    not_said.push_back(fmt::format("{}: cbd_nanoporosity_after_percent is not compared; calibrate "
                                   "learns from it.",
                                   c.id));
}

/// How far along the curve: half of it is loading.
double along(double share, Branch branch) {
  return 0.5 * (branch == Branch::Release ? 2.0 - share : share);
}

/// The pressure that a curve's shares refer to: the one asked for if all shares of it are within
/// the curve, else the one it reaches. Rows are noted a little before it or past it, otherwise for
/// each specimen.
double scale_of(const Condition &c, double reached) {
  const bool has_all =
      by_pressure(c) && *std::rbegin(kCurveShares) * c.max_pressure_MPa->value <= reached;
  return has_all ? c.max_pressure_MPa->value : reached;
}

/// Displacement at shares of the pressure asked for or reached, over the solid thickness where the
/// sample's loading is known.
void along_curve(const Experiment &e, const Condition &c, std::vector<Observable> &out,
                 std::vector<std::string> &not_said) {
  if (c.curve.empty())
    return;
  const MeasuredCurve curve = read_measured_curve(c.curve);
  if (curve.left_out > 0)
    not_said.push_back(fmt::format("{}: rows of its curve jump away from their neighbours: {} left "
                                   "out.",
                                   c.id, curve.left_out));
  const std::optional<Measured> loading = loading_of(e, c);
  const double solid = loading ? solid_thickness_um(e, loading->value) : 1.0;
  if (!loading)
    not_said.push_back(without_loading(c, "displacements are"));
  if (e.on_press && !(c.curve_zero_um > 0.0))
    not_said.push_back(
        fmt::format("{}: the first touch counts as exactly known. Say how well it is "
                    "(curve_zero_um): on a rough film rather a micrometre.",
                    c.id));
  const double largest = scale_of(c, curve.loading.pressure.back());
  const auto add = [&](const MeasuredBranch &measured, Branch branch) {
    for (Observable &o : points_of_curve(e, c, largest, branch)) {
      o.measured = displacement_at(measured.pressure, measured.displacement, o.pressure) / solid;
      o.sd = c.curve_sd_um / solid;
      o.by_loading = loading ? -o.measured * loading->sd / loading->value : 0.0;
      o.by_drift = c.curve_drift_um / solid * along(o.coordinate, branch);
      o.by_zero = c.curve_zero_um / solid;
      if (std::isfinite(o.measured))
        out.push_back(o);
      else if (branch == Branch::Loading)
        not_said.push_back(fmt::format("{}: its curve has {:g} to {:g} MPa; nothing is said at "
                                       "{:g}.",
                                       c.id, measured.pressure.front(), measured.pressure.back(),
                                       o.pressure));
    }
  };
  add(curve.loading, Branch::Loading);
  add(curve.release, Branch::Release);
}

/// As stated, else the largest of the curve [um].
double displacement_of(const Condition &c) {
  if (c.displacement_um)
    return c.displacement_um->value;
  return read_measured_curve(c.curve).loading.displacement.back();
}

bool near(double a, double b) { return std::fabs(a - b) <= kSameTarget * std::fabs(b); }

} // namespace

bool by_pressure(const Condition &c) {
  return c.max_pressure_MPa && (c.control == "pressure" || c.control == "roll_gap");
}

std::vector<Observable> points_of_curve(const Experiment &e, const Condition &c, double largest,
                                        Branch branch) {
  const std::optional<Measured> loading = loading_of(e, c);
  const bool over_solid = loading.has_value(), released = branch == Branch::Release;
  const auto of_run = [over_solid, released](const SimulatedRun &r, double p) {
    return (released ? displacement_at(r.release_pressure, r.release_displacement, p)
                     : displacement_at(r.pressure, r.displacement, p)) /
           (over_solid ? r.solid_column : 1.0);
  };
  // The whole release moves with the thickness at the maximum.
  const auto of_release = [over_solid](const SimulatedRun &r) {
    return -r.porosity_slope * r.thickness_at_max / (1.0 - r.porosity_at_max) /
           (over_solid ? r.solid_column : 1.0);
  };
  // what is more porous under a pressure moves less, by its thickness there; before it, more
  const auto per_porosity = [of_run, over_solid](const SimulatedRun &r, double p) {
    const double solid = over_solid ? 1.0 : r.solid_column;
    const double over = over_solid ? r.solid_column : 1.0;
    const double h = (r.thickness_at_max + r.displacement.back()) / over - of_run(r, p);
    return -h * h / solid;
  };
  const auto per_initial = [over_solid](const SimulatedRun &r) {
    return std::pow(1.0 - r.porosity_initial, -2) * (over_solid ? 1.0 : r.solid_column);
  };
  // a calibration error is a share of each pressure, not of the largest
  const double sd = c.max_pressure_MPa ? c.max_pressure_MPa->sd : 0.0;
  const double relative = sd > 0.0 ? sd / c.max_pressure_MPa->value : 0.0;
  std::vector<Observable> out;
  for (const double share : kCurveShares) {
    if (released && share == kCurveShares[0])
      continue;
    const double at = share * largest;
    Observable o;
    o.curve = over_solid ? "displacement over solid thickness" : "displacement";
    o.coordinate = share;
    o.pressure = at;
    o.name = fmt::format("{} at {:.{}f} MPa{}", o.curve, at, at < 1.0 ? 2 : 0,
                         released ? " on release" : "");
    o.stage = released ? "relaxation" : "compression";
    o.unit = over_solid ? "" : "um";
    o.simulated = [of_run, at](const SimulatedRun &r) { return of_run(r, at); };
    o.per_porosity = [per_porosity, at](const SimulatedRun &r) { return per_porosity(r, at); };
    o.per_initial_porosity = per_initial;
    o.slope = [of_run, of_release, released, at, relative, sd](const SimulatedRun &r) {
      if (released)
        return of_release(r);
      return relative > 0.0 ? (of_run(r, 1.05 * at) - of_run(r, 0.95 * at)) / 0.1 * relative / sd
                            : 0.0;
    };
    out.push_back(o);
  }
  return out;
}

std::vector<Observable> observables_of(const Experiment &e, const Condition &c,
                                       std::vector<std::string> &not_said) {
  std::vector<Observable> out;
  porosity_before(c, out);
  porosity_after(e, c, out, not_said);
  under_load(e, c, out, not_said);
  along_curve(e, c, out, not_said);
  for (const Observable &o : out)
    if (o.sd == 0.0 && o.by_loading == 0.0)
      not_said.push_back(fmt::format("{}: {} has no standard deviation; the measurement counts as "
                                     "exact.",
                                     c.id, o.name));
  return out;
}

bool belongs(const SimulatedRun &r, const Condition &c) {
  if (by_pressure(c))
    return r.control == "pressure" && near(r.target, c.max_pressure_MPa->value);
  if (c.control == "displacement")
    return r.control == "displacement" && near(r.target, displacement_of(c));
  if (c.control == "thickness" && c.thickness_at_max_um)
    return r.control == "thickness" && near(r.target, c.thickness_at_max_um->value);
  return false;
}

} // namespace calendem
