// SPDX-License-Identifier: GPL-2.0-or-later
// From an image of phases (pores, active material, carbon-binder) to an image of particles: the active
// material is cut where it is narrow, by a distance transform and a watershed (ITK).
#ifndef CALENDEM_ELECTRODE_STRUCTURE_SEPARATED_PARTICLES_H
#define CALENDEM_ELECTRODE_STRUCTURE_SEPARATED_PARTICLES_H

#include "base/recipe.h"
#include "electrode/structure/label_image.h"

namespace calendem {

/// Throws Failure(2) with every label of the image that is none of the phases, and where one of them
/// has no voxel.
void check_phases(const LabelImage &image, const PhaseLabels &phases);

/// 0 outside the active material, particles from 1 in the order of their first voxels. Two maxima of
/// the distance d to the surface belong to two particles where on every way between them
/// (d + v)/(d_max + v) falls below `neck`, d_max being the smaller maximum and v a voxel's side: the
/// neck's radius over the inscribed radius of the smaller part. This is the watershed of -ln(d + v)
/// from its minima of a dynamic of -ln(neck): Vincent and Soille, IEEE Trans. Pattern Anal. Mach.
/// Intell. 13 (1991) 583 (doi:10.1109/34.87344), distances by Maurer et al., the same 25 (2003) 265
/// (doi:10.1109/TPAMI.2003.1177156). Deviations:
/// ln(d + v) in place of d, which makes the dynamic a ratio; pores that the active material encloses
/// count as its own.
LabelImage separate_particles(const LabelImage &image, const PhaseLabels &phases, double neck);

} // namespace calendem

#endif
