// SPDX-License-Identifier: GPL-2.0-or-later

#include "report/raster.h"
#include <algorithm>
#include <cmath>
#include <limits>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include "base/encoding.h"
#include "physics/pi.h"

namespace calendem::report {
namespace {

constexpr int kSamples = 2;
constexpr float kFar = -std::numeric_limits<float>::max();

double dot(const Point &a, const Point &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Brightness of a surface with normal (nx, ny up, nz to the viewer): light from the upper left.
double shade(double nx, double ny, double nz) {
  const double diffuse = std::max(0.0, -0.42 * nx + 0.50 * ny + 0.757 * nz);
  const double rim = nz < 0.3 ? 0.72 + 0.93 * nz : 1.0; // darker outline separates neighbours
  return (0.50 + 0.54 * diffuse) * rim;
}

} // namespace

Camera::Camera(double azimuth, double elevation) {
  const double a = azimuth * kPi / 180, e = elevation * kPi / 180;
  toward_ = {std::cos(e) * std::sin(a), -std::cos(e) * std::cos(a), std::sin(e)};
  right_ = {std::cos(a), std::sin(a), 0};
  up_ = {-std::sin(e) * std::sin(a), std::sin(e) * std::cos(a), std::cos(e)};
}

Point Camera::view(const Point &p) const { return {dot(p, right_), dot(p, up_), dot(p, toward_)}; }

void Camera::frame(const Point &low, const Point &high, double margin, double pixels_per_unit) {
  Point least{1e300, 1e300, 0}, most{-1e300, -1e300, 0};
  for (int corner = 0; corner < 8; ++corner) {
    const Point p = view({corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
                          corner & 4 ? high[2] : low[2]});
    for (int k = 0; k < 2; ++k) {
      least[k] = std::min(least[k], p[k] - margin);
      most[k] = std::max(most[k], p[k] + margin);
    }
  }
  scale_ = pixels_per_unit;
  left_ = least[0];
  top_ = most[1];
  width_ = std::max(1, static_cast<int>(std::ceil((most[0] - least[0]) * scale_)));
  height_ = std::max(1, static_cast<int>(std::ceil((most[1] - least[1]) * scale_)));
}

Point Camera::project(const Point &p) const {
  const Point v = view(p);
  return {(v[0] - left_) * scale_, (top_ - v[1]) * scale_, v[2] * scale_};
}

Raster::Raster(const Camera &camera)
    : camera_(camera), width_(camera.width() * kSamples), height_(camera.height() * kSamples),
      depth_(static_cast<std::size_t>(width_) * height_, kFar),
      colour_(depth_.size(), Colour{255, 255, 255}) {}

void Raster::put(int x, int y, double depth, double brightness, const Colour &colour) {
  const std::size_t at = static_cast<std::size_t>(y) * width_ + x;
  if (depth <= depth_[at])
    return;
  depth_[at] = static_cast<float>(depth);
  for (int k = 0; k < 3; ++k)
    colour_[at][k] = static_cast<std::uint8_t>(std::clamp(colour[k] * brightness, 0.0, 255.0));
}

void Raster::sphere(const Point &centre, double radius, const Colour &colour) {
  const Point c = camera_.project(centre);
  const double cx = c[0] * kSamples, cy = c[1] * kSamples, depth = c[2] * kSamples;
  const double r = radius * camera_.scale() * kSamples;
  const int y_end = std::min(height_ - 1, static_cast<int>(std::floor(cy + r)));
  for (int y = std::max(0, static_cast<int>(std::ceil(cy - r))); y <= y_end; ++y) {
    const double ny = (y - cy) / r;
    const double half = r * std::sqrt(std::max(0.0, 1 - ny * ny));
    const int x_end = std::min(width_ - 1, static_cast<int>(std::floor(cx + half)));
    for (int x = std::max(0, static_cast<int>(std::ceil(cx - half))); x <= x_end; ++x) {
      const double nx = (x - cx) / r;
      const double nz = std::sqrt(std::max(0.0, 1 - nx * nx - ny * ny));
      put(x, y, depth + r * nz, shade(nx, -ny, nz), colour);
    }
  }
}

void Raster::rod(const Point &from, const Point &to, double radius, const Colour &colour) {
  const Point a = camera_.project(from), b = camera_.project(to);
  const double ax = a[0] * kSamples, ay = a[1] * kSamples;
  const double dx = b[0] * kSamples - ax, dy = b[1] * kSamples - ay;
  const double r = std::max(radius * camera_.scale() * kSamples, 0.8);
  const double length2 = std::max(dx * dx + dy * dy, 1e-12);
  const int x0 = std::max(0, static_cast<int>(std::floor(std::min(ax, ax + dx) - r)));
  const int x1 = std::min(width_ - 1, static_cast<int>(std::ceil(std::max(ax, ax + dx) + r)));
  const int y0 = std::max(0, static_cast<int>(std::floor(std::min(ay, ay + dy) - r)));
  const int y1 = std::min(height_ - 1, static_cast<int>(std::ceil(std::max(ay, ay + dy) + r)));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double t = std::clamp(((x - ax) * dx + (y - ay) * dy) / length2, 0.0, 1.0);
      const double ox = (x - ax - t * dx) / r, oy = (y - ay - t * dy) / r;
      if (ox * ox + oy * oy > 1)
        continue;
      const double nz = std::sqrt(1 - ox * ox - oy * oy);
      put(x, y, kSamples * (a[2] + t * (b[2] - a[2])) + r * nz, shade(ox, -oy, nz), colour);
    }
}

void Raster::fade(double share_of_white) {
  for (auto &pixel : colour_)
    for (auto &channel : pixel)
      channel = static_cast<std::uint8_t>(channel + share_of_white * (255 - channel));
  std::fill(depth_.begin(), depth_.end(), kFar);
}

std::vector<std::uint8_t> Raster::pixels() const {
  std::vector<std::uint8_t> out;
  out.reserve(static_cast<std::size_t>(camera_.width()) * camera_.height() * 3);
  for (int y = 0; y < camera_.height(); ++y)
    for (int x = 0; x < camera_.width(); ++x)
      for (int k = 0; k < 3; ++k) {
        int sum = 0;
        for (int s = 0; s < kSamples * kSamples; ++s)
          sum += colour_[static_cast<std::size_t>(y * kSamples + s / kSamples) * width_ +
                         x * kSamples + s % kSamples][k];
        out.push_back(static_cast<std::uint8_t>(sum / (kSamples * kSamples)));
      }
  return out;
}

std::string png_base64(const std::vector<std::uint8_t> &pixels, int width, int height) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(width, height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto *data = static_cast<unsigned char *>(image->GetScalarPointer());
  const std::size_t row = static_cast<std::size_t>(width) * 3;
  for (int y = 0; y < height; ++y) // VTK's rows begin at the bottom
    std::copy_n(pixels.data() + y * row, row, data + (height - 1 - y) * row);
  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn();
  writer->SetInputData(image);
  writer->Write();
  return base64(writer->GetResult()->GetPointer(0),
                static_cast<std::size_t>(writer->GetResult()->GetNumberOfTuples()));
}

} // namespace calendem::report
