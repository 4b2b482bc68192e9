// SPDX-License-Identifier: GPL-2.0-or-later
#include "measure/phases.h"
#include "base/messages.h"
#include "physics/pi.h"
#include <algorithm>
#include <climits>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <unordered_map>

namespace calendem {

namespace {

using Spheres = std::vector<Sphere>;

constexpr double kBlur = 0.4;  // lattice spacings
constexpr double kReach = 3.0; // blurs

int wrapped(int i, int n) { return ((i % n) + n) % n; }

// Brings the spheres of a body together that lie on both sides of a periodic face: each next to
// the nearest of those that are together already (the body may be wider than half the cell).
void join(Spheres &body, const Cell &cell) {
  std::vector<double> nearest(body.size(), HUGE_VAL);
  std::vector<Eigen::Vector3d> there(body.size()); // place next to that one
  for (size_t m = 0; m + 1 < body.size(); ++m) {
    size_t next = m + 1;
    for (size_t i = m + 1; i < body.size(); ++i) {
      Eigen::Vector3d d = body[i].x - body[m].x;
      d.x() -= cell.lx * std::round(d.x() / cell.lx);
      d.y() -= cell.ly * std::round(d.y() / cell.ly);
      if (d.norm() < nearest[i]) {
        nearest[i] = d.norm();
        there[i] = body[m].x + d;
      }
      if (nearest[i] < nearest[next])
        next = i;
    }
    std::swap(body[m + 1], body[next]);
    std::swap(nearest[m + 1], nearest[next]);
    std::swap(there[m + 1], there[next]);
    body[m + 1].x = there[m + 1];
  }
}

// Voxels around some spheres, on the lattice of the image but not wrapped, with a number each.
class Box {
public:
  Box(const Spheres &spheres, const Eigen::Vector3d &voxel, double reach)
      : voxel_(voxel), reach_(reach) {
    low_.setConstant(INT_MAX);
    Eigen::Array3i high = Eigen::Array3i::Constant(INT_MIN);
    for (const Sphere &s : spheres) {
      low_ = low_.min(voxel_at(s.x.array() - reach));
      high = high.max(voxel_at(s.x.array() + reach));
    }
    n_ = high - low_ + 1;
    value.assign(size_t(n_[0]) * n_[1] * n_[2], 0.0F);
  }
  std::vector<float> value;

  /// Adds f(squared distance from x) to the voxels with their centre closer than the reach.
  void add(const Eigen::Vector3d &x, const std::function<float(double)> &f) {
    const Eigen::Array3i from = voxel_at(x.array() - reach_), to = voxel_at(x.array() + reach_);
    for (int k = from[2]; k <= to[2]; ++k)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i) {
          const Eigen::Array3d centre = (Eigen::Array3d(i, j, k) + 0.5) * voxel_.array();
          const double d2 = (centre.matrix() - x).squaredNorm();
          if (d2 < reach_ * reach_)
            value[index({i, j, k})] += f(d2);
        }
  }
  Eigen::Array3i voxel_of(size_t index) const {
    return low_ + Eigen::Array3i(int(index % n_[0]), int(index / n_[0] % n_[1]),
                                 int(index / n_[0] / n_[1]));
  }

private:
  Eigen::Vector3d voxel_;
  double reach_;
  Eigen::Array3i low_, n_;

  Eigen::Array3i voxel_at(const Eigen::Array3d &x) const {
    return (x / voxel_.array()).floor().cast<int>();
  }
  size_t index(const Eigen::Array3i &v) const {
    return (size_t(v[2] - low_[2]) * n_[1] + (v[1] - low_[1])) * n_[0] + (v[0] - low_[0]);
  }
};

void put(PhaseImage &image, const Eigen::Array3i &v, std::int32_t label) {
  if (v[2] < 0 || v[2] >= image.n[2])
    return;
  std::int32_t &at =
      image.label[image.index(wrapped(v[0], image.n[0]), wrapped(v[1], image.n[1]), v[2])];
  if (at == kPoreLabel)
    at = label;
}

void put_body(PhaseImage &image, const Spheres &body, double lattice) {
  const double blur = kBlur * lattice;
  Box box(body, image.voxel, kReach * blur);
  for (const Sphere &s : body)
    box.add(s.x, [&](double d2) { return float(std::exp(-0.5 * d2 / (blur * blur))); });
  std::vector<size_t> order;
  for (size_t v = 0; v < box.value.size(); ++v)
    if (box.value[v] > 0.0F)
      order.push_back(v);
  const double volume = double(body.size()) * std::pow(lattice, 3);
  const size_t voxels = std::min(order.size(), size_t(std::lround(volume / image.voxel.prod())));
  const auto denser = [&](size_t a, size_t b) {
    return box.value[a] > box.value[b] || (box.value[a] == box.value[b] && a < b);
  };
  std::nth_element(order.begin(), order.begin() + long(voxels), order.end(), denser);
  for (size_t m = 0; m < voxels; ++m)
    put(image, box.voxel_of(order[m]), body[0].body);
}

void put_cbd(PhaseImage &image, const Sphere &sphere) {
  Box box({sphere}, image.voxel, sphere.radius);
  box.add(sphere.x, [](double) { return 1.0F; });
  for (size_t v = 0; v < box.value.size(); ++v)
    if (box.value[v] > 0.0F)
      put(image, box.voxel_of(v), kCbdLabel);
}

} // namespace

PhaseImage voxelise(const std::vector<Sphere> &spheres, const Cell &cell, double lattice,
                    double voxel) {
  const auto number = [&](double side) {
    return std::max(1, int(std::ceil(0.5 * side / voxel - 1e-9))) * 2;
  };
  const std::array<int, 3> n = {number(cell.lx), number(cell.ly), number(cell.height)};
  PhaseImage image =
      empty_phases(n, {cell.lx / n[0], cell.ly / n[1], cell.height / n[2]}, /*periodic=*/true);
  std::map<int, Spheres> bodies;
  for (const Sphere &s : spheres)
    bodies[s.body].push_back(s);
  for (auto &[body, members] : bodies)
    if (body > 0) {
      join(members, cell);
      put_body(image, members, lattice);
    }
  for (const Sphere &s : bodies[0])
    put_cbd(image, s);
  return image;
}

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
