// SPDX-License-Identifier: GPL-2.0-or-later
// A study under way: which packings and runs it needs, how each stands, and how one is made, here or
// as job arrays of Slurm.
#ifndef CALENDEM_SIMULATE_MAKING_H
#define CALENDEM_SIMULATE_MAKING_H

#include "base/output_folder.h"
#include "simulate/study.h"
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace calendem {

/// Status of a run that ended, but not as it should.
inline constexpr const char *kChecksFailed = "checks failed";

/// Runs count from 0 here, in the order of the study.
class Making {
public:
  /// Both must outlive it. `options.folder` and `options.liggghts` are absolute paths.
  Making(const Study &study, const StudyOptions &options);

  /// Makes the step of the options of this run, unless it is there already.
  void make(int k);
  /// Looks again how the runs stand that are not done, this one left out.
  void refresh(int but = -1);
  /// A run that other programs were to make and that they did not make, with what is known of it.
  void lost(int k, const std::string &why);
  void write_table();

  std::vector<int> runs_to_make() const;
  /// The first run of each packing that is not there and that a run needs.
  std::vector<int> packings_to_make() const;
  int count(const std::string &status) const;
  bool packed(int k) const;
  bool ended(int k) const; ///< done, or its checks did not hold
  std::string failures() const;
  std::string log_of(int k) const; ///< of its packing as long as that is not there
  std::vector<std::string> finished() const;
  nlohmann::json description() const;

private:
  /// Where a run's results lie and how it stands.
  struct RunState {
    std::string run, packing;           ///< names of their folders: hashes of what they depend on
    std::string status = "not started"; ///< "done", "checks failed", "failed", ...
    std::string results;                ///< cells of the table
    std::string why;                    ///< what is known of a failure
  };
  const Study &study_;
  const StudyOptions &o_;
  std::vector<RunState> states_;
  std::mutex guard_;
  std::map<std::string, std::string> not_packed_; ///< why, by folder: other runs do not try again

  std::string run_folder(const RunState &s) const;
  std::string packing_folder(const RunState &s) const;
  std::string status_of(const RunState &s) const;
  std::string results(const RunState &s) const;
  void set_status(int k, const std::string &status);
  void report(int k, const std::string &what);
  std::vector<std::string> command(const char *verb, const std::string &spec,
                                   const std::string &folder) const;
  std::string pack(int k);
  std::string run(int k);
  std::string measure(int k);
  void keep_tables(int k) const;
};

// Slurm's commands: job arrays and how their tasks stand. https://slurm.schedmd.com/job_array.html

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
