// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/grains.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace calendem {
namespace {

using Eigen::Vector3d;
using Site = std::array<int, 3>;

constexpr int kSamplesAlong = 7; // of a cell of the mean volume
constexpr int kIterations = 50;

/// Points of a fine lattice at a random turn and offset: the innermost of the hull that have the
/// volume asked for.
struct Samples {
  std::vector<Site> sites;
  std::vector<Vector3d> points;
  double spacing = 0.0; ///< [um]
};

Samples sample(const Hull &hull, int count, double volume, double farthest, Random &random) {
  Samples out;
  out.spacing = std::cbrt(volume) / kSamplesAlong;
  const Eigen::Matrix3d turn = random.rotation().toRotationMatrix();
  const Vector3d offset = random.uniform3();
  const int n = int(std::ceil(hull.reach / out.spacing)) + 1;
  struct Inside {
    double depth;
    Site site;
    Vector3d point;
  };
  std::vector<Inside> all;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -n; k <= n; ++k) {
        const Vector3d p = turn * (out.spacing * (Vector3d(i, j, k) + offset));
        if (p.norm() <= std::min(hull.reach, farthest))
          all.push_back({hull.depth(p), {i, j, k}, p});
      }
  const size_t wanted = size_t(count) * kSamplesAlong * kSamplesAlong * kSamplesAlong;
  if (all.size() < wanted)
    return out;
  const auto deeper = [](const Inside &a, const Inside &b) {
    return a.depth != b.depth ? a.depth < b.depth : a.site < b.site;
  };
  std::nth_element(all.begin(), all.begin() + long(wanted) - 1, all.end(), deeper);
  all.resize(wanted);
  std::sort(all.begin(), all.end(), [](const auto &a, const auto &b) { return a.site < b.site; });
  for (const Inside &s : all) {
    out.sites.push_back(s.site);
    out.points.push_back(s.point);
  }
  return out;
}

/// Finds the nearest of some points.
class Nearest {
public:
  Nearest(const std::vector<Vector3d> &points, double width) : points_(points), width_(width) {
    low_ = high_ = points.front();
    for (const Vector3d &p : points) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    for (int axis = 0; axis < 3; ++axis)
      n_[axis] = int((high_[axis] - low_[axis]) / width) + 1;
    bins_.resize(size_t(n_[0]) * n_[1] * n_[2]);
    for (size_t k = 0; k < points.size(); ++k)
      bins_[bin(index(points[k]))].push_back(int(k));
  }

  int of(const Vector3d &x) const {
    for (int rings = 1;; ++rings)
      if (const auto [k, squared] = within(x, rings);
          k >= 0 && squared <= rings * width_ * rings * width_)
        return k;
  }

private:
  const std::vector<Vector3d> &points_;
  double width_;
  Vector3d low_, high_;
  Site n_;
  std::vector<std::vector<int>> bins_;

  Site index(const Vector3d &x) const {
    Site at;
    for (int axis = 0; axis < 3; ++axis)
      at[axis] = int(std::floor((x[axis] - low_[axis]) / width_));
    return at;
  }
  size_t bin(const Site &at) const { return (size_t(at[2]) * n_[1] + at[1]) * n_[0] + at[0]; }

  std::pair<int, double> within(const Vector3d &x, int rings) const {
    const Site c = index(x);
    std::pair<int, double> best = {-1, std::numeric_limits<double>::infinity()};
    const auto from = [&](int axis) { return std::max(0, c[axis] - rings); };
    const auto to = [&](int axis) { return std::min(n_[axis] - 1, c[axis] + rings); };
    for (int k = from(2); k <= to(2); ++k)
      for (int j = from(1); j <= to(1); ++j)
        for (int i = from(0); i <= to(0); ++i)
          for (const int p : bins_[bin({i, j, k})])
            if (const double squared = (x - points_[p]).squaredNorm(); squared < best.second)
              best = {p, squared};
    return best;
  }
};

std::vector<Vector3d> draw_seeds(const std::vector<Vector3d> &points, int count, Random &random) {
  std::vector<size_t> left(points.size());
  for (size_t k = 0; k < left.size(); ++k)
    left[k] = k;
  std::vector<Vector3d> seeds;
  for (int k = 0; k < count; ++k) {
    const size_t drawn = k + size_t(random.uniform() * double(left.size() - k));
    std::swap(left[k], left[drawn]);
    seeds.push_back(points[left[k]]);
  }
  return seeds;
}

