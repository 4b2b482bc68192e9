// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/plots.h"

namespace calendem::report {

Chart sphericities(const Run &run, bool single) {
  Chart chart;
  chart.id = "shape";
  chart.title = single ? "Shape of the bodies" : "Shape of the bodies: " + run.name;
  chart.x_label = "Sphericity";
  chart.y_label = "Bodies";
  const auto found = run.electrode.find("sphericity_histogram");
  if (found == run.electrode.end() || !found->is_object())
    return chart;
  const double from = found->value("from", 0.0), step = found->value("step", 0.0);
  const auto count = found->value("count", std::vector<double>());
  Series bars;
  bars.mark = Mark::area;
  bars.colour = "#9ecae8";
  for (std::size_t k = 0; k < count.size(); ++k)
    for (const double x : {from + double(k) * step, from + double(k + 1) * step}) {
      bars.x.push_back(x);
      bars.y.push_back(count[k]);
      bars.base.push_back(0.0);
    }
  if (!bars.x.empty())
    chart.series.push_back(std::move(bars));
  chart.note = "Surface of the sphere of equal volume over the surface of the smooth shape that "
               "the primaries fill; the first class holds everything below it.";
  return chart;
}

} // namespace calendem::report
