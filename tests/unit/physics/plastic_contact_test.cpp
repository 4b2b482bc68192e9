// SPDX-License-Identifier: GPL-2.0-or-later
#include "physics/plastic_contact.h"
#include "physics/sjkr_cohesion.h"

#include <gtest/gtest.h>

using namespace calendem;

namespace {

constexpr double E = 1e8, R = 0.4, p_y = 5e6; // NMC-like; kPa, um
const PlasticContact contact(E, R, p_y);

PlasticContact::Params params(double yield_pressure) {
  PlasticContact::Params p;
  p.yield_pressure = yield_pressure;
  return p;
}

} // namespace

// Requirement: yield is where Hertz' largest pressure 2 E a/(pi R) meets the limit. 4 ulp.
TEST(PlasticContact, YieldsAtTheLimitingPressure) {
  const double a = std::sqrt(R * contact.yield_overlap());
  EXPECT_DOUBLE_EQ(2.0 * E * a / (kPi * R), p_y);
}

// Requirement: below yield nothing but Hertz, loading and unloading.
TEST(PlasticContact, HertzBelowYield) {
  const double d = 0.9 * contact.yield_overlap();
  for (double part : {0.0, 0.3, 1.0}) {
    EXPECT_DOUBLE_EQ(contact.force(part * d, {d}), hertz_force(E, R, part * d));
    EXPECT_DOUBLE_EQ(contact.elastic_energy(part * d, {d}), hertz_energy(E, R, part * d));
  }
  EXPECT_EQ(contact.plastic_work(d), 0.0);
  EXPECT_EQ(contact.force(-0.1, {0.0}), 0.0);
  EXPECT_EQ(contact.force(-0.1, {d}), 0.0);
}

// Requirement: force and slope are continuous at yield; beyond, the slope is pi p_y R. The overlaps
// differ by 1e-7: the force by 1.5e-7 of itself, Hertz' slope by 0.5e-7.
TEST(PlasticContact, LoadingIsSmooth) {
  const double y = contact.yield_overlap(), h = 1e-7 * y;
  EXPECT_NEAR(contact.loading_force(y + h) / hertz_force(E, R, y), 1.0, 2e-7);
  EXPECT_NEAR(hertz_stiffness(E, R, y) / (kPi * p_y * R), 1.0, 1e-15);
  EXPECT_NEAR((contact.loading_force(9 * y) - contact.loading_force(4 * y)) / (5 * y),
              kPi * p_y * R, 1e-6);
}

// Requirement: the overlap under a force is that of loading. 4 ulp of the power.
TEST(PlasticContact, OverlapUnderAForce) {
  for (double times : {0.1, 0.9, 1.0, 1.1, 40.0}) {
    const double d = times * contact.yield_overlap();
    EXPECT_NEAR(contact.overlap_under(contact.loading_force(d)) / d, 1.0, 1e-15);
  }
}

// Requirement: unloading is Hertz with Thornton's radius and residual overlap, written as he does:
// R_p = 4E/(3F*) ((2F* + F_y)/(2 pi p_y))^(3/2), d_p = d* - (3F*/(4E sqrt(R_p)))^(2/3).
TEST(PlasticContact, UnloadingIsThorntons) {
  const double y = contact.yield_overlap(), F_y = hertz_force(E, R, y);
  for (double times : {1.5, 10.0, 60.0}) {
    const double largest = times * y, F = contact.loading_force(largest);
    const double R_p = 4 * E / (3 * F) * std::pow((2 * F + F_y) / (2 * kPi * p_y), 1.5);
    const double residual = largest - std::pow(3 * F / (4 * E * std::sqrt(R_p)), 2.0 / 3.0);
    EXPECT_GT(R_p, R);
    EXPECT_GT(residual, 0.0);
    EXPECT_NEAR((largest - contact.elastic_overlap(largest)) / residual, 1.0, 1e-13);
    for (double part : {0.1, 0.5, 1.0}) { // of the way from the residual overlap to the largest
      const double d = residual + part * (largest - residual);
      const double law = hertz_force(E, R_p, d - residual);
      EXPECT_NEAR(contact.force(d, {largest}) / law, 1.0, 1e-13);
      EXPECT_NEAR(contact.contact_radius(d, {largest}) / std::sqrt(R_p * (d - residual)), 1.0,
                  1e-13);
    }
    EXPECT_EQ(contact.force(0.99 * residual, {largest}), 0.0);
    EXPECT_EQ(contact.contact_radius(0.99 * residual, {largest}), 0.0);
  }
}

