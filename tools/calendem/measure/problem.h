// SPDX-License-Identifier: GPL-2.0-or-later
// A mistake in the user's input: which file, what is wrong with it, what to do. Collected, so that
// all of them are shown at once.
#ifndef CALENDEM_MEASURE_PROBLEM_H
#define CALENDEM_MEASURE_PROBLEM_H

#include <string>
#include <vector>

namespace calendem {

struct FileProblem {
  std::string file;
  std::string what;   ///< what is wrong, the value met, what is expected
  std::string remedy; ///< what to do
};

using Problems = std::vector<FileProblem>;

} // namespace calendem

#endif
