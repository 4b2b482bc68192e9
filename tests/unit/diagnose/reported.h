// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef CALENDEM_TESTS_UNIT_DIAGNOSE_REPORTED_H
#define CALENDEM_TESTS_UNIT_DIAGNOSE_REPORTED_H

#include "diagnose/experiment_data.h"
#include <algorithm>
#include <string>

namespace calendem_test {

/// True if the data's list of what is not used, and why, has `part`.
inline bool reported(const calendem::ExperimentData &data, const std::string &part) {
  return std::any_of(data.not_said.begin(), data.not_said.end(),
                     [&](const std::string &s) { return s.find(part) != std::string::npos; });
}

} // namespace calendem_test

#endif
