// SPDX-License-Identifier: GPL-2.0-or-later
// Makes the packings and runs of a study as independent jobs; what is there already is not made
// again, so that a study that was stopped goes on where it was. A table of what they gave.
#ifndef CALENDEM_SIMULATE_STUDY_H
#define CALENDEM_SIMULATE_STUDY_H

#include "base/provenance.h"
#include "simulate/study_file.h"

namespace calendem {

/// What of a run is made; tasks of a job array make one step each.
enum class StudyStep { All, Packing, Run };

/// The runs as job arrays of Slurm.
struct SlurmOptions {
  bool on = false;
  bool dry_run = false; ///< write the scripts, submit nothing
  std::string sbatch;   ///< options of sbatch, as on its command line
  int every_s = 15;     ///< between looks at the queue [s]
};

struct StudyOptions {
  std::string verb, file; ///< that make the same study again: "study" or "bank" and its file
  std::vector<std::string> further; ///< options that the verb needs for it
  std::string folder;
  std::string liggghts;
  std::string calendem = program_beside("calendem"); ///< makes each packing and run
  int jobs = 0;  ///< runs at a time; 0: one, in Slurm's queue as many as it lets run
  int ranks = 1; ///< MPI ranks of each
  int only = 0;  ///< number of the one run to make; 0: all
  StudyStep step = StudyStep::All;
  bool table = false; ///< make nothing: only the table of what there is
  SlurmOptions slurm;
};

/// Where a run and its packing lie, and whether its making is over: done, its checks did not hold, or
/// it failed.
struct RunPlace {
  std::string run, packing;
  bool ended = false;
};
/// Places of the runs in their order, as study.csv of the folder has it.
std::vector<RunPlace> places_of(const Study &study, const StudyOptions &options);

/// Writes packings/, runs/, study.csv (after every run) and study.json into the folder; with Slurm
/// also slurm/, the scripts and what its jobs said. Returns the folders of the runs in their order;
/// empty where a run is not done or its checks did not hold. Throws Failure: 2 bad input, or Slurm
/// refused the jobs; 3 a run failed (the others were made), 4 checks of a run did not hold.
std::vector<std::string> make_study(const Study &study, const StudyOptions &options);

/// Makes the study and goes on where runs fail, saying that `parts` ("Draws") with such runs are
/// left out; bad input and a stop are thrown.
std::vector<std::string> make_what_runs(const Study &study, const StudyOptions &options,
                                        const std::string &parts);

/// Header of study.csv: number, status, folders, the varied settings, then numbers of summary.json
/// and, for every pressure of the study, displacement, thickness, broken fraction and total
/// porosity at the compression's first crossing. Pressures MPa, lengths um.
std::string study_header(const Study &study);

/// The cells of a finished run's results, each after a comma; empty cells: not known.
std::string results_of(const std::string &folder, const std::vector<double> &pressures);

/// The cells of a run that is not finished.
std::string no_results(const std::vector<double> &pressures);

} // namespace calendem

#endif
