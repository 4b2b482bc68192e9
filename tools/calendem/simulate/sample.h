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

// Cells of different loading, each pressed on its own, as the parts of one sample that lie side by
// side, equal in area.
//   under one gap         p(h) = (1/N) sum p_i(h), a cell that is thinner than h bears nothing
//   under one pressure    h(p) = (1/N) sum h_i(p)
// A rigid platen or roll is the first, a press that gives way with every cell the second; what is
// between lies between them. Exact if cells do not push each other sideways (loading varies over
// millimetres, the film is tens of um thick) and answer to their own gap alone, not to speed: all
// cells of a sample turn at the same gap, or at the same pressure. Sources: elements in parallel
// and in series (Voigt 1889, Reuss 1929). Deviations: none. Verified by tests/unit/sample and
// tests/regression/coating.

/// Points along a path of a cell: gap [um] and pressure [MPa].
struct PressPath {
  std::vector<double> gap, pressure;
};

struct PressedCell {
  double thickness = 0.0; ///< before [um]
  PressPath down;         ///< the gap falls from point to point
  PressPath up;           ///< it rises
};

struct SampleRow {
  bool released = false;
  double gap = 0.0, pressure = 0.0; ///< mean of the cells [um], [MPa]
};

/// Linear between points of rising x; `below` before the first, the last y beyond the last.
double along_points(const std::vector<double> &x, const std::vector<double> &y, double at,
                    double below);

/// Keeps the points in which the gap moves on: falls, or rises.
PressPath monotone(const PressPath &path, bool rises);

/// Down from the thickest cell's thickness to the smallest gap that all cells have seen, and up to
/// where the last of them is free; a row for every point of a cell.
std::vector<SampleRow> under_one_gap(const std::vector<PressedCell> &cells);

/// Up to the largest pressure that all cells have seen and down to the highest of their last ones.
/// A cell has a pressure where it first meets it going down, and last going up; a row for each.
std::vector<SampleRow> under_one_pressure(const std::vector<PressedCell> &cells);

} // namespace calendem

#endif
