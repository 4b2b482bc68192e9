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

std::string gap_table(const FilmBank &bank, const std::vector<Film> &films,
                      const std::vector<std::vector<AtGap>> &at) {
  return table_of(bank, sheet_of(films, at));
}

Json gap_json(const FilmBank &bank, const Film &film, const std::vector<AtGap> &at) {
  const FilmSheet sheet = sheet_of({film}, {at});
  Json out = film_json(bank, film);
  const int runs = at.empty() ? 0 : at.front().runs;
  out["beyond"] = beyond_at_gaps(bank, film, runs);
  out["by"] = runs == 0 ? Json("emulators") : Json{{"runs", runs}};
  out["predicted"] = rows_json(sheet, sheet.films[0]);
  return out;
}

std::string gap_page(const std::vector<Film> &films, const std::vector<std::vector<AtGap>> &at,
                     const Json &json_of) {
  const FilmSheet sheet = sheet_of(films, at);
  report::Page page{kPredictionHtml, json_of};
  page.charts = charts_of(sheet);
  json basis = json::array();
  for (std::size_t f = 0; f < films.size(); ++f)
    if (!at[f].empty() && at[f].front().runs > 0)
      basis.push_back(
          fmt::format("{}: from {} simulations under a roll at each gap, each with another draw of "
                      "the material and "
                      "on another packing. The emulators tell only what the model error changes.",
                      films[f].name, at[f].front().runs));
  for (std::size_t f = 0; f < films.size(); ++f)
    for (const AtGap &row : at[f])
      if (std::max(row.below, row.above) >= 0.01)
        basis.push_back(
            fmt::format("{}, {:.4g} µm: with {:.0f} % the pressure lies outside the bank's; its "
                        "interval ends there.",
                        films[f].name, row.gap, kPercent * (row.below + row.above)));
  for (const Json &film : json_of.at("films"))
    for (const Json &text : film.at("beyond"))
      basis.push_back(film.at("name").get<std::string>() + ": " + text.get<std::string>() + ".");
  basis.push_back(
      "The gap is that of rigid rolls, less the foil. Rolls, bearings and press give way "
      "under load: the gap to be set is smaller by that much.");
  basis.push_back(
      "The porosity after release follows from gap and springback alone; the pressure that "
      "it takes, from the porosity under load. Springback was not measured on these films: these "
      "intervals are valid only if the model is right.");
  page.values = {{"title", "Prediction at a gap"},
                 {"subtitle",
                  "Films that were not measured, against the gap: the thickness of the "
                  "coating under load, without foil. The 50 and 90 % intervals include "
                  "the uncertainty of the parameters, the model error, the emulators and "
                  "the numerics of the bank."},
                 {"against", "Against the gap"},
                 {"heads", heads_of(sheet, "Gap, µm")},
                 {"rows", page_rows(sheet)},
                 {"basis", basis}};
  return report::to_html(page);
}

} // namespace calendem
