// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a data file can have the columns and the units that its user states.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_DATA_PLAUSIBLE_H
#define CALENDEM_ELECTRODE_STRUCTURE_DATA_PLAUSIBLE_H

#include "electrode/structure/particle_data.h"

namespace calendem {

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
