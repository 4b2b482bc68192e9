// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "base/run_folder.h"
#include "base/shown.h"
#include "simulate/collect.h"
#include <algorithm>
#include <cmath>

namespace calendem {
namespace {

/// A frame so near to a release's end knows how large the spheres are then [us].
constexpr double kNearFrame = 0.1;

/// Nanoporosity of CBD at a time, whose spheres keep their solid.
double nanoporosity_at(const UnionVolume &filled, double initial, double time) {
  double near = kNearFrame, now = NAN;
  for (std::size_t k = 0; k < filled.cbd_spheres.size(); ++k)
    if (const double apart = std::fabs(filled.time[k] - time); apart <= near) {
      near = apart;
      now = filled.cbd_spheres[k];
    }
  return initial > 0.0 && now > 0.0 ? 1.0 - (1.0 - initial) * filled.cbd_spheres.front() / now
                                    : NAN;
}

/// Share of the bodies with bonds that are cracked at a time, by cracks.csv.
double cracked_at(const std::map<std::string, Column> &cracks, double time) {
  const Column &times = cracks.at("time_us");
  const auto after = std::upper_bound(times.begin(), times.end(), time + 1e-6); // of rounding
  if (after == times.begin())
    return NAN;
  const auto row = after - times.begin() - 1;
  return cracks.at("bodies_cracked")[row] / cracks.at("bodies_with_bonds")[row];
}

} // namespace

nlohmann::json presses_of(const std::string &path, const std::vector<RawRow> &rows,
                          const UnionVolume &filled, const ElectrodeFacts &e,
                          const Settings &settings) {
  Mistakes none, mistakes;
  RunFolder folder(path);
  const Curve curve = folder.curve({"pressure_MPa"}, none, none);
  const std::map<std::string, Column> cracks =
      folder.columns("cracks.csv", {"time_us", "bodies_cracked", "bodies_with_bonds"}, mistakes);
  const PressInstruments press = instruments_of(settings);
  nlohmann::json out = nlohmann::json::array();
  if (curve.rows() == 0)
    return out;
  double highest = 0.0;
  for (const Press &p : curve.presses()) {
    const std::vector<RawRow> until(rows.begin(), rows.begin() + long(p.last) + 1);
    const RawRow &top = rows[p.top], &last = rows[p.last];
    highest = std::max(highest, top.p_top);
    if (last.stage < 2.5)
      break; // not released
    const double gap = gap_at_loss(until, settings.number("platen.contact_lost_fraction"), highest)
                           .value_or(last.gap);
    const auto porosity = [&](double thickness, const RawRow &row) {
      return total_porosity(e, press.thickness_shown(thickness), row.elongation);
    };
    out.push_back(
        {{"pressure_MPa", press.pressure_shown(top.p_top)},
         {"time_loaded_us", top.time},
         {"time_released_us", last.time},
         {"thickness_loaded_um", press.thickness_shown(top.gap)},
         {"thickness_released_um", press.thickness_shown(gap)},
         {"porosity_loaded", total_porosity(e, top.gap, top.elongation)},
         {"porosity_released", porosity(gap, last)},
         {"broken_fraction", last.made > 0 ? last.broken / last.made : 0.0},
         {"cracked_fraction", or_null(mistakes.empty() ? cracked_at(cracks, last.time) : NAN)},
         {"cbd_nanoporosity", or_null(nanoporosity_at(filled, e.nanoporosity, last.time))}});
  }
  return out;
}

} // namespace calendem
