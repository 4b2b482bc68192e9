// SPDX-License-Identifier: GPL-2.0-or-later
// A study as two job arrays of Slurm: its packings, then its runs.
#ifndef CALENDEM_SIMULATE_BY_SLURM_H
#define CALENDEM_SIMULATE_BY_SLURM_H

#include "simulate/making.h"

namespace calendem {

/// Submits what is neither made nor in the queue, and waits for it. A task makes one step of one
/// run, so that no two make the same packing; a run that ended without a result is lost to
/// `making`. Stopped, it leaves the queue as it is. Throws Failure: 2 Slurm is not there or
/// refuses, 3 stopped on request.
void make_by_slurm(Making &making, const Study &study, const StudyOptions &options);

} // namespace calendem

#endif
