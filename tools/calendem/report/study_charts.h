// SPDX-License-Identifier: GPL-2.0-or-later
// What a study shows, as charts: the paper's Figure 4 for every setting, and results against the
// settings that were varied.
#ifndef CALENDEM_REPORT_STUDY_CHARTS_H
#define CALENDEM_REPORT_STUDY_CHARTS_H

#include "report/chart.h"
#include "report/study_groups.h"
#include <functional>

namespace calendem {

/// The curve.csv of a run by its name in the table; a table without rows if it is not there.
using CurveOfRun = std::function<CsvTable(const std::string &run)>;

/// A setting's key in words: "bond tensile strength (MPa)".
std::string setting_in_words(const std::string &key);

std::vector<report::Chart> study_charts(const StudyTable &table, const CurveOfRun &curve);

} // namespace calendem

#endif
