// SPDX-License-Identifier: GPL-2.0-or-later
// structure.csv and structure.json.
#include "measure/structure.h"
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

using nlohmann::json;

json or_null(double v) { return std::isfinite(v) ? json(v) : json(nullptr); }
json or_null(const std::optional<double> &v) { return v ? or_null(*v) : json(nullptr); }

std::string or_empty(double v) { return std::isfinite(v) ? fmt::format("{:.6f}", v) : ""; }

json to_json(const Tortuosity &t) {
  json j = {{"tau", or_null(t.tau)},
            {"effective_diffusivity", t.effective},
            {"effective_diffusivity_on_voxels", t.on_voxels},
            {"effective_diffusivity_on_doubled_voxels", t.on_doubled},
            {"extrapolated", t.extrapolated},
            {"porosity", t.porosity},
            {"percolating_fraction", t.percolating},
            {"voxel_um", {t.voxel[0], t.voxel[1], t.voxel[2]}}};
  if (t.effective <= 0.0)
    j["statement"] = "no path of pore voxels leads through: tau is infinite";
  else if (!t.extrapolated)
    j["statement"] = "no path leads through on voxels of twice the size: tau is not extrapolated "
                     "and an upper bound";
  return j;
}

json to_json(const std::vector<Tortuosity> &t) {
  if (t.empty())
    return nullptr;
  json j = {{"in_plane_x", to_json(t[0])},
            {"in_plane_y", to_json(t[1])},
            {"through_plane", to_json(t[2])}};
  const double mean = 0.5 * (t[0].effective + t[1].effective);
  j["tau_in_plane"] = mean > 0.0 ? json(t[0].porosity / mean) : json(nullptr);
  j["tau_through_plane"] = or_null(t[2].tau);
  return j;
}

json to_json(const Coordination &c) {
  return {{"am_am", c.am_am},
          {"am_cbd", c.am_cbd},
          {"cbd_am", c.cbd_am},
          {"cbd_cbd", c.cbd_cbd},
          {"bodies_without_am_contact", c.am_without_am},
          {"bodies_without_contact", c.am_without_any}};
}

} // namespace

std::string profile_table(const std::vector<StructureMeasures> &moments) {
  std::string out = "moment,z_from_um,z_to_um,z_over_thickness,am_fraction,cbd_fraction,"
                    "porosity_macro,porosity_total,bonds,bonds_broken\n";
  for (const StructureMeasures &m : moments)
    for (const Slice &s : m.slices) {
      out += fmt::format("{},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.6f},{},", m.moment, s.from, s.to,
                         0.5 * (s.from + s.to) / m.thickness_um, s.fraction.am, s.fraction.cbd,
                         s.fraction.pore, or_empty(s.porosity_total));
      out += m.has_bonds ? fmt::format("{},{}\n", s.bonds, s.broken) : ",\n";
    }
  return out;
}

json to_json(const StructureMeasures &m) {
  json j = {{"moment", m.moment},
            {"time_us", or_null(m.time_us)},
            {"pressure_MPa", or_null(m.pressure_MPa)},
            {"thickness_um", m.thickness_um},
            {"voxel_um", {m.voxel[0], m.voxel[1], m.voxel[2]}},
            {"voxels", m.voxels},
            {"porosity_total", or_null(m.porosity.total)},
            {"porosity_macro", m.porosity.macro},
            {"porosity_nano", or_null(m.porosity.nano)},
            {"pore_voxel_fraction", m.fraction.pore},
            {"am_fraction", m.fraction.am},
            {"cbd_fraction", m.fraction.cbd},
            {"am_on_voxels_over_lattice_volume", or_null(m.am_on_voxels)},
            {"area_per_volume_1_um",
             {{"pore_solid", m.surface.pore_solid()},
              {"pore_am", m.surface.pore_am},
              {"pore_cbd", m.surface.pore_cbd},
              {"am_cbd", m.surface.am_cbd}}},
            {"bodies_on_voxels",
             {{"bodies", m.bodies.bodies},
              {"am_am", m.bodies.am_am},
              {"whole", m.bodies.whole},
              {"in_pieces", m.bodies.in_pieces}}},
            {"tortuosity", to_json(m.tortuosity)}};
  if (m.coordination)
    j["coordination"] = to_json(*m.coordination);
  return j;
}

json structure_definitions() {
  return {{"porosity_total", "1 - (V_AM + V_CBD,solid)/(A h)"},
          {"porosity_macro",
           "1 - (V_AM + V_CBD,envelope)/(A h): what a tomogram resolves; V_CBD,envelope "
           "is the part of the CBD spheres outside the AM envelopes"},
          {"porosity_nano", "total - macro: inside CBD"},
          {"V_AM", "N s^3, N primaries on a lattice of spacing s; of an image: its voxels"},
          {"thickness_um",
           "h: gap between collector and platen, after relaxation that at which the "
           "platen lost contact; of an image: all of its layers"},
          {"area_per_volume_1_um", "Cauchy-Crofton along 13 directions of voxels, per volume A h"},
          {"coordination",
           "am_am: other bodies a body touches; am_cbd: CBD spheres a body touches; cbd_am: "
           "bodies a CBD sphere touches; touching: spheres overlap; means"},
          {"bodies_on_voxels",
           "am_am: other bodies that share a face of a voxel; whole: not cut by the "
           "image's sides, 200 voxels at least; in_pieces: of those, largest "
           "connected part below 95 %"},
          {"tau", "tortuosity factor of the macro pores, eps D/D_eff, eps all pore voxels; D_eff "
                  "extrapolated to voxels of size 0; CBD counts as solid"},
          {"tau_in_plane", "eps over the mean D_eff/D of x and y"}};
}

} // namespace calendem
