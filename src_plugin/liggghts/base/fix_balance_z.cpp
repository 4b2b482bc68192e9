// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_balance_z.h"
#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "film_cuts.h"
#include "force.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "pair.h"
#include <algorithm>

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {
constexpr int kLayers = 1000;
}

FixBalanceZ::FixBalanceZ(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg), imbalance_(1.0) {
  if (narg != 3)
    error->fix_error(FLERR, this, "takes no arguments: 'fix ID all balance/z'");
  if (domain->triclinic)
    error->fix_error(FLERR, this, "needs a cell with right angles");
  scalar_flag = 1;
  global_freq = 1;
}

int FixBalanceZ::setmask() { return PRE_EXCHANGE; }

double FixBalanceZ::compute_scalar() { return imbalance_; }

// The height is that of the cell as it will be when the faces are set: where it ends at the highest
// particle, that one may have moved.
double FixBalanceZ::height() const {
  if (domain->boundary[2][1] < 2)
    return domain->prd[2];
  double mine = domain->boxlo[2], top = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    mine = std::max(mine, atom->x[i][2]);
  MPI_Allreduce(&mine, &top, 1, MPI_DOUBLE, MPI_MAX, world);
  return top - domain->boxlo[2];
}

// A particle and each pair that its rank keeps count alike; before the first list particles alone.
std::vector<double> FixBalanceZ::work_of_layers() const {
  const Pair *pair = force->pair_match("gran", 0);
  const NeighList *list = pair ? pair->list : NULL;
  const bool listed = list && list->inum == atom->nlocal && neighbor->ncalls > 0;
  std::vector<double> mine(kLayers, 0.0), all(kLayers, 0.0);
  const double low = domain->boxlo[2], per_um = kLayers / height();
  for (int i = 0; i < atom->nlocal; ++i) {
    const int layer = static_cast<int>(per_um * (atom->x[i][2] - low));
    mine[std::min(std::max(layer, 0), kLayers - 1)] += 1.0 + (listed ? list->numneigh[i] : 0);
  }
  MPI_Allreduce(&mine[0], &all[0], kLayers, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

void FixBalanceZ::setup_pre_exchange() { pre_exchange(); }

void FixBalanceZ::pre_exchange() {
  const int slabs = comm->procgrid[2];
  if (slabs == 1)
    return;
  const std::vector<double> work = work_of_layers();
  const std::vector<double> old(comm->zsplit, comm->zsplit + slabs + 1);
  imbalance_ = calendem::busiest_slab(work, old);
  const std::vector<double> cuts = calendem::cuts_of_equal_work(work, old);
  std::copy(cuts.begin(), cuts.end(), comm->zsplit);
  comm->uniform = 0;
  if (domain->box_change)
    return; // the host sets up the ranks' boxes now
  domain->set_local_box();
  comm->setup();
  if (neighbor->style)
    neighbor->setup_bins();
}
