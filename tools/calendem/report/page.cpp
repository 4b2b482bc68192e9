// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/page.h"

#include "report/embedded.h"
#include "report/page_template.h"
#include "report/tables.h"

namespace calendem::report {
namespace {

using nlohmann::json;

json drawn(const Picture &picture) {
  constexpr double kEdge = 12; // px between scale bar and the picture's edge
  const double length = picture.scale_bar_um * picture.pixels_per_um;
  return {{"moment", picture.moment},
          {"time", shown(picture.time_us, 2)},
          {"pressure", shown(picture.pressure_MPa, 1)},
          {"broken", shown(100 * picture.broken_fraction, 1)},
          {"width", picture.width},
          {"height", picture.height},
          {"total_height", picture.height + 34},
          {"png", picture.png},
          {"outlines", picture.outlines},
          {"bar_um", picture.scale_bar_um},
          {"bar_start", kEdge},
          {"bar_end", kEdge + length},
          {"bar_middle", kEdge + length / 2},
          {"bar_y", picture.height + 10},
          {"bar_text_y", picture.height + 28},
          {"across_faces", picture.across_faces > 0 ? json(picture.across_faces) : json(nullptr)}};
}

/// The pictures of one subject, as the template wants them; null: none.
json list_of(const std::vector<Picture> &pictures, const char *subject) {
  json list = json::array();
  for (const auto &picture : pictures)
    if (picture.subject == subject)
      list.push_back(drawn(picture));
  return list.empty() ? json(nullptr) : json{{"list", list}};
}

/// Adds what the page draws but the JSON twin leaves out.
void add_pictures(const RunPart &part, json &run) {
  json electrode = json::array(), bonds = json::array();
  for (const auto &picture : part.pictures)
    (picture.subject == "bonds" ? bonds : electrode).push_back(drawn(picture));
  run["electrode_pictures"] = {{"list", electrode}};
  run["bond_pictures"] = {{"list", bonds}};
  run["facts_table"] = !part.facts.empty();
  run["electrode_table"] = !part.electrode.empty();
  run["has_pictures"] = !part.pictures.empty();
  run["has_bond_pictures"] = !bonds.empty();
  run["stage_electrodes"] = list_of(part.stages, "electrode");
  run["stage_bonds"] = list_of(part.stages, "bonds");
  run["has_stages"] = !part.stages.empty();
  run["body_place"] = list_of(part.one_body, "place");
  run["body_shapes"] = list_of(part.one_body, "shape");
  run["body_bonds"] = list_of(part.one_body, "bonds");
  run["has_one_body"] = !part.one_body.empty();
  run["has_view"] = !part.explorer.is_null();
  run["view"] = part.explorer.dump();
}

} // namespace

std::string to_html(const Report &report) {
  json values = to_json(report);
  values["css"] = embedded::kPageCss;
  values["is_unfinished"] = values["status"] == "unfinished";
  values["several"] = report.runs.size() > 1;
  values["provenance_rows"] = facts_of(values["provenance"], {});
  bool any_view = false;
  for (std::size_t i = 0; i < report.runs.size(); ++i) {
    add_pictures(report.runs[i], values["runs"][i]);
    any_view = any_view || !report.runs[i].explorer.is_null();
  }
  if (any_view)
    values["scripts"] = {{"three", embedded::kThree},
                         {"orbit", embedded::kOrbitControls},
                         {"explorer", embedded::kExplorer}};
  for (std::size_t i = 0; i < report.charts.size(); ++i) {
    json &chart = values["charts"][i];
    chart.erase("series");
    chart["svg"] = to_svg(report.charts[i]);
  }
  return fill_template(kPageHtml, values);
}

} // namespace calendem::report
