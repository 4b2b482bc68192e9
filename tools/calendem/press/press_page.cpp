// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"
#include "press/press_curve.h"
#include "report/page.h"

namespace calendem {

extern const char *const kPressHtml;

namespace {

using report::Chart;
using report::kSeriesColours;
using report::line_through;

Chart of_export(const PressExport &from, const PressCurve &curve) {
  return {"export",
          "What the press recorded",
          "Its position (µm)",
          "Pressure (MPa)",
          "",
          {line_through("all rows", from.displacement, from.pressure, kSeriesColours[0]),
           report::points_at("first contact", {from.displacement[curve.contact]},
                             {from.pressure[curve.contact]}, kSeriesColours[1],
                             report::Symbol::circle)}};
}

Chart of_curve(const PressCurve &curve) {
  Chart chart{"curve", "The curve", "Displacement from first contact (µm)", "Pressure (MPa)"};
  std::size_t look = 0;
  for (const char *stage : {"loading", "dwell", "unloading"}) {
    std::vector<double> x, y;
    for (std::size_t k = 0; k < curve.stage.size(); ++k)
      if (curve.stage[k] == stage) {
        x.push_back(curve.displacement[k]);
        y.push_back(curve.pressure[k]);
      }
    if (!x.empty())
      chart.series.push_back(
          line_through(stage, x, y, kSeriesColours[look], look == 0 ? "" : "9 4"));
    ++look;
  }
  if (curve.machine.empty())
    return chart;
  std::vector<double> x = curve.displacement;
  for (std::size_t k = 0; k < x.size(); ++k)
    x[k] += curve.machine[k];
  chart.series.push_back(line_through("before the press's own way was taken off", x, curve.pressure,
                                      kSeriesColours[5], "2 3"));
  return chart;
}

} // namespace

std::string press_page(const std::string &file, const PressExport &from, const PressCurve &curve) {
  nlohmann::ordered_json j = {{"file", file}, {"said", from.said}};
  for (const std::string &text : curve.said)
    j["said"].push_back(text);
  j["provenance"] = {{"calendem", version()}, {"export", {{file, hash_of_file(file)}}}};
  report::Page page{kPressHtml, j};
  page.charts = {of_curve(curve), of_export(from, curve)};
  return report::to_html(page);
}

} // namespace calendem
