// SPDX-License-Identifier: GPL-2.0-or-later
// How a rank stops the run at once for what it alone has found.
#ifndef CALENDEM_STOP_RUN_H
#define CALENDEM_STOP_RUN_H

#include "comm.h"
#include "error.h"
#include "lammps.h"

namespace LAMMPS_NS {

/// A single rank has a log to say it in; others may wait for this one, and are ended with it.
inline void stop_run(LAMMPS *lmp, const char *file, int line, const char *message) {
  if (lmp->comm->nprocs == 1)
    lmp->error->all(file, line, message);
  lmp->error->one(file, line, message);
}

} // namespace LAMMPS_NS

#endif
