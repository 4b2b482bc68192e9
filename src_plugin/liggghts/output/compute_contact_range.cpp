// SPDX-License-Identifier: GPL-2.0-or-later
#include "compute_contact_range.h"
#include "atom.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_wall_gran_platen.h"
#include "force.h"
#include "memory.h"
#include "modify.h"
#include "physics/hertz_contact.h"
#include "update.h"
#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using calendem::ContactRange;

ComputeContactRange::ComputeContactRange(LAMMPS *lmp, int &iarg, int narg, char **arg)
    : Compute(lmp, iarg, narg, arg), bonds_(NULL), pairs_have_effects_(false),
      phase_(atom->ntypes + 1, -1), phases_(0) {
  for (; iarg < narg; ++iarg) {
    const int type = force->inumeric(FLERR, arg[iarg]);
    if (type < 1 || type > atom->ntypes || phase_[type] >= 0) {
      char message[200];
      snprintf(message, sizeof message,
               "compute contact/range: '%s' must be an atom type from 1 to %d, each once",
               arg[iarg], atom->ntypes);
      error->all(FLERR, message);
    }
    phase_[type] = phases_++;
  }
  array_flag = 1;
  extarray = 0;
  size_array_rows = kPairs + phases_ * (phases_ + 1) / 2;
  size_array_cols = kColumns;
  memory->create(array, size_array_rows, size_array_cols, "contact/range:array");
}

ComputeContactRange::~ComputeContactRange() { memory->destroy(array); }

void ComputeContactRange::init() {
  bonds_ = FixBondBpm::find(lmp, "compute contact/range");
  pairs_have_effects_ = ContactEffects::in_use(lmp);
  effects_.connect(force->registry, "compute contact/range");
  walls_ = FixWallGranPlaten::all(*modify);
}

// Rows of the pairs: those of the first phase, then what the second adds, ...; -1: none.
int ComputeContactRange::row_of(int itype, int jtype) const {
  const int low = std::min(phase_[itype], phase_[jtype]),
            high = std::max(phase_[itype], phase_[jtype]);
  return low < 0 ? -1 : kPairs + low * phases_ - low * (low - 1) / 2 + high - low;
}

void ComputeContactRange::add(int row, const EffectContact &contact, const double *memory) {
  if (contact.overlap <= 0.0)
    return;
  const double force = effects_.force(contact, memory);
  if (force <= 0.0)
    return;
  const double range = effects_.range(contact, memory);
  if (row != kInsideBodies)
    mine_[kAll].add(contact.overlap, contact.radius, force, range);
  if (row >= 0)
    mine_[row].add(contact.overlap, contact.radius, force, range);
}

void ComputeContactRange::add_pairs() {
  const double *radius = atom->radius;
  const int *type = atom->type;
  bonds_->pairs().for_each_touching([&](int i, int j, double r, const BondHistory &bond) {
    add(bond.has_reference() ? int(kInsideBodies) : row_of(type[i], type[j]),
        EffectContact::of_spheres(type[i], type[j], radius[i], radius[j],
                                  bond.contact(r, radius[i] + radius[j]).overlap),
        pairs_have_effects_ ? bond.effect_memory() : NULL);
  });
}

void ComputeContactRange::add_walls() {
  for (FixWallGranPlaten *wall : walls_)
    for (int i = 0; i < atom->nlocal; ++i) {
      add(kWalls,
          EffectContact::at_wall(atom->type[i], wall->atom_type_wall(), atom->radius[i],
                                 wall->contact(i).overlap),
          wall->effect_memory(i));
    }
}

void ComputeContactRange::compute_array() {
  invoked_array = update->ntimestep;
  mine_.assign(size_array_rows, ContactRange());
  add_pairs();
  add_walls();
  for (int row = 0; row < size_array_rows; ++row) {
    ContactRange all;
    MPI_Allreduce(mine_[row].of, all.of, ContactRange::kSums, MPI_DOUBLE, MPI_SUM, world);
    MPI_Allreduce(&mine_[row].largest, &all.largest, 1, MPI_DOUBLE, MPI_MAX, world);
    double *out = array[row];
    out[0] = all.of[ContactRange::kContacts];
    out[1] = all.of[ContactRange::kForce];
    out[2] = all.mean();
    out[3] = all.largest;
    std::copy(all.of + ContactRange::kBeyond, all.of + ContactRange::kSums, out + 4);
  }
}
