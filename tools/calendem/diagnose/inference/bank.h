// SPDX-License-Identifier: GPL-2.0-or-later
// The bank of simulations: runs of small cells from which the emulators learn.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_BANK_H
#define CALENDEM_DIAGNOSE_INFERENCE_BANK_H

#include "inference/quantities.h"
#include <utility>

namespace calendem::inference {

struct ModelledEffect {
  std::string name;
  std::vector<Parameter> parameters; ///< at least one with `amplitude`
  /// Its runs are computed from those of the base model: they scatter with them, not on their own.
  bool computed = false;
};

struct BankRun {
  std::string effect;  ///< name of the effect that is on; empty: base model
  std::string packing; ///< id; runs of one packing share its scatter
  Vector base;         ///< values of the base parameters
  Vector amplitudes;   ///< values of the effect's parameters; empty for the base model
  Vector values;       ///< of the bank's observables
};

struct Bank {
  std::vector<Parameter> base;
  std::vector<ModelledEffect> effects;
  std::vector<ObservableId> observables;
  std::vector<BankRun> runs;
};

/// Runs that the base model needs at least, and an effect beside runs of it.
constexpr int kFewestRuns = 5;

/// Throws Failure(2) with every mistake of the bank: names, sizes, values that are no numbers, an
/// effect run without a base run of the same parameters and packing, too few runs. Runs may lack the
/// observables at the places `may_lack`: NaN.
void check(const Bank &bank, const std::vector<int> &may_lack = {});

/// (base run, effect run) of the same base parameters and packing, for one effect.
std::vector<std::pair<int, int>> pairs_of(const Bank &bank, const std::string &effect);

/// Places of the runs that have the observables at these places, beside a base run that has.
std::vector<int> runs_that_have(const Bank &bank, const std::vector<int> &observables);

} // namespace calendem::inference

#endif
