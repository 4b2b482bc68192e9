// SPDX-License-Identifier: GPL-2.0-or-later
// What a study's runs gave, one row for each.
#ifndef CALENDEM_STUDY_STUDY_TABLE_H
#define CALENDEM_STUDY_STUDY_TABLE_H

#include "study/study_file.h"

namespace calendem {

/// Where a run's results lie and how it stands.
struct RunState {
  std::string run, packing;           ///< names of their folders: hashes of what they depend on
  std::string status = "not started"; ///< "done", "checks failed", "failed", ...
};

/// study.csv: number, status, folders, the varied settings, then numbers of summary.json and, for
/// every pressure of the study, displacement, thickness, broken fraction and total porosity at the
/// compression's first crossing. Empty cells: not known. Pressures MPa, lengths um.
std::string study_table(const Study &study, const std::vector<RunState> &states,
                        const std::string &folder);

} // namespace calendem

#endif
