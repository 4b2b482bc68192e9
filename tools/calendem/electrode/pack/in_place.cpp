// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/pack/from_structure.h"
#include "physics/pi.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace calendem {
namespace {

using Eigen::Vector3d;

constexpr int kMostRounds = 400;
// Over a primary's radius. Less overlap is left to LIGGGHTS, where bodies turn too: without a turn a dense
// film has no place near by at which all would be free.
constexpr double kLeft = 0.4;
constexpr double kAlmost = 0.02;  // to that
constexpr double kMostMove = 0.2; // in a round

/// A body or a CBD sphere, moved as a whole.
struct Unit {
  Vector3d at, shift = Vector3d::Zero();
  double mass = 0.0;
  bool body = false;
  int contacts = 0;
};

struct Ball {
  int unit;
  Vector3d from; ///< the unit's centre
  double radius;
  Vector3d x = Vector3d::Zero(); ///< in the cell
};

/// Two balls, or two units, that overlap.
struct Overlap {
  int a, b;
  double depth;
  Vector3d push; ///< a from b; of balls as long as the depth
};

class Relaxation {
public:
  explicit Relaxation(const Recipe &recipe) : recipe_(recipe) {}

  void add(const Vector3d &at, const std::vector<Vector3d> &from, double radius, double density,
           bool body) {
    const double ball = kPi * 4.0 / 3.0 * radius * radius * radius;
    units_.push_back({at, Vector3d::Zero(), ball * density * double(from.size()), body, 0});
    for (const Vector3d &x : from)
      balls_.push_back({int(units_.size()) - 1, x, radius});
    width_ = std::max(width_, 2.0 * radius);
  }

  const Vector3d &at(size_t unit) const { return units_[unit].at; }

  void run() {
    for (int round = 0; round < kMostRounds && !step(); ++round)
      ;
  }

private:
  const Recipe &recipe_;
  std::vector<Unit> units_;
  std::vector<Ball> balls_;
  double width_ = 0.0;

  // True once no bodies overlap by more than is left, nor plates.
  bool step() {
    for (Ball &ball : balls_)
      ball.x = in_cell(recipe_, units_[ball.unit].at + ball.from);
    const double R = 0.5 * recipe_.primary_diameter;
    double deepest = push_from_plates();
    for (const Overlap &o : of_units(of_balls())) {
      Unit &a = units_[o.a], &b = units_[o.b];
      const Vector3d push = o.depth * o.push / (a.mass + b.mass);
      a.shift += b.mass * push;
      b.shift -= a.mass * push;
      ++a.contacts;
      ++b.contacts;
      if (a.body && b.body)
        deepest = std::max(deepest, o.depth);
    }
    if (deepest < kAlmost * R)
      return true;
    for (Unit &u : units_) {
      if (u.contacts > 0)
        u.shift /= double(u.contacts);
      const double length = u.shift.norm();
      u.at += u.shift * std::min(1.0, kMostMove * R / std::max(length, 1e-12));
      u.shift.setZero();
      u.contacts = 0;
    }
    return false;
  }

  double push_from_plates() {
    std::vector<double> low(units_.size(), 0.0), high(units_.size(), 0.0);
    for (const Ball &b : balls_) {
      low[b.unit] = std::max(low[b.unit], b.radius - b.x.z());
      high[b.unit] = std::max(high[b.unit], b.x.z() + b.radius - recipe_.thickness());
    }
    double deepest = 0.0;
    for (size_t k = 0; k < units_.size(); ++k) {
      units_[k].shift.z() += low[k] - high[k];
      units_[k].contacts += (low[k] > 0.0) + (high[k] > 0.0);
      deepest = std::max({deepest, low[k], high[k]});
    }
    return deepest;
  }

