// SPDX-License-Identifier: GPL-2.0-or-later
#include "compute_calendering.h"
#include "error.h"
#include "fix_bond_bpm.h"
#include "fix_wall_gran_platen.h"
#include "modify.h"
#include "update.h"

using namespace LAMMPS_NS;

ComputeCalendering::ComputeCalendering(LAMMPS *lmp, int &iarg, int narg, char **arg)
    : Compute(lmp, iarg, narg, arg), platen_(NULL), collector_(NULL), bonds_(NULL) {
  if (narg != iarg + 2)
    error->all(FLERR, "compute calendering takes two arguments: 'compute ID all calendering PLATEN "
                      "COLLECTOR', the IDs of two fixes wall/gran/platen");
  platen_id_ = arg[iarg];
  collector_id_ = arg[iarg + 1];
  iarg += 2;
  vector_flag = 1;
  size_vector = 15;
  extvector = 0;
  vector = new double[size_vector]();
}

ComputeCalendering::~ComputeCalendering() { delete[] vector; }

FixWallGranPlaten *ComputeCalendering::wall(const std::string &id) {
  const int n = modify->find_fix(id.c_str());
  FixWallGranPlaten *found = n < 0 ? NULL : dynamic_cast<FixWallGranPlaten *>(modify->fix[n]);
  if (!found) {
    const std::string message = "compute calendering: '" + id + "' is no fix wall/gran/platen";
    error->all(FLERR, message.c_str());
  }
  return found;
}

void ComputeCalendering::init() {
  platen_ = wall(platen_id_);
  collector_ = wall(collector_id_);
  bonds_ = FixBondBpm::find(lmp, "compute calendering");
}

void ComputeCalendering::compute_vector() {
  invoked_vector = update->ntimestep;
  vector[0] = platen_->compute_vector(4);
  vector[1] = collector_->compute_vector(4);
  vector[2] = platen_->mean_position() - collector_->mean_position();
  vector[3] = platen_->mean_displacement();
  for (int n = 0; n < 9; ++n)
    vector[4 + n] = bonds_->compute_vector(n);
  vector[13] = platen_->compute_vector(6);
  vector[14] = collector_->compute_vector(6);
}
