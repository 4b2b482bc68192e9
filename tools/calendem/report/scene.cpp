// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace calendem::report {
namespace {

constexpr double kAzimuth = 28, kElevation = 14; // degrees
constexpr Colour kCbd{96, 96, 96};

Colour from_hue(double hue, double saturation, double value) {
  Colour colour{};
  for (int k = 0; k < 3; ++k) {
    const double place = std::fmod(hue * 6 + (k == 0 ? 5 : k == 1 ? 3 : 1), 6.0);
    const double dip = std::max(0.0, std::min({place, 4 - place, 1.0}));
    colour[k] = static_cast<std::uint8_t>(255 * value * (1 - saturation * dip));
  }
  return colour;
}

std::string outline_of(const Camera &camera, const std::vector<Point> &corners) {
  std::ostringstream points;
  for (const auto &corner : corners) {
    const Point p = camera.project(corner);
    char text[40];
    std::snprintf(text, sizeof text, "%.1f,%.1f ", p[0], p[1]);
    points << text;
  }
  return points.str();
}

int scale_bar(double pixels_per_um) {
  for (const int length : {50, 20, 10, 5, 2})
    if (length * pixels_per_um <= 110)
      return length;
  return 1;
}

} // namespace

Colour colour_of(int body) {
  if (body <= 0)
    return kCbd;
  return from_hue(std::fmod(body * 0.61803398875, 1.0), body % 2 ? 0.50 : 0.68,
                  body % 3 ? 0.95 : 0.78);
}

Box box_of(Run &run) {
  Box box;
  for (const auto &centre : read_particles(run.particles.front().path, run.notes).centre)
    box.include(centre);
  if (box.low[0] <= box.high[0] && !run.platen.empty())
    for (const auto &outline : read_platen(run.platen.front().path, run.notes).outlines)
      for (const auto &corner : outline)
        box.include(corner);
  return box;
}

Camera camera_for(const Box &box, double tallest, double widest) {
  constexpr double kMargin = 1.2; // um: the spheres' radius and some air
  Camera camera(kAzimuth, kElevation);
  camera.frame(box.low, box.high, kMargin, 100.0);
  const double wide = camera.width() / 100.0, tall = camera.height() / 100.0;
  camera.frame(box.low, box.high, kMargin, std::min(tallest / tall, widest / wide));
  return camera;
}

std::string png_of(const Raster &raster, const Camera &camera) {
  return png_base64(raster.pixels(), camera.width(), camera.height());
}

std::size_t row_near(const Curve &curve, double time_us) {
  const Column &time = curve["time_us"];
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < time.size(); ++i)
    if (std::abs(time[i] - time_us) < std::abs(time[nearest] - time_us))
      nearest = i;
  return nearest;
}

void add_state(const Curve &curve, Picture &picture) {
  const std::size_t nearest = row_near(curve, picture.time_us);
  picture.pressure_MPa = curve["pressure_MPa"][nearest];
  picture.broken_fraction = curve["broken_fraction"][nearest];
}

Picture framed(const Moment &moment, const char *subject, const FrameFile &source,
               const Camera &camera, const PlatenFrame &platen) {
  Picture picture;
  picture.moment = moment.name;
  picture.subject = subject;
  picture.time_us = source.time_us;
  picture.file = source.path;
  picture.width = camera.width();
  picture.height = camera.height();
  picture.pixels_per_um = camera.scale();
  picture.scale_bar_um = scale_bar(camera.scale());
  for (const auto &outline : platen.outlines)
    picture.outlines.push_back(outline_of(camera, outline));
  return picture;
}

} // namespace calendem::report
