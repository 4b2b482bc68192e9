// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/parallel_bond.h"

#include <gtest/gtest.h>

#include "random_vector.h"

using namespace calendem;

namespace {

constexpr double kE = 2e8, kNu = 0.3, kR = 0.795, kLength = 1.28;
const double kG = kE / (2.0 * (1.0 + kNu));
const double kA = kPi * kR * kR, kI = kPi * kR * kR * kR * kR / 4.0, kJ = 2.0 * kI;

BondMaterial material(double damping = 0.0) { return {kE, shear_modulus(kE, kNu), 1.0, damping}; }

struct Pair {
  Vec3 x_i, x_j;
};

// What the host hands over after a step: new positions and the velocity that led there.
PairMotion motion_between(const Pair &before, const Pair &after, const Vec3 &spin_i,
                          const Vec3 &spin_j, double dt) {
  const Vec3 d = after.x_i - after.x_j;
  const Vec3 v = (1.0 / dt) * (d - (before.x_i - before.x_j));
  return {d, v, spin_i, spin_j, (1.0 / norm(d)) * d, norm(d)};
}

Vec3 rotated(const Vec3 &a, const Vec3 &axis, double angle) { // Rodrigues
  return std::cos(angle) * a + std::sin(angle) * cross(axis, a) +
         ((1.0 - std::cos(angle)) * dot(axis, a)) * axis;
}

BondLoads after_one_step(const Vec3 &shift_i, const Vec3 &turn_i, const Vec3 &turn_j) {
  const Pair before = {{kLength, 0, 0}, {0, 0, 0}};
  const Pair after = {before.x_i + shift_i, before.x_j};
  const double dt = 1e-3;
  const PairMotion m = motion_between(before, after, (1.0 / dt) * turn_i, (1.0 / dt) * turn_j, dt);
  BondLoads loads;
  advance(loads, m, BondStiffness(material(), BondSection(kR), kLength), dt);
  return loads;
}

BondAction action_on(const BondLoads &loads, double tension) {
  const PairMotion m = {{kLength, 0, 0}, {}, {}, {}, {1, 0, 0}, kLength};
  return action(loads, tension, m, BondDamping());
}

double largest_load(const BondLoads &l) {
  return norm(l.shear) + norm(l.bending) + std::fabs(l.twist);
}

} // namespace

// Requirement: tension F = E A d/l pulls i towards j.
TEST(ParallelBond, Tension) {
  const BondStiffness k(material(), BondSection(kR), kLength);
  const BondAction a = action_on({}, k.normal * 1e-3);
  EXPECT_NEAR(a.force.x / (kE * kA * 1e-3 / kLength), -1.0, 1e-14); // five products
  EXPECT_EQ(norm(a.torque_i) + norm(a.torque_j), 0.0);
}

// Requirement: shear F = G A s/l against the motion, with a moment F l/2 on either sphere. The
// sideways step turns the centre line by s/l, so the closed form holds to (s/l)^2 = 1e-12.
TEST(ParallelBond, Shear) {
  const double s = 1e-6 * kLength;
  const BondAction a = action_on(after_one_step({0, s, 0}, {}, {}), 0.0);
  const double F = kG * kA * s / kLength;
  EXPECT_NEAR(a.force.y / F, -1.0, 2e-12);
  EXPECT_NEAR(a.torque_i.z / (F * kLength / 2), 1.0, 2e-12);
  EXPECT_NEAR(a.torque_j.z / (F * kLength / 2), 1.0, 2e-12);
}

// Requirement: bending M = E I theta/l, no force; torsion M = G J phi/l. 1e-14: products only.
TEST(ParallelBond, BendingAndTorsion) {
  const double angle = 1e-4;
  const BondAction b = action_on(after_one_step({}, {0, 0, angle / 2}, {0, 0, -angle / 2}), 0.0);
  EXPECT_NEAR(b.torque_i.z / (kE * kI * angle / kLength), -1.0, 1e-14);
  EXPECT_NEAR(b.torque_j.z / (kE * kI * angle / kLength), 1.0, 1e-14);
  EXPECT_EQ(norm(b.force), 0.0);
  const BondAction t =
      action_on(after_one_step({}, {angle / 4, 0, 0}, {-3 * angle / 4, 0, 0}), 0.0);
  EXPECT_NEAR(t.torque_i.x / (kG * kJ * angle / kLength), -1.0, 1e-14);
  EXPECT_NEAR(t.torque_j.x / (kG * kJ * angle / kLength), 1.0, 1e-14);
  EXPECT_EQ(norm(t.force), 0.0);
}

