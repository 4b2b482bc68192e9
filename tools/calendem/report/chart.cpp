// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/chart.h"

namespace calendem::report {

NLOHMANN_JSON_SERIALIZE_ENUM(Mark,
                             {{Mark::line, "line"}, {Mark::points, "points"}, {Mark::area, "area"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Symbol, {{Symbol::none, "none"},
                                      {Symbol::circle, "circle"},
                                      {Symbol::square, "square"},
                                      {Symbol::triangle, "triangle"},
                                      {Symbol::diamond, "diamond"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Hatch, {{Hatch::solid, "solid"},
                                     {Hatch::rising, "rising"},
                                     {Hatch::falling, "falling"},
                                     {Hatch::dots, "dots"}})

nlohmann::json to_json(const Chart &chart) {
  nlohmann::json series = nlohmann::json::array(), limits = nlohmann::json::array();
  for (const auto &s : chart.series) {
    series.push_back({{"name", s.name},
                      {"axis", s.right_axis ? chart.right_label : chart.y_label},
                      {"right", s.right_axis},
                      {"mark", s.mark},
                      {"colour", s.colour},
                      {"dash", s.dash},
                      {"symbol", s.symbol},
                      {"hatch", s.hatch},
                      {"x", s.x},
                      {"y", s.y}});
    if (!s.base.empty())
      series.back()["base"] = s.base;
    if (!s.y_error.empty())
      series.back()["y_error"] = s.y_error;
  }
  for (const auto &limit : chart.limits)
    limits.push_back({{"y", limit.y}, {"label", limit.label}});
  return {{"id", chart.id},
          {"title", chart.title},
          {"x_label", chart.x_label},
          {"y_label", chart.y_label},
          {"right_label", chart.right_label},
          {"note", chart.note},
          {"y_top", chart.y_top},
          {"from_zero", chart.from_zero},
          {"limits", limits},
          {"series", series}};
}

} // namespace calendem::report
