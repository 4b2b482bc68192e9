// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of an experiment file. A new measured value is a row of quantities() and a field of
// Condition.
#ifndef CALENDEM_BASE_EXPERIMENT_KEYS_H
#define CALENDEM_BASE_EXPERIMENT_KEYS_H

#include "base/experiment.h"
#include "base/key.h"

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
