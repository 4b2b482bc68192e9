// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/page.h"
#include "report/page_template.h"

namespace calendem::report {

nlohmann::ordered_json data_of(const Page &page) {
  nlohmann::ordered_json data = page.json;
  if (!page.charts.empty())
    data["charts"] = nlohmann::ordered_json::array();
  for (const Chart &chart : page.charts)
    data["charts"] += nlohmann::ordered_json(to_json(chart));
  return data;
}

nlohmann::json places_of(const std::vector<Chart> &charts) {
  nlohmann::json places = nlohmann::json::array();
  for (const Chart &chart : charts)
    places.push_back({{"id", chart.id}, {"title", chart.title}, {"note", chart.note}});
  return places;
}

std::string to_html(const Page &page) {
  nlohmann::json values = page.json;
  values.update(page.values);
  values["charts"] = places_of(page.charts);
  values["css"] = embedded::kPageCss;
  values["data"] = in_script(data_of(page).dump());
  values["script"] = embedded::kPageScript;
  if (!page.charts.empty())
    values["chart_scripts"] = {embedded::kD3, embedded::kChartScript};
  return fill_template(page.html, values);
}

} // namespace calendem::report
