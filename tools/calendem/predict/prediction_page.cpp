// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/files.h"
#include "predict/film_charts.h"
#include "predict/film_sheet.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {

extern const char *const kPredictionHtml;

using Json = nlohmann::ordered_json;
using nlohmann::json;
using report::kSeriesColours;

std::string prediction_table(const FilmBank &bank, const std::vector<PredictedFilm> &films) {
  return table_of(bank, sheet_of(films));
}

Json to_json(const FilmBank &bank, const std::vector<PredictedFilm> &films) {
  const FilmSheet sheet = sheet_of(films);
  Json out = Json::array();
  for (std::size_t k = 0; k < films.size(); ++k) {
    Json row = film_json(bank, films[k].film);
    row["beyond"] = films[k].beyond;
    row["by"] = films[k].runs == 0 ? Json("emulators") : Json{{"runs", films[k].runs}};
    row["predicted"] = rows_json(sheet, sheet.films[k]);
    out.push_back(row);
  }
  return {{"films", out}};
}

namespace {

/// How the films were predicted, and with what reservation.
json basis_of(const std::vector<PredictedFilm> &films) {
  json out = json::array();
  for (const PredictedFilm &f : films)
    for (const std::string &text : f.beyond)
      out.push_back(f.film.name + ": " + text + ".");
  bool by_emulators = false;
  for (const PredictedFilm &f : films) {
    by_emulators = by_emulators || f.runs == 0;
    if (f.runs > 0)
      out.push_back(fmt::format("{}: from {} simulations at each pressure, each with another draw "
                                "of the material and on another packing. Material and model error "
                                "are calibrated on measured films.",
                                f.film.name, f.runs));
  }
  if (by_emulators)
    out.push_back("Predicted by emulators of the bank's runs, calibrated on measured films.");
  return out;
}

} // namespace

std::string prediction_page(const Calibration &c, const std::vector<PredictedFilm> &films,
                            const Json &json_of) {
  const FilmSheet sheet = sheet_of(films);
  report::Page page{kPredictionHtml, json_of};
  page.charts = charts_of(sheet);
  for (std::size_t f = 0; f < c.films.size() && films.size() == 1; ++f)
    if (is_same_film(c.films[f], films[0].film)) // the first chart is of the porosity after
      page.charts[0].series.push_back(points_of(c, int(f), kSeriesColours[5]));
  const bool cracks = std::any_of(c.data.begin(), c.data.end(),
                                  [](const Datum &d) { return d.number == FilmNumber::Cracked; });
  json basis = basis_of(films);
  basis.push_back(
      fmt::format("{} not measured on these films: their intervals are valid only if the model is "
                  "right.",
                  cracks ? "Springback, modulus and tortuosity were"
                         : "Springback, cracks, modulus and tortuosity were"));
  page.values = {{"title", "Prediction"},
                 {"subtitle",
                  "Films that were not measured, against the maximum pressure. The 50 and "
                  "90 % intervals include the uncertainty of the parameters, the model "
                  "error, the emulators, the numerics of the bank and the press."},
                 {"against", "Against pressure"},
                 {"heads", heads_of(sheet, "MPa")},
                 {"rows", page_rows(sheet)},
                 {"basis", basis}};
  return report::to_html(page);
}

} // namespace calendem
