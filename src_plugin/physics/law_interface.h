// SPDX-License-Identifier: GPL-2.0-or-later
// What a normal contact law is: a class with these members, m being its history values (as many
// arguments as kMemory says; 0 where the surfaces meet for the first time). Overlaps, radii and
// lengths in um, forces in nN, energies in fJ, times in us.
//   kMemory                              number of history values
//   Law(surfaces, values)                values of its properties, in the order of its row
//   force(overlap, m...)                 elastic force, > 0 repulsive
//   elastic_energy(overlap, m...)        what it can give back
//   contact_radius(overlap, m...)        of the area; 0 if the law has opened it. Damping and the
//                                        tangential stiffness 8 G* a follow from it
//   stiffness_radius(overlap, m...)      2 E* times it bounds the stiffness from here on, on the
//                                        way back too: for the time step
//   radius_under(force)                  stiffness_radius under a force not borne before
//   advance(before, now, time, m...)     brings m up to the overlap `now`, which `time` ago was
//                                        `before`; returns the work taken for good, >= 0
// A row of registry/contact_law.h makes it known. Stateless: all that lasts is in m.
#ifndef CALENDEM_PHYSICS_LAW_INTERFACE_H
#define CALENDEM_PHYSICS_LAW_INTERFACE_H

namespace calendem {

/// The two surfaces of a contact.
struct ContactSurfaces {
  double E_eff;          ///< effective modulus [kPa]
  double R_eff;          ///< effective radius [um]
  double radius;         ///< of the smaller sphere [um]
  double cohesion = 0.0; ///< energy density [kPa]
};

/// What a law's advance returns, as a term of the energy ledger.
enum class WorkTaken { Nothing, PlasticFlow, Dashpots };

} // namespace calendem

#endif
