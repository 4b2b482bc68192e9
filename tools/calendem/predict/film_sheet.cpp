// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/film_sheet.h"
#include "predict/film_charts.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {

using Json = nlohmann::ordered_json;
using report::Chart;
using report::kSeriesColours;

namespace {

/// A text cell (RFC 4180).
std::string quoted(const std::string &text) {
  std::string out = "\"";
  for (const char c : text)
    out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

constexpr std::size_t kMostFilms = 6; // in a chart

const FilmQuantity
    kAfter = {"porosity_after_percent", "Total porosity after release (%)", "Porosity after, %",
              kPercent, 1},
    kUnderLoad = {"porosity_under_load_percent", "Total porosity under load (%)", "Under load, %",
                  kPercent, 1},
    kSpringback = {"springback_percent", "Springback of the thickness (%)", "Springback, %",
                   kPercent, 1},
    kCracked = {"cracked_percent", "Cracked particles (%)", "Cracked, %", kPercent, 0},
    kModulus = {"unloading_modulus_GPa", "Unloading modulus (GPa)", "Modulus, GPa", 1.0, 2},
    kBroken = {"broken_bonds_percent", "Broken bonds (%)", "Broken bonds, %", kPercent, 1},
    kTortuosity = {"tortuosity_through_plane", "Tortuosity factor of the pores, through the plane",
                   "Tortuosity factor", 1.0, 2},
    kCbdPores = {"cbd_nanoporosity_percent", "Nanoporosity of carbon and binder after release (%)",
                 "Nanoporosity, %", kPercent, 0},
    kPressure = {"pressure_MPa", "Pressure (MPa)", "Pressure, MPa", 1.0, 0},
    kThickness = {"thickness_after_um", "Thickness after release (µm)", "Thickness after, µm", 1.0,
                  1};

/// Leaves out the quantities that one of the films lacks.
FilmSheet only_known(FilmSheet sheet) {
  for (std::size_t q = sheet.quantities.size(); q-- > 0;) {
    const bool known = std::all_of(sheet.films.begin(), sheet.films.end(), [&](const FilmRows &f) {
      return f.bands[q].size() == f.at.size();
    });
    if (known)
      continue;
    sheet.quantities.erase(sheet.quantities.begin() + std::ptrdiff_t(q));
    for (FilmRows &f : sheet.films)
      f.bands.erase(f.bands.begin() + std::ptrdiff_t(q));
  }
  return sheet;
}

} // namespace

FilmSheet sheet_of(const std::vector<PredictedFilm> &films) {
  FilmSheet out = {
      "pressure_MPa",
      "Pressure (MPa)",
      {kAfter, kUnderLoad, kSpringback, kCracked, kModulus, kBroken, kTortuosity, kCbdPores},
      {},
      {}};
  for (const PredictedFilm &f : films)
    out.films.push_back({f.film,
                         f.pressures,
                         {f.after, f.under_load, f.springback, f.cracked, f.modulus, f.broken,
                          f.tortuosity, f.cbd_nanoporosity}});
  return only_known(out);
}

FilmSheet sheet_of(const std::vector<Film> &films, const std::vector<std::vector<AtGap>> &at) {
  FilmSheet out = {"gap_um",
                   "Gap (µm)",
                   {kPressure, kAfter, kThickness, kSpringback, kCracked, kBroken, kTortuosity},
                   {"pressure_below_percent", "pressure_above_percent"},
                   {}};
  for (std::size_t f = 0; f < films.size(); ++f) {
    FilmRows rows = {films[f], {}, std::vector<std::vector<Band>>(out.quantities.size()), {{}, {}}};
    for (const AtGap &row : at[f]) {
      rows.at.push_back(row.gap);
      std::size_t q = 0;
      for (const Band &b :
           {row.pressure, row.after, row.thickness_after, row.springback, row.cracked})
        rows.bands[q++].push_back(b);
      for (const std::optional<Band> &b : {row.broken, row.tortuosity}) {
        if (b)
          rows.bands[q].push_back(*b);
        ++q;
      }
      rows.further[0].push_back(kPercent * row.below);
      rows.further[1].push_back(kPercent * row.above);
    }
    out.films.push_back(rows);
  }
  return only_known(out);
}

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

std::string table_of(const FilmBank &bank, const FilmSheet &sheet) {
  std::string out = "film";
  for (const bank::Input &p : bank.film())
    out += "," + p.name;
  out += "," + sheet.at_name;
  for (const std::string &name : sheet.further)
    out += "," + name;
  for (const FilmQuantity &q : sheet.quantities)
    for (const char *part : {"median", "low50", "high50", "low90", "high90"})
      out += fmt::format(",{}_{}", q.name, part);
  out += "\n";
  for (const FilmRows &f : sheet.films)
    for (std::size_t k = 0; k < f.at.size(); ++k) {
      out += quoted(f.film.name);
      for (const double x : f.film.recipe)
        out += fmt::format(",{:g}", x);
      out += fmt::format(",{:g}", f.at[k]);
      for (const std::vector<double> &values : f.further)
        out += fmt::format(",{:.3g}", values[k]);
      for (std::size_t q = 0; q < sheet.quantities.size(); ++q) {
        const Band &b = f.bands[q][k];
        for (const double x : {b.median, b.low50, b.high50, b.low90, b.high90})
          out += fmt::format(",{:.4g}", sheet.quantities[q].scale * x);
      }
      out += "\n";
    }
  return out;
}

Json rows_json(const FilmSheet &sheet, const FilmRows &film) {
  Json out = Json::array();
  for (std::size_t k = 0; k < film.at.size(); ++k) {
    Json row = {{sheet.at_name, film.at[k]}};
    for (std::size_t n = 0; n < sheet.further.size(); ++n)
      row[sheet.further[n]] = film.further[n][k];
    for (std::size_t q = 0; q < sheet.quantities.size(); ++q)
      row[sheet.quantities[q].name] = band_json(film.bands[q][k], sheet.quantities[q].scale);
    out.push_back(row);
  }
  return out;
}

std::vector<Chart> charts_of(const FilmSheet &sheet) {
  std::vector<Chart> out;
  const std::size_t count = sheet.films.size();
  for (std::size_t q = 0; q < sheet.quantities.size(); ++q) {
    const FilmQuantity &of = sheet.quantities[q];
    Chart chart = chart_of(of.name, of.title, of.title);
    chart.x_label = sheet.at_label;
    if (count == 1)
      add_bands(sheet.films[0].at, sheet.films[0].bands[q], of.scale, kSeriesColours[0], chart);
    for (std::size_t k = 0; k < count && count > 1 && k < kMostFilms; ++k)
      add_edges(sheet.films[k].film.name, sheet.films[k].at, sheet.films[k].bands[q], of.scale, k,
                chart);
    if (count > 1)
      chart.note = "Dashed: the ends of the 90 % intervals.";
    if (count > kMostFilms)
      chart.note += fmt::format(" The first {} of {} films; the table has all.", kMostFilms, count);
    out.push_back(chart);
  }
  return out;
}

nlohmann::json page_rows(const FilmSheet &sheet) {
  nlohmann::json rows = nlohmann::json::array();
  for (const FilmRows &f : sheet.films)
    for (std::size_t k = 0; k < f.at.size(); ++k) {
      nlohmann::json row = {{"film", f.film.name}, {"at", fmt::format("{:.4g}", f.at[k])}};
      for (std::size_t q = 0; q < sheet.quantities.size(); ++q) {
        const FilmQuantity &of = sheet.quantities[q];
        const Band &b = f.bands[q][k];
        row["cells"].push_back(fmt::format("{0:.{3}f} ({1:.{3}f} to {2:.{3}f})",
                                           of.scale * b.median, of.scale * b.low90,
                                           of.scale * b.high90, of.decimals));
      }
      rows.push_back(row);
    }
  return rows;
}

std::vector<std::string> heads_of(const FilmSheet &sheet, const std::string &at) {
  std::vector<std::string> out = {at};
  for (const FilmQuantity &q : sheet.quantities)
    out.push_back(q.head);
  return out;
}

} // namespace calendem
