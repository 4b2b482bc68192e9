// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/files.h"
#include "predict/film_charts.h"
#include "predict/film_sheet.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {

extern const char *const kDesignHtml;

using Json = nlohmann::ordered_json;
using nlohmann::json;
using report::Chart;
using report::kSeriesColours;
using report::kSeriesSymbols;

namespace {

/// What is chosen, in words and files.
struct Setting {
  const char *key, *name, *unit, *axis, *direction;
  int decimals;
};
Setting setting_of(SetBy by) {
  return by == SetBy::Gap
             ? Setting{"gap_um", "gap", "µm", "Gap (µm)", "The gap narrows from right to left.", 1}
             : Setting{"pressure_MPa",
                       "pressure",
                       "MPa",
                       "Pressure (MPa)",
                       "The pressure rises from right to left.",
                       0};
}

Json to_json(const Confirmation &c) {
  Json out = {{"runs", c.predicted.runs}, {"probability", c.chance.all}};
  if (c.passes > 0)
    out["passes"] = c.passes;
  out["porosity_after_percent"] = band_json(c.predicted.after[0], kPercent);
  out["cracked_percent"] = band_json(c.predicted.cracked[0], kPercent);
  return out;
}

} // namespace

Json to_json(const FilmBank &bank, const Target &t, SetBy by, const std::vector<Design> &designs) {
  const Setting set = setting_of(by);
  Json out = Json::array();
  for (const Design &d : designs) {
    Json row = film_json(bank, d.film);
    row["beyond"] = d.predicted.beyond;
    row["by"] = d.predicted.runs == 0 ? Json("emulators") : Json{{"runs", d.predicted.runs}};
    row["best"] = {{set.key, d.chances[d.best].at},
                   {"probability", d.chances[d.best].all},
                   {"assured", d.chances[d.best].assured},
                   {"porosity_after_percent", band_json(d.predicted.after[d.best], kPercent)},
                   {"cracked_percent", band_json(d.predicted.cracked[d.best], kPercent)},
                   {"springback_percent", band_json(d.predicted.springback[d.best], kPercent)}};
    if (!d.predicted.tortuosity.empty())
      row["best"]["tortuosity_through_plane"] = band_json(d.predicted.tortuosity[d.best], 1.0);
    if (by == SetBy::Gap)
      row["best"]["pressure_MPa"] = d.predicted.pressures[d.best];
    for (const Confirmation &c : d.confirmed)
      row["confirmed"].push_back(to_json(c));
    row["chances"] = Json::array();
    for (const Chance &c : d.chances)
      row["chances"].push_back({{set.key, c.at},
                                {"porosity", c.porosity},
                                {"cracked", c.cracked},
                                {"tortuosity", c.tortuosity},
                                {"all", c.all},
                                {"assured", c.assured}});
    out.push_back(row);
  }
  return {{"target",
           {{"porosity_percent", kPercent * t.porosity},
            {"within_points", kPercent * t.within},
            {"cracked_below_percent", kPercent * t.cracked_below},
            {"tortuosity_below", t.tortuosity_below}}},
          {"films", out}};
}

namespace {

/// Median and the interval that holds 90 %.
std::string band_text(const Band &b, int decimals, double scale = kPercent) {
  return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", scale * b.median, decimals, scale * b.low90,
                     decimals, scale * b.high90, decimals);
}

std::string confirmed_text(const Confirmation &c) {
  const std::string passes =
      c.passes == 0 ? "" : fmt::format(" in {} pass{}", c.passes, c.passes == 1 ? "" : "es");
  return fmt::format("{} runs{}: {:.0f} %, porosity {} %, cracked {} %", c.predicted.runs, passes,
                     kPercent * c.chance.all, band_text(c.predicted.after[0], 1),
                     band_text(c.predicted.cracked[0], 0));
}

json row_of(const Design &d, const Setting &set) {
  const Chance &best = d.chances[d.best];
  json row = {{"film", d.film.name},
              {"at", fmt::format("{:.{}f}", best.at, set.decimals)},
              {"probability", fmt::format("{:.0f}", kPercent * best.all)},
              {"assured", fmt::format("{:.0f}", kPercent * best.assured)},
              {"porosity", band_text(d.predicted.after[d.best], 1)},
              {"cracked", band_text(d.predicted.cracked[d.best], 0)}};
  if (!d.predicted.tortuosity.empty())
    row["tortuosity"] = band_text(d.predicted.tortuosity[d.best], 2, 1.0);
  row["confirmed"] = json::array();
  for (const Confirmation &c : d.confirmed)
    row["confirmed"].push_back(confirmed_text(c));
  return row;
}

