// SPDX-License-Identifier: GPL-2.0-or-later
// The paper's Figures 3 and 5 of a run: electrode and bonds at its pressures, and one particle.
#ifndef CALENDEM_REPORT_FRACTURE_PICTURES_H
#define CALENDEM_REPORT_FRACTURE_PICTURES_H

#include "report/electrode_picture.h"

namespace calendem::report {

/// The frames in compression nearest to the paper's pressures (0, 9.2, 20.1, 50.9, 146.8 MPa), as
/// far as the run went; a frame that is nearest to two of them stands for the nearer one.
std::vector<Moment> stages_of(const Run &run);

/// Subjects "electrode" and "bonds" at every stage; bonds that will be broken in the last frame are
/// told from those that will not, broken ones are not drawn.
std::vector<Picture> draw_stages(Run &run);

/// The body that studied_body() names: "place" in the electrode before, "shape" and "bonds" at
/// every stage, seen from the same side; their broken_fraction is its own.
std::vector<Picture> draw_one_body(Run &run);

} // namespace calendem::report

#endif
