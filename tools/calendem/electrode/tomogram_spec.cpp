// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/tomogram.h"
#include <fmt/format.h>

namespace calendem {

const std::vector<Key> &tomogram_keys() {
  static const std::vector<Key> keys = {
      {"seed", "", "1", 0, 4e9, "", "of all random numbers", "", false, true},
      {"image.voxel_um", "", "0.3", 0.005, 5, "um", "side of a voxel"},
      {"image.x_um", "", "30", 1, 1000, "um", "of the image"},
      {"image.y_um", "", "30", 1, 1000, "um", "of the image"},
      {"image.z_um", "", "30", 1, 1000, "um", "of the image"},
      {"image.solid_fraction", "", "0.4", 0.01, 0.6, "", "particles are added up to this"},
      {"particles.median_um", "", "4.35", 0.5, 50, "um", "by number"},
      {"particles.sigma_ln", "", "0.487", 0.01, 1, "", "of the lognormal size distribution"},
      {"particles.min_um", "", "3", 0.1, 50, "um", "smallest"},
      {"particles.max_um", "", "10", 0.2, 100, "um", "largest"},
      {"particles.irregularity", "", "0.1", 0, 0.3, "", "rms of the surface's radius"},
      {"particles.touching_fraction", "", "0.7", 0, 1, "", "are pushed against another one"},
      {"particles.pores", "", "3", 0, 50, "", "closed pores per particle"},
      {"particles.pore_diameter_fraction", "", "0.12", 0.01, 0.3, "", "of the particle's diameter"},
      {"border.noise", "", "0.05", 0, 0.5, "", "share of a surface's voxels that change sides"},
  };
  return keys;
}

TomogramSpec read_tomogram_spec(const std::string &file) {
  Mistakes mistakes(file);
  const Settings s = read_toml(file, FileKind::Tomogram, tomogram_keys(), mistakes);
  mistakes.stop_if_any();
  TomogramSpec t;
  t.seed = static_cast<unsigned long>(s.number("seed"));
  t.voxel = s.number("image.voxel_um");
  t.size = {s.number("image.x_um"), s.number("image.y_um"), s.number("image.z_um")};
  t.solid_fraction = s.number("image.solid_fraction");
  t.median = s.number("particles.median_um");
  t.sigma_ln = s.number("particles.sigma_ln");
  t.min_diameter = s.number("particles.min_um");
  t.max_diameter = s.number("particles.max_um");
  t.irregularity = s.number("particles.irregularity");
  t.touching = s.number("particles.touching_fraction");
  t.pores = static_cast<int>(s.number("particles.pores"));
  t.pore_diameter = s.number("particles.pore_diameter_fraction");
  t.noise = s.number("border.noise");
  const double voxels = t.size.prod() / (t.voxel * t.voxel * t.voxel);
  if (voxels > 1e9)
    mistakes.add(0, fmt::format("the image would have {:.2g} voxels of 4 bytes; at most 1e9 are "
                                "made. Take a smaller image or larger voxels.",
                                voxels));
  if (t.min_diameter >= t.max_diameter)
    mistakes.add(0, fmt::format("particles.min_um = {} must be below max_um = {}.", t.min_diameter,
                                t.max_diameter));
  mistakes.stop_if_any();
  return t;
}

} // namespace calendem
