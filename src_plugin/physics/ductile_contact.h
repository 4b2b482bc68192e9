// SPDX-License-Identifier: GPL-2.0-or-later
// Normal contact of a ductile sphere that keeps its volume, up to full density.
//   elastic            F = 4/3 E sqrt(R_p) e^(3/2),  e = d - d_p,  a^2 = R_p e
//   at most, not full  F <= pi a_y^2 p
//     a_y^2 = R_s'^2 x (2 - x) - R d_y, at first at least a^2;  x = R' (d + g)/R_s'^2
//     p = H (0.364 + 0.636 exp(-4.4 x)) + b CED,  d_y = R (3 pi (H + b CED)/(4 E))^2
//   full               nothing yields once it has begun to (d > d_y), and beyond its overlap d_f then the bulk answers:
//     F = F(d_f) + k (d - d_f),  k = 6 pi K c R_s^3 t/r^2, at least 2 E a(d_f)
//     r = R_s - c d_f, at least 0.69 R_s,  t = 1 - q/4 - sqrt(2 q + q^2/4)/2,  q = (r/R_s)^3
// d: overlap [um]; E, K: effective and bulk modulus, H: hardness, CED: cohesion energy density [kPa];
// R, R_s: effective radius and that of the smaller sphere, R', R_s': as grown by g in all, because
// the spheres keep their volume (kept_volume.h) [um]; b: the part of the pressure of cohesion, CED
// on an area of 2 pi R d, by which an indenter that does not stick measures the hardness too low; F
// in nN, > 0 repulsive.
// a_y is the radius at which a flat cuts the grown sphere, p what a contact of this depth can bear: H
// while it is shallow, the flow stress of the sphere, 0.364 H, when it is deep. A contact that would
// bear more becomes a dent of depth d_p with a = a_y and the larger radius R_p, its memory with d_f.
// A first loading is Hertz up to 2.6 d_y (where it meets pi a_y^2 p of a shallow contact); d_y itself
// is where its mean pressure is H + b CED.
// Bulk: a full sphere of volume V is cones to its contacts, of areas 3 V t/(2 r) as if all were like
// this one (t from kept_volume.h); each moves in by u = c d, so that dp = 3 K du/r. c: flat_depth. The least r is that of four such contacts: a deeper one
// of a full sphere is not like the others.
// Range: x up to 0.5, a flat halfway to the centre; growth up to half the radius; kRange. The stress
// that a crowded surface adds before it is full is left out. Energy: elastic_energy is given back;
// advance returns what yielding takes, by trapezoids.
// Source: Zunker and Kamrin, J. Mech. Phys. Solids 183 (2024) 105492, 105493 (MDR), as in LAMMPS'
// `normal mdr`: a_y, p = Y (1 + 1.75 exp(-4.4 x)) with H = 2.75 Y, growth and bulk. Deviations:
// Hertz instead of an ellipse for the elastic part; the bulk begins when a sphere is full instead of
// at half of its surface; cohesion is SJKR's. Verified by
// tests/unit/physics/ductile_contact_test.cpp, tests/verification/ductile_contact.
#ifndef CALENDEM_PHYSICS_DUCTILE_CONTACT_H
#define CALENDEM_PHYSICS_DUCTILE_CONTACT_H

#include "hertz_contact.h"
#include "law_interface.h"
#include "pi.h"

namespace calendem {

class DuctileContact {
public:
  static constexpr double kFlow = 1.0 / 2.75; ///< flow stress over hardness
  struct Params {
    double hardness = 0.0;        ///< H [kPa], > 0
    double bulk_modulus = 0.0;    ///< K [kPa], > 0
    double beyond_cohesion = 0.0; ///< b [-], 0 to 1
  };
  struct State {
    double dent = 0.0;   ///< d_p [um]
    double radius = 0.0; ///< R_p [um]; 0: R, nothing has yielded
    double full = 0.0;   ///< d_f [um]; 0: not full
    double bulk = 0.0;   ///< k [nN/um]
  };
  static constexpr const char *kName = "ductile", *kHeader = "ductile_contact.h";
  static constexpr LawProperty<Params> kProperties[] = {
      {&Params::hardness, {"contactHardness", "kPa"}},
      {&Params::bulk_modulus, {"contactFullModulus", "kPa"}},
      {&Params::beyond_cohesion, ContactProperty{"contactHardnessBeyondCohesion"}.or_zero()}};
  static constexpr bool kStiffens = true;
  static constexpr WorkTaken kTakes = WorkTaken::PlasticFlow;
  static constexpr double kDeepest = 0.9;
  static constexpr bool kGrows = true;
  static double range(const ContactSurfaces &s) { return strain_at(0.5, s); }

  DuctileContact(const ContactSurfaces &s, const Params &p)
      : E_(s.E_eff), R_(s.R_eff), R_s_(s.radius), H_(p.hardness),
        cohesion_(p.beyond_cohesion * s.cohesion), K_(p.bulk_modulus),
        yields_at_(0.75 * kPi * (H_ + cohesion_) / E_) {}

  /// The force grows with the overlap, and by more than cohesion does.
  static ContactLimits limits(const PhasePair &phases, const Params &p) {
    ContactLimits limits;
    limits.least = std::fmax(kLeast, kPerCohesion * (1.0 - p.beyond_cohesion)) * phases.cohesion;
    limits.why = "contacts that yield at less cannot carry their own cohesion, and the packing "
                 "collapses";
    return limits;
  }

