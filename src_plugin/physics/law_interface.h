// SPDX-License-Identifier: GPL-2.0-or-later
// What a normal contact law is: a class with these members. Overlaps, radii and lengths in um,
// forces in nN, energies in fJ, times in us. Stateless: all that lasts is in a contact's State.
//   Params                             struct of its parameters, doubles, 0 unless given
//   State                              struct of its history, doubles, 0 where the surfaces meet
//                                      for the first time; empty: it has none
//   kName, kHeader                     its name, and its file in src_plugin/physics
//   kProperties                        what the script calls the parameters: a LawProperty each;
//                                      the law acts where the first of them is > 0
//   kStiffens                          contacts get stiffer than Hertz' under the same force: the
//                                      time step is checked as they do
//   kTakes                             what its work is in the energy ledger
//   kDeepest                           largest overlap with a wall, of the radius: deeper, the
//                                      host may lose a sphere through it
//   kGrows                             it asks what other contacts have done to the spheres
//   Law(surfaces, params)
//   force(overlap, state)              elastic force, > 0 repulsive
//   elastic_energy(overlap, state)     what it can give back
//   contact_radius(overlap, state)     of the area; 0 if the law has opened it. Damping and the
//                                      tangential stiffness 8 G* a follow from it
//   stiffness_radius(overlap, state)   2 E* times it bounds the stiffness from here on, on the way
//                                      back too: for the time step
//   radius_under(force)                stiffness_radius under a force not borne before
//   advance(before, now, time, state)  brings the state up to the overlap `now`, which `time` ago
//                                      was `before`; returns the work taken for good, >= 0
//                                      with a fifth argument, GrownSurfaces, if it has kGrows
//   range(surfaces)                    overlap over the smaller radius up to which the law has been
//                                      compared with what it stands for
//   limits(phases, params)             ContactLimits of the first parameter, all of them given
// The list of laws/contact_laws.h makes it known.
#ifndef CALENDEM_PHYSICS_LAW_INTERFACE_H
#define CALENDEM_PHYSICS_LAW_INTERFACE_H

#include <limits>

namespace calendem {

/// The two surfaces of a contact.
struct ContactSurfaces {
  double E_eff;          ///< effective modulus [kPa]
  double R_eff;          ///< effective radius [um]
  double radius;         ///< of the smaller sphere [um]
  double cohesion = 0.0; ///< energy density [kPa]
};

/// The surfaces of a contact as they have grown, because soft spheres keep the volume that their
/// contacts displace (kept_volume.h).
struct GrownSurfaces {
  double R_eff;        ///< effective radius of the grown spheres [um]
  double radius;       ///< of the smaller sphere, grown [um]
  double growth = 0.0; ///< of both together [um]
  bool full = false;   ///< one of them has no free surface left
  double depth = 1.0;  ///< of the flat that stands for the contact, over its overlap
};

/// Overlap over the smaller radius at which a flat in place of the contact is `depth` times the
/// radius deep: depth itself at a wall, twice as much for equal spheres.
inline double strain_at(double depth, const ContactSurfaces &s) {
  return depth * s.radius / s.R_eff;
}

/// What a law's advance returns, as a term of the energy ledger.
enum class WorkTaken { Nothing, PlasticFlow, Dashpots };

/// A number that the script gives pairs of atom types (`fix property/global NAME peratomtypepair`,
/// units micro); 0 where it is not set. Where the law acts it is > 0 unless it may be 0.
struct ContactProperty {
  const char *name = ""; ///< the script's
  const char *unit = "";
  double below = std::numeric_limits<double>::infinity();
  bool may_be_zero = false;
  double most_of_modulus = std::numeric_limits<double>::infinity(); ///< the effective one

  constexpr ContactProperty less_than(double limit) const {
    ContactProperty p = *this;
    p.below = limit;
    return p;
  }
  constexpr ContactProperty or_zero() const {
    ContactProperty p = *this;
    p.may_be_zero = true;
    return p;
  }
  constexpr ContactProperty at_most_of_modulus(double part) const {
    ContactProperty p = *this;
    p.most_of_modulus = part;
    return p;
  }
};

/// A property and the parameter that it sets.
template <class Params> struct LawProperty {
  double Params::*parameter;
  ContactProperty property;
};

/// Two phases that meet: cohesion energy density [kPa] and effective modulus [kPa].
struct PhasePair {
  double cohesion, modulus;
};

/// Values that a law's first parameter may have between two phases where it acts, beside its
/// property's own range, and why: with their cohesion and modulus some let a packing collapse.
struct ContactLimits {
  double least = 0.0;
  double most = std::numeric_limits<double>::infinity();
  const char *why = "";
};

} // namespace calendem

#endif
