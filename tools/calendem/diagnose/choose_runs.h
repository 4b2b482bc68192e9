// SPDX-License-Identifier: GPL-2.0-or-later
// The runs that a bank should get next, for what they tell about an experiment.
#ifndef CALENDEM_DIAGNOSE_CHOOSE_RUNS_H
#define CALENDEM_DIAGNOSE_CHOOSE_RUNS_H

#include "diagnose/diagnose.h"

namespace calendem {

struct RunChoice {
  std::vector<ChosenRun> chosen; ///< in the order in which they were chosen
  /// An effect of the bank that is simulated and learnt.
  struct Effect {
    std::string name;
    int points = 0;      ///< it has
    int chosen = 0;      ///< more
    double gain = 0.0;   ///< of those, in bits as in inference/choose_points.h
    double evenly = 0.0; ///< of its part of as many points, given to all effects alike
  };
  std::vector<Effect> effects;
  double cells = 0.0; ///< of the bank, that the sample is as large as
  std::vector<std::string> not_said;
};

/// `count` points, or fewer if there are no more, beside base points at which their effect was not
/// run. Chosen points are run to the bank's pressures: conditions that need others, or other ways of
/// pressing, are left out and reported. `cells`: 0: from the sample's size. Throws Failure(2) if
/// chosen points of the bank were not run yet, no effect can get any, or nothing of the experiment
/// can be compared.
RunChoice choose_runs(const Experiment &experiment, const BankTable &table, double cells,
                      int count);

} // namespace calendem

#endif
