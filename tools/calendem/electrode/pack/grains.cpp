// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/grains.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace calendem {
namespace {

using Eigen::Vector3d;
using Site = std::array<int, 3>;

constexpr int kSamplesAlong = 7; // of a cell of the mean volume
constexpr int kIterations = 50;
constexpr double kRounding = 1e-9; // of distances, in widths of a cell

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
  struct Found {
    int place = -1;
    double farther; ///< by how much, at least, any other point is farther away
  };

  Nearest(const std::vector<Vector3d> &points, double width) : width_(width) {
    Vector3d high = low_ = points.front();
    for (const Vector3d &p : points) {
      low_ = low_.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    for (int axis = 0; axis < 3; ++axis)
      n_[axis] = int((high[axis] - low_[axis]) / width) + 1;
    first_.resize(size_t(n_[0]) * n_[1] * n_[2] + 1);
    for (const Vector3d &p : points)
      ++first_[bin(index(p)) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    sorted_.resize(points.size());
    std::vector<size_t> next = first_;
    for (size_t k = 0; k < points.size(); ++k)
      sorted_[next[bin(index(points[k]))]++] = {points[k], int(k)};
  }

  Found of(const Vector3d &x) const {
    for (int rings = 1;; ++rings) {
      const auto [k, least, second] = within(x, rings);
      const double seen = rings * width_;
      if (k >= 0 && least <= seen * seen)
        return {k, std::min(std::sqrt(second), seen) - std::sqrt(least)};
    }
  }

private:
  struct Point {
    Vector3d at;
    int place;
  };
  struct Two {
    int place;
    double least, second; ///< squared distances
  };
  double width_;
  Vector3d low_;
  Site n_;
  std::vector<size_t> first_; ///< of each bin in `sorted_`, and the end
  std::vector<Point> sorted_;

  Site index(const Vector3d &x) const {
    Site at;
    for (int axis = 0; axis < 3; ++axis)
      at[axis] = int(std::floor((x[axis] - low_[axis]) / width_));
    return at;
  }
  size_t bin(const Site &at) const { return (size_t(at[2]) * n_[1] + at[1]) * n_[0] + at[0]; }

  Two within(const Vector3d &x, int rings) const {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const Site c = index(x);
    Two best = {-1, kFar, kFar};
    const auto from = [&](int axis) { return std::max(0, c[axis] - rings); };
    const auto to = [&](int axis) { return std::min(n_[axis] - 1, c[axis] + rings); };
    for (int k = from(2); k <= to(2); ++k)
      for (int j = from(1); j <= to(1) && from(0) <= to(0); ++j)
        for (size_t p = first_[bin({from(0), j, k})]; p < first_[bin({to(0), j, k}) + 1]; ++p) {
          const double squared = (x - sorted_[p].at).squaredNorm();
          if (squared < best.least)
            best = {sorted_[p].place, squared, best.least};
          else
            best.second = std::min(best.second, squared);
        }
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

/// Points, each in the cell of the nearest of some centres that move. A point is looked up again only where
/// the centres may have moved far enough for another to be nearest (Hamerly 2010, SIAM Data Mining).
class Cells {
public:
  /// `width` is that of a cell.
  Cells(const std::vector<Vector3d> &points, double width, std::vector<Vector3d> centres)
      : points_(points), width_(width), centres_(std::move(centres)), of_(points.size(), {0, 0.0}) {
    look_up();
  }

  const std::vector<Vector3d> &centres() const { return centres_; }
  int of(size_t point) const { return of_[point].place; }

  void move_to_centroids() {
    std::vector<Vector3d> sum(centres_.size(), Vector3d::Zero());
    std::vector<int> number(centres_.size(), 0);
    for (size_t k = 0; k < points_.size(); ++k) {
      sum[of(k)] += points_[k];
      ++number[of(k)];
    }
    std::vector<double> moved(centres_.size(), 0.0);
    for (size_t c = 0; c < centres_.size(); ++c)
      if (number[c] > 0) {
        const Vector3d centroid = sum[c] / number[c];
        moved[c] = (centroid - centres_[c]).norm();
        centres_[c] = centroid;
      }
    const double most = *std::max_element(moved.begin(), moved.end());
    for (Nearest::Found &cell : of_)
      cell.farther -= moved[cell.place] + most;
    look_up();
  }

private:
  const std::vector<Vector3d> &points_;
  double width_;
  std::vector<Vector3d> centres_;
  std::vector<Nearest::Found> of_;

  void look_up() {
    const Nearest nearest(centres_, width_);
    for (size_t k = 0; k < points_.size(); ++k)
      if (of_[k].farther < kRounding * width_)
        of_[k] = nearest.of(points_[k]);
  }
};

/// Area of all facets. A staircase of samples has 3/2 times the area of a surface at random turns.
double area_of_facets(const Samples &samples, const std::vector<Vector3d> &centres) {
  const Cells cells(samples.points, kSamplesAlong * samples.spacing, centres);
  const auto key = [](const Site &s) {
    return (long(s[0]) * 4096 + s[1]) * 4096 + s[2]; // sites are within 2000 of 0
  };
  std::unordered_map<long, int> cell_at;
  for (size_t k = 0; k < samples.sites.size(); ++k)
    cell_at[key(samples.sites[k])] = cells.of(k);
  long faces = 0;
  for (size_t k = 0; k < samples.sites.size(); ++k)
    for (int axis = 0; axis < 3; ++axis) {
      Site beside = samples.sites[k];
      ++beside[axis];
      const auto found = cell_at.find(key(beside));
      faces += found != cell_at.end() && found->second != cells.of(k);
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
  Cells cells(points, width, draw_seeds(points, count, random));
  for (int k = 0; k < kIterations; ++k)
    cells.move_to_centroids();
  return cells.centres();
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
