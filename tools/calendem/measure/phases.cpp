// SPDX-License-Identifier: GPL-2.0-or-later
#include "measure/phases.h"
#include "base/messages.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unordered_map>

namespace calendem {

PhaseImage phases_of(const LabelImage &image, std::int32_t background,
                     std::optional<std::int32_t> cbd) {
  refuse_negative_labels(image, {background, cbd});
  PhaseImage out;
  static_cast<LabelImage &>(out) = image;
  std::unordered_map<std::int32_t, std::int32_t> number;
  for (std::int32_t &label : out.label) {
    if (label == background)
      label = kPoreLabel;
    else if (cbd && label == *cbd)
      label = kCbdLabel;
    else
      label = number.try_emplace(label, std::int32_t(number.size() + 1)).first->second;
  }
  return out;
}

PhaseFractions phase_fractions(const PhaseImage &image) {
  std::array<size_t, 3> count = {0, 0, 0};
  for (size_t v = 0; v < image.label.size(); ++v)
    ++count[size_t(image.phase(v))];
  const double all = double(image.label.size());
  return {count[0] / all, count[1] / all, count[2] / all};
}

PhaseImage every_nth(const PhaseImage &image, int stride) {
  if (*std::min_element(image.n.begin(), image.n.end()) < stride)
    throw Failure(kBadInput,
                  fmt::format("the image has {} x {} x {} voxels: too few to take one of "
                              "{}. Give a larger image or smaller voxels.",
                              image.n[0], image.n[1], image.n[2], stride));
  const std::array<int, 3> n = {image.n[0] / stride, image.n[1] / stride, image.n[2] / stride};
  PhaseImage out = empty_phases(n, stride * image.voxel, image.periodic);
  size_t v = 0;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        out.label[v++] = image.at(stride * i, stride * j, stride * k);
  return out;
}

Porosity porosity(const Volumes &v) {
  Porosity p;
  p.total = 1.0 - (v.am + v.cbd_solid) / v.cell;
  p.macro = 1.0 - (v.am + v.cbd_envelope) / v.cell;
  p.nano = p.total - p.macro;
  return p;
}

std::vector<Slice> profile(const PhaseImage &image, const Density &density, double thickness) {
  const int wanted = std::max(1, int(std::lround(image.side(2) / thickness)));
  const int number = std::min(image.n[2], wanted);
  const size_t per_layer = size_t(image.n[0]) * image.n[1];
  std::vector<Slice> slices;
  for (int m = 0; m < number; ++m) {
    const int k = int(long(m) * image.n[2] / number), end = int(long(m + 1) * image.n[2] / number);
    std::array<size_t, 3> count = {0, 0, 0};
    for (size_t v = k * per_layer; v < end * per_layer; ++v)
      ++count[size_t(image.phase(v))];
    Slice s;
    s.from = k * image.voxel.z();
    s.to = end * image.voxel.z();
    const double all = double((end - k) * per_layer);
    s.fraction = {count[0] / all, count[1] / all, count[2] / all};
    s.porosity_total = 1.0 - density.am * s.fraction.am - density.cbd * s.fraction.cbd;
    slices.push_back(s);
  }
  return slices;
}

void count_bonds(const std::vector<BondAt> &bonds, std::vector<Slice> &slices) {
  for (const BondAt &b : bonds) {
    const auto above =
        std::find_if(slices.begin(), slices.end() - 1, [&](const Slice &s) { return b.z < s.to; });
    ++above->bonds;
    above->broken += b.broken;
  }
}

namespace {

using Offset = std::array<int, 3>;
constexpr int kDirections = 13;

std::array<Offset, kDirections> directions() {
  std::array<Offset, kDirections> out;
  size_t n = 0;
  for (int c = 0; c <= 1; ++c)
    for (int b = c == 0 ? 0 : -1; b <= 1; ++b)
      for (int a = c == 0 && b == 0 ? 1 : -1; a <= 1; ++a)
        out[n++] = {a, b, c};
  return out;
}

Eigen::Vector3d length(const Offset &d, const Eigen::Vector3d &voxel) {
  return Eigen::Vector3d(d[0], d[1], d[2]).cwiseProduct(voxel);
}

// Share of all directions that are nearest to each of the 13, on an even spiral of points.
std::array<double, kDirections> shares(const std::array<Offset, kDirections> &d,
                                       const Eigen::Vector3d &voxel) {
  constexpr int kPoints = 100000;
  const double golden = kPi * (3.0 - std::sqrt(5.0));
  std::array<Eigen::Vector3d, kDirections> unit;
  for (size_t m = 0; m < d.size(); ++m)
    unit[m] = length(d[m], voxel).normalized();
  std::array<double, kDirections> share{};
  for (int p = 0; p < kPoints; ++p) {
    const double z = (p + 0.5) / kPoints, r = std::sqrt(1.0 - z * z); // half the sphere
    const Eigen::Vector3d x(r * std::cos(golden * p), r * std::sin(golden * p), z);
    size_t nearest = 0;
    for (size_t m = 1; m < d.size(); ++m)
      if (std::fabs(x.dot(unit[m])) > std::fabs(x.dot(unit[nearest])))
        nearest = m;
    share[nearest] += 1.0 / kPoints;
  }
  return share;
}

/// Pairs of voxels along one direction: all of them, and those of two phases.
struct Count {
  double pairs = 0.0, pore_am = 0.0, pore_cbd = 0.0, am_cbd = 0.0;
  void note(VoxelPhase p, VoxelPhase q) {
    pairs += 1.0;
    if (p == q)
      return;
    const bool pore = p == VoxelPhase::pore || q == VoxelPhase::pore;
    const bool am = p == VoxelPhase::am || q == VoxelPhase::am;
    (pore && am ? pore_am : pore ? pore_cbd : am_cbd) += 1.0;
  }
};

Count count_along(const PhaseImage &image, const Offset &d) {
  Count count;
  size_t v = 0;
  for (int k = 0; k < image.n[2]; ++k)
    for (int j = 0; j < image.n[1]; ++j)
      for (int i = 0; i < image.n[0]; ++i, ++v)
        if (const long w = neighbour(image, i, j, k, d[0], d[1], d[2]); w >= 0)
          count.note(image.phase(v), image.phase(size_t(w)));
  return count;
}

} // namespace

SurfaceArea surface_area(const PhaseImage &image) {
  const auto d = directions();
  const auto share = shares(d, image.voxel);
  SurfaceArea out;
  for (size_t m = 0; m < d.size(); ++m) {
    const Count count = count_along(image, d[m]);
    if (count.pairs == 0.0)
      continue;
    const double factor = 2.0 * share[m] / (count.pairs * length(d[m], image.voxel).norm());
    out.pore_am += factor * count.pore_am;
    out.pore_cbd += factor * count.pore_cbd;
    out.am_cbd += factor * count.am_cbd;
  }
  return out;
}

} // namespace calendem