// Requirement: unloading starts with the stiffness of Hertz at the same overlap, 2 E a. Difference
// of step h = 1e-6 e*: error h F''/2 = h F'/(4 e*) and round-off 1e-16/1e-6.
TEST(PlasticContact, UnloadingIsAsStiffAsHertzAtThatOverlap) {
  const double largest = 20 * contact.yield_overlap(), h = 1e-6 * contact.elastic_overlap(largest);
  const double slope =
      (contact.force(largest, {largest}) - contact.force(largest - h, {largest})) / h;
  EXPECT_NEAR(slope / hertz_stiffness(E, R, largest), 1.0, 0.25e-6 + 1e-9);
  EXPECT_GT(slope, 4.0 * kPi * p_y * R); // plastic loading is softer: sqrt(20) times
}

// Requirement: the work of loading is elastic energy and plastic work; the elastic energy is what
// unloading gives back. Both integrals by Simpson with 2000 intervals; kink at yield and root at
// the residual overlap leave h^2 and h^(5/2): 1e-6.
TEST(PlasticContact, WorkIsStoredOrTaken) {
  const double y = contact.yield_overlap(), largest = 30 * y;
  const auto integral = [](double low, double high, auto f) {
    const int n = 2000;
    const double h = (high - low) / n;
    double sum = f(low) + f(high);
    for (int k = 1; k < n; ++k)
      sum += f(low + k * h) * (k % 2 ? 4 : 2);
    return sum * h / 3;
  };
  const double in = integral(0.0, largest, [&](double d) { return contact.loading_force(d); });
  const double out = integral(0.0, largest, [&](double d) { return contact.force(d, {largest}); });
  EXPECT_NEAR(contact.elastic_energy(largest, {largest}) / out, 1.0, 1e-6);
  EXPECT_NEAR(contact.plastic_work(largest) / (in - out), 1.0, 1e-6);
  EXPECT_GT(in, 2 * out); // most of it is taken
}

// Requirement: the force is the slope of the elastic energy on the way back. Central difference of
// step h = 1e-4 e*: 1e-8/8 at x = 1, (1/0.3)^2 of it at x = 0.3; round-off 1e-16/1e-4.
TEST(PlasticContact, ForceIsSlopeOfElasticEnergy) {
  const double largest = 10 * contact.yield_overlap(), e = contact.elastic_overlap(largest);
  for (double back : {0.1, 0.7}) {
    const double d = largest - back * e, h = 1e-4 * e;
    const double slope =
        (contact.elastic_energy(d + h, {largest}) - contact.elastic_energy(d - h, {largest})) /
        (2 * h);
    EXPECT_NEAR(slope / contact.force(d, {largest}), 1.0, 1.4e-8 + 1e-11);
  }
}

// Requirement: plastic work never falls, and a repeated loading to the same overlap takes none.
TEST(PlasticContact, PlasticWorkGrows) {
  double before = 0.0;
  for (double times = 0.0; times < 50.0; times += 0.5) {
    const double work = contact.plastic_work(times * contact.yield_overlap());
    EXPECT_GE(work, before);
    before = work;
  }
}

