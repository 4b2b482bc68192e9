// SPDX-License-Identifier: GPL-2.0-or-later
// The cell of a run whose web elongates: elongation_raw.csv, which the input scripts write beside
// curve_raw.csv, and what of it goes into curve.csv and summary.json.
#ifndef CALENDEM_SIMULATE_ELONGATION_H
#define CALENDEM_SIMULATE_ELONGATION_H

#include "simulate/collect.h"

namespace calendem {

/// Fills in `elongation` and `work_elongation` of the rows; false if the cell kept its sides.
bool add_elongation(const std::string &folder, std::vector<RawRow> &rows);

/// Elongation at a time, between rows by interpolation.
double elongation_at(const std::vector<RawRow> &rows, double time);

/// Header and cells of further columns of curve.csv.
std::string elongation_columns();
std::string elongation_cells(const RawRow &row, const ElectrodeFacts &electrode);

/// For summary.json.
nlohmann::json elongation_of(const RawRow &top, const RawRow &last, const ElectrodeFacts &);

} // namespace calendem

#endif
