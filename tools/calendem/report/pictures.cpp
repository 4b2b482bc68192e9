// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/pictures.h"
#include "base/provenance.h"
#include "electrode/structure/slices.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <limits>

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

void Raster::rod(const Point &from, const Point &to, double radius, const Colour &colour) {
  const Point a = camera_.project(from), b = camera_.project(to);
  const double ax = a[0] * kSamples, ay = a[1] * kSamples;
  const double dx = b[0] * kSamples - ax, dy = b[1] * kSamples - ay;
  const double r = std::max(radius * camera_.scale() * kSamples, 0.8); // else it has no pixel
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

std::string png_of(const Raster &raster, const Camera &camera) {
  const std::string bytes = png_bytes(raster.pixels(), camera.width(), camera.height());
  return base64(reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size());
}

std::size_t row_near(const Curve &curve, double time_us) {
  const Column &time = curve["time_us"];
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < time.size(); ++i)
    if (std::abs(time[i] - time_us) < std::abs(time[nearest] - time_us))
      nearest = i;
  return nearest;
}

namespace {

constexpr double kTurn = 2.0 * kPi;

/// Side of a cell whose web may elongate.
double side_of(const Run &run, double as_packed, double time_us) {
  const std::string elongated = "cell_x_um";
  return run.curve.has(elongated) ? run.curve[elongated][row_near(run.curve, time_us)] : as_packed;
}

} // namespace

std::array<double, 2> period_of(const Run &run, double time_us) {
  const nlohmann::json cell = run.electrode.value("cell_um", nlohmann::json());
  if (cell.is_array() && cell.size() == 2 && cell[0].is_number() && cell[1].is_number())
    return {side_of(run, cell[0], time_us), cell[1]};
  return {0.0, 0.0};
}

PeriodicUnwrapper::PeriodicUnwrapper(const ParticleFrame &frame,
                                     const std::array<double, 2> &period)
    : period_(period) {
  if (!(period[0] > 0.0 && period[1] > 0.0))
    return;
  std::map<int, std::array<double, 4>> sums; // cosines and sines of x and y as angles
  for (std::size_t i = 0; i < frame.centre.size(); ++i)
    for (int k = 0; k < 2; ++k) {
      const double angle = kTurn * frame.centre[i][k] / period_[k];
      sums[frame.body[i]][k] += std::cos(angle);
      sums[frame.body[i]][2 + k] += std::sin(angle);
    }
  for (const auto &[body, s] : sums)
    for (int k = 0; k < 2; ++k)
      centre_[body][k] = period_[k] / kTurn * std::atan2(s[2 + k], s[k]);
}

Point PeriodicUnwrapper::place(Point p, int body) const {
  const auto found = centre_.find(body);
  if (body <= 0 || found == centre_.end())
    return p;
  for (int k = 0; k < 2; ++k) { // the centre in the cell, the point at its nearest image
    const double c = found->second[k] - period_[k] * std::floor(found->second[k] / period_[k]);
    p[k] -= period_[k] * std::round((p[k] - c) / period_[k]);
  }
  return p;
}

} // namespace calendem::report