// Requirement: rolling both spheres the same way shears the bond by l theta, as a beam does.
TEST(ParallelBond, EqualTurnsShear) {
  const BondLoads l = after_one_step({}, {0, 0, 1e-4}, {0, 0, 1e-4});
  EXPECT_NEAR(l.shear.y / (kG * kA * 1e-4), 1.0, 1e-14);
  EXPECT_EQ(norm(l.bending), 0.0);
}

// Requirement: a rigid motion creates no load whatever the radii, overlap, gap and axis: ten turns
// stay at round-off. In a step of angle theta the centres move by 2 tan(theta/2) times the mid-step
// centre line; spheres that spin at that rate turn with it exactly. Each step adds |v|/|d| 1e-16 of
// the angle at random; taken at its worst, N steps of angle theta give a shear angle of 4e-16 N
// theta = 4e-16 * 20 pi.
TEST(ParallelBond, RigidMotionCreatesNoLoad) {
  const double theta = 2.0 * kPi / 1000.0, dt = 1e-3;
  RandomVectors random(3);
  for (double length : {0.9, 1.28, 1.59, 1.7}) { // deep overlap, lattice, touching, gap
    const Vec3 axis = random.unit(), arm = length * random.unit();
    const Vec3 spin = (2.0 * std::tan(0.5 * theta) / dt) * axis;
    const BondStiffness k(material(), BondSection(0.4), length); // unequal pair, R_min = 0.4
    BondLoads loads;
    for (int n = 1; n <= 10000; ++n) {
      const Pair before = {rotated(arm, axis, (n - 1) * theta), {}};
      const Pair after = {rotated(arm, axis, n * theta), {}};
      advance(loads, motion_between(before, after, spin, spin, dt), k, dt);
    }
    // the chord is a difference of rounded positions: 1e-16 |d| / dt at random, as a walk over N
    // steps
    EXPECT_LT(largest_load(loads), (4e-16 * 20.0 * kPi + 4e-16 * 100.0) * k.shear * length);
  }
}

// Requirement: the same when the spheres spin at theta/dt: a step leaves a shear angle of
// 2 tan(theta/2) - theta = theta^3/12, so ten turns at most 20 pi theta^2/12, about whichever axis
// (the last is oblique); turns about the bond's own axis leave nothing.
TEST(ParallelBond, TenFiniteTurnsCreateNoLoad) {
  const double theta = 2.0 * kPi / 20000.0, dt = 1e-3;
  RandomVectors random(4);
  for (int axis_no = 0; axis_no < 4; ++axis_no) {
    const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6, 0.48, 0.64}};
    const Vec3 axis = axes[axis_no], spin = (theta / dt) * axis;
    const BondStiffness k(material(), BondSection(0.4), kLength);
    const Vec3 arm = {kLength, 0, 0}, offset = random.vector(3.0); // the axis is anywhere
    BondLoads loads;
    Pair before = {rotated(arm + offset, axis, 0), rotated(offset, axis, 0)};
    for (int n = 1; n <= 200000; ++n) {
      const Pair after = {rotated(arm + offset, axis, n * theta), rotated(offset, axis, n * theta)};
      advance(loads, motion_between(before, after, spin, spin, dt), k, dt);
      before = after;
    }
    const double most = 20.0 * kPi * theta * theta / 12.0 * k.shear * kLength;
    EXPECT_LT(largest_load(loads), axis_no == 0 ? 1e-6 * most : 1.01 * most) << "axis " << axis_no;
  }
}

// Requirement: a sheared, bent and twisted bond that turns rigidly by 90 degrees carries its loads
// along, about each axis and whatever the unit of length. Swing is exact; the twist's Cayley vector
// loses theta^3/12 per step: (pi/2) theta^2/12 in all. (No stiffness: nothing new is created.)
TEST(ParallelBond, LoadsTurnWithThePair) {
  const int steps = 1000;
  const double theta = 0.5 * kPi / steps, dt = 1e-3;
  const double tolerance = 0.5 * kPi * theta * theta / 12.0 + steps * 4e-16;
  for (double scale : {1.0, 1e-6})
    for (const Vec3 &axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      const BondStiffness none({0.0, 0.0, 1.0, 0.0}, BondSection(scale), scale);
      BondLoads loads = {{0, 1, 0}, {0, 0, 1}, 0.7};
      const Vec3 arm = {scale, 0, 0};
      for (int n = 1; n <= steps; ++n) {
        const Pair before = {rotated(arm, axis, (n - 1) * theta), {}};
        const Pair after = {rotated(arm, axis, n * theta), {}};
        const Vec3 spin = (theta / dt) * axis;
        advance(loads, motion_between(before, after, spin, spin, dt), none, dt);
      }
      EXPECT_LT(norm(loads.shear - rotated({0, 1, 0}, axis, 0.5 * kPi)), tolerance);
      EXPECT_LT(norm(loads.bending - rotated({0, 0, 1}, axis, 0.5 * kPi)), tolerance);
      EXPECT_EQ(loads.twist, 0.7);
    }
}

