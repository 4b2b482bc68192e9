// SPDX-License-Identifier: GPL-2.0-or-later
// What all pictures of a run share: colours, the camera, what stands in the caption.
#ifndef CALENDEM_REPORT_SCENE_H
#define CALENDEM_REPORT_SCENE_H

#include "report/electrode_picture.h"
#include "report/raster.h"

namespace calendem::report {

/// Hues a golden angle apart, with changing brightness: neighbours in number differ most. Body 0 is
/// CBD.
Colour colour_of(int body);

/// What the first frame holds, with the platen; low > high when it cannot be read.
Box box_of(Run &run);
/// The camera of all pictures, that shows `box` in at most that many pixels.
Camera camera_for(const Box &box, double tallest, double widest);

std::string png_of(const Raster &raster, const Camera &camera);

/// The curve's row next to a time [us].
std::size_t row_near(const Curve &curve, double time_us);
/// Pressure and broken bonds of that row.
void add_state(const Curve &curve, Picture &picture);

/// A picture without pixels: size, scale bar, outlines of the walls.
Picture framed(const Moment &moment, const char *subject, const FrameFile &source,
               const Camera &camera, const PlatenFrame &platen);

} // namespace calendem::report

#endif