  // Pairs of different units.
  std::vector<Overlap> of_balls() const {
    const int nx = std::max(1, int(recipe_.cell_x / width_)),
              ny = std::max(1, int(recipe_.cell_y / width_));
    const auto index = [&](const Vector3d &x) {
      return std::array<int, 3>{std::min(nx - 1, int(x.x() / recipe_.cell_x * nx)),
                                std::min(ny - 1, int(x.y() / recipe_.cell_y * ny)),
                                int(std::floor(x.z() / width_))};
    };
    const auto key = [&](int i, int j, int k) {
      return (long(k) * ny + (j + ny) % ny) * nx + (i + nx) % nx;
    };
    std::unordered_map<long, std::vector<int>> bins;
    std::vector<Overlap> out;
    for (int n = 0; n < int(balls_.size()); ++n) { // with those that are in a bin already
      const auto [ci, cj, ck] = index(balls_[n].x);
      for (int i = ci - 1; i <= ci + 1; ++i)
        for (int j = cj - 1; j <= cj + 1; ++j)
          for (int k = ck - 1; k <= ck + 1; ++k)
            if (const auto bin = bins.find(key(i, j, k)); bin != bins.end())
              for (const int m : bin->second)
                note(m, n, out);
      bins[key(ci, cj, ck)].push_back(n);
    }
    return out;
  }

  void note(int m, int n, std::vector<Overlap> &out) const {
    const Ball &a = balls_[m], &b = balls_[n];
    if (a.unit == b.unit)
      return;
    const Vector3d d = periodic_difference(recipe_, a.x, b.x);
    const double left = kLeft * 0.5 * recipe_.primary_diameter;
    const double r = d.norm(), depth = a.radius + b.radius - r - left;
    if (depth > 0.0 && r > 0.0)
      out.push_back(a.unit < b.unit ? Overlap{a.unit, b.unit, depth, depth / r * d}
                                    : Overlap{b.unit, a.unit, depth, -depth / r * d});
  }

  // One for each pair of units: their deepest overlap, along the mean of all. Where these point
  // anywhere, as of units inside each other, along their centres.
  std::vector<Overlap> of_units(std::vector<Overlap> balls) const {
    std::stable_sort(balls.begin(), balls.end(), [](const Overlap &p, const Overlap &q) {
      return p.a != q.a ? p.a < q.a : p.b < q.b;
    });
    std::vector<Overlap> out;
    for (size_t first = 0, k = 0; first < balls.size(); first = k) {
      Overlap pair = balls[first];
      double total = 0.0;
      pair.push.setZero();
      for (; k < balls.size() && balls[k].a == pair.a && balls[k].b == pair.b; ++k) {
        pair.depth = std::max(pair.depth, balls[k].depth);
        pair.push += balls[k].push;
        total += balls[k].depth;
      }
      if (pair.push.norm() < 0.5 * total)
        pair.push = periodic_difference(recipe_, units_[pair.a].at, units_[pair.b].at);
      pair.push.normalize();
      out.push_back(pair);
    }
    return out;
  }
};

} // namespace

PlacementOfStructure place_in_place(const Recipe &r, const ExistingStructure &structure,
                                    const BodiesOfStructure &given) {
  Relaxation relaxation(r);
  for (size_t k = 0; k < given.bodies.size(); ++k)
    relaxation.add(given.at[k], given.bodies[k].primaries, 0.5 * r.primary_diameter,
                   primary_density(r), true);
  for (const ExistingSphere &s : structure.cbd)
    relaxation.add(s.x, {Vector3d::Zero()}, 0.5 * s.diameter, cbd_density(r), false);
  relaxation.run();
  PlacementOfStructure out;
  std::vector<Particle> &particles = out.loose.particles;
  const auto add = [&](int type, double diameter, double density, const Vector3d &x, int body) {
    const int tag = int(particles.size()) + 1;
    particles.push_back({tag, type, diameter, density, in_cell(r, x), body});
    out.loose.height = std::max(out.loose.height, x.z() + 0.5 * diameter);
  };
  size_t unit = 0;
  const auto note_move = [&](const Vector3d &from) {
    const double move = (relaxation.at(unit) - from).norm();
    out.moved += move > 0.0;
    out.largest_move_um = std::max(out.largest_move_um, move);
  };
  for (size_t k = 0; k < given.bodies.size(); ++k, ++unit) {
    note_move(given.at[k]);
    for (const Vector3d &p : given.bodies[k].primaries)
      add(1, r.primary_diameter, primary_density(r), relaxation.at(unit) + p, int(k) + 1);
  }
  for (const ExistingSphere &s : structure.cbd) {
    note_move(s.x);
    add(2, s.diameter, cbd_density(r), relaxation.at(unit++), 0);
  }
  out.loose.height = std::max(out.loose.height, r.thickness()) + 0.1;
  return out;
}

} // namespace calendem
