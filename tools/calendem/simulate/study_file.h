// SPDX-License-Identifier: GPL-2.0-or-later
// A study (study.toml): one electrode recipe and one case, with the settings that are varied.
//   [study]
//   name = "Bond strength"
//   recipe = "electrode.toml"          # paths are relative to this file
//   case = "case.toml"                 # its electrode is replaced by the study's packing
//   at_pressure_MPa = [20, 90, 146]    # columns of the table
//   keep = "tables"                    # or "all": frames and restart files of every run
//   [[vary]]                           # every combination of the groups is a run
//   keys = ["case.bond.tensile_strength_MPa", "case.bond.shear_strength_MPa"]
//   values = [200, 500]                # one value for all keys, or a list with one for each
//   [[vary]]
//   keys = ["recipe.coating.loading_mg_cm2"]
//   normal = { mean = 17.46, sd = 0.4, cells = 5 } # instead: cells of a sample, calendem sample
//   [[vary]]
//   design = "points.csv"              # instead: columns named by keys, a row for each value
#ifndef CALENDEM_SIMULATE_STUDY_FILE_H
#define CALENDEM_SIMULATE_STUDY_FILE_H

#include "base/recipe.h"
#include <string>
#include <vector>

namespace calendem {

/// One simulation of a study.
struct StudyRun {
  int number = 0;                  ///< from 1, in the order of the file
  std::vector<std::string> values; ///< of the study's columns
  std::string said; ///< those that differ from recipe and case: "seed 3, am.friction 0.2"
  Recipe recipe;
  Settings settings; ///< of the case; its electrode is not yet known
};

struct Study {
  std::string file, name, recipe_file, case_file;
  std::vector<double> at_pressure; ///< MPa, increasing
  bool keep_all = true;
  bool measured = false;            ///< the structure after release, structure.json
  std::vector<std::string> columns; ///< the keys that are varied: "case.…", "recipe.…"
  std::vector<StudyRun> runs;
};

/// A column must be the name of a key that can be varied.
void check_column(const std::string &name, Mistakes &mistakes);

/// Gives a study with name, files and columns its runs, one for each row of values of the columns.
/// Values that no key may hold, and what they contradict, go to `mistakes`.
void add_runs(Study &study, const std::vector<std::vector<std::string>> &rows, Mistakes &mistakes);

/// Throws Failure(2) with every mistake of the file, its recipe, its case and its runs.
Study read_study(const std::string &file);

} // namespace calendem

#endif
