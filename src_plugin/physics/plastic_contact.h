// SPDX-License-Identifier: GPL-2.0-or-later
// Elastic-plastic normal contact with a limiting contact pressure p_y, and linear hardening h.
//   loading, d = d* <= d_y:  F = 4/3 E sqrt(R) d^(3/2)         (Hertz)
//   loading, d = d* > d_y:   F = F_y + pi R u (p_y + h u/R)
//   below d*:                F = F* x^(3/2), 0 for x < 0
// with
//   d_y = R (pi p_y/(2 E))^2      overlap at yield
//   F_y = 2/3 pi p_y R d_y        force there
//   u   = d - d_y                 overlap beyond it
//   a*  = sqrt(R d*)              contact radius at the largest overlap
//   e*  = 3 F*/(4 E a*)           overlap that comes back
//   x   = 1 - (d* - d)/e*
// d: overlap, d*: the largest one so far [um]; F*: the force there; E, R: effective modulus
// [kPa] and radius [um]; p_y > 0, h >= 0 [kPa]; F in nN, > 0 repulsive.
// The last is Hertz with the larger radius R_p = a*^2/e* from the residual overlap d_p = d* - e*
// on. p_y -> infinity is Hertz; h = 0 is perfectly plastic. The area pi R u that has yielded
// carries p_y + h u/R. Force and slope are continuous in loading; the slope at the start of
// unloading is 2 E a*, that of Hertz at the same overlap: unloading is stiffer than plastic
// loading, and since overlaps grow larger, stiffer than Hertz at the same force.
//
// Range: between spheres a flat 0.4 of the radius deep, at a wall, flattened, 0.3. Between two flats
// the force of a sphere that keeps its volume (ductile_contact.h, kept_volume.h: fitted to finite
// elements while shallow, a disc under its flow stress when deep) with the hardness p_y is that of
//   depth                      0.1   0.2   0.3   0.4   0.5
//   pi R u p_y, by    [%]      -35   -19    -6    +2    +4    spheres
//   with flattening   [%]      -33   -11   +13   +37   +60    walls
// It leaves out that the area is 2 pi R u and more, and that the pressure falls with depth, which
// cancel. Cohesion (below) adds up to 33 % to what a CBD sphere of 0.22 GPa carries beyond it at a
// primary, at a depth of 0.4: no contact in the range is off by more than 35 %. A sphere with contacts
// all round is stiffer: its plastic zones meet, which h can stand for; h <= E/(2 pi), for which
// loading stays below Hertz up to d = R (F' is straight, Hertz' concave, and at R it is
// pi (p_y R + 2 h (R - d_y)) <= 2 E R).
//
// Energy: elastic_energy is given back, plastic_work (of d* alone) is not.
//
// Cohesion. Below SJKR's 2 CED such a contact cannot carry its own cohesion: F ~ pi p_y R d,
// F_C ~ 2 pi CED R d. An indenter, which does not stick, measures what a contact carries beyond:
//   p_y = p + 2 b CED,  p: the pressure that is given,  0 <= b <= 1 (0: p is the whole pressure)
// SJKR's area falls behind 2 pi R d: beyond cohesion a deep contact carries more than p.
//
// Flattening. At a wall the sphere has nowhere to go but aside, and keeps its volume V. Held from
// both sides and flattened by u on each it is a disc of thickness 2 (R - u) in the end, whose area
// V/(2 (R - u)) grows without bound. With the flattening f, 0 to 1, the area that has yielded is
// pi R g u:
//   R_y  = R - d_y
//   g    = 1/(1 - (f u/R_y)^(3/2))
//   F    = F_y + pi R g u (p_y + h u/R)
//   a*^2 = R (d_y + g u)
// For f = 1 the exponent 3/2 is the one with which it tends to that of the disc; f = 0 leaves the
// area as it was. From the depth on at which loading would be stiffer than 2 E a* nothing yields
// any more: d* stays, and x grows beyond 1.
//
// Source: Thornton, J. Appl. Mech. 64 (1997) 383, eqs 8-21; hardening in proportion to the area,
// a^2/R^2, as of Meyer's law p ~ a^(n-2) with n = 4 beyond yield (Tabor, The Hardness of Metals,
// ch. 1: n = 2 to 2.5 for single indents). Deviations: hardening; flattening; d* alone is the
// contact's memory (a*^2 = R d* follows from his R_p F* = R F_e). Verified by
// tests/unit/physics/plastic_contact_test.cpp, tests/verification/plastic_contact.
#ifndef CALENDEM_PHYSICS_PLASTIC_CONTACT_H
#define CALENDEM_PHYSICS_PLASTIC_CONTACT_H

#include "hertz_contact.h"
#include "law_interface.h"
#include "pi.h"

