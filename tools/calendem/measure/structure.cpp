// SPDX-License-Identifier: GPL-2.0-or-later
#include "measure/structure.h"
#include <algorithm>
#include <cmath>

namespace calendem {

StructureMeasures measure_phases(const PhaseImage &image, const Density &density,
                                 const MeasureOptions &options) {
  StructureMeasures m;
  m.thickness_um = image.side(2);
  m.voxels = image.n;
  m.voxel = image.voxel;
  m.fraction = phase_fractions(image);
  m.surface = surface_area(image);
  m.bodies = bodies_on_voxels(image);
  m.slices = profile(image, density, options.slice_um);
  for (int axis = 0; options.tortuosity && axis < 3; ++axis)
    m.tortuosity.push_back(tortuosity(image, axis));
  return m;
}

StructureMeasures measure_image(const std::string &file, const MeasureOptions &options) {
  const PhaseImage image = phases_of(read_label_image(file, options.voxel_um.value_or(0.0)),
                                     options.background, options.cbd_label);
  const double solid_in_cbd = 1.0 - options.nanoporosity.value_or(NAN);
  StructureMeasures m = measure_phases(image, {1.0, solid_in_cbd}, options);
  m.moment = "image";
  m.porosity = porosity({1.0, m.fraction.am, solid_in_cbd * m.fraction.cbd, m.fraction.cbd});
  return m;
}

StructureMeasures measure_spheres(const SimulatedStructure &s, const MeasureOptions &options) {
  const PhaseImage image =
      voxelise(s.spheres, s.cell, s.lattice, options.voxel_um.value_or(kSimulatedVoxel));
  const PhaseFractions fraction = phase_fractions(image);
  Volumes v;
  v.cell = s.cell.lx * s.cell.ly * s.cell.height;
  v.am = std::pow(s.lattice, 3) * double(std::count_if(s.spheres.begin(), s.spheres.end(),
                                                       [](const Sphere &p) { return p.body > 0; }));
  v.cbd_solid = s.cbd_solid;
  v.cbd_envelope = fraction.cbd * v.cell;
  const auto over = [](double a, double b) { return b > 0.0 ? a / b : 1.0; };
  StructureMeasures m = measure_phases(
      image, {over(v.am, fraction.am * v.cell), over(v.cbd_solid, v.cbd_envelope)}, options);
  m.porosity = porosity(v);
  m.am_on_voxels = over(fraction.am * v.cell, v.am);
  m.coordination = coordination(s.spheres, s.cell);
  m.has_bonds = !s.bonds.empty();
  count_bonds(s.bonds, m.slices);
  return m;
}

} // namespace calendem
