// SPDX-License-Identifier: GPL-2.0-or-later
// What a bank's runs gave, small enough to ship: one row per run.
#ifndef CALENDEM_DIAGNOSE_BANK_BANK_TABLE_H
#define CALENDEM_DIAGNOSE_BANK_BANK_TABLE_H

#include "diagnose/bank/bank_design.h"
#include "diagnose/compare/gap.h"

namespace calendem {

struct BankRow {
  BankPoint point;
  SimulatedRun run; ///< its curve on the table's grid of pressures
};

struct BankTable {
  BankSpec spec;
  std::vector<BankRow> rows; ///< those of the full cell too
};

/// Columns: effect, base_point, packing, the base parameters, value (of the effect's key), then the
/// run's numbers, its displacement at pressures of a fixed grid (um, MPa; empty: not reached) and
/// on release at shares of the largest pressure (um; a table may lack these). Instrument effects
/// have no rows: they follow from those of the base model.
std::string write_bank_table(const BankTable &table);

/// Throws Failure(2): columns that are missing, lines that are damaged, effects that are unknown.
BankTable read_bank_table(const BankSpec &spec, const std::string &file);

/// Its runs have displacements on release.
bool has_release(const BankTable &table);

/// The run as another press would show it; `value` is of the instrument effect's key.
SimulatedRun shown_with(const Effect &effect, double value, const SimulatedRun &run);

/// The run to a maximum pressure between those of two runs of the same point, linear between them;
/// the loading is that of the run that goes further, the release linear at equal shares.
SimulatedRun between_runs(const SimulatedRun &lower, const SimulatedRun &upper, double pressure);

} // namespace calendem

#endif
