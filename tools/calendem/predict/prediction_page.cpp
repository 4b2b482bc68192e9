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

struct Number {
  const char *name, *title;
  const std::vector<Band> PredictedFilm::*bands;
  double scale;
  int decimals; ///< in the table of the page
};
const std::vector<Number> &numbers() {
  static const std::vector<Number> all = {
      {"porosity_after_percent", "Total porosity after release (%)", &PredictedFilm::after,
       kPercent, 1},
      {"porosity_under_load_percent", "Total porosity under load (%)", &PredictedFilm::under_load,
       kPercent, 1},
      {"springback_percent", "Springback of the thickness (%)", &PredictedFilm::springback,
       kPercent, 1},
      {"cracked_percent", "Cracked particles (%)", &PredictedFilm::cracked, kPercent, 0},
      {"unloading_modulus_GPa", "Unloading modulus (GPa)", &PredictedFilm::modulus, 1.0, 2}};
  return all;
}

} // namespace

Json band_json(const Band &b, double scale) {
  return {{"median", scale * b.median},
          {"low50", scale * b.low50},
          {"high50", scale * b.high50},
          {"low90", scale * b.low90},
          {"high90", scale * b.high90}};
}

Json film_json(const FilmBank &bank, const Film &f) {
  Json out = {{"name", f.name}, {"loading_mg_cm2", f.loading}};
  for (std::size_t k = 0; k < f.recipe.size(); ++k)
    out[bank.film()[k].name] = f.recipe[k];
  return out;
}

std::string prediction_table(const FilmBank &bank, const std::vector<PredictedFilm> &films) {
  std::string out = "film";
  for (const BankParameter &p : bank.film())
    out += "," + p.name;
  out += ",pressure_MPa";
  for (const Number &n : numbers())
    for (const char *part : {"median", "low50", "high50", "low90", "high90"})
      out += fmt::format(",{}_{}", n.name, part);
  out += "\n";
  for (const PredictedFilm &f : films)
    for (std::size_t k = 0; k < f.pressures.size(); ++k) {
      out += "\"" + f.film.name + "\"";
      for (const double x : f.film.recipe)
        out += fmt::format(",{:g}", x);
      out += fmt::format(",{:g}", f.pressures[k]);
      for (const Number &n : numbers()) {
        const Band &b = (f.*n.bands)[k];
        for (const double x : {b.median, b.low50, b.high50, b.low90, b.high90})
          out += fmt::format(",{:.4g}", n.scale * x);
      }
      out += "\n";
    }
  return out;
}

Json to_json(const FilmBank &bank, const std::vector<PredictedFilm> &films) {
  Json out = Json::array();
  for (const PredictedFilm &f : films) {
    Json row = film_json(bank, f.film);
    row["beyond"] = f.beyond;
    row["by"] = f.runs == 0 ? Json("emulators") : Json{{"runs", f.runs}};
    row["predicted"] = Json::array();
    for (std::size_t k = 0; k < f.pressures.size(); ++k) {
      Json at = {{"pressure_MPa", f.pressures[k]}};
      for (const Number &n : numbers())
        at[n.name] = band_json((f.*n.bands)[k], n.scale);
      row["predicted"].push_back(at);
    }
    out.push_back(row);
  }
  return {{"films", out}};
}

namespace {

Chart number_chart(const Number &n, const Calibration &c, const std::vector<PredictedFilm> &films) {
  Chart chart = chart_of(n.name, n.title, n.title);
  if (films.size() == 1)
    add_bands(films[0].pressures, films[0].*n.bands, n.scale, kSeriesColours[0], chart);
  for (std::size_t k = 0; k < films.size() && films.size() > 1 && k < kMostFilms; ++k)
    add_edges(films[k].film.name, films[k].pressures, films[k].*n.bands, n.scale, k, chart);
  for (std::size_t f = 0; f < c.films.size() && n.bands == &PredictedFilm::after; ++f)
    if (films.size() == 1 && is_same_film(c.films[f], films[0].film))
      chart.series.push_back(points_of(c, int(f), kSeriesColours[5]));
  if (films.size() > 1)
    chart.note = "Dashed: the ends of the 90 % intervals.";
  if (films.size() > kMostFilms)
    chart.note +=
        fmt::format(" The first {} of {} films; the table has all.", kMostFilms, films.size());
  return chart;
}

/// A row for each film and pressure.
json rows_of(const std::vector<PredictedFilm> &films) {
  json rows = json::array();
  for (const PredictedFilm &f : films)
    for (std::size_t k = 0; k < f.pressures.size(); ++k) {
      json row = {{"film", f.film.name}, {"at", fmt::format("{:.3g}", f.pressures[k])}};
      for (const Number &n : numbers()) {
        const Band &b = (f.*n.bands)[k];
        row["cells"].push_back(fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", n.scale * b.median,
                                           n.decimals, n.scale * b.low90, n.decimals,
                                           n.scale * b.high90, n.decimals));
      }
      rows.push_back(row);
    }
  return rows;
}

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
  report::Page page{kPredictionHtml, json_of};
  for (const Number &n : numbers())
    page.charts.push_back(number_chart(n, c, films));
  const bool cracks = std::any_of(c.data.begin(), c.data.end(),
                                  [](const Datum &d) { return d.number == FilmNumber::Cracked; });
  json basis = basis_of(films);
  basis.push_back(
      fmt::format("{} not measured on these films: their intervals are valid only if "
                  "the model is right.",
                  cracks ? "Springback and modulus were" : "Springback, cracks and modulus were"));
  page.values = {{"title", "Prediction"},
                 {"subtitle",
                  "Films that were not measured, against the maximum pressure. The 50 and "
                  "90 % intervals include the uncertainty of the parameters, the model "
                  "error, the emulators, the numerics of the bank and the press."},
                 {"against", "Against pressure"},
                 {"heads",
                  {"MPa", "Porosity after, %", "Under load, %", "Springback, %", "Cracked, %",
                   "Modulus, GPa"}},
                 {"rows", rows_of(films)},
                 {"basis", basis}};
  return report::to_html(page);
}

} // namespace calendem
