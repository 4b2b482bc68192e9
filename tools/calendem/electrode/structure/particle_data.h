// SPDX-License-Identifier: GPL-2.0-or-later
// Data files of LAMMPS and LIGGGHTS (read_data, write_data) that hold spheres, and whether a file
// can have the columns and the units that its user states.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_PARTICLE_DATA_H
#define CALENDEM_ELECTRODE_STRUCTURE_PARTICLE_DATA_H

#include "base/messages.h"
#include <Eigen/Core>
#include <string>
#include <vector>

namespace calendem {

/// What a data file does not say of itself; the script that wrote it does.
struct DataFormat {
  std::string atom_style = "sphere"; ///< sphere = granular, bpm/sphere, hybrid (of those first)
  double length_um = 1.0;            ///< one unit of length
  double density_g_cm3 = 1.0;        ///< one unit of density
  bool z_periodic = false;           ///< x and y always are
};

struct DataParticle {
  long id = 0;
  int type = 0;
  long molecule = 0; ///< 0: of none
  double diameter = 0.0, density = 0.0;
  Eigen::Vector3d x; ///< from the lower corner of the box; inside it where the box is periodic
  int line = 0;      ///< of the file
};

struct ParticleData {
  Eigen::Vector3d box = Eigen::Vector3d::Zero(); ///< sides
  bool molecules = false;                        ///< the rows have a column for them
  std::vector<DataParticle> particles;           ///< in the order of the file
};

/// Columns of a row by atom_style, for messages.
std::string columns_of(const std::string &atom_style);

/// Lengths come in um, densities in g/cm3. Velocities and masses by type are counted and left out.
/// Mistakes: rows that are no sphere, ids that are there twice, fewer or more rows than announced,
/// spheres outside the box, a tilted box, columns or units that cannot be the stated ones.
ParticleData read_particle_data(const std::string &file, const DataFormat &format,
                                Mistakes &mistakes);

/// As read_particle_data(), without these checks; `style`: what stands behind `Atoms #`.
ParticleData parse_particle_data(const std::string &file, const DataFormat &format,
                                 std::string &style, Mistakes &mistakes);

/// Against the style that the file names; where it names none, against the other columns: a file
/// that only they make sound, or in which only they give few densities, is taken for theirs.
void check_columns(const std::string &file, const DataFormat &format, const std::string &style,
                   const ParticleData &data, Mistakes &mistakes);

/// Secondary particles and CBD are 0.05 to 100 um wide and weigh 0.01 to 25 g/cm3.
void check_units(const DataFormat &format, const ParticleData &data, Mistakes &mistakes);

} // namespace calendem

#endif