namespace {

PairMotion random_motion(RandomVectors &random) {
  const Vec3 n = random.unit();
  const double r = random.number(0.9, 1.5);
  const Vec3 d = r * n;
  const Vec3 v = random.vector(2.0), spin_i = random.vector(3.0), spin_j = random.vector(3.0);
  return {d, v, spin_i, spin_j, (1.0 / norm(d)) * d, norm(d)};
}

BondLoads random_loads(RandomVectors &random, const PairMotion &m) {
  const Vec3 shear = reject(random.vector(1e5), m.n), bending = reject(random.vector(1e5), m.n);
  return {shear, bending, random.number(-1e5, 1e5)};
}

PairMotion swapped(const PairMotion &m) { return {-m.d, -m.v, m.spin_j, m.spin_i, -m.n, m.r}; }
BondLoads swapped(const BondLoads &l) { return {-l.shear, -l.bending, l.twist}; }

void expect_same_bits(const Vec3 &a, const Vec3 &b) {
  ASSERT_EQ(a.x, b.x);
  ASSERT_EQ(a.y, b.y);
  ASSERT_EQ(a.z, b.z);
}

} // namespace

// Requirement: the two sides of a pair (two ranks, or a periodic face) compute mirrored numbers,
// bit for bit, so that both break in the same step.
TEST(ParallelBond, SwappedParticlesMirrorBits) {
  RandomVectors random(5);
  const BondStiffness k(material(), BondSection(0.6), kLength);
  const BondDamping c(material(0.1), BondSection(0.6), k, 4.0, 0.6);
  for (int n = 0; n < 2000; ++n) {
    const PairMotion m = random_motion(random);
    BondLoads here = random_loads(random, m), there = swapped(here);
    advance(here, m, k, 1e-3);
    advance(there, swapped(m), k, 1e-3);
    expect_same_bits(there.shear, -here.shear);
    expect_same_bits(there.bending, -here.bending);
    ASSERT_EQ(there.twist, here.twist);
    const double tension = random.number(-1e5, 1e5);
    const BondAction a = action(here, tension, m, c), b = action(there, tension, swapped(m), c);
    expect_same_bits(b.force, -a.force);
    expect_same_bits(b.torque_i, a.torque_j);
    expect_same_bits(b.torque_j, a.torque_i);
  }
}

// Requirement: angular momentum: d x F + M_i + M_j = 0, damping included (linear momentum: the
// partner gets the opposite of the same force). 16 ulp of the sizes that are added.
TEST(ParallelBond, AngularMomentumIsConserved) {
  RandomVectors random(6);
  const BondStiffness k(material(), BondSection(0.6), kLength);
  const BondDamping c(material(0.3), BondSection(0.6), k, 4.0, 0.6);
  for (int n = 0; n < 2000; ++n) {
    const PairMotion m = random_motion(random);
    const BondAction a = action(random_loads(random, m), random.number(-1e5, 1e5), m, c);
    const Vec3 sum = cross(m.d, a.force) + a.torque_i + a.torque_j;
    const double size = norm(m.d) * norm(a.force) + norm(a.torque_i) + norm(a.torque_j);
    ASSERT_LT(norm(sum), 16 * 2.2e-16 * size);
  }
}

// Requirement: damping only takes energy: its power is never positive, and vanishes for a rigid
// motion.
TEST(ParallelBond, DampingDissipates) {
  RandomVectors random(7);
  const BondStiffness k(material(), BondSection(0.6), kLength);
  const BondDamping c(material(0.3), BondSection(0.6), k, 4.0, 0.6);
  for (int n = 0; n < 2000; ++n) {
    PairMotion m = random_motion(random);
    BondAction a = action({}, 0.0, m, c);
    ASSERT_LT(dot(a.force, m.v) + dot(a.torque_i, m.spin_i) + dot(a.torque_j, m.spin_j), 0.0);
    m.spin_j = m.spin_i;
    m.v = cross(m.spin_i, m.d);
    a = action({}, 0.0, m, c);
    ASSERT_LT(norm(a.force), 1e-14 * c.normal * norm(m.spin_i) * m.r);
  }
}