// Requirement: with hardening, what has yielded beyond d_y carries p_y + h u/R on the area pi R u;
// the overlap under a force is still that of loading. 8 ulp.
TEST(PlasticContact, HardeningRaisesThePressureOfWhatHasYielded) {
  constexpr double h = 1e7;
  const PlasticContact hard(E, R, p_y, h);
  const double y = contact.yield_overlap(), F_y = hertz_force(E, R, y);
  EXPECT_EQ(hard.yield_overlap(), y);
  EXPECT_EQ(hard.force(0.9 * y, {0.0}), contact.force(0.9 * y, {0.0}));
  for (double times : {1.5, 10.0, 60.0}) {
    const double d = times * y, u = d - y;
    EXPECT_NEAR(hard.loading_force(d) / (F_y + kPi * R * u * (p_y + h * u / R)), 1.0, 2e-15);
    EXPECT_NEAR(hard.overlap_under(hard.loading_force(d)) / d, 1.0, 4e-15);
  }
}

// Requirement: hardening 0 is the perfectly plastic law to the bit.
TEST(PlasticContact, NoHardeningChangesNoBit) {
  const PlasticContact none({E, R, R, 1e5}, params(p_y));
  for (double times : {0.5, 3.0, 40.0}) {
    const double d = times * contact.yield_overlap();
    EXPECT_EQ(none.force(0.9 * d, {d}), contact.force(0.9 * d, {d}));
    EXPECT_EQ(none.plastic_work(d), contact.plastic_work(d));
    EXPECT_EQ(none.overlap_under(none.loading_force(d)),
              contact.overlap_under(none.loading_force(d)));
  }
}

// Requirement: with the limit p beyond cohesion a contact that has yielded carries pi R (p + CED d/2R)
// more for each um, though SJKR pulls it together: of spheres of radius 2 R its force grows by
// pi CED (2 R - d/2). Round-off 1e-15/1e-5.
TEST(PlasticContact, TheLimitMayBeBeyondCohesion) {
  constexpr double ced = 1e5, soft = 5e4; // p_y below 2 CED
  for (double part : {0.5, 1.0}) {
    PlasticContact::Params limit = params(soft + (1.0 - part) * 2.0 * ced);
    limit.beyond_cohesion = part;
    const PlasticContact law({E, R, R, ced}, limit);
    const auto carried = [&](double d) {
      return law.loading_force(d) - sjkr_force(ced, 4 * R - d, 2 * R, 2 * R);
    };
    const double d = 1e-3 * R, h = 1e-2 * d;
    ASSERT_GT(d - h, law.yield_overlap());
    EXPECT_NEAR((carried(d + h) - carried(d - h)) / (2 * h) / (kPi * R), soft + ced * d / (2.0 * R),
                1e-9 * soft);
    EXPECT_GT(carried(d), 0.0);
    EXPECT_EQ(law.yield_overlap(), PlasticContact(E, R, soft + 2.0 * ced).yield_overlap());
    EXPECT_NEAR(PlasticContact::limits({ced, E}, limit).least, (2.5 - 2.0 * part) * ced, 1e-9);
  }
}

// Requirement: up to the hardening allowed, loading stays below Hertz and unloading begins with its
// stiffness, so that less than the overlap comes back.
TEST(PlasticContact, HardeningStaysBelowHertz) {
  const PlasticContact hard(E, R, p_y, PlasticContact::kMostHardening * E);
  for (double d = 1.01 * contact.yield_overlap(); d < R; d *= 1.1) {
    EXPECT_LT(hard.loading_force(d), hertz_force(E, R, d));
    EXPECT_LT(hard.elastic_overlap(d), d);
  }
}

// Requirement: with hardening too the work of loading is stored or taken. As WorkIsStoredOrTaken.
TEST(PlasticContact, WorkOfHardeningIsStoredOrTaken) {
  const PlasticContact hard(E, R, p_y, 1e7);
  const double y = contact.yield_overlap(), largest = 30 * y;
  const double h = (largest - y) / 2000;
  double in = hertz_energy(E, R, y);
  for (int k = 0; k < 2000; k += 2) // Simpson's rule is exact for the parabola
    in += h / 3 *
          (hard.loading_force(y + k * h) + 4 * hard.loading_force(y + (k + 1) * h) +
           hard.loading_force(y + (k + 2) * h));
  EXPECT_NEAR((hard.elastic_energy(largest, {largest}) + hard.plastic_work(largest)) / in, 1.0,
              1e-13);
}

