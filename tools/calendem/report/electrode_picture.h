// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a run's electrode and of its bonds before, at maximum pressure and after, all six
// seen by one fixed camera.
#ifndef CALENDEM_REPORT_ELECTRODE_PICTURE_H
#define CALENDEM_REPORT_ELECTRODE_PICTURE_H

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "measure/run_directory.h"

namespace calendem::report {

struct Picture {
  std::string moment;  ///< "Before", "At maximum pressure", "After"
  std::string subject; ///< "electrode" or "bonds"
  double time_us = 0;
  double pressure_MPa = 0, broken_fraction = 0; ///< of the curve's row next to that time
  std::string file;                             ///< frame it was made from
  std::string png;                              ///< base64
  int width = 0, height = 0;
  std::vector<std::string> outlines; ///< SVG point lists: collector and platen
  double pixels_per_um = 1;
  int scale_bar_um = 10;
  std::size_t across_faces = 0; ///< bonds through a periodic face, not drawn
};

struct Moment {
  std::string name;
  double time_us;
};

/// Before, at (or nearest to) maximum pressure, after; `run.particles` must not be empty.
std::vector<Moment> moments_of(const Run &run);

/// Empty when the run has no frames; unreadable frames are added to `run.notes`.
std::vector<Picture> draw_pictures(Run &run);

} // namespace calendem::report

#endif