/// The probability of meeting the target: its mean, and what four of five materials reach.
Chart chance_chart(const std::vector<Design> &designs, const Setting &set) {
  Chart chart =
      chart_of("chance", "Probability of meeting the target", "Probability (%)", set.axis);
  chart.note = fmt::format("Dashed: what four of five materials reach, by which the {} is chosen.",
                           set.name);
  for (std::size_t k = 0; k < designs.size(); ++k) {
    std::vector<double> at, both, assured;
    for (const Chance &c : designs[k].chances) {
      at.push_back(c.at);
      both.push_back(kPercent * c.all);
      assured.push_back(kPercent * c.assured);
    }
    const std::string colour = kSeriesColours[k % kSeriesColours.size()];
    chart.series.push_back(line_of(designs[k].film.name, at, both, colour));
    chart.series.back().symbol = kSeriesSymbols[k % kSeriesSymbols.size()];
    chart.series.push_back(line_of("", at, assured, colour));
    chart.series.back().dash = "4 3";
  }
  return chart;
}

bool all_have_tortuosity(const std::vector<Design> &designs) {
  return std::none_of(designs.begin(), designs.end(),
                      [](const Design &d) { return d.predicted.tortuosity.empty(); });
}

/// A number against porosity, along the pressures or gaps.
Chart against_porosity(const std::vector<Design> &designs, const Setting &set, const char *id,
                       const char *title, const char *label,
                       const std::vector<Band> PredictedFilm::*bands, double scale) {
  Chart chart = chart_of(id, title, label);
  chart.x_label = "Total porosity after release (%)";
  chart.note = fmt::format("{} Porosity: median; the other: median and intervals.", set.direction);
  for (std::size_t k = 0; k < designs.size(); ++k) {
    const PredictedFilm &p = designs[k].predicted;
    const std::vector<double> porosity = part_of(p.after, &Band::median, kPercent);
    if (designs.size() == 1)
      add_bands(porosity, p.*bands, scale, kSeriesColours[0], chart);
    else
      add_edges(designs[k].film.name, porosity, p.*bands, scale, k, chart);
  }
  return chart;
}

} // namespace

std::string design_page(const Target &t, SetBy by, const std::vector<Design> &designs,
                        const Json &json_of) {
  const Setting set = setting_of(by);
  report::Page page{kDesignHtml, json_of};
  page.charts = {chance_chart(designs, set),
                 against_porosity(designs, set, "cracks", "Cracks against porosity",
                                  "Cracked particles (%)", &PredictedFilm::cracked, kPercent)};
  if (all_have_tortuosity(designs))
    page.charts.push_back(
        against_porosity(designs, set, "tortuosity", "Tortuosity against porosity",
                         "Tortuosity factor through the plane", &PredictedFilm::tortuosity, 1.0));
  json rows = json::array(), notes = json::array();
  for (const Design &d : designs) {
    rows.push_back(row_of(d, set));
    for (const std::string &text : d.predicted.beyond)
      notes.push_back(d.film.name + ": " + text + ".");
  }
  page.values = {
      {"rows", rows},
      {"notes", notes},
      {"any_notes", !notes.empty()},
      {"setting", set.name},
      {"unit", set.unit},
      {"by_runs", designs.front().predicted.runs > 0
                      ? json(fmt::format("{}", designs.front().predicted.runs))
                      : json()},
      {"any_confirmed", std::any_of(designs.begin(), designs.end(),
                                    [](const Design &d) { return !d.confirmed.empty(); })},
      {"any_tortuosity", all_have_tortuosity(designs)},
      {"porosity", fmt::format("{:g}", kPercent * t.porosity)},
      {"within", fmt::format("{:g}", kPercent * t.within)},
      {"cracked_below",
       t.cracked_below < 1.0 ? json(fmt::format("{:g}", kPercent * t.cracked_below)) : json()},
      {"tortuosity_below", t.tortuosity_below < kMostTortuosity
                               ? json(fmt::format("{:g}", t.tortuosity_below))
                               : json()}};
  return report::to_html(page);
}

} // namespace calendem