// Requirement: at a wall the area pi R u that has yielded is 1/(1 - (u/R_y)^(3/2)) times as large,
// carries the same pressure, and is the area of the contact. 8 ulp.
TEST(PlasticContact, FlatteningWidensTheAreaThatHasYielded) {
  constexpr double h = 1e7;
  PlasticContact::Params wall = params(p_y);
  wall.hardening = h;
  wall.flattening = 1.0;
  const PlasticContact flat({E, R, R, 0.0}, wall);
  const double y = flat.yield_overlap(), F_y = hertz_force(E, R, y);
  EXPECT_EQ(flat.force(0.9 * y, {0.0}), contact.force(0.9 * y, {0.0}));
  for (double part : {0.03, 0.1, 0.5}) {
    const double d = y + part * (R - y), u = d - y, g = 1.0 / (1.0 - std::pow(part, 1.5));
    EXPECT_NEAR(flat.force(d, {0.0}) / (F_y + kPi * R * g * u * (p_y + h * u / R)), 1.0, 2e-15);
    EXPECT_NEAR(flat.contact_radius(d, {d}) / std::sqrt(R * (y + g * u)), 1.0, 2e-15);
    EXPECT_EQ(flat.stiffness_radius(0.5 * d, {d}), flat.contact_radius(d, {d}));
    EXPECT_NEAR(flat.overlap_under(flat.force(d, {0.0})) / d, 1.0, 4e-15);
    EXPECT_NEAR(flat.radius_under(flat.force(d, {0.0})) / flat.contact_radius(d, {d}), 1.0, 4e-14);
  }
}

// Requirement: pressed from both sides, a soft sphere keeps its volume: in the end it is a disc of
// thickness 2 (R - u) and area pi a^2. With e = 1 - u/R, e/(1 - (1 - e)^1.5) = 2/3 (1 + e/4 + ...),
// so that pi a^2 2 (R - u) is V (1 - 3 e/4 + ...).
TEST(PlasticContact, AFlattenedSphereKeepsItsVolume) {
  const PlasticContact flat(E, R, 1e-4 * p_y, 0.0, 1.0); // d_y/R below 1e-10
  for (double e : {1e-1, 1e-2}) {
    const double d = (1.0 - e) * R, a = flat.contact_radius(d, {d});
    ASSERT_LT(d, flat.locking_overlap());
    EXPECT_NEAR(kPi * a * a * 2.0 * (R - d) / (4.0 / 3.0 * kPi * R * R * R), 1.0 - 0.75 * e, e * e);
  }
}

// Requirement: between two spheres, and with flattening 0, all is as without it, to the bit; a part
// f of it is all of it at the depth f u.
TEST(PlasticContact, FlatteningIsForWalls) {
  const PlasticContact::Params none = params(p_y);
  PlasticContact::Params whole = none;
  whole.flattening = 1.0;
  for (double d : {0.1 * R, 0.5 * R, 1.5 * R})
    for (const PlasticContact &law :
         {PlasticContact({E, R, 2 * R, 0.0}, whole), PlasticContact({E, R, R, 0.0}, none)}) {
      EXPECT_EQ(law.force(d, {0.0}), contact.force(d, {0.0}));
      EXPECT_EQ(law.force(0.9 * d, {d}), contact.force(0.9 * d, {d}));
      EXPECT_EQ(law.plastic_work(d), contact.plastic_work(d));
    }
  const PlasticContact half(E, R, p_y, 0.0, 0.5), full(E, R, p_y, 0.0, 1.0);
  const auto widened = [&](const PlasticContact &law, double u) {
    const double y = law.yield_overlap();
    return (law.force(y + u, {0.0}) - law.force(y, {0.0})) / (kPi * p_y * R * u);
  };
  EXPECT_NEAR(widened(half, 0.6 * R) / widened(full, 0.3 * R), 1.0, 1e-14);
}

