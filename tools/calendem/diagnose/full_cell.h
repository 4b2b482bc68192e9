// SPDX-License-Identifier: GPL-2.0-or-later
// What the bank's small cell lacks to the sample's film, and how well that is known.
#ifndef CALENDEM_DIAGNOSE_FULL_CELL_H
#define CALENDEM_DIAGNOSE_FULL_CELL_H

#include "diagnose/point_runs.h"

namespace calendem {

struct Transfer {
  inference::Vector change;     ///< of all observables; empty: none
  inference::Matrix covariance; ///< of the change at other parameters
};

/// Mean of runs of the same parameters on the full cell less those on the bank's, and what a
/// further one would scatter about it. A film is more porous at its faces, in layers that do not
/// grow with it: the change goes with 1 / loading, and is 0 for a sample of the bank's own loading.
/// None with fewer than two points. What is done is told in `not_said`.
Transfer transfer_of(const Experiment &experiment, const BankTable &bank,
                     const std::vector<Covered> &all, std::vector<std::string> &not_said);

} // namespace calendem

#endif
