// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all check/timestep/bpm N FRACTION [error yes|no] [pressure P]
// Every N steps (and at set-up) compares the time step with the bound of physics/time_step_bound.h
// and with the Rayleigh time; warns, or stops with `error yes`, when it exceeds FRACTION of the
// smaller. The bound is over all intact bonds and the contacts that there are, damping included; a
// plastic contact is as stiff as its largest area so far makes it (its unloading is not stiffer).
// With `pressure` it is also over the contacts that this pressure [kPa] will make, for a step that
// must last. Global vector: 1 bound [us], 2 time step / bound, 3 smallest Rayleigh time [us], 4
// time step / that.
#ifdef FIX_CLASS

FixStyle(check/timestep/bpm, FixCheckTimestepBpm)

#else
#ifndef LMP_FIX_CHECK_TIMESTEP_BPM_H
#define LMP_FIX_CHECK_TIMESTEP_BPM_H

#include "contact_effects.h"
#include "fix.h"
#include "physics/time_step_bound.h"
#include <vector>

namespace LAMMPS_NS {

class FixCheckTimestepBpm : public Fix {
public:
  FixCheckTimestepBpm(class LAMMPS *, int, char **);
  int setmask();
  void init();
  void setup(int);
  void end_of_step();
  double compute_vector(int);

private:
  double fraction_, bound_, rayleigh_, pressure_;
  double warned_; ///< limit of the last warning; again when it has fallen by a tenth [us]
  ContactEffects effects_;
  bool pairs_have_effects_, stop_;

  struct Sphere {
    calendem::SphereBlock stiffness, damping;
    /// `n` points to this sphere.
    void add(const calendem::BondCoefficients &k, const calendem::BondCoefficients &c,
             const calendem::Vec3 &n, double length) {
      stiffness.add(k, n, length);
      damping.add(c, n, length);
    }
    void add(const Sphere &more) {
      stiffness.add(more.stiffness);
      damping.add(more.damping);
    }
  };
  typedef std::vector<Sphere> Spheres;

  double bond_bound() const;
  double contact_bound(const Spheres &bonds, const Spheres &bridges) const;
  double contact_bound(int i, int other, const Sphere &bonds, const Sphere &bridges) const;
  void add_contacts(Spheres &spheres) const;
  calendem::BondCoefficients stiffness_of(int ti, int tj, double a) const;
  double rayleigh_time() const;
};

} // namespace LAMMPS_NS

#endif
#endif
