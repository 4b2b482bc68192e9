// SPDX-License-Identifier: GPL-2.0-or-later
// A study as a page: its finished runs, packings of the same settings together; the paper's Figure 4
// for every setting, and results against the settings that were varied.
#ifndef CALENDEM_REPORT_STUDY_PAGE_H
#define CALENDEM_REPORT_STUDY_PAGE_H

#include "base/csv_table.h"
#include "report/page.h"
#include <functional>
#include <map>

namespace calendem {

/// Mean over packings and their standard deviation; 0 with one packing.
struct MeanAndSd {
  double mean = 0.0, sd = 0.0;
  int n = 0; ///< 0: none has a value, the mean is NaN
};

MeanAndSd mean_and_sd(const std::vector<double> &values);

struct StudyGroup {
  std::map<std::string, std::string> settings; ///< by column
  std::vector<std::size_t> rows;               ///< of the table
};

class StudyTable {
public:
  /// `varied`: the study's columns. Columns that say the same as one before them are left out.
  /// `of_paper`: its films are of the paper's recipe, and compared with the paper.
  StudyTable(CsvTable table, const std::vector<std::string> &varied, bool of_paper);

  /// Varied columns but for the seed of the packing.
  const std::vector<std::string> &settings() const { return settings_; }
  /// Settings whose values are numbers, two at least.
  std::vector<std::string> numeric_settings() const;
  /// Finished runs that share all settings but those in `apart`; in the order of the table.
  std::vector<StudyGroup> groups(const std::vector<std::string> &apart = {}) const;
  /// "criterion = signed, tensile strength = 500 MPa"; empty where nothing is varied.
  static std::string label(const StudyGroup &group);

  std::vector<double> numbers(const StudyGroup &group, const std::string &column) const;
  std::vector<std::string> texts(const StudyGroup &group, const std::string &column) const;
  MeanAndSd mean_and_sd(const StudyGroup &group, const std::string &column) const;
  /// Pressures [MPa] of columns `name`_at_…_MPa.
  std::vector<double> pressures(const std::string &name) const;
  std::size_t finished() const { return finished_.size(); }
  bool of_paper() const { return of_paper_; }

private:
  CsvTable table_;
  std::vector<std::string> settings_;
  std::vector<std::size_t> finished_;
  bool of_paper_;
};

/// The curve.csv of a run by its name in the table; a table without rows if it is not there.
using CurveOfRun = std::function<CsvTable(const std::string &run)>;

/// A setting's key in words: "bond tensile strength (MPa)".
std::string setting_in_words(const std::string &key);

std::vector<report::Chart> study_charts(const StudyTable &table, const CurveOfRun &curve);

/// The page of a study: charts, and a table of its settings; films of the paper's recipe have their
/// distance to the paper's numbers. `description` is study.json.
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
