// SPDX-License-Identifier: GPL-2.0-or-later
// What a study's runs gave, one row for each.
#ifndef CALENDEM_SIMULATE_STUDY_TABLE_H
#define CALENDEM_SIMULATE_STUDY_TABLE_H

#include "simulate/study_file.h"

namespace calendem {

/// Header of study.csv: number, status, folders, the varied settings, then numbers of summary.json
/// and, for every pressure of the study, displacement, thickness, broken fraction and total
/// porosity at the compression's first crossing. Pressures MPa, lengths um.
std::string study_header(const Study &study);

/// The cells of a finished run's results, each after a comma; empty cells: not known.
std::string results_of(const std::string &folder, const std::vector<double> &pressures);

/// The same for a run that is not finished.
std::string no_results(const std::vector<double> &pressures);

} // namespace calendem

#endif