  double yield_overlap() const { return R_ * yields_at_ * yields_at_; } ///< d_y [um]

  /// p [kPa] at a depth x of the head comment.
  double pressure(double x) const {
    return H_ * (kFlow + (1.0 - kFlow) * std::exp(-4.4 * x)) + cohesion_;
  }

  double force(double overlap, const State &s) const {
    const double e = elastic(overlap, s), beyond = bulk(overlap, s);
    const double hertz = hertz_force(E_, radius_of(s), e - beyond);
    return beyond > 0.0 ? hertz + s.bulk * beyond : hertz;
  }

  double elastic_energy(double overlap, const State &s) const {
    const double e = elastic(overlap, s), beyond = bulk(overlap, s);
    double energy = hertz_energy(E_, radius_of(s), e - beyond);
    if (beyond > 0.0)
      energy += beyond * (hertz_force(E_, radius_of(s), e - beyond) + 0.5 * s.bulk * beyond);
    return energy;
  }

  double contact_radius(double overlap, const State &s) const {
    return std::sqrt(radius_of(s) * (elastic(overlap, s) - bulk(overlap, s)));
  }

  /// The contact as it yielded, or the bulk if the sphere is full here or now.
  double stiffness_radius(double overlap, const State &s) const {
    const double R_p = radius_of(s);
    const double e = std::fmax(elastic(overlap, s), R_p * yields_at_ * yields_at_);
    const double bulk =
        s.full > 0.0 ? s.bulk : of_cones(most_depth() * std::fmax(overlap, 0.0), most_depth());
    return std::fmax(std::sqrt(R_p * e), 0.5 * bulk / E_);
  }
  /// Yielding at the flow stress has the largest area, a full sphere the stiffest contact.
  double radius_under(double force) const {
    const double e = hertz_overlap(E_, R_, force), flow = kFlow * H_ + cohesion_;
    const double a = e > yield_overlap() ? std::sqrt(force / (kPi * flow)) : std::sqrt(R_ * e);
    return std::fmax(a, 0.5 * of_cones(kMostDepth * R_s_, most_depth()) / E_);
  }

  double advance(double before, double now, double, State &s, const GrownSurfaces &grown) const {
    const State was = s;
    const bool freed = was.full > 0.0 && !grown.full;
    if (freed)
      s.full = s.bulk = 0.0;
    const double most = freed ? force(now, was) : HUGE_VAL;
    const bool yields = s.full == 0.0 && now > 0.0 && yield(now, grown, most, s);
    if (grown.full && s.full == 0.0 && now > (s.radius > 0.0 ? s.dent : yield_overlap()))
      fill(now, grown, s);
    if (!yields && s.full == was.full)
      return 0.0;
    const double from = std::fmax(before, 0.0);
    const double work = 0.5 * (force(from, was) + force(now, s)) * (now - from);
    return std::fmax(0.0, elastic_energy(from, was) + work - elastic_energy(now, s));
  }

private:
  static constexpr double kMostDepth = 0.31;  // u/R_s of a sphere that four flats fill
  static constexpr double kLeast = 0.1;       // overlaps at rest stay below a fifth of R
  static constexpr double kPerCohesion = 4.5; // 1.25 over 0.278, the least slope of x p(x)/H
  double E_, R_, R_s_, H_, cohesion_, K_;
  double yields_at_; // a/R_p of a contact whose mean pressure is H + b CED

  double radius_of(const State &s) const { return s.radius > 0.0 ? s.radius : R_; }
  static double elastic(double overlap, const State &s) { return std::fmax(overlap - s.dent, 0.0); }

  double bulk(double overlap, const State &s) const { // d - d_f
    return s.full > 0.0 ? std::fmax(overlap - s.full, 0.0) : 0.0;
  }
  double most_depth() const { return std::sqrt(R_ / R_s_); } // c beside a rigid sphere
  double of_cones(double u, double c) const {                // k of a contact of depth u
    const double r = R_s_ - std::fmin(u, kMostDepth * R_s_), q = r * r * r / (R_s_ * R_s_ * R_s_);
    const double t = 1.0 - 0.25 * q - 0.5 * std::sqrt(2.0 * q + 0.25 * q * q);
    return 6.0 * kPi * K_ * c * R_s_ * R_s_ * R_s_ * t / (r * r);
  }

  void fill(double now, const GrownSurfaces &grown, State &s) const {
    s.full = now;
    s.bulk = std::fmax(of_cones(grown.depth * now, grown.depth),
                       2.0 * E_ * std::sqrt(radius_of(s) * elastic(now, s)));
  }

  /// Leaves a dent where the contact would bear more than the law allows, and than `bears`.
  bool yield(double now, const GrownSurfaces &grown, double bears, State &s) const {
    const double R_p = radius_of(s), e = elastic(now, s);
    const double x =
        std::fmin(grown.R_eff * (now + grown.growth) / (grown.radius * grown.radius), 1.0);
    const double cut = grown.radius * grown.radius * x * (2.0 - x) - R_ * yield_overlap();
    const double a2_y = std::fmax(cut, s.radius > 0.0 ? 0.0 : R_ * e);
    const double most = std::fmin(kPi * a2_y * pressure(x), bears);
    if (hertz_force(E_, R_p, e) <= most || most <= 0.0)
      return false;
    const double left = 0.75 * most / (E_ * std::sqrt(a2_y));
    s = {now - left, a2_y / left, 0.0, 0.0};
    return true;
  }
};

} // namespace calendem

#endif
