// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/viscous_contact.h"

#include <gtest/gtest.h>

using namespace calendem;

namespace {

constexpr double E = 1e6, R = 0.33, g = 0.4, tau = 2.0, depth = 0.05;
const ViscousContact contact({E, R, R}, {g, tau});

struct Pressed {
  ViscousContact::State state;
  double overlap = 0.0, work = 0.0, taken = 0.0;

  /// At constant speed to `to` in `time`, in n steps; work by the trapezoid.
  void go(double to, double time, int n) {
    const double step = (to - overlap) / n;
    for (int k = 0; k < n; ++k) {
      const double before = overlap, force = contact.force(overlap, state);
      overlap = before + step;
      taken += contact.advance(before, overlap, time / n, state);
      work += 0.5 * step * (force + contact.force(overlap, state));
    }
  }
  double force() const { return contact.force(overlap, state); }
};

} // namespace

// Requirement: fast is Hertz, slow is (1 - g) Hertz. To first order in the ratio of times.
TEST(ViscousContact, FastAndSlow) {
  Pressed fast, slow;
  fast.go(depth, 1e-6 * tau, 10);
  slow.go(depth, 1e6 * tau, 10);
  EXPECT_NEAR(fast.force() / hertz_force(E, R, depth), 1.0, 1e-6);
  EXPECT_NEAR(slow.force() / hertz_force(E, R, depth), 1.0 - g, 1e-6);
}

// Requirement: at a fixed overlap the relaxing part falls as exp(-t/tau), however it is cut into
// steps.
TEST(ViscousContact, Relaxation) {
  for (int n : {1, 7}) {
    Pressed p;
    p.go(depth, 1e-9 * tau, 1);
    p.go(depth, 0.7 * tau, n);
    EXPECT_NEAR(p.force() / hertz_force(E, R, depth), 1.0 - g + g * std::exp(-0.7), 1e-9);
  }
}

// Requirement: at constant speed v the branch's spring is at v (1 - exp(-r t))/r, r = 2/(3 tau);
// exact, so steps do not matter. 1e-12: round-off of 1000 steps.
TEST(ViscousContact, ExactAtConstantSpeed) {
  const double time = 1.5, r = 2.0 / (3.0 * tau);
  const double e = depth / time * (1.0 - std::exp(-r * time)) / r;
  for (int n : {1, 1000}) {
    Pressed p;
    p.go(depth, time, n);
    EXPECT_NEAR((p.overlap - p.state.dashpot) / e, 1.0, 1e-12);
    EXPECT_NEAR(p.force() / ((1 - g) * hertz_force(E, R, depth) + g * hertz_force(E, R, e)), 1.0,
                1e-12);
  }
}

// Requirement: after a relaxed contact is let out quickly it pushes less than (1 - g) Hertz and
// comes back to it: the springback is delayed. It never pulls.
TEST(ViscousContact, DelayedSpringback) {
  Pressed p;
  p.go(depth, 10 * tau, 100);
  p.go(depth, 20 * tau, 1);
  p.go(0.8 * depth, 1e-3 * tau, 10);
  const double at_last = (1.0 - g) * hertz_force(E, R, p.overlap);
  const double at_once = p.force();
  EXPECT_LT(at_once, at_last);
  EXPECT_NEAR(at_once, at_last - g * hertz_force(E, R, 0.2 * depth), 1e-3 * at_last);
  p.go(p.overlap, 40 * tau, 10);
  EXPECT_NEAR(p.force() / at_last, 1.0, 1e-9);
  while (p.overlap > 1e-3 * depth) {
    p.go(0.9 * p.overlap, 1e-3 * tau, 1);
    EXPECT_GE(p.force(), 0.0);
  }
}

// Requirement: work is stored or taken, in and out, quickly or slowly, through the open state too.
// Trapezoids over n steps: second order, some 1/n^2 of the work, n^-1.5 where H has its root.
TEST(ViscousContact, WorkIsStoredOrTaken) {
  for (double time : {0.01 * tau, tau, 30.0 * tau}) {
    const int n = 4000;
    Pressed p;
    p.go(depth, time, n);
    const double in = p.work;
    EXPECT_NEAR(p.work, contact.elastic_energy(p.overlap, p.state) + p.taken, 1e-6 * in);
    p.go(depth, 2.0 * tau, n);
    p.go(0.0, time, n);
    EXPECT_LT(contact.elastic_energy(p.overlap, p.state), 1e-20); // (an ulp of the way)^2.5
    EXPECT_GT(p.taken, 0.0);
    EXPECT_NEAR(p.work, p.taken, 1e-5 * in);
  }
}

// Requirement: the dashpot never gives. No contact, no force.
TEST(ViscousContact, TakesOnly) {
  Pressed p;
  const double way[] = {0.02, 0.05, 0.01, 0.04, 0.001, 0.03, 0.0, 0.02};
  double before = 0.0;
  for (double to : way) {
    p.go(to, 0.3 * tau, 50);
    EXPECT_GE(p.taken, before);
    EXPECT_GE(p.state.dashpot, 0.0);
    before = p.taken;
  }
  EXPECT_EQ(contact.force(-0.1, {}), 0.0);
  EXPECT_EQ(contact.elastic_energy(-0.1, {}), 0.0);
  EXPECT_EQ(contact.contact_radius(-0.1, {}), 0.0);
}
