// SPDX-License-Identifier: GPL-2.0-or-later
// fix ID all cbd/growth type T every N
//
// Spheres of atom type T keep the volume that their contacts displace (physics/kept_volume.h): every
// N steps (default 50), after the step, the growth of their surfaces is found from the overlaps that
// act with spheres and with fixes wall/gran/platen. Contacts whose law asks for it
// (physics/ductile_contact.h) yield at an area of the grown spheres, and no more when a sphere is
// full. The radii of the spheres stay. A pair of two such spheres shares what it displaces; any
// other sphere is rigid beside them. Needs fix bond/bpm (for its lists). Kept in the host's fix
// property/atom cbd_growth, with restarts. Global vector: 1 mean growth over the radius, 2 largest,
// 3 part of the spheres that is full.
#ifdef FIX_CLASS

FixStyle(cbd/growth, FixCbdGrowth)

#else
#ifndef LMP_FIX_CBD_GROWTH_H
#define LMP_FIX_CBD_GROWTH_H

#include "contact_effects.h"
#include "fix.h"
#include "physics/fixed_point.h"
#include "physics/kept_volume.h"
#include <vector>

namespace LAMMPS_NS {

class FixCbdGrowth : public Fix {
public:
  FixCbdGrowth(class LAMMPS *, int, char **);
  void post_create();
  void pre_delete(bool unfixflag);
  int setmask();
  void init();
  void setup_pre_force(int);
  void pre_force(int);
  void end_of_step();
  double compute_vector(int);

private:
  struct Caps {
    calendem::WideSum volume, area;
  };
  int type_;
  class FixPropertyAtom *growth_;
  class FixBondBpm *bonds_;
  std::vector<class FixWallGranPlaten *> walls_;

  bool is_mine(int i) const;
  calendem::KeptVolume of(int i) const;
  void add(std::vector<Caps> &caps, int i, double overlap, double R_eff, int soft_spheres) const;
  void add_pairs(std::vector<Caps> &caps) const;
  void add_walls(std::vector<Caps> &caps) const;
};

} // namespace LAMMPS_NS

#endif
#endif
