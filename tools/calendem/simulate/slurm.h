// SPDX-License-Identifier: GPL-2.0-or-later
// Slurm's commands: job arrays and how their tasks stand. https://slurm.schedmd.com/job_array.html
#ifndef CALENDEM_SIMULATE_SLURM_H
#define CALENDEM_SIMULATE_SLURM_H

#include "simulate/making.h"
#include <map>
#include <string>
#include <vector>

namespace calendem {

struct SlurmArray {
  std::string name;                 ///< of the job: one array at a time has it
  std::string folder;               ///< of the script and of what the tasks print
  std::string file;                 ///< name of the script; "runs": runs.sh, runs.7.log
  std::string purpose;              ///< what its tasks do, for the reader of the script
  std::vector<std::string> command; ///< of a task; the number of the task follows
  std::vector<int> tasks;           ///< their numbers, increasing
  int at_once = 0;                  ///< tasks at a time; 0: no limit
  int ranks = 1;                    ///< processes of each
  std::string options;              ///< of sbatch, as on its command line
};

struct SlurmTask {
  long job = 0;      ///< of the array
  std::string state; ///< PENDING, RUNNING, TIMEOUT, ...; UNKNOWN: ended
  std::string reason;
  bool live() const; ///< waits or runs: it will still do something
};

/// "1-3,7": ascending numbers as sbatch --array takes them.
std::string ranges_of(const std::vector<int> &numbers);

std::string array_script(const SlurmArray &array);

/// Submits the array's script; it waits for the end of the jobs `after`. Returns its job. Throws
/// Failure(2) with sbatch's own words.
long submit_array(const SlurmArray &array, const std::vector<long> &after);

/// Throws Failure(2) where there is no sbatch. `scratch` here and below: a folder for what Slurm's
/// commands print.
void check_slurm(const std::string &scratch);

/// The newest task of each number of the user's arrays of that name, ended ones as long as Slurm
/// remembers them (MinJobAge). Throws Failure(2) with
/// squeue's own words.
std::map<int, SlurmTask> tasks_of(const std::string &name, const std::string &scratch);

/// How a task ended that squeue no longer knows, from the accounts; empty where there are none.
std::string state_in_accounts(long job, int task, const std::string &scratch);

// A study as two job arrays of Slurm: its packings, then its runs.

/// Submits what is neither made nor in the queue, and waits for it. A task makes one step of one
/// run, so that no two make the same packing; a run that ended without a result is lost to
/// `making`. Stopped, it leaves the queue as it is. Throws Failure: 2 Slurm is not there or
/// refuses, 3 stopped on request.
void make_by_slurm(Making &making, const Study &study, const StudyOptions &options);

} // namespace calendem

#endif
