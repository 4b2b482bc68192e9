// SPDX-License-Identifier: GPL-2.0-or-later
// Energy of undamped bonded spheres that spin and vibrate, moved as the host's nve/sphere moves
// them, over a million production steps.
#include "physics/parallel_bond.h"
#include "physics/time_step_bound.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

using namespace calendem;

namespace {

constexpr double kR = 0.795, kLength = 1.28, kSpin = 10.0; // um, um, rad/us
constexpr double kOfBound = 0.8;                           // production step over its bound
constexpr double kMass = 4.65 * 4.0 / 3.0 * kPi * kR * kR * kR, kInertia = 0.4 * kMass * kR * kR;

struct Sphere {
  Vec3 x, v, spin, force, torque;
};

/// Spheres of which each is bonded to the first.
struct Body {
  std::vector<Sphere> spheres;
  std::vector<BondLoads> loads;
  BondStiffness k =
      BondStiffness({2e8, shear_modulus(2e8, 0.3), 1.0, 0.0}, BondSection(kR), kLength);
  double dt = 0.0, strain = 0.0;

  explicit Body(const std::vector<Vec3> &arms) : spheres(1), loads(arms.size()) {
    SphereBlock block;
    for (const Vec3 &n : arms) {
      spheres.push_back({kLength * n, {}, {}, {}, {}});
      block.add(k, -n, kLength);
    }
    dt = kOfBound * stable_step(block, SphereBlock(), kMass, kR);
    act(false);
  }
  void spin(const Vec3 &omega) {
    Vec3 centre;
    for (const Sphere &s : spheres)
      centre = centre + (1.0 / spheres.size()) * s.x;
    for (Sphere &s : spheres) {
      s.spin = omega;
      s.v = cross(omega, s.x - centre);
    }
  }
  void act(bool advancing) {
    strain = 0.0;
    for (Sphere &s : spheres)
      s.force = s.torque = {};
    for (size_t n = 0; n < loads.size(); ++n) {
      Sphere &i = spheres[0], &j = spheres[n + 1];
      const Vec3 d = i.x - j.x;
      const PairMotion m = {d, i.v - j.v, i.spin, j.spin, (1.0 / norm(d)) * d, norm(d)};
      if (advancing)
        advance(loads[n], m, k, dt);
      const double tension = k.normal * (m.r - kLength);
      const BondAction a = action(loads[n], tension, m, BondDamping());
      i.force = i.force + a.force;
      j.force = j.force - a.force;
      i.torque = i.torque + a.torque_i;
      j.torque = j.torque + a.torque_j;
      strain += strain_energy(loads[n], tension, k);
    }
  }
  void kick() {
    for (Sphere &s : spheres) {
      s.v = s.v + (0.5 * dt / kMass) * s.force;
      s.spin = s.spin + (0.5 * dt / kInertia) * s.torque;
    }
  }
  void step() {
    kick();
    for (Sphere &s : spheres)
      s.x = s.x + dt * s.v;
    act(true); // with the velocities of the half step
    kick();
  }
  double energy() const {
    double sum = strain;
    for (const Sphere &s : spheres)
      sum += 0.5 * (kMass * norm_squared(s.v) + kInertia * norm_squared(s.spin));
    return sum;
  }
};

/// Energy over that of the start: extremes over the run, means over its first and its last fifth.
struct Course {
  double least = HUGE_VAL, most = -HUGE_VAL, first = 0.0, last = 0.0;
};

Course run(Body &body, int steps) {
  const double start = body.energy();
  const int fifth = steps / 5;
  Course c;
  for (int n = 0; n < steps; ++n) {
    body.step();
    const double e = body.energy() / start;
    c.least = std::min(c.least, e);
    c.most = std::max(c.most, e);
    c.first += n < fifth ? e / fifth : 0.0;
    c.last += n >= steps - fifth ? e / fifth : 0.0;
  }
  return c;
}

/// Spins about `axis` with the inner motion `amount` times a fixed pattern [um/us, rad/us].
void expect_energy_kept(Body body, const Vec3 &axis, double amount, int steps) {
  body.spin(kSpin * axis);
  const double rigid = body.energy();
  body.spheres[1].v = body.spheres[1].v + amount * Vec3{0.3, 0.5, 0.4};
  body.spheres[0].spin = body.spheres[0].spin + amount * Vec3{-0.2, 0.5, 0.5};
  body.spheres[1].spin = body.spheres[1].spin + amount * Vec3{0.4, -0.7, 0.5};
  // From the first step on each bond carries the turn: no more than two spheres at kLength pull,
  // along it, across it, and with half its length as lever.
  const double pull = 2.0 * kMass * kSpin * kSpin * kLength;
  const BondLoads most = {{0, pull, 0}, {0, 0, 0.5 * kLength * pull}, 0.0};
  const double inner =
      std::fabs(body.energy() - rigid) + body.loads.size() * strain_energy(most, pull, body.k);
  // A mode of frequency omega exchanges its energy with a swing of (omega dt/2)^2 / (1 - the same).
  const double s = kOfBound * kOfBound, swing = s / (1.0 - s) * inner / body.energy();
  const Course c = run(body, steps);
  std::printf("%zu spheres, inner motion %g: E/E0 %.9f to %.9f, mean %.9f, later %.9f\n",
              body.spheres.size(), amount, c.least, c.most, c.first, c.last);
  EXPECT_GT(c.least, 1.0 - swing);
  EXPECT_LT(c.most, 1.0 + swing);
  // Means of a bounded swing over many turns differ by at most a part of a turn in either mean.
  const double turns = kSpin * steps / 5 * body.dt / (2.0 * kPi);
  EXPECT_LT(std::fabs(c.last - c.first), (c.most - c.least) / (kPi * turns));
}

const Vec3 kOblique = {0.6, 0.48, 0.64};

} // namespace

// Requirement: a pair that spins keeps its energy, about an axis across and one oblique to the
// bond, at rest within and with inner motion: within Verlet's swing at every step, and its mean.
TEST(ParallelBondEnergy, SpinningPair) {
  for (const Vec3 &axis : {Vec3{0, 0, 1}, kOblique})
    for (double amount : {0.0, 0.1, 1.0})
      expect_energy_kept(Body({{1, 0, 0}}), axis, amount, 1000000);
}

// Requirement: the same for three spheres in an L, whose bonds bend, twist and shear each other.
TEST(ParallelBondEnergy, SpinningCorner) {
  for (double amount : {0.0, 1.0})
    expect_energy_kept(Body({{1, 0, 0}, {0, 1, 0}}), kOblique, amount, 1000000);
}