// Requirement: a contact never loads more stiffly than it unloads, 2 E a*. Where flattening would
// make it do so it stops yielding: force, slope and energy go on as on the way back, up to any
// depth, and back on the same way. Slopes over steps of 1e-6 R: 1e-5, and 1e-4 where loading is about
// to diverge.
TEST(PlasticContact, AFlattenedContactLocks) {
  for (double p : {1e6, 5e6, 2e7, 5e7})
    for (double h : {0.0, 1e7}) {
      const PlasticContact flat(E, R, p, h, 1.0);
      const double lock = flat.locking_overlap(), step = 1e-6 * R, F = flat.force(lock, {0.0});
      const auto slope = [&](double d) {
        return (flat.force(d + step, {0.0}) - flat.force(d, {0.0})) / step;
      };
      ASSERT_GT(lock, flat.yield_overlap());
      ASSERT_LT(lock, R);
      const double stiffness = 2.0 * E * flat.contact_radius(lock, {lock});
      EXPECT_NEAR(slope(lock - 2 * step) / stiffness, 1.0, 1e-4) << p;
      EXPECT_NEAR(slope(lock + step) / stiffness, 1.0, 1e-5) << p;
      for (double part : {0.02, 0.5, 0.95}) {
        const double d = flat.yield_overlap() + part * (lock - flat.yield_overlap());
        EXPECT_LT(slope(d), 2.0 * E * flat.contact_radius(d, {d})) << p << " " << part;
      }
      PlasticContact::State memory;
      const double deep = 1.2 * R;
      EXPECT_GT(flat.advance(0.0, deep, 1.0, memory), 0.0);
      EXPECT_EQ(memory.largest, lock);
      EXPECT_EQ(flat.advance(0.0, 1.1 * deep, 1.0, memory), 0.0);
      const double x = 1.0 + (deep - lock) / flat.elastic_overlap(lock);
      EXPECT_NEAR(flat.force(deep, memory) / (F * std::pow(x, 1.5)), 1.0, 1e-14);
      EXPECT_NEAR(flat.overlap_under(flat.force(deep, memory)) / deep, 1.0, 1e-14);
      EXPECT_NEAR(flat.stiffness_radius(deep, memory) / flat.contact_radius(deep, memory), 1.0,
                  1e-15);
      EXPECT_NEAR(flat.elastic_energy(deep, memory) /
                      (flat.elastic_energy(lock, {lock}) * std::pow(x, 2.5)),
                  1.0, 1e-14);
      EXPECT_EQ(flat.plastic_work(deep), flat.plastic_work(lock));
    }
}

// Requirement: with flattening too the work of loading is stored or taken, and what is taken never
// falls. Simpson in s = sqrt(u), in which force ds is smooth: 1e-9.
TEST(PlasticContact, WorkOfFlatteningIsStoredOrTaken) {
  for (double h : {0.0, 1e7}) {
    const PlasticContact flat(E, R, p_y, h, 1.0);
    const double y = flat.yield_overlap();
    double before = 0.0;
    for (double part : {0.01, 0.3, 0.9, 1.0}) {
      const double end = std::sqrt(part * (flat.locking_overlap() - y)), step = end / 4000;
      const auto f = [&](double s) { return 2.0 * s * flat.loading_force(y + s * s); };
      double in = f(0.0) + f(end);
      for (int k = 1; k < 4000; ++k)
        in += f(k * step) * (k % 2 ? 4 : 2);
      in = in * step / 3 + hertz_energy(E, R, y);
      const double d = y + end * end;
      EXPECT_NEAR((flat.elastic_energy(d, {d}) + flat.plastic_work(d)) / in, 1.0, 1e-9);
      EXPECT_GT(flat.plastic_work(d), before);
      before = flat.plastic_work(d);
    }
  }
}
