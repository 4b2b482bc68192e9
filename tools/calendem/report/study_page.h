// SPDX-License-Identifier: GPL-2.0-or-later
// A study as a page.
#ifndef CALENDEM_REPORT_STUDY_PAGE_H
#define CALENDEM_REPORT_STUDY_PAGE_H

#include "report/study_charts.h"

namespace calendem {

/// The page of a study: charts, and a table of its settings with the distance to the paper's
/// numbers. `description` is study.json.
std::string study_page(const StudyTable &table, const std::vector<report::Chart> &charts,
                       const nlohmann::json &description);

/// Root mean square distance of broken bonds to the paper's at the pressures that both have, in
/// percentage points; NaN if there are none. Nothing says that the paper's are the truth.
double distance_to_paper(const StudyTable &table, const StudyGroup &group);

/// Writes study.html of a study into its folder, from study.csv, study.json and the
/// runs' curves there.
void draw_study(const std::vector<std::string> &columns, const std::string &folder);

} // namespace calendem

#endif
