// SPDX-License-Identifier: GPL-2.0-or-later
#include "measure/phases.h"
#include "base/messages.h"
#include <algorithm>
#include <fmt/format.h>
#include <unordered_map>

namespace calendem {
namespace {

constexpr double kMostVoxels = 4e8; // 1.6 GB of labels

} // namespace

PhaseImage empty_phases(const std::array<int, 3> &n, const Eigen::Vector3d &voxel, bool periodic) {
  const double voxels = double(n[0]) * n[1] * n[2];
  if (voxels > kMostVoxels)
    throw Failure(kBadInput, fmt::format("voxels of {:.3g} x {:.3g} x {:.3g} um make {:.3g} of "
                                         "them; allowed are {:.0e}. Take larger voxels.",
                                         voxel[0], voxel[1], voxel[2], voxels, kMostVoxels));
  PhaseImage image;
  image.n = n;
  image.voxel = voxel;
  image.periodic = periodic;
  image.label.assign(size_t(voxels), kPoreLabel);
  return image;
}

PhaseImage phases_of(const LabelImage &image, std::int32_t background,
                     std::optional<std::int32_t> cbd) {
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

} // namespace calendem