namespace calendem {

class PlasticContact {
public:
  static constexpr double kMostHardening = 0.159; ///< 1/(2 pi), of the effective modulus
  struct Params {
    double yield_pressure = 0.0;  ///< limit of the contact pressure p [kPa], > 0
    double hardening = 0.0;       ///< h [kPa], 0 to kMostHardening of the effective modulus
    double beyond_cohesion = 0.0; ///< b [-], 0 to 1
    double flattening = 0.0;      ///< f [-], 0 to 1; for walls
  };
  struct State {
    double largest = 0.0; ///< overlap so far, d* [um]
  };
  static constexpr const char *kName = "elastic-plastic", *kHeader = "plastic_contact.h";
  static constexpr LawProperty<Params> kProperties[] = {
      {&Params::yield_pressure, {"contactYieldPressure", "kPa"}},
      {&Params::hardening,
       ContactProperty{"contactHardening", "kPa"}.or_zero().at_most_of_modulus(kMostHardening)},
      {&Params::beyond_cohesion, ContactProperty{"contactBeyondCohesion"}.or_zero()},
      {&Params::flattening, ContactProperty{"contactFlattening"}.or_zero()}};
  static constexpr bool kStiffens = true;
  static constexpr WorkTaken kTakes = WorkTaken::PlasticFlow;
  static constexpr double kDeepest = 0.9;
  static constexpr bool kGrows = false;
  static double range(const ContactSurfaces &s) { return strain_at(at_wall(s) ? 0.3 : 0.4, s); }

  /// Effective modulus [kPa], effective radius [um], limiting pressure [kPa]; all > 0. Hardening
  /// [kPa] >= 0. Flattening: 0 to 1.
  PlasticContact(double E_eff, double R_eff, double yield_pressure, double hardening = 0.0,
                 double flattening = 0.0)
      : E_(E_eff), R_(R_eff), slope_(kPi * yield_pressure * R_eff), growth_(kPi * hardening),
        yield_overlap_(slope_ * slope_ / (4.0 * E_eff * E_eff * R_eff)),
        spent_(flattening / (R_eff - yield_overlap_)) {}
  /// There the effective radius is the sphere's.
  static bool at_wall(const ContactSurfaces &s) { return s.R_eff >= s.radius; }
  /// Flattening is for walls.
  PlasticContact(const ContactSurfaces &s, const Params &p)
      : PlasticContact(s.E_eff, s.R_eff, p.yield_pressure + of_cohesion(s.cohesion, p), p.hardening,
                       at_wall(s) ? p.flattening : 0.0) {}

  /// What cohesion adds to the pressure that is given [kPa].
  static double of_cohesion(double energy_density, const Params &p) {
    return 2.0 * p.beyond_cohesion * energy_density;
  }
  /// A contact that yields below 2 CED cannot carry its cohesion.
  static ContactLimits limits(const PhasePair &phases, const Params &p) {
    ContactLimits limits;
    limits.least = 2.5 * phases.cohesion - of_cohesion(phases.cohesion, p);
    limits.why = "contacts that yield below twice the cohesion energy density cannot carry their "
                 "own cohesion, and the packing collapses";
    return limits;
  }

  double yield_overlap() const { return yield_overlap_; }

  /// Force [nN] while the overlap is the largest so far.
  double loading_force(double overlap) const {
    const double u = overlap - yield_overlap_;
    if (u <= 0.0)
      return hertz_force(E_, R_, overlap);
    const double perfect = slope_ * (overlap - yield_overlap_ / 3.0) + growth_ * u * u;
    return spent_ == 0.0 ? perfect : perfect + (spread(u) - 1.0) * u * (slope_ + growth_ * u);
  }

  /// Overlap [um] at which a first loading reaches a force [nN].
  double overlap_under(double force) const {
    const double at_yield = 2.0 / 3.0 * slope_ * yield_overlap_;
    if (force <= at_yield)
      return hertz_overlap(E_, R_, force);
    if (spent_ > 0.0)
      return flattened_under(force);
    const double perfect = force / slope_ + yield_overlap_ / 3.0, u = perfect - yield_overlap_;
    const double root = std::sqrt(1.0 + 4.0 * growth_ * u / slope_);
    return perfect - u * (root - 1.0) / (root + 1.0);
  }

  /// Overlap [um] that comes back between the largest one and loss of contact: e*.
  double elastic_overlap(double largest) const {
    return largest <= yield_overlap_ ? largest
                                     : 0.75 * loading_force(largest) / (E_ * radius_at(largest));
  }

  /// Force [nN] at an overlap with the largest one so far (or the overlap, if that is larger).
  double force(double overlap, const State &s) const {
    const double from = yielded(overlap, s.largest);
    if (overlap == from)
      return loading_force(overlap);
    const double x = still_elastic(overlap, from);
    return loading_force(from) * x * std::sqrt(x);
  }

  /// Radius [um] of the contact's area; the tangent stiffness below d* is 2 E times it.
  double contact_radius(double overlap, const State &s) const {
    const double from = yielded(overlap, s.largest);
    if (overlap == from)
      return radius_at(std::fmax(overlap, 0.0));
    return radius_at(from) * std::sqrt(still_elastic(overlap, from));
  }

