// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a run: its electrode and its bonds before, at maximum pressure and after, the paper's
// Figures 3 and 5, and what all of them share: colours, one fixed camera, captions, whole bodies.
#ifndef CALENDEM_REPORT_PICTURES_H
#define CALENDEM_REPORT_PICTURES_H

#include "measure/run_directory.h"
#include "report/raster.h"
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

/// The periodic sides [um] at that time; 0: not known.
std::array<double, 2> period_of(const Run &run, double time_us);

class Wholes {
public:
  /// Without a period everything stays where it is.
  Wholes(const ParticleFrame &frame, const std::array<double, 2> &period);
  /// The image of `p`, a point of `body`, nearest to the body's centre in the cell.
  Point place(Point p, int body) const;

private:
  std::array<double, 2> period_;
  std::map<int, std::array<double, 2>> centre_;
};

/// The frames in compression nearest to the paper's pressures (0, 9.2, 20.1, 50.9, 146.8 MPa), as
/// far as the run went; a frame that is nearest to two of them stands for the nearer one.
std::vector<Moment> stages_of(const Run &run);

/// Subjects "electrode" and "bonds" at every stage; bonds that will be broken in the last frame are
/// distinguished from those that will not, broken ones are not drawn.
std::vector<Picture> draw_stages(Run &run);

/// The body that studied_body() names: "place" in the electrode before, "shape" and "bonds" at
/// every stage, seen from the same side; their broken_fraction is its own.
std::vector<Picture> draw_one_body(Run &run);

} // namespace calendem::report

#endif
