// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a run stayed where its laws hold: overlaps within the range of Hertz' law, the platen
// slow enough to count as quasi-static.
#ifndef CALENDEM_SIMULATE_VALIDITY_H
#define CALENDEM_SIMULATE_VALIDITY_H

#include "physics/inertial_number.h"
#include "simulate/collect.h"

namespace calendem {

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
