// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of an experiment file. A new measured value is a row of quantities() and a field of
// Condition.
#ifndef CALENDEM_SPEC_EXPERIMENT_KEYS_H
#define CALENDEM_SPEC_EXPERIMENT_KEYS_H

#include "spec/experiment.h"
#include "spec/key.h"

namespace calendem {

/// A number, or { value, sd }, of a condition.
struct Quantity {
  Key key;
  std::optional<Measured> Condition::*field;
};

const std::vector<Key> &head_keys();      ///< of [experiment]
const std::vector<Key> &condition_keys(); ///< of [[condition]], without the measured values
const std::vector<Quantity> &quantities();

} // namespace calendem

#endif
