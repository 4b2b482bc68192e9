// SPDX-License-Identifier: GPL-2.0-or-later
// Turns what the input scripts wrote into the files of a run's directory: curve.csv, summary.json,
// bodies.csv, vtk/*.pvd; and checks them against each other.
#ifndef CALENDEM_SIMULATE_COLLECT_H
#define CALENDEM_SIMULATE_COLLECT_H

#include "physics/contact_range.h"
#include "physics/inertial_number.h"
#include "physics/roll_nip.h"
#include "simulate/fracture.h"
#include "simulate/run.h"
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

class vtkPolyData;
template <class T> class vtkSmartPointer;

namespace calendem {

/// Contacts of one kind by overlap over the smaller radius (physics/contact_range.h), as `compute
/// contact/range` gives them.
struct RangeOfContacts {
  double contacts, force, mean, largest, beyond[kRangeLimits], force_beyond[kRangeLimits];
};

enum KindOfContact { kWallContacts, kInsideBodies, kAmAm, kAmCbd, kCbdCbd, kKindsOfContact };

/// One row of curve_raw.csv: doubles in the order of its columns, kRawColumns of them. Pressures,
/// gap and displacement are averages over one window; energies of contacts are NaN in a run that
/// kept no ledger.
struct RawRow {
  double step, time, stage, displacement, gap, p_top, p_bottom, made, broken, tension, bending,
      shear, torsion, kinetic, strain, work_platen, work_lost, work_collector, contact_elastic,
      cohesion, damped, friction, speed;
  RangeOfContacts ranges[kKindsOfContact];
  double elongation = 0.0, work_elongation = 0.0; ///< of elongation_raw.csv [-], [fJ]
};
constexpr int kRawColumns = offsetof(RawRow, elongation) / sizeof(double);

/// |P platen - P collector| / P platen within which a run counts as quasi-static.
constexpr double kQuasiStatic = 0.05;

/// Rows of a file that the input scripts write on and on, by their first column, the step. Of equal
/// steps, as a resumption leaves them, the last counts. Headings and rows that are cut are left out.
std::map<long, std::vector<double>> rows_by_step(const std::string &file, std::size_t columns);

/// curve_raw.csv.
std::vector<RawRow> read_raw(const std::string &file);

/// Gap at which the averaged pressure first falls below `fraction` of the maximum during the last
/// relaxation, linear between rows; none if the platen stopped before that.
std::optional<double> gap_at_loss(const std::vector<RawRow> &rows, double fraction,
                                  double max_pressure);

/// The row of the highest pressure; of a film that is pressed again, of the last time that it gets as
/// far, within 2 %.
RawRow top_of(const std::vector<RawRow> &rows);

/// Union volume [um3] of body envelopes and CBD spheres against time, from the frames.
struct UnionVolume {
  std::vector<double> time, volume;
  std::vector<double> cbd_spheres; ///< volume of all CBD spheres, overlaps counted twice [um3]
  double at(double t) const;
};

/// Porosity with the platen at `gap` [um].
double total_porosity(const ElectrodeFacts &electrode, double gap, double elongation = 0.0);

/// For summary.json: largest pressure, gaps and porosities, of the model and as the press's
/// instruments show them.
nlohmann::json gaps_and_porosities(const std::vector<RawRow> &rows, const RawRow &top,
                                   const Settings &settings, const ElectrodeFacts &electrode);

/// "presses" of summary.json, of curve.csv and cracks.csv in the folder: what each press of a run
/// gave that was released. What no frame or table tells is null.
nlohmann::json presses_of(const std::string &folder, const std::vector<RawRow> &rows,
                          const UnionVolume &filled, const ElectrodeFacts &electrode,
                          const Settings &settings);

/// What the caller passes in about the run; ranks = 0: unknown.
struct RunFacts {
  double wall_clock_s = 0.0; ///< of this call
  double earlier_s = 0.0;    ///< of the calls that this one resumed, as far as they are known
  double first_step = 0.0;   ///< about where this call began
  int ranks = 0;
  std::string case_hash;
  std::string program;         ///< hash of LIGGGHTS
  std::string stopped_because; ///< empty: it ran to its end
};

/// Writes the files; returns the summary. Checks that did not hold are in its "failed_checks": the
/// target was not reached, the log of breaks and the curve disagree, or the bonds made are not
/// those of the electrode. A run that was stopped is not checked. Throws Failure(3) if there is no
/// curve.
nlohmann::json collect(const std::string &folder, const Settings &settings,
                       const ElectrodeFacts &electrode, const RunFacts &facts);

/// summary.json, which begins with the numbers that are asked for most.
void write_summary(const std::string &folder, const nlohmann::json &summary);

/// Throws Failure(4) with the summary's failed checks, if there are any.
void stop_if_checks_failed(const nlohmann::json &summary, const std::string &folder);

/// vtk/{particles,bonds,platen}.pvd over the frames; frames that
/// were not written to their end are left out. Returns step -> time of the particle frames.
std::vector<std::pair<long, double>> write_series(const std::string &folder, double dt);
/// The particles of a frame.
vtkSmartPointer<vtkPolyData> particles_of(const std::string &folder, long step);
/// Height [um] below which 99.9 % of the particle tops of a frame lie.
double height_of_tops(const std::string &folder, long step);
UnionVolume union_volumes(const std::string &folder, const ElectrodeFacts &electrode,
                          const std::vector<std::pair<long, double>> &frames,
                          const std::vector<RawRow> &rows);

/// bodies.csv, cracks.csv and thresholds.csv; returns {bodies, cracked}. `moments`: the rows of
/// curve.csv; `elongation`: of the cell in the last frame.
std::pair<int, int> write_bodies(const std::string &folder, const ElectrodeFacts &electrode,
                                 const std::string &electrode_folder,
                                 const std::vector<std::pair<long, double>> &frames,
                                 const std::vector<MomentOfRun> &moments, double elongation);

// The energy ledger of a run: work of the platen against what it has become.

/// A ledger with more than this fraction of the work unaccounted for does not close.
inline constexpr double kLedgerLimit = 0.01;

/// Every term, in fJ and since the first row, at maximum pressure and at the end, and what is left
/// over: `unaccounted_fraction` is the largest |rest| of any row over the largest work. Terms that
/// the run did not measure are NaN (null in the file).
nlohmann::json energy_ledger(const std::vector<RawRow> &rows, const RawRow &top);

/// Warning when the ledger does not close; empty when it does or was not kept.
std::string ledger_warning(const nlohmann::json &energy);

// Binder bridges along a run: bridges.csv from what the input scripts wrote, and what of it goes
// into the summary. They are no bonds of bodies and are counted apart from them.

/// Writes bridges.csv, a row for each of `rows`; returns made and broken, at the row of the largest
/// pressure and at the end, by what they join CBD to. Null, and no file, in a run without bridges.
nlohmann::json write_bridges(const std::string &folder, const std::vector<RawRow> &rows,
                             const RawRow &top);

/// Reads drying.csv, the film before the press, for the summary. Null in a run without drying
/// stress.
nlohmann::json dried_film(const std::string &folder);

// What the passes under a roll amount to: line load, length of the nip, and the times of the real
// passage against those of the run.

RollNip roll_nip(const Settings &settings);

/// For each pass its smallest gap, largest pressure, and line load and contact length on both sides
/// of the nip; the time under the roll at the web's real speed, and how much faster the run was.
nlohmann::json roll_passes(const std::vector<RawRow> &rows, const Settings &settings);

// A web that elongates in the nip: elongation_raw.csv, and what of it goes into curve.csv and
// summary.json.

/// Fills in `elongation` and `work_elongation` of the rows; false if the cell kept its sides.
bool add_elongation(const std::string &folder, std::vector<RawRow> &rows);

/// Elongation at a time, between rows by interpolation.
double elongation_at(const std::vector<RawRow> &rows, double time);

/// Header and cells of further columns of curve.csv.
std::string elongation_columns();
std::string elongation_cells(const RawRow &row, const ElectrodeFacts &electrode);

/// For summary.json.
nlohmann::json elongation_of(const RawRow &top, const RawRow &last, const ElectrodeFacts &);

// Whether a run stayed where its laws hold: overlaps within the range of Hertz' law, the platen
// slow enough to count as quasi-static.

/// Contacts beyond this overlap over the smaller radius are what a warning speaks of ...
inline constexpr int kWarnedLimit = 1; // of kRangeLimit: 0.2
/// ... when they carry more than this share of the force.
inline constexpr double kWarnedShare = 0.1;

/// Names of the columns that end each row of curve.csv, and their cells; each begins with a comma.
std::string validity_columns();
std::string validity_cells(const RawRow &row, const MeanSphere &primary);

/// Inertial number and kinetic over elastic energy, that of bonds and contacts: at maximum
/// pressure, and the largest of the rows above 5 MPa before the release.
nlohmann::json inertia(const std::vector<RawRow> &rows, const RawRow &top,
                       const MeanSphere &primary);

/// Shares of contacts and of force beyond each limit, mean and largest overlap, by kind and of all
/// but those inside bodies: at maximum pressure, and the largest of any row.
nlohmann::json contact_range(const std::vector<RawRow> &rows, const RawRow &top);

/// Warning when too much of the force is carried beyond the range; empty: nothing.
std::string range_warning(const nlohmann::json &range);

} // namespace calendem

#endif
