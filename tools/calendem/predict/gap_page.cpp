// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/files.h"
#include "predict/film_charts.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {

extern const char *const kPredictionHtml;

namespace {

using Json = nlohmann::ordered_json;
using nlohmann::json;
using report::Chart;
using report::kSeriesColours;

constexpr std::size_t kMostFilms = 6; // in a chart

struct Column {
  const char *name, *title;
  Band AtGap::*band;
  double scale;
  int decimals; ///< in the table of the page
};
constexpr Column kColumns[] = {
    {"pressure_MPa", "Pressure (MPa)", &AtGap::pressure, 1.0, 0},
    {"porosity_after_percent", "Total porosity after release (%)", &AtGap::after, kPercent, 1},
    {"thickness_after_um", "Thickness after release (µm)", &AtGap::thickness_after, 1.0, 1},
    {"springback_percent", "Springback of the thickness (%)", &AtGap::springback, kPercent, 1},
    {"cracked_percent", "Cracked particles (%)", &AtGap::cracked, kPercent, 0}};

std::vector<double> gaps_of(const std::vector<AtGap> &at) {
  std::vector<double> out;
  for (const AtGap &row : at)
    out.push_back(row.gap);
  return out;
}

std::vector<Band> bands_of(const std::vector<AtGap> &at, const Column &column) {
  std::vector<Band> out;
  for (const AtGap &row : at)
    out.push_back(row.*column.band);
  return out;
}

} // namespace

std::string gap_table(const FilmBank &bank, const std::vector<Film> &films,
                      const std::vector<std::vector<AtGap>> &at) {
  std::string out = "film";
  for (const BankParameter &p : bank.film())
    out += "," + p.name;
  out += ",gap_um,pressure_below_percent,pressure_above_percent";
  for (const Column &column : kColumns)
    for (const char *part : {"median", "low50", "high50", "low90", "high90"})
      out += fmt::format(",{}_{}", column.name, part);
  out += "\n";
  for (std::size_t f = 0; f < films.size(); ++f)
    for (const AtGap &row : at[f]) {
      out += "\"" + films[f].name + "\"";
      for (const double x : films[f].recipe)
        out += fmt::format(",{:g}", x);
      out +=
          fmt::format(",{:g},{:.3g},{:.3g}", row.gap, kPercent * row.below, kPercent * row.above);
      for (const Column &column : kColumns) {
        const Band &b = row.*column.band;
        for (const double x : {b.median, b.low50, b.high50, b.low90, b.high90})
          out += fmt::format(",{:.4g}", column.scale * x);
      }
      out += "\n";
    }
  return out;
}

Json gap_json(const FilmBank &bank, const Film &film, const std::vector<AtGap> &at) {
  Json out = film_json(bank, film);
  out["beyond"] = bank.beyond(film);
  out["predicted"] = Json::array();
  for (const AtGap &row : at) {
    Json of = {{"gap_um", row.gap},
               {"pressure_below_the_banks", row.below},
               {"pressure_above_the_banks", row.above}};
    for (const Column &column : kColumns)
      of[column.name] = band_json(row.*column.band, column.scale);
    out["predicted"].push_back(of);
  }
  return out;
}

std::string gap_page(const std::vector<Film> &films, const std::vector<std::vector<AtGap>> &at,
                     const Json &json_of) {
  report::Page page{kPredictionHtml, json_of};
  for (const Column &column : kColumns) {
    Chart chart = chart_of(column.name, column.title, column.title);
    chart.x_label = "Gap (µm)";
    if (films.size() == 1)
      add_bands(gaps_of(at[0]), bands_of(at[0], column), column.scale, kSeriesColours[0], chart);
    for (std::size_t k = 0; k < films.size() && films.size() > 1 && k < kMostFilms; ++k)
      add_edges(films[k].name, gaps_of(at[k]), bands_of(at[k], column), column.scale, k, chart);
    if (films.size() > 1)
      chart.note = "Dashed: the ends of the 90 % intervals.";
    if (films.size() > kMostFilms)
      chart.note +=
          fmt::format(" The first {} of {} films; the table has all.", kMostFilms, films.size());
    page.charts.push_back(chart);
  }
  json rows = json::array(), basis = json::array();
  for (std::size_t f = 0; f < films.size(); ++f)
    for (const AtGap &row : at[f]) {
      json of = {{"film", films[f].name}, {"at", fmt::format("{:.4g}", row.gap)}};
      for (const Column &column : kColumns) {
        const Band &b = row.*column.band;
        of["cells"].push_back(fmt::format("{0:.{3}f} ({1:.{3}f} to {2:.{3}f})",
                                          column.scale * b.median, column.scale * b.low90,
                                          column.scale * b.high90, column.decimals));
      }
      rows.push_back(of);
      if (std::max(row.below, row.above) >= 0.01)
        basis.push_back(
            fmt::format("{}, {:.4g} µm: with {:.0f} % the pressure lies outside the bank's; its "
                        "interval ends there.",
                        films[f].name, row.gap, kPercent * (row.below + row.above)));
    }
  for (const Json &film : json_of.at("films"))
    for (const Json &text : film.at("beyond"))
      basis.push_back(film.at("name").get<std::string>() + ": " + text.get<std::string>() + ".");
  basis.push_back(
      "The gap is that of rigid rolls, less the foil. Rolls, bearings and press give way "
      "under load: the gap to be set is smaller by that much.");
  basis.push_back(
      "The porosity after release follows from gap and springback alone; the pressure that "
      "it takes, from the bank. Springback was not measured on these films: these "
      "intervals are valid only if the model is right.");
  page.values = {{"title", "Prediction at a gap"},
                 {"subtitle",
                  "Films that were not measured, against the gap: the thickness of the "
                  "coating under load, without foil. The 50 and 90 % intervals include "
                  "the uncertainty of the parameters, the model error, the emulators and "
                  "the numerics of the bank."},
                 {"against", "Against the gap"},
                 {"heads",
                  {"Gap, µm", "Pressure, MPa", "Porosity after, %", "Thickness after, µm",
                   "Springback, %", "Cracked, %"}},
                 {"rows", rows},
                 {"basis", basis}};
  return report::to_html(page);
}

} // namespace calendem
