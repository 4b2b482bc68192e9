// SPDX-License-Identifier: GPL-2.0-or-later
// Measurements that a laboratory could make next, and what each costs.
#ifndef CALENDEM_DIAGNOSE_BANK_MEASUREMENT_PRICE_H
#define CALENDEM_DIAGNOSE_BANK_MEASUREMENT_PRICE_H

#include <string>
#include <vector>

namespace calendem {

struct MeasurementPrice {
  std::string name;   ///< [[measurement]] name in a bank's file
  std::string what;   ///< what is done
  double hours = 0.0; ///< work for one sample
  double sd = 0.0;    ///< standard deviation of the result, in `unit`
  std::string unit;   ///< empty: the bank's table has no such result, so nothing is foretold
};

constexpr const char *kUnloadingCurve = "unloading_curve"; ///< a bank may lack it

/// Hours and deviations are estimates of this project, from no source; a bank's file changes them.
const std::vector<MeasurementPrice> &usual_prices();

} // namespace calendem

#endif
