// SPDX-License-Identifier: GPL-2.0-or-later
// The atom types that the host's properties are known of. The host makes their vectors and matrices
// at the set-up of a run, up to the highest type of an atom, a wall or an insertion; the box may
// have more. Whoever goes through types asks here, and an atom of another type stops the run.
#ifndef CALENDEM_KNOWN_TYPES_H
#define CALENDEM_KNOWN_TYPES_H

#include "atom.h"
#include "force.h"
#include "pointers.h"
#include "property_registry.h"
#include "stop_run.h"
#include <cstdio>

namespace LAMMPS_NS {

class KnownTypes : protected Pointers {
public:
  explicit KnownTypes(LAMMPS *lmp) : Pointers(lmp) {}

  /// At every set-up; all ranks must call.
  void find() { highest_ = force->registry.max_type(); }
  int highest() const { return highest_; }

  /// An atom may change its type, or come, between runs that are not set up.
  void check() const {
    for (int i = 0; i < atom->nlocal; ++i)
      if (atom->type[i] > highest_)
        refuse(i);
  }

private:
  int highest_ = 0;

  void refuse(int i) const {
    char message[300];
    snprintf(message, sizeof message,
             "particle %d is of atom type %d, and this run was set up for types 1 to %d. Leave out "
             "'pre no' of its run command, or create the particle before the first run",
             static_cast<int>(atom->tag[i]), atom->type[i], highest_);
    stop_run(lmp, FLERR, message);
  }
};

} // namespace LAMMPS_NS

#endif
