// SPDX-License-Identifier: GPL-2.0-or-later
// Makes the packings and runs of a study as independent jobs; what is there already is not made
// again, so that a study that was stopped goes on where it was.
#ifndef CALENDEM_STUDY_STUDY_H
#define CALENDEM_STUDY_STUDY_H

#include "study/study_file.h"

namespace calendem {

struct StudyOptions {
  std::string folder;
  std::string liggghts;
  int jobs = 1;       ///< runs at a time
  int ranks = 1;      ///< MPI ranks of each
  int only = 0;       ///< number of the one run to make; 0: all
  bool table = false; ///< make nothing: only the table of what there is
};

/// Writes packings/, runs/, study.csv (after every run) and study.json into the folder. Throws
/// Failure: 2 bad input, 3 a run failed (the others were made), 4 checks of a run did not hold.
void make_study(const Study &study, StudyOptions options);

/// Folders of the runs in their order; empty where a run is not done or its checks did not hold.
std::vector<std::string> finished_runs(const Study &study, StudyOptions options);

} // namespace calendem

#endif
