// SPDX-License-Identifier: GPL-2.0-or-later
// A small software renderer: spheres and rods in orthographic view with a depth buffer. It needs no
// display, no driver and no window, and gives the same bytes on every machine.
#ifndef CALENDEM_REPORT_RASTER_H
#define CALENDEM_REPORT_RASTER_H

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "measure/frames.h"

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
  void sphere(const Point &centre, double radius, const Colour &colour);
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

/// PNG file of `pixels` (three bytes per pixel, rows from the top) as base64.
std::string png_base64(const std::vector<std::uint8_t> &pixels, int width, int height);

} // namespace calendem::report

#endif
