// SPDX-License-Identifier: GPL-2.0-or-later
#include "break_log.h"
#include "comm.h"
#include "error.h"
#include "fix.h"
#include "physics/bond_failure.h"
#include <algorithm>
#include <cstdio>

using namespace LAMMPS_NS;
using calendem::BreakMode;

namespace {
const int kEventSize = sizeof(BreakEvent) / sizeof(double);
} // namespace

void BreakLog::open(const std::string &file) {
  if (opened_)
    return;
  opened_ = true;
  file_ = file;
  if (file_.empty())
    return;
  int ok = 1;
  if (comm->me == 0) {
    FILE *fp = fopen(file_.c_str(), "w");
    ok = fp != NULL;
    if (fp) {
      fprintf(fp, "time_us,tag_i,tag_j,body,mode,sigma_MPa,tau_MPa,x_um,y_um,z_um,pressure_MPa\n");
      ok = fclose(fp) == 0;
    }
  }
  MPI_Bcast(&ok, 1, MPI_INT, 0, world);
  if (!ok) {
    const std::string message = "cannot write the event log '" + file_ + "'";
    error->fix_error(FLERR, owner_, message.c_str());
  }
  write(events_);
}

void BreakLog::write(const std::vector<BreakEvent> &events) {
  FILE *fp = comm->me == 0 && !file_.empty() ? fopen(file_.c_str(), "a") : NULL;
  if (comm->me == 0 && !file_.empty() && !fp)
    error->warning(FLERR,
                   "cannot append to the event log of fix bond/bpm; breaks stay in restarts");
  if (!fp)
    return;
  for (const BreakEvent &e : events)
    fprintf(fp, "%.9g,%d,%d,%d,%s,%.6g,%.6g,%.6f,%.6f,%.6f,%.6g\n", e.time,
            static_cast<int>(e.tag_low), static_cast<int>(e.tag_high), static_cast<int>(e.body),
            calendem::name_of(static_cast<BreakMode>(static_cast<int>(e.mode))), 1e-3 * e.sigma,
            1e-3 * e.tau, e.x, e.y, e.z, 1e-3 * e.pressure);
  fclose(fp);
}

bigint BreakLog::waiting() const {
  return std::count_if(mine_.begin(), mine_.end(),
                       [](const BreakEvent &e) { return e.tag_low > 0.0; });
}

void BreakLog::gather() {
  const int nprocs = comm->nprocs;
  std::vector<int> counts(nprocs), starts(nprocs, 0);
  const int mine = kEventSize * static_cast<int>(mine_.size());
  MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (int p = 1; p < nprocs; ++p)
    starts[p] = starts[p - 1] + counts[p - 1];
  std::vector<BreakEvent> all((starts[nprocs - 1] + counts[nprocs - 1]) / kEventSize);
  if (all.empty())
    return;
  MPI_Allgatherv(mine_.data(), mine, MPI_DOUBLE, all.data(), counts.data(), starts.data(),
                 MPI_DOUBLE, world);
  mine_.clear();
  std::sort(all.begin(), all.end());
  for (const BreakEvent &e : all) {
    ++(e.of_bridge() ? totals_.of_bridges : totals_.of_mode)[static_cast<int>(e.mode)];
    (e.of_bridge() ? totals_.bridge_energy : totals_.energy) += e.energy;
  }
  all.erase(
      std::remove_if(all.begin(), all.end(), [](const BreakEvent &e) { return e.of_bridge(); }),
      all.end());
  events_.insert(events_.end(), all.begin(), all.end());
  write(all);
}
