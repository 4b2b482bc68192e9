// SPDX-License-Identifier: GPL-2.0-or-later
// The points of a bank: where the base model is run, and beside which of them each effect.
#ifndef CALENDEM_DIAGNOSE_BANK_BANK_DESIGN_H
#define CALENDEM_DIAGNOSE_BANK_BANK_DESIGN_H

#include "diagnose/bank/bank_spec.h"
#include "simulate/study_file.h"

namespace calendem {

/// `effect` of the points that are run on the full cell.
extern const char *const kFullCell;

/// One set of parameters on one packing, run to every pressure of the bank.
struct BankPoint {
  std::string effect;       ///< empty: base model
  int base_point = 0;       ///< number of the base point that has the same packing and parameters
  int packing = 1;          ///< seed
  std::vector<double> base; ///< values of the base parameters, in their units
  double value = 0.0;       ///< of the effect's key
};

/// `share` (0-1) of the way from low to high; four digits, so that tables and files agree.
double prior_value(double low, double high, Spread spread, double share);

/// Base points first: a Sobol sequence over the priors, packings in turn. Then the points of each
/// effect that needs runs of its own, spread over its prior, beside the first base points: these
/// fill the priors evenly too, and stand on all packings.
std::vector<BankPoint> bank_points(const BankSpec &spec);

/// The runs of all points: for each point one per pressure, in their order. Throws Failure(2) where
/// values are no values of their keys or contradict each other.
Study bank_study(const BankSpec &spec, const std::vector<BankPoint> &points);

/// The first base points once more, for the full cell; those parameters that are keys of the recipe
/// are the full cell's own there. Empty if the bank has none.
std::vector<BankPoint> full_cell_points(const BankSpec &spec);
Study full_cell_study(const BankSpec &spec, const std::vector<BankPoint> &points);

} // namespace calendem

#endif
