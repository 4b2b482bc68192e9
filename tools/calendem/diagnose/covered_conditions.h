// SPDX-License-Identifier: GPL-2.0-or-later
// The conditions of an experiment that a bank covers, and what could be measured on them beside
// what was.
#ifndef CALENDEM_DIAGNOSE_COVERED_CONDITIONS_H
#define CALENDEM_DIAGNOSE_COVERED_CONDITIONS_H

#include "diagnose/bank/bank_table.h"
#include "diagnose/compare/observables.h"

namespace calendem {

struct CoveredCondition {
  Condition condition;
  double pressure; ///< MPa
  std::vector<Observable> observables;
  int specimens = 1; ///< of which these are means
};

/// The conditions named in `wanted` (all if it is empty) whose pressure the bank reaches. What is
/// left out, and why, is reported in `not_said`. A sample of unknown loading has the recipe's
/// within 3 % where the bank's film carries another: micrometres of one film say nothing of
/// another.
std::vector<CoveredCondition> covered_conditions(const Experiment &experiment,
                                                 const BankTable &table,
                                                 const std::vector<std::string> &wanted,
                                                 std::vector<std::string> &not_said);

/// A measurement that was not made: what it would give, without measured values.
struct Further {
  std::string what;
  double hours = 0.0; ///< of work, for all its samples
  std::vector<CoveredCondition> of;
};

/// Those that the table can predict: each kind on the covered conditions that lack it, and
/// porosities after the bank's other pressures, whose uncertainty is that of the others. The
/// pressure's error counts as independent of that in what was measured already.
std::vector<Further> further_measurements(const Experiment &experiment, const BankTable &table,
                                          const std::vector<CoveredCondition> &covered);

} // namespace calendem

#endif
