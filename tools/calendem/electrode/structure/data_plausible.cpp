// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/data_plausible.h"
#include "base/structure_source.h"
#include "electrode/structure/atom_rows.h"
#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace calendem {
namespace {

const char *const kStyles[] = {"sphere", "bpm/sphere", "hybrid"};
const char *const kNoSpheres[] = {"angle",     "atomic",   "body",      "bond",
                                  "charge",    "dipole",   "ellipsoid", "full",
                                  "molecular", "template", "line",      "tri"};

size_t densities(const ParticleData &data) {
  std::set<double> all;
  for (const DataParticle &p : data.particles)
    all.insert(p.density);
  return all.size();
}

double median(const ParticleData &data, double DataParticle::*value) {
  std::vector<double> all;
  for (const DataParticle &p : data.particles)
    all.push_back(p.*value);
  std::nth_element(all.begin(), all.begin() + long(all.size() / 2), all.end());
  return all[all.size() / 2];
}

bool plausible(double diameter, double density) {
  return diameter >= 0.05 && diameter <= 100.0 && density >= 0.01 && density <= 25.0;
}

// False if the file names no style that is known.
bool named_style_fits(const std::string &stated, const std::string &style, Mistakes &mistakes) {
  const std::string name = columns_name(style);
  const auto is = [&](const char *known) { return name == known; };
  if (std::any_of(std::begin(kNoSpheres), std::end(kNoSpheres), is))
    mistakes.add(0, fmt::format("its section says 'Atoms # {}'; atoms of that style are no spheres "
                                "with diameter and density. Write it with atom_style sphere.",
                                style));
  else if (std::none_of(std::begin(kStyles), std::end(kStyles), is))
    return false;
  else if (columns_name(stated) != name)
    mistakes.add(0, fmt::format("its section says 'Atoms # {0}', structure.atom_style is \"{1}\". "
                                "Give structure.atom_style = \"{0}\".",
                                style, stated));
  return true;
}

} // namespace

void check_columns(const std::string &file, const DataFormat &format, const std::string &style,
                   const ParticleData &data, Mistakes &mistakes) {
  if (named_style_fits(format.atom_style, style, mistakes))
    return;
  const bool sound = mistakes.empty();
  const size_t of_file = densities(data);
  for (const char *other : kStyles) {
    if (columns_name(format.atom_style) == other)
      continue;
    DataFormat tried = format;
    tried.atom_style = other;
    std::string none;
    Mistakes wrong(file, 0);
    const ParticleData theirs = parse_particle_data(file, tried, none, wrong);
    if (wrong.empty() && (!sound || (of_file > 3 && of_file >= 2 * densities(theirs))))
      mistakes.add(0, fmt::format("its columns look like those of atom_style {0} ({1}), not of {2} "
                                  "({3}){4}. Give structure.atom_style as in the script that wrote "
                                  "it.",
                                  other, columns_of(other), format.atom_style,
                                  columns_of(format.atom_style),
                                  sound ? ": the densities differ as places do" : ""));
  }
}

void check_units(const DataFormat &format, const ParticleData &data, Mistakes &mistakes) {
  if (data.particles.empty())
    return;
  const double diameter = median(data, &DataParticle::diameter),
               density = median(data, &DataParticle::density);
  if (plausible(diameter, density))
    return;
  std::string looks;
  for (const char *units : {"micro", "si", "cgs"}) {
    const DataUnits f = units_named(units);
    if (plausible(diameter / format.length_um * f.length_um,
                  density / format.density_g_cm3 * f.density_g_cm3))
      looks += fmt::format(" In units {} it would be {:.4g} um and {:.4g} g/cm3.", units,
                           diameter / format.length_um * f.length_um,
                           density / format.density_g_cm3 * f.density_g_cm3);
  }
  mistakes.add(0, fmt::format("the median sphere is {:.4g} um wide and weighs {:.4g} g/cm3 in the "
                              "units stated; 0.05 to 100 um and 0.01 to 25 g/cm3 are plausible. "
                              "Give structure.units as in the script that wrote the file.{}",
                              diameter, density, looks));
}

} // namespace calendem
