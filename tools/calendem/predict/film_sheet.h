// SPDX-License-Identifier: GPL-2.0-or-later
// Predicted numbers of films against pressure or gap: the same table, JSON, charts and rows of a page
// for both.
#ifndef CALENDEM_PREDICT_FILM_SHEET_H
#define CALENDEM_PREDICT_FILM_SHEET_H

#include "predict/by_gap.h"
#include "report/page.h"
#include <nlohmann/json.hpp>

namespace calendem {

/// What a band is of, and how it is written.
struct FilmQuantity {
  std::string name;  ///< in files, with its unit
  std::string title; ///< of its chart
  std::string head;  ///< of its column on a page
  double scale = 1.0;
  int decimals = 0; ///< on a page
};

/// One film: a row for each pressure or gap.
struct FilmRows {
  Film film;
  std::vector<double> at;
  std::vector<std::vector<Band>> bands;       ///< by quantity, then row
  std::vector<std::vector<double>> further{}; ///< by FilmSheet::further, then row
};

struct FilmSheet {
  std::string at_name, at_label;        ///< of the rows: in files, on the axis
  std::vector<FilmQuantity> quantities; ///< those that are known of all films
  std::vector<std::string> further;     ///< names of single numbers in files
  std::vector<FilmRows> films;
};

FilmSheet sheet_of(const std::vector<PredictedFilm> &films);
FilmSheet sheet_of(const std::vector<Film> &films, const std::vector<std::vector<AtGap>> &at);

/// A row for each film and pressure or gap.
std::string table_of(const FilmBank &bank, const FilmSheet &sheet);
/// The rows of a film.
nlohmann::ordered_json rows_json(const FilmSheet &sheet, const FilmRows &film);

std::vector<report::Chart> charts_of(const FilmSheet &sheet);
/// {"film", "at", "cells"}; the cells are of `heads_of`.
nlohmann::json page_rows(const FilmSheet &sheet);
std::vector<std::string> heads_of(const FilmSheet &sheet, const std::string &at);

/// Name, loading and what the bank varies of a film.
nlohmann::ordered_json film_json(const FilmBank &bank, const Film &film);
nlohmann::ordered_json band_json(const Band &band, double scale);

} // namespace calendem

#endif
