// SPDX-License-Identifier: GPL-2.0-or-later
// What a bank's runs gave, small enough to ship: one row per run.
#ifndef CALENDEM_DIAGNOSE_BANK_BANK_TABLE_H
#define CALENDEM_DIAGNOSE_BANK_BANK_TABLE_H

#include "diagnose/bank/bank_spec.h"
#include "compare/gap.h"
#include "simulate/study_file.h"

namespace calendem {

// The points of a bank: where the base model is run, and beside which of them each effect.

/// `effect` of the points that are run on the full cell.
extern const char *const kFullCell;

/// One set of parameters on one packing, run to every pressure of the bank.
struct BankPoint {
  std::string effect;       ///< empty: base model
  int base_point = 0;       ///< number of the base point that has the same packing and parameters
  int packing = 1;          ///< seed
  std::vector<double> base; ///< values of the base parameters, in their units
  double value = 0.0;       ///< of the effect's key
  std::map<std::string, double> also; ///< values of effects' keys, in runs beside a bank's
};

/// `share` (0-1) of the way from low to high; four digits, so that tables and files agree.
double prior_value(double low, double high, Spread spread, double share);

/// Base points first: a Sobol sequence over the priors, packings in turn. Then the points of each
/// effect that needs runs of its own, spread over its prior, beside the first base points: these
/// fill the priors evenly too, and stand on all packings. Last the chosen points.
std::vector<BankPoint> bank_points(const BankSpec &spec);

/// A point and how it is pressed; `name` as of the bank's pressing, empty: the usual one.
struct PressedPoint {
  BankPoint point;
  Pressing pressing;
  std::string name;
};

/// To that pressure [MPa], in the usual way or with these settings.
Pressing to_pressure(double pressure, const Pressing &settings = {});

/// Columns of a study, and for each way of pressing a row of their values: all keys that any of them
/// has. A key that one lacks is that of the case on the material of the recipe.
struct PressingColumns {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;
};
PressingColumns columns_of(const std::vector<Pressing> &pressings, const BankSpec &spec);

/// All points in all of these ways, by point.
std::vector<PressedPoint> pressed(const std::vector<BankPoint> &points,
                                  const std::vector<Pressing> &pressings);

/// The bank's runs: for each point one per pressure, in their order; then those of each pressing;
/// last the chosen points to the bank's pressures.
std::vector<PressedPoint> bank_runs(const BankSpec &spec);

/// Throws Failure(2) where values are no values of their keys or contradict each other.
Study pressed_study(const BankSpec &spec, const std::vector<PressedPoint> &runs);

/// The first base points once more, for the full cell; those parameters that are keys of the recipe
/// are the full cell's own there. Empty if the bank has none.
std::vector<BankPoint> full_cell_points(const BankSpec &spec);
/// To all pressures that points are pressed to in the usual way.
std::vector<PressedPoint> full_cell_runs(const BankSpec &spec);
Study full_cell_study(const BankSpec &spec, const std::vector<PressedPoint> &runs);

struct BankRow {
  BankPoint point;
  SimulatedRun run; ///< its curve on the table's grid of pressures
};

struct BankTable {
  BankSpec spec;
  std::vector<BankRow> rows; ///< those of the full cell too
};

/// Runs of the bank that none of the rows is. Throws Failure(2) if a row has the place of
/// one, but other parameters: it is another bank's.
std::vector<PressedPoint> runs_beside(const BankSpec &spec, std::vector<PressedPoint> runs,
                                      const std::vector<BankRow> &rows);

/// Columns: effect, base_point, packing, pressing (if any run has one), the base parameters, value
/// (of the effect's key), then the
/// run's numbers, its displacement at pressures of a fixed grid (um, MPa; empty: not reached) and
/// on release at shares of the largest pressure (um). A table may lack the release, displacements
/// above 180 MPa, broken bonds, tortuosity, nanoporosity and what a dwell leaves of the pressure.
/// Instrument effects have no rows: they follow from
/// those of the base model.
std::string write_bank_table(const BankTable &table);

/// With the further table if the file is the bank's own. Throws Failure(2): columns that are missing,
/// lines that are damaged, effects that are unknown.
BankTable read_bank_table(const BankSpec &spec, const std::string &file);

/// Its runs have displacements on release.
bool has_release(const BankTable &table);

/// The run as another press would show it; `value` is of the instrument effect's key.
SimulatedRun shown_with(const Effect &effect, double value, const SimulatedRun &run);

/// The run with what the second of each pair of runs differs by from the first, on average: numbers, and
/// displacements at its own pressures; a curve that ends before keeps its last difference.
SimulatedRun with_mean_change(const SimulatedRun &run,
                              const std::vector<std::pair<SimulatedRun, SimulatedRun>> &pairs);

/// The run to a maximum pressure p between those of two runs of the same point, its release at equal
/// shares; the loading is that of the run that goes further. Linear in ln p: 150 MPa from 80 and 300
/// is off by 0.40 points of porosity after release (root mean square of the shipped bank's 96 base
/// points), 1.0 under load and 7 % of the particles cracked; linear in p by 0.82, 1.6 and 11.
SimulatedRun between_runs(const SimulatedRun &lower, const SimulatedRun &upper, double pressure);

/// What a mean of many such runs is off by, as a standard deviation: it grows from 0 at both
/// pressures with ln(p / lower) ln(upper / p). Per unit of that product, root mean square over the
/// means of base model and effects: 0.7 points of porosity after release, 1.4 under load, 7 % of the
/// particles cracked for these runs; 0.6, 1.6 and 7 for 80 MPa from 20 and 150; 0.9, 1.7 and 8 for 80
/// from 50 and 150; 0.9, 2.0 and 14 for 50 from 20 and 80, of which films' scatter is 0.6, 1.2 and 7;
/// 0.65, 2.4 and 9 for the coatings' bank's to 50, 80 and 150 MPa from those next to them. Taken are
/// 0.7, 2 and 12.
/// Porosity and share of cracked particles 0-1.
struct BetweenRuns {
  double porosity_after = 0.0, porosity_at_max = 0.0, cracked = 0.0;
};
BetweenRuns error_between_runs(double lower, double upper, double pressure);

} // namespace calendem

#endif