// Requirement: what the ledger counts as dissipated is the bond's action less its elastic part, to
// the round-off of the larger.
TEST(ParallelBond, ViscousPart) {
  RandomVectors random(8);
  const BondStiffness k(material(), BondSection(0.6), kLength);
  const BondDamping c(material(0.3), BondSection(0.6), k, 4.0, 0.6);
  for (int n = 0; n < 2000; ++n) {
    const PairMotion m = random_motion(random);
    const BondLoads loads = {random.vector(1e3), random.vector(1e3), random.number(-1e3, 1e3)};
    const BondAction viscous = damping_action(m, c), all = action(loads, 1e3, m, c);
    const BondAction elastic = action(loads, 1e3, m, BondDamping());
    const auto near = [&](const Vec3 &a, const Vec3 &b, const Vec3 &v) {
      const double size = norm(a) + norm(b) + norm(v) + 1e3;
      return norm(a - b - v) < 1e-14 * size * (1.0 + norm(m.d));
    };
    ASSERT_TRUE(near(all.force, elastic.force, viscous.force));
    ASSERT_TRUE(near(all.torque_i, elastic.torque_i, viscous.torque_i));
    ASSERT_TRUE(near(all.torque_j, elastic.torque_j, viscous.torque_j));
  }
}

// Requirement: `damping` is the fraction of critical damping of the pair's axial mode: 2 sqrt(k m).
TEST(ParallelBond, DampingIsFractionOfCritical) {
  const BondStiffness k(material(), BondSection(0.6), kLength);
  EXPECT_DOUBLE_EQ(BondDamping(material(1.0), BondSection(0.6), k, 4.0, 0.6).normal,
                   2.0 * std::sqrt(k.normal * 4.0));
  EXPECT_EQ(BondDamping(material(0.0), BondSection(0.6), k, 4.0, 0.6).normal, 0.0);
}

namespace {

// A smooth motion with large common turns and small strains of every kind; returns the work done on
// the bond (trapezoid) minus its energy, relative to the energy's maximum.
double energy_error(int steps) {
  const double end = 4.0, dt = end / steps;
  const BondStiffness k(material(), BondSection(0.6), kLength);
  const auto centre_line = [](double t) {
    const Vec3 d = {kLength * (1.0 + 0.01 * std::sin(2 * t)), 0.01 * std::sin(3 * t), 0.0};
    return rotated(rotated(d, {0, 0, 1}, 0.5 * t * t), {0.6, 0.8, 0}, 0.7 * t);
  };
  const auto spins = [](double t, Vec3 &i, Vec3 &j) { // the turn of centre_line and a difference
    const Vec3 common = 0.7 * Vec3{0.6, 0.8, 0} + rotated({0, 0, t}, {0.6, 0.8, 0}, 0.7 * t);
    const Vec3 part = {0.02 * std::cos(t), 0.03 * std::sin(2 * t), 0.01 * std::cos(3 * t)};
    i = common + part;
    j = common - 0.7 * part;
  };
  BondLoads loads;
  Vec3 d = centre_line(0.0);
  double tension = k.normal * (norm(d) - kLength), work = 0.0, largest = 0.0, energy = 0.0;
  const double start = strain_energy(loads, tension, k);
  PairMotion m = {d, {}, {}, {}, (1.0 / norm(d)) * d, norm(d)};
  BondAction before = action(loads, tension, m, BondDamping());
  for (int n = 1; n <= steps; ++n) {
    const Vec3 next = centre_line(n * dt);
    Vec3 spin_i, spin_j;
    spins((n - 0.5) * dt, spin_i, spin_j);
    m = {next, (1.0 / dt) * (next - d), spin_i, spin_j, (1.0 / norm(next)) * next, norm(next)};
    advance(loads, m, k, dt);
    tension = k.normal * (m.r - kLength);
    const BondAction now = action(loads, tension, m, BondDamping());
    work -= 0.5 * dt *
            (dot(before.force + now.force, m.v) + dot(before.torque_i + now.torque_i, spin_i) +
             dot(before.torque_j + now.torque_j, spin_j));
    before = now;
    d = next;
    energy = strain_energy(loads, tension, k);
    largest = std::fmax(largest, energy);
  }
  return std::fabs(work - (energy - start)) / largest;
}

} // namespace

// Requirement: the bond's energy is the work done on it, through any motion: the difference
// vanishes with the square of the step (4, and a tenth for the next order).
TEST(ParallelBond, EnergyIsWork) {
  const double coarse = energy_error(2000), fine = energy_error(4000), finest = energy_error(8000);
  RecordProperty("error_2000_steps", std::to_string(coarse));
  std::printf("energy error: %.3g %.3g %.3g\n", coarse, fine, finest);
  EXPECT_LT(finest, 2e-3);
  EXPECT_GT(coarse / fine, 3.9);
  EXPECT_GT(fine / finest, 3.9);
}
