// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of an experiment file, and whether a condition has what its values need. A new measured
// value is a row of quantities() and a field of Condition.
#ifndef CALENDEM_BASE_EXPERIMENT_KEYS_H
#define CALENDEM_BASE_EXPERIMENT_KEYS_H

#include "base/experiment.h"
#include "base/key.h"
#include "base/messages.h"

namespace calendem {

/// A number, or { value, sd }, of a condition.
struct Quantity {
  Key key;
  std::optional<Measured> Condition::*field;
};

const std::vector<Key> &head_keys();      ///< of [experiment]
const std::vector<Key> &condition_keys(); ///< of [[condition]], without the measured values
const std::vector<Quantity> &quantities();

/// Foil and sample are known where masses and thicknesses hold them, and leave a coating.
void check_foil(const Experiment &experiment, const Condition &condition, const std::string &who,
                int line, Mistakes &mistakes);

/// A CSV file whose displacements, pressures and stages can be those of the condition; `line` is
/// that of its key.
void check_curve(const Experiment &experiment, const Condition &condition, int line,
                 Mistakes &mistakes);

} // namespace calendem

#endif
