// SPDX-License-Identifier: GPL-2.0-or-later
// Runs of cells of different loading as one sample: a folder with curve.csv, summary.json,
// electrode.json and case.toml, as far as `calendem compare` reads those of a run.
#ifndef CALENDEM_SIMULATE_SAMPLE_H
#define CALENDEM_SIMULATE_SAMPLE_H

#include <string>
#include <vector>

namespace calendem {

enum class OneFor { Gap, Pressure };

/// What all cells of the sample share under the press. Throws Failure(2) with everything that is
/// wrong with the folders of the runs, or makes them no sample: they must have turned at one gap,
/// or at one pressure.
void make_sample(const std::vector<std::string> &runs, OneFor shared, const std::string &folder);

} // namespace calendem

#endif
