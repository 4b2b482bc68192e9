// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a condition of an experiment has what its values need.
#ifndef CALENDEM_BASE_EXPERIMENT_CHECKS_H
#define CALENDEM_BASE_EXPERIMENT_CHECKS_H

#include "base/experiment.h"
#include "base/messages.h"

namespace calendem {

/// Foil and sample are known where masses and thicknesses hold them, and leave a coating.
void check_foil(const Experiment &experiment, const Condition &condition, const std::string &who,
                int line, Mistakes &mistakes);

/// A CSV file whose displacements, pressures and stages can be those of the condition; `line` is
/// that of its key.
void check_curve(const Experiment &experiment, const Condition &condition, int line,
                 Mistakes &mistakes);

} // namespace calendem

#endif
