// SPDX-License-Identifier: GPL-2.0-or-later
// fix bond/bpm: what must hold in every step, and the messages when it does not.
#include "atom.h"
#include "bpm_pair_loop.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "mpi_liggghts.h"
#include "neighbor.h"
#include "update.h"

using namespace LAMMPS_NS;

// Every intact bond must act in every step. A rank counts its own; where the lists are new, or the
// run is, all see that together they have all.
void FixBondBpm::check_acting(bool new_lists) {
  if (new_lists) {
    expected_ = 0;
    for_each_neighbor([this](int i, int j, const BondHistory &bond) {
      expected_ += bond.acts() && decides(i, j);
    });
  }
  if (missing_ == 0)
    missing_ = expected_ - acting_;
  acting_ = 0;
}

// What one rank has found wrong stops all of them, where they meet.
void FixBondBpm::stop_if_wrong() {
  double stretch = 0.0;
  MPI_Allreduce(&overstretched_, &stretch, 1, MPI_DOUBLE, MPI_MAX, world);
  if (stretch > 0.0)
    stop_overstretched(stretch);
  bigint mine[4] = {missing_, expected_, 0, atom->nlocal}, all[4];
  for (const BreakEvent &e : mine_)
    mine[2] += e.tag_low > 0.0;
  MPI_Allreduce(mine, all, 4, MPI_LMP_BIGINT, MPI_SUM, world);
  const bigint intact = acting_pairs() - all[2];
  if (all[0] != 0)
    stop_lost(intact - all[0], intact, all[3]);
  if (all[1] != intact)
    stop_lost(all[1], intact, all[3]);
  spheres_ = all[3];
}

// By this rank at once: the forces of this step are wrong.
void FixBondBpm::stop_if_overflowed() {
  if (overflowed_ > 0)
    loop_->stop_overflow(overflowed_);
}

void FixBondBpm::stop_overstretched(double stretch) {
  char message[300];
  snprintf(
      message, sizeof message,
      "an intact bond is stretched to %.4f times the sum of radii; beyond %.2f its history would "
      "be lost. The time step is too large or the bonds are unbreakable or too strong",
      stretch, kContactDistanceFactor);
  error->fix_error(FLERR, this, message);
}

// Beyond the range of histories the host calls no contact model: a bond stretched from within that
// range to beyond it in one step, or one whose history is gone, just does not act any more.
void FixBondBpm::stop_lost(bigint acting, bigint intact, bigint spheres) {
  char message[100];
  snprintf(message, sizeof message,
           BIGINT_FORMAT " of " BIGINT_FORMAT " intact bonds acted in a step. ", acting, intact);
  error->fix_error(FLERR, this, (message + why_lost(spheres)).c_str());
}

std::string FixBondBpm::why_lost(bigint spheres) const {
  char reason[400];
  if (spheres < spheres_)
    snprintf(reason, sizeof reason,
             BIGINT_FORMAT
             " spheres are gone since all of them did, and bonds with them: deleted, or lost at a "
             "face of the box that is not periodic. Keep bonded spheres inside, and delete a body "
             "only when its bonds have broken",
             spheres_ - spheres);
  else if (neighbor->exclude_setting())
    snprintf(reason, sizeof reason,
             "'neigh_modify exclude' leaves pairs out of the lists, and with them their bonds: "
             "exclude no pair that is bonded");
  else
    snprintf(
        reason, sizeof reason,
        "Either a bond was stretched within one step to more than %.2f times the sum of radii, "
        "where its history is lost: the time step is too large. Or the host lost histories: "
        "leave 'one' and 'page' of neigh_modify as they are",
        kContactDistanceFactor);
  return reason;
}

// A minimizer follows an energy, and the host's contacts have none; each of its iterations would
// advance histories like a time step.
void FixBondBpm::refuse_minimizer() {
  if (update->whichflag == 2)
    error->fix_error(
        FLERR, this,
        "'minimize' does not know the energy of contacts and bonds. To let spheres come "
        "to rest, 'run' with fix viscous or nve/limit, or with 'damping' of the bonds");
}
