// SPDX-License-Identifier: GPL-2.0-or-later
// What an experiment's label images show, beside the frames of a run, cut into voxels of the same
// size and measured by the same code.
#ifndef CALENDEM_DIAGNOSE_COMPARE_IMAGE_OBSERVABLES_H
#define CALENDEM_DIAGNOSE_COMPARE_IMAGE_OBSERVABLES_H

#include "diagnose/compare/observables.h"
#include "measure/phases.h"

namespace calendem {

/// Of an image, or of the part [i0, i1) x [j0, j1) of its columns of voxels. Shares of the volume
/// 0-1.
struct ImageMeasures {
  double am = 0.0, pore = 0.0;
  double upper_minus_lower = 0.0;   ///< share of AM, upper third minus lower third
  double middle_minus_others = 0.0; ///< middle third minus the mean of the others
};
ImageMeasures measures_of(const PhaseImage &image);
ImageMeasures measures_of(const PhaseImage &image, int i0, int i1, int j0, int j1);

/// Before and after calendering, as far as the condition has images: share of AM or, where CBD is
/// labelled, macro porosity; two numbers for the profile of AM through the thickness; the share of
/// whole particles that are in pieces. Standard deviations: of the mean of the image's four
/// quarters (x, y), and binomial for the particles.
/// The frames of a run are read when an observable is asked for its value; one without frames has
/// none. Throws Failure(2) as read_label_image does, and for images too small to be measured.
std::vector<Observable> image_observables_of(const Experiment &experiment,
                                             const Condition &condition,
                                             std::vector<std::string> &not_said);

} // namespace calendem

#endif
