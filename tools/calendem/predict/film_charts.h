// SPDX-License-Identifier: GPL-2.0-or-later
// Charts of films against pressure, and what the three pages share.
#ifndef CALENDEM_PREDICT_FILM_CHARTS_H
#define CALENDEM_PREDICT_FILM_CHARTS_H

#include "base/shown.h"
#include "predict/prediction.h"
#include "report/page.h"
#include <string>
#include <vector>

namespace calendem {

/// One part of the bands, times a scale.
std::vector<double> part_of(const std::vector<Band> &bands, double Band::*part, double scale);

/// Against pressure [MPa], unless another axis is given.
report::Chart chart_of(const std::string &id, const std::string &title, const std::string &y,
                       const std::string &x = "Pressure (MPa)");

report::Series line_of(const std::string &name, const std::vector<double> &x,
                       const std::vector<double> &y, const std::string &colour);

/// The bands of one number as areas and a line.
void add_bands(const std::vector<double> &x, const std::vector<Band> &bands, double scale,
               const std::string &colour, report::Chart &chart);

/// One of several: its median, and the ends of its 90 % dashed.
void add_edges(const std::string &name, const std::vector<double> &x,
               const std::vector<Band> &bands, double scale, std::size_t number,
               report::Chart &chart);

/// What was measured of a film [%].
report::Series points_of(const Calibration &calibration, int film, const std::string &colour);

} // namespace calendem

#endif
