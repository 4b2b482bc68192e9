// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/bank/measurement_price.h"

namespace calendem {

const std::vector<MeasurementPrice> &usual_prices() {
  static const std::vector<MeasurementPrice> prices = {
      {"porosity_after", "porosity after release, by mass and thickness", 3.0, 0.5, "%"},
      {"thickness_at_max", "thickness under the largest pressure", 2.0, 1.0, "um"},
      {"cracked_bodies", "share of cracked particles in a cross-section", 8.0, 0.05, "fraction"},
      {"loading_curve", "displacement while the pressure rises", 1.0, 0.5, "um"},
      {kUnloadingCurve, "displacement while the pressure falls", 1.0, 0.5, "um"},
      {"dwell", "decay of pressure at constant gap", 2.0, 0.0, ""},
      {"second_speed", "the same pressures at a tenth of the speed", 3.0, 0.0, ""},
      {"thickness_series", "coatings of several loadings at one pressure", 6.0, 0.0, ""},
      {"temperature_series", "the same pressures at 25 and 60 degrees C", 8.0, 0.0, ""},
      {"tomogram", "X-ray tomogram before and after", 40.0, 0.0, ""}};
  return prices;
}

} // namespace calendem