  /// Unloading begins with the largest stiffness, that of Hertz at the largest overlap.
  double stiffness_radius(double overlap, const State &s) const {
    const double from = yielded(overlap, s.largest);
    const double radius = radius_at(from);
    return overlap > from ? radius * std::sqrt(still_elastic(overlap, from)) : radius;
  }
  double radius_under(double force) const { return stiffness_radius(overlap_under(force), {}); }

  /// Energy [fJ] that unloading gives back.
  double elastic_energy(double overlap, const State &s) const {
    const double from = std::fmax(yielded(overlap, s.largest), 0.0);
    const double x = overlap == from ? 1.0 : still_elastic(overlap, from);
    return 0.4 * elastic_overlap(from) * loading_force(from) * x * x * std::sqrt(x);
  }

  /// Work [fJ] that plastic flow has taken up to the largest overlap; >= 0.
  double plastic_work(double largest) const {
    const double from = yielded(largest, largest), d = from - yield_overlap_;
    if (d <= 0.0)
      return 0.0;
    const double yielding = spent_ == 0.0 ? d * d * (0.5 * slope_ + growth_ * d / 3.0) : work_of(d);
    const double done =
        hertz_energy(E_, R_, yield_overlap_) + d * loading_force(yield_overlap_) + yielding;
    return done - elastic_energy(from, {from});
  }

  double advance(double, double now, double, State &s) const {
    if (now <= s.largest)
      return 0.0;
    const double before = plastic_work(s.largest);
    s.largest = yielded(now, s.largest);
    return plastic_work(s.largest) - before;
  }

  /// Depth [um] at a wall from which on nothing yields; infinite without flattening.
  double locking_overlap() const {
    if (spent_ == 0.0)
      return HUGE_VAL;
    double low = kShallow / spent_, high = 1.0 / spent_; // yields; does not
    for (double u = 0.5 * (low + high); low < u && u < high; u = 0.5 * (low + high))
      (locks(u) ? high : low) = u;
    return yield_overlap_ + low;
  }

private:
  static constexpr double kShallow = 1e-6; // part of spent_: no contact locks before
  double E_, R_, slope_, growth_, yield_overlap_;
  double spent_; // f/R_y: where u times it is 1, the sphere is a disc without thickness

  double spread(double u) const { // g of the head comment
    const double w = spent_ * u;
    return 1.0 / (1.0 - w * std::sqrt(w));
  }

  double radius_at(double largest) const { // a*
    const double u = largest - yield_overlap_;
    return spent_ == 0.0 || u <= 0.0 ? std::sqrt(R_ * largest)
                                     : std::sqrt(R_ * (yield_overlap_ + u * spread(u)));
  }

  // Loading would be stiffer than 2 E a*. At u = 0 the two are equal.
  bool locks(double u) const {
    if (!(spent_ * u > kShallow))
      return false;
    if (spent_ * u >= 1.0)
      return true;
    const double g = spread(u);
    const double stiffness = g * (slope_ * (1.5 * g - 0.5) + growth_ * u * (1.5 * g + 0.5));
    return stiffness > 2.0 * E_ * radius_at(yield_overlap_ + u);
  }

  // d*
  double yielded(double overlap, double largest) const {
    const double d = overlap >= largest ? overlap : largest;
    return locks(d - yield_overlap_) ? locking_overlap() : d;
  }

  // With w = u spent, A w + B w^2 = 1 - w^(3/2): the left is convex and the right falls, so that
  // Newton's steps from w = 1 fall to the root.
  double flattened_under(double force) const {
    const double lock = locking_overlap(), at_lock = loading_force(lock);
    if (force > at_lock)
      return lock + elastic_overlap(lock) * (std::pow(force / at_lock, 2.0 / 3.0) - 1.0);
    const double beyond = force - 2.0 / 3.0 * slope_ * yield_overlap_;
    const double A = slope_ / (spent_ * beyond), B = growth_ / (spent_ * spent_ * beyond);
    double w = 1.0, before = 2.0;
    while (w < before) {
      before = w;
      const double root = std::sqrt(w);
      w -= (w * (A + B * w + root) - 1.0) / (A + 2.0 * B * w + 1.5 * root);
    }
    return yield_overlap_ + before / spent_;
  }

  // Integral of g u (slope + growth u). With s^2 = w, 2 s^3/(1 - s^3) and 2 s^5/(1 - s^3) over s.
  double work_of(double u) const {
    const double s = std::sqrt(spent_ * u), cube = s * s * s, root3 = std::sqrt(3.0);
    const double turn = std::atan(root3 * s / (2.0 + s)); // atan((2s+1)/root3) - atan(1/root3)
    const double perfect =
        2.0 * (turn / root3 + (std::log1p(s + s * s) - 2.0 * std::log1p(-s)) / 6.0 - s);
    const double hardened = -2.0 / 3.0 * (cube + std::log1p(-cube));
    return (slope_ * perfect + growth_ / spent_ * hardened) / (spent_ * spent_);
  }

  double still_elastic(double overlap, double largest) const { // x of the head comment
    return std::fmax(0.0, 1.0 - (largest - overlap) / elastic_overlap(largest));
  }
};

} // namespace calendem

#endif
