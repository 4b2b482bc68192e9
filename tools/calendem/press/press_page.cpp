// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"
#include "press/press_curve.h"
#include "report/page.h"

namespace calendem {

extern const char *const kPressHtml;

namespace {

using report::Chart;
using report::Series;

Series line(const std::string &name, std::vector<double> x, std::vector<double> y, std::size_t look,
            const char *dash = "") {
  Series s;
  s.name = name;
  s.x = std::move(x);
  s.y = std::move(y);
  s.colour = report::kSeriesColours[look];
  s.dash = dash;
  return s;
}

Chart of_export(const PressExport &from, const PressCurve &curve) {
  Chart chart{
      "export", "What the press recorded", "Its position (µm)", "Pressure (MPa)", "", {}, {}, ""};
  chart.series.push_back(line("all rows", from.displacement, from.pressure, 0));
  Series contact =
      line("first contact", {from.displacement[curve.contact]}, {from.pressure[curve.contact]}, 1);
  contact.mark = report::Mark::points;
  contact.symbol = report::Symbol::circle;
  chart.series.push_back(contact);
  return chart;
}

Chart of_curve(const PressCurve &curve) {
  Chart chart{
      "curve", "The curve", "Displacement from first contact (µm)", "Pressure (MPa)", "", {},
      {},      ""};
  std::size_t look = 0;
  for (const char *stage : {"loading", "dwell", "unloading"}) {
    std::vector<double> x, y;
    for (std::size_t k = 0; k < curve.stage.size(); ++k)
      if (curve.stage[k] == stage) {
        x.push_back(curve.displacement[k]);
        y.push_back(curve.pressure[k]);
      }
    if (!x.empty())
      chart.series.push_back(line(stage, x, y, look, look == 0 ? "" : "9 4"));
    ++look;
  }
  if (curve.machine.empty())
    return chart;
  std::vector<double> x = curve.displacement;
  for (std::size_t k = 0; k < x.size(); ++k)
    x[k] += curve.machine[k];
  chart.series.push_back(
      line("before the press's own way was taken off", x, curve.pressure, 5, "2 3"));
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
