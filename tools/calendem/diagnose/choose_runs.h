// SPDX-License-Identifier: GPL-2.0-or-later
// The runs that a bank should get next, for what they tell about an experiment.
#ifndef CALENDEM_DIAGNOSE_CHOOSE_RUNS_H
#define CALENDEM_DIAGNOSE_CHOOSE_RUNS_H

#include "diagnose/diagnose.h"

namespace calendem {

struct RunChoice {
  std::vector<ChosenRun> chosen; ///< in the order in which they were chosen
  /// Of each effect of the bank that is simulated.
  struct Effect {
    std::string name;
    int points = 0;      ///< it has
    int chosen = 0;      ///< more
    double gain = 0.0;   ///< of those, in bits as in inference/choose_points.h
    double evenly = 0.0; ///< of as many in all, the same number of each effect, spread evenly
  };
  std::vector<Effect> effects;
  double cells = 0.0; ///< of the bank, that the sample is as large as
};

/// `count` points beside base points at which their effect was not run. `cells`: 0: from the sample's
/// size. Throws Failure(2) if chosen points of the bank were not run yet, none is left, or nothing of
/// the experiment can be compared.
RunChoice choose_runs(const Experiment &experiment, const BankTable &table, double cells,
                      int count);

} // namespace calendem

#endif
