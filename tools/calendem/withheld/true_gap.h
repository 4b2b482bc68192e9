// SPDX-License-Identifier: GPL-2.0-or-later
// What gap a cause really made, from the keeper's two runs of the same samples: with it, without it.
#ifndef CALENDEM_WITHHELD_TRUE_GAP_H
#define CALENDEM_WITHHELD_TRUE_GAP_H

#include "diagnose/diagnose.h"
#include <set>

namespace calendem {

struct TrueGap {
  /// Length of the difference in the metric in which noise and free recalibration have covariance 1.
  double signal_to_noise = 0.0;
  /// "condition|stage|observable" where what recalibration leaves of the difference, without any
  /// noise, is beyond the threshold of "where".
  std::set<std::string> places;
};

/// `handed_out` and `without_cause` share all errors of measurement. Recalibration is linear about
/// the true base parameters `base` (in the bank's order and units); the bank serves for what it
/// absorbs and for the covariance only, not for the difference.
TrueGap true_gap(const Experiment &handed_out, const Experiment &without_cause,
                 const std::vector<double> &base, const BankTable &table, SharedModels &models);

} // namespace calendem

#endif
