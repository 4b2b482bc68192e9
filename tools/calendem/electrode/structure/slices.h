// SPDX-License-Identifier: GPL-2.0-or-later
// The picture by which a user judges separated particles.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_SLICES_H
#define CALENDEM_ELECTRODE_STRUCTURE_SLICES_H

#include "base/recipe.h"
#include "electrode/structure/label_image.h"

namespace calendem {

/// PNG: the three slices through the middle (xy, xz, yz), phases in grey, outlines of whole particles
/// in red and of those that the border cuts in blue.
void draw_particles(const LabelImage &image, const PhaseLabels &phases, const LabelImage &particles,
                    const std::string &file);

/// Bytes of a PNG file; three bytes per pixel, rows from the top.
std::string png_bytes(const std::vector<std::uint8_t> &pixels, int width, int height);

} // namespace calendem

#endif
