// SPDX-License-Identifier: GPL-2.0-or-later
// All of a run in memory, as `calendem report` and `calendem measure` need it.
#ifndef CALENDEM_MEASURE_RUN_DIRECTORY_H
#define CALENDEM_MEASURE_RUN_DIRECTORY_H

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/run_folder.h"
#include "measure/frames.h"

namespace calendem {

/// A row of structure.csv.
struct StructureRow {
  std::string moment;
  double height; ///< of the slice's middle above the collector over the thickness
  double macro, bonds, broken;
};

/// Columns of bodies.csv, cracks.csv, thresholds.csv and breaks.csv by their names; empty where the
/// run has none or one of another version.
struct FractureTables {
  std::map<std::string, Column> bodies, cracks, thresholds, breaks;
};

struct Run {
  std::string name;      ///< of the directory; unique among the runs of a report
  std::string directory; ///< as given
  Curve curve;           ///< curve.csv
  nlohmann::json summary = nlohmann::json::object();   ///< summary.json, empty if unfinished
  nlohmann::json electrode = nlohmann::json::object(); ///< electrode.json if it is there
  nlohmann::json structure; ///< structure.json, null unless `calendem measure` wrote it
  std::vector<StructureRow> profile;
  FractureTables fracture;
  std::vector<FrameFile> particles, bonds, platen; ///< vtk/*.pvd; may be empty
  std::vector<std::string> files_read;
  std::string unfinished; ///< why the run counts as unfinished; empty = finished
  Mistakes notes;         ///< what is missing without making the report impossible
};

/// Reads `directory`. What makes a report impossible is added to `mistakes`.
Run read_run(const std::string &directory, Mistakes &mistakes);

/// Makes the names of the runs unique (a longer part of the path where the last part repeats).
void make_names_unique(std::vector<Run> &runs);

} // namespace calendem

#endif
