// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/pi.h"
#include "report/pictures.h"

#include <gtest/gtest.h>

using calendem::Point;
using namespace calendem::report;

namespace {
Camera front(double scale) {
  Camera camera(0, 0); // looks along +y: x to the right, z up
  camera.frame({0, 0, 0}, {10, 10, 10}, 0, scale);
  return camera;
}
Colour at(const std::vector<std::uint8_t> &pixels, const Camera &camera, int x, int y) {
  const std::size_t i = 3 * (static_cast<std::size_t>(y) * camera.width() + x);
  return {pixels[i], pixels[i + 1], pixels[i + 2]};
}
} // namespace

// Requirement: x goes right, z goes up, what is nearer to the viewer (smaller y) is in front.
TEST(Raster, Orientation) {
  const Camera camera = front(10);
  EXPECT_EQ(camera.width(), 100);
  const Point low = camera.project({2, 5, 1}), high = camera.project({8, 5, 9});
  EXPECT_NEAR(low[0], 20, 1e-9);
  EXPECT_NEAR(low[1], 90, 1e-9);
  EXPECT_NEAR(high[1], 10, 1e-9);
  EXPECT_GT(camera.project({5, 0, 5})[2], camera.project({5, 9, 5})[2]);
}

// Requirement: a nearer sphere hides a farther one whatever the order; outside the sphere is white.
TEST(Raster, DepthAndOutline) {
  const Camera camera = front(10);
  for (const bool red_first : {true, false}) {
    Raster raster(camera);
    for (const bool red : {red_first, !red_first})
      raster.sphere({5, red ? 2.0 : 8.0, 5}, 2, red ? Colour{200, 0, 0} : Colour{0, 0, 200});
    const auto pixels = raster.pixels();
    EXPECT_GT(at(pixels, camera, 50, 50)[0], 100);
    EXPECT_EQ(at(pixels, camera, 50, 50)[2], 0);
    EXPECT_EQ(at(pixels, camera, 50, 75), (Colour{255, 255, 255}));
    EXPECT_NE(at(pixels, camera, 50, 68), (Colour{255, 255, 255}));
  }
}

// Requirement: a sphere of radius r covers pi r^2 (to 2 % at this resolution).
TEST(Raster, AreaOfASphere) {
  const Camera camera = front(20);
  Raster raster(camera);
  raster.sphere({5, 5, 5}, 3, {100, 100, 100});
  const auto pixels = raster.pixels();
  int inside = 0;
  for (std::size_t i = 0; i < pixels.size(); i += 3)
    inside += pixels[i] < 200;
  EXPECT_NEAR(inside / (calendem::kPi * 60 * 60), 1.0, 0.02);
}

// Requirement: what is drawn after a fade lies on top of everything before it.
TEST(Raster, FadeForgetsDepth) {
  const Camera camera = front(10);
  Raster raster(camera);
  raster.sphere({5, 1, 5}, 2, {0, 0, 200});
  raster.fade(0.5);
  raster.rod({1, 9, 5}, {9, 9, 5}, 0.5, {200, 0, 0});
  const auto middle = at(raster.pixels(), camera, 50, 50);
  EXPECT_GT(middle[0], middle[2] + 50);
}

// Requirement: the picture is a PNG.
TEST(Raster, WritesPng) {
  const Camera camera = front(2);
  EXPECT_EQ(png_of(Raster(camera), camera).substr(0, 10), "iVBORw0KGg");
}
