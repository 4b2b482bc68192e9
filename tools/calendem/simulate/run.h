// SPDX-License-Identifier: GPL-2.0-or-later
// One compression and relaxation: checks the folder, starts LIGGGHTS on in.calendering or resumes it,
// follows it, collects.
#ifndef CALENDEM_SIMULATE_RUN_H
#define CALENDEM_SIMULATE_RUN_H

#include "base/toml_reader.h"
#include "physics/inertial_number.h"
#include <chrono>
#include <cmath>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace calendem {

struct Particle;
struct RawRow;

struct RunOptions {
  std::string folder;
  std::string liggghts;
  int ranks = 2;
  bool resume = false;
  bool force = false; ///< overwrite a run of another case or an unfinished one
};

/// All that a run depends on, but for its electrode's file: settings and run_tools; as text.
std::string run_identity(const Settings &settings, const std::string &tools);
/// Program and scripts of it, as text.
std::string run_tools(const std::string &liggghts);

/// What was computed is collected and kept however the run ends, marked in summary.json
/// ("finished", "stopped_because", "failed_checks"). Throws Failure: 2 bad input, 3 the simulation
/// failed, 4 a check did not hold.
void run_case(const Settings &settings, RunOptions options);

/// The electrode that a case names.
struct ElectrodeFacts {
  double thickness = 0.0; ///< um
  double area = 0.0;      ///< um2
  double solid = 0.0;     ///< AM envelopes + solid carbon and binder [um3]
  double cbd_envelope = 0.0;
  double am = 0.0;
  double lx = 0.0, ly = 0.0;
  double lattice = 0.0;      ///< cube root of a primary's volume [um]
  double facet = 0.0;        ///< area between two bonded primaries, mean [um2]
  double nanoporosity = 0.0; ///< of CBD, as packed; 0: not known
  double widest = 0.0;       ///< largest diameter of a primary or a CBD sphere [um]
  MeanSphere primary;        ///< of the active material; from the atoms, as `atoms` is
  long bonds = 0, atoms = 0, bodies = 0, primaries = 0;

  /// In a cell that is longer along x by a fraction.
  ElectrodeFacts elongated(double by) const {
    ElectrodeFacts e = *this;
    e.lx *= 1.0 + by;
    e.area *= 1.0 + by;
    return e;
  }
};

/// From electrode.json; the atoms are not in it. Throws std::exception where a field is missing.
ElectrodeFacts describe_electrode(const nlohmann::json &electrode);

/// The particles of an electrode's folder, by tag, and their bodies; what is wrong with electrode.data
/// and bodies.map.
std::vector<Particle> electrode_particles(const std::string &folder, Mistakes &data, Mistakes &map);

/// Throws Failure(2) if a file is missing or cut.
ElectrodeFacts read_electrode(const std::string &folder);

// The folder of a run before it starts: may it be written, does it hold a run, can that go on, is
// its restart file complete.

/// True if the folder already holds this run, finished. `hash`: of all that it depends on;
/// `electrode`: of electrode.data. Throws Failure(2) if it holds another run, results of others, or
/// an unfinished run and neither --resume nor --force was given; Failure(4) if it holds this run
/// and its checks did not hold.
bool holds_this_run(const RunOptions &options, const Settings &settings, const std::string &hash,
                    const std::string &electrode);

/// True if there is a complete restart file to go on from, which is then running.restart; false if
/// there is none. Throws Failure(2) if all that there are are cut.
bool find_restart(const std::string &folder, long atoms);

/// Removes what an earlier run left, its summary.json excepted.
void clear_old_results(const std::string &folder);

/// A summary.json that says that the run has not ended; replaced when it ends. `wall_clock_s`: of
/// what a resumed run has done before.
void mark_as_running(const std::string &folder, const std::string &hash,
                     const std::string &electrode, double wall_clock_s);

/// The file ends, as the host writes it, with one chunk per rank (count of values, values; every
/// atom's record begins with its own length) and these hold `atoms` atoms in all.
bool restart_is_whole(const std::string &file, long atoms);

// How far a running compression is.

/// Share of the target of pressure, displacement or thickness that a row has reached; 1 once the
/// platen goes back.
double target_share(const Settings &settings, const RawRow &row);

/// Simulated time [us] until the compression's target is met: at the platen's speed, or as the
/// pressure has grown over the last quarter; NaN where that says nothing.
double time_to_target(const Settings &settings, const std::vector<RawRow> &rows);

/// Shows the progress line; on a terminal in place, else a line every half minute.
class Progress {
public:
  /// `settings` is referred to.
  Progress(const std::string &curve, const Settings &settings);
  void operator()();

private:
  std::string curve_;
  const Settings &settings_;
  double from_ = NAN; ///< simulated time at the first look, which was at looked_ [us]
  std::chrono::steady_clock::time_point looked_, begin_, shown_;
};

} // namespace calendem

#endif