/// The cell that each point belongs to; `width` is that of a cell.
std::vector<int> cells_of(const std::vector<Vector3d> &points, double width,
                          const std::vector<Vector3d> &centres) {
  const Nearest nearest(centres, width);
  std::vector<int> cells;
  cells.reserve(points.size());
  for (const Vector3d &p : points)
    cells.push_back(nearest.of(p));
  return cells;
}

void move_to_centroids(const std::vector<Vector3d> &points, double width,
                       std::vector<Vector3d> &centres) {
  const std::vector<int> cells = cells_of(points, width, centres);
  std::vector<Vector3d> sum(centres.size(), Vector3d::Zero());
  std::vector<int> number(centres.size(), 0);
  for (size_t k = 0; k < cells.size(); ++k) {
    sum[cells[k]] += points[k];
    ++number[cells[k]];
  }
  for (size_t c = 0; c < centres.size(); ++c)
    if (number[c] > 0)
      centres[c] = sum[c] / number[c];
}

/// Area of all facets. A staircase of samples has 3/2 times the area of a surface at random turns.
double area_of_facets(const Samples &samples, const std::vector<Vector3d> &centres) {
  const std::vector<int> cells = cells_of(samples.points, kSamplesAlong * samples.spacing, centres);
  const auto key = [](const Site &s) {
    return (long(s[0]) * 4096 + s[1]) * 4096 + s[2]; // sites are within 2000 of 0
  };
  std::unordered_map<long, int> cell_at;
  for (size_t k = 0; k < cells.size(); ++k)
    cell_at[key(samples.sites[k])] = cells[k];
  long faces = 0;
  for (size_t k = 0; k < cells.size(); ++k)
    for (int axis = 0; axis < 3; ++axis) {
      Site beside = samples.sites[k];
      ++beside[axis];
      const auto found = cell_at.find(key(beside));
      faces += found != cell_at.end() && found->second != cells[k];
    }
  return double(faces) * samples.spacing * samples.spacing / 1.5;
}

int count_bonds(const std::vector<Vector3d> &centres, double bond) {
  int bonds = 0;
  for (size_t i = 0; i < centres.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      bonds += (centres[i] - centres[j]).norm() < bond;
  return bonds;
}

/// The innermost first, then each bonded to one before; what does not hang together is left out.
std::vector<Vector3d> grow(std::vector<Vector3d> left, double bond) {
  const auto inner = [](const Vector3d &a, const Vector3d &b) {
    return a.squaredNorm() < b.squaredNorm();
  };
  std::swap(left.front(), *std::min_element(left.begin(), left.end(), inner));
  std::vector<Vector3d> out = {left.front()};
  left.erase(left.begin());
  for (size_t k = 0; k < out.size(); ++k) {
    const auto apart = [&](const Vector3d &p) { return (p - out[k]).norm() >= bond; };
    const auto next = std::stable_partition(left.begin(), left.end(), apart);
    out.insert(out.end(), next, left.end());
    left.erase(next, left.end());
  }
  return out;
}

} // namespace

std::vector<Vector3d> spread_centres(const std::vector<Vector3d> &points, int count, double width,
                                     Random &random) {
  std::vector<Vector3d> centres = draw_seeds(points, count, random);
  for (int k = 0; k < kIterations; ++k)
    move_to_centroids(points, width, centres);
  return centres;
}

Grains make_grains(const Hull &hull, int count, double volume, double farthest, double bond,
                   Random &random) {
  const Samples samples = sample(hull, count, volume, farthest, random);
  if (samples.points.empty())
    return {};
  const std::vector<Vector3d> centres =
      spread_centres(samples.points, count, kSamplesAlong * samples.spacing, random);
  const std::vector<Vector3d> grown = grow(centres, bond);
  if (int(grown.size()) < count)
    return {};
  const int bonds = count_bonds(grown, bond);
  return {grown, bonds ? area_of_facets(samples, grown) / bonds : 0.0};
}

} // namespace calendem
