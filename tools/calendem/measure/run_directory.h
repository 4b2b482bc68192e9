// SPDX-License-Identifier: GPL-2.0-or-later
// All of a run in memory, as `calendem report` and `calendem measure` need it, with the frames of its
// VTK time series. Lengths in um.
#ifndef CALENDEM_MEASURE_RUN_DIRECTORY_H
#define CALENDEM_MEASURE_RUN_DIRECTORY_H

#include "base/messages.h"
#include "base/run_folder.h"
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace calendem {

using Point = std::array<double, 3>;

struct FrameFile {
  double time_us;
  std::string path;
};

struct ParticleFrame {
  std::vector<Point> centre;
  std::vector<double> radius;
  std::vector<int> body;      ///< 0 = CBD
  std::vector<int> tag, type; ///< empty: not in the file
};

struct BondFrame {
  std::vector<Point> from, to;
  std::vector<bool> intact;
  std::vector<int> body;
  std::vector<std::pair<int, int>> tags; ///< of its primaries, lower first; empty: not in the file
};

struct PlatenFrame {
  std::vector<std::vector<Point>> outlines; ///< closed polygons: collector, platen
};

/// Frames listed in a .pvd file, by time. Whatever cannot be read is added to `mistakes`.
std::vector<FrameFile> read_series(const std::string &pvd, Mistakes &mistakes);
ParticleFrame read_particles(const std::string &file, Mistakes &mistakes);
BondFrame read_bonds(const std::string &file, Mistakes &mistakes);
PlatenFrame read_platen(const std::string &file, Mistakes &mistakes);

/// The frame closest to `time_us`; `frames` must not be empty.
const FrameFile &closest(const std::vector<FrameFile> &frames, double time_us);

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
