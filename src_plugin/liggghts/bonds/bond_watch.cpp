// SPDX-License-Identifier: GPL-2.0-or-later
#include "bond_watch.h"
#include "error.h"
#include "fix.h"
#include "mpi_liggghts.h"
#include "neighbor.h"

using namespace LAMMPS_NS;

// A rank counts its own; where the lists are new, or the run is, all see that together they have
// all.
void BondWatch::end_step(const BondPairs &pairs, bool new_lists) {
  if (new_lists) {
    expected_ = 0;
    pairs.for_each_neighbor([&](int i, int j, const BondHistory &bond) {
      expected_ += bond.acts() && pairs.decides(i, j);
    });
  }
  if (missing_ == 0)
    missing_ = expected_ - acting_;
  acting_ = 0;
}

void BondWatch::stop_if_wrong(bigint intact, bigint waiting) {
  double stretch = 0.0;
  MPI_Allreduce(&overstretched_, &stretch, 1, MPI_DOUBLE, MPI_MAX, world);
  if (stretch > 0.0)
    stop_overstretched(stretch);
  const bigint mine[4] = {missing_, expected_, waiting, atom->nlocal};
  bigint all[4];
  MPI_Allreduce(mine, all, 4, MPI_LMP_BIGINT, MPI_SUM, world);
  intact -= all[2];
  if (all[0] != 0)
    stop_lost(intact - all[0], intact, all[3]);
  if (all[1] != intact)
    stop_lost(all[1], intact, all[3]);
  spheres_ = all[3];
}

void BondWatch::stop_overstretched(double stretch) const {
  char message[300];
  snprintf(
      message, sizeof message,
      "an intact bond is stretched to %.4f times the sum of radii; beyond %.2f its history would "
      "be lost. The time step is too large or the bonds are unbreakable or too strong",
      stretch, kContactDistanceFactor);
  error->fix_error(FLERR, owner_, message);
}

// Beyond the range of histories the host calls no contact model: a bond stretched from within that
// range to beyond it in one step, or one whose history is gone, just does not act any more.
void BondWatch::stop_lost(bigint acting, bigint intact, bigint spheres) const {
  char message[100];
  snprintf(message, sizeof message,
           BIGINT_FORMAT " of " BIGINT_FORMAT " intact bonds acted in a step. ", acting, intact);
  error->fix_error(FLERR, owner_, (message + why_lost(spheres)).c_str());
}

std::string BondWatch::why_lost(bigint spheres) const {
  char reason[500];
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
        "where its history is lost: the time step is too large. Or a command between two runs, "
        "such as displace_atoms or replicate, parted bonded spheres. Or the host lost histories: "
        "leave 'one' and 'page' of neigh_modify as they are",
        kContactDistanceFactor);
  return reason;
}
