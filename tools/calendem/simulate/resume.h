// SPDX-License-Identifier: GPL-2.0-or-later
// The folder of a run before it starts: may it be written, does it hold a run, can that go on, is
// its restart file complete.
#ifndef CALENDEM_SIMULATE_RESUME_H
#define CALENDEM_SIMULATE_RESUME_H

#include "simulate/run.h"
#include <string>

namespace calendem {

/// True if the folder already holds this run, finished. `hash`: of all that it depends on;
/// `electrode`: of electrode.data. Throws Failure(2) if it holds another run,
/// results of others, or an unfinished run and neither --resume nor --force was given; Failure(4) if it holds this run
/// and its checks did not hold.
bool holds_this_run(const RunOptions &options, const Settings &settings, const std::string &hash,
                    const std::string &electrode);

/// True if there is a complete restart file to go on from, which is then running.restart; false if
/// there is none. Throws Failure(2) if all that there are are cut.
bool find_restart(const std::string &folder, long atoms);

/// Removes what an earlier run left, its summary.json excepted.
void clear_old_results(const std::string &folder);

/// A summary.json that says that the run has not ended; replaced when it ends. `wall_clock_s`: of
/// what a resumed run has done before.
void mark_as_running(const std::string &folder, const std::string &hash,
                     const std::string &electrode, double wall_clock_s);

/// The file ends, as the host writes it, with one chunk per rank (count of values, values; every
/// atom's record begins with its own length) and these hold `atoms` atoms in all.
bool restart_is_whole(const std::string &file, long atoms);

} // namespace calendem

#endif
