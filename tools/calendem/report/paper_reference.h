// SPDX-License-Identifier: GPL-2.0-or-later
// The published figures a run is shown beside: reference/table1.csv and reference/paper_bonds.csv,
// compiled into the program. Source: Xu et al. (named in the files).
#ifndef CALENDEM_REPORT_PAPER_REFERENCE_H
#define CALENDEM_REPORT_PAPER_REFERENCE_H

#include <vector>

namespace calendem::report {

struct MeasuredPorosity {
  double pressure_MPa;
  double porosity_percent; ///< total, after relaxation
  double sd_percent;
};

struct PublishedBreaks {
  double pressure_MPa;
  double broken_percent; ///< of the initial bonds
};

std::vector<MeasuredPorosity> paper_porosity();
std::vector<PublishedBreaks> paper_breaks();

} // namespace calendem::report

#endif
