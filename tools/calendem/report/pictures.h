// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a run: its electrode and its bonds before, at maximum pressure and after, the paper's
// Figures 3 and 5. A small renderer of our own draws spheres and rods in orthographic view with a
// depth buffer: it needs no display, no driver and no window, and gives the same bytes everywhere.
#ifndef CALENDEM_REPORT_PICTURES_H
#define CALENDEM_REPORT_PICTURES_H

#include "measure/run_directory.h"
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace calendem::report {

/// The smallest box that holds what it was shown.
struct Box {
  Point low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void include(const Point &p) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  bool empty() const { return low[0] > high[0]; }
};
using Colour = std::array<std::uint8_t, 3>;

/// Orthographic view: azimuth about z, then elevation above the xy plane [degrees]; z is up.
class Camera {
public:
  Camera(double azimuth, double elevation);
  /// Frames the box [low, high] with `margin` [same unit] around it, at `pixels_per_unit`.
  void frame(const Point &low, const Point &high, double margin, double pixels_per_unit);

  /// Pixel coordinates (x right, y down) and depth (towards the viewer), in pixels.
  Point project(const Point &p) const;
  double scale() const { return scale_; }
  int width() const { return width_; }
  int height() const { return height_; }

private:
  Point view(const Point &p) const;
  Point right_{}, up_{}, toward_{};
  double scale_ = 1, left_ = 0, top_ = 0;
  int width_ = 1, height_ = 1;
};

/// Picture being drawn, at twice the resolution of the camera.
class Raster {
public:
  explicit Raster(const Camera &camera);
  void sphere(const Point &centre, double radius, const Colour &colour) {
    rod(centre, centre, radius, colour);
  }
  /// With a half sphere at each end.
  void rod(const Point &from, const Point &to, double radius, const Colour &colour);
  /// Mixes everything drawn so far with white and forgets its depth: later objects lie on top.
  void fade(double share_of_white);
  /// Averages 2 x 2 samples: rows from the top, three bytes per pixel.
  std::vector<std::uint8_t> pixels() const;

private:
  void put(int x, int y, double depth, double brightness, const Colour &colour);
  const Camera &camera_;
  int width_, height_;
  std::vector<float> depth_;
  std::vector<Colour> colour_;
};

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

/// What the frames next to a moment hold.
struct FramesAt {
  Moment moment;
  ParticleFrame particles;
  BondFrame bonds;
  PlatenFrame platen;
  const FrameFile *particle_file, *bond_file; ///< null: the run has none
};
/// `run.particles` must not be empty; unreadable frames are added to `run.notes`.
FramesAt frames_at(Run &run, const Moment &moment);

/// Empty when the run has no frames; unreadable frames are added to `run.notes`.
std::vector<Picture> draw_pictures(Run &run);

/// PNG file of what was drawn, as base64.
std::string png_of(const Raster &raster, const Camera &camera);

/// The curve's row next to a time [us].
std::size_t row_near(const Curve &curve, double time_us);

/// The periodic sides [um] at that time; 0: not known.
std::array<double, 2> period_of(const Run &run, double time_us);

class PeriodicUnwrapper {
public:
  /// Without a period everything stays where it is.
  PeriodicUnwrapper(const ParticleFrame &frame, const std::array<double, 2> &period);
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
