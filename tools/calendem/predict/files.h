// SPDX-License-Identifier: GPL-2.0-or-later
// What calibrate, predict and design write: model.json, the case, tables and pages. model.json names
// the bank by its files and their hashes; it does not hold it.
#ifndef CALENDEM_PREDICT_FILES_H
#define CALENDEM_PREDICT_FILES_H

#include "predict/by_gap.h"
#include "predict/own_runs.h"
#include <nlohmann/json.hpp>
#include <optional>

namespace calendem {

/// model.json, to be written into `folder`; `left_out` may be empty.
nlohmann::ordered_json to_json(const FilmBank &bank, const Calibration &calibration,
                               const std::vector<LeftOut> &left_out, const std::string &folder);

/// In model.json.
const char *name_of(FilmNumber number);
/// A number that is read of films, by its name there.
const char *reading_in_words(const std::string &name);

/// Rows of "confirmed" of model.json.
nlohmann::ordered_json to_json(const std::vector<Confirmed> &rows);

/// How that case begins.
inline constexpr const char *kHeadOfCase = "# The most probable material of a calibration";

/// A case.toml of one of the materials: the middle of the draws of the most probable hypothesis.
std::string case_of(const FilmBank &bank, const Calibration &calibration, std::size_t material);

/// The other files that a bank reads: recipes, cases, crushed particles.
std::vector<std::string> files_beside(const bank::Bank &spec);

struct Model {
  FilmBank bank;
  Calibration calibration;
  nlohmann::ordered_json json; ///< of the file
};
/// Throws Failure(2): a file that is missing, cut or no model, or a bank that has changed.
Model read_model(const std::string &file);

/// Predictions at all draws for every film that the model was calibrated on, and the page.
std::string model_page(const FilmBank &bank, const Calibration &calibration,
                       const nlohmann::ordered_json &model);

/// A row for each film and pressure; percent and MPa.
std::string prediction_table(const FilmBank &bank, const std::vector<PredictedFilm> &films);
nlohmann::ordered_json to_json(const FilmBank &bank, const std::vector<PredictedFilm> &films);
std::string prediction_page(const Calibration &calibration, const std::vector<PredictedFilm> &films,
                            const nlohmann::ordered_json &json);

/// A proposal by runs of its own.
struct Confirmation {
  int passes = 0; ///< under a roll; 0: under a platen
  PredictedFilm predicted;
  Chance chance;
};

/// What a film's pressures offer, or its gaps.
struct Design {
  Film film;
  std::vector<Chance> chances;
  PredictedFilm predicted; ///< at the same pressures or gaps
  std::size_t best = 0;    ///< as best_of
  std::vector<Confirmation> confirmed;
};
enum class SetBy { Pressure, Gap };
nlohmann::ordered_json to_json(const FilmBank &bank, const Target &target, SetBy set_by,
                               const std::vector<Design> &designs);
std::string design_page(const Target &target, SetBy set_by, const std::vector<Design> &designs,
                        const nlohmann::ordered_json &json);

/// Pressure, porosity and cracked particles of films against the gap: a row for each film and gap
/// [percent, um, MPa], the same as JSON, and the page.
std::string gap_table(const FilmBank &bank, const std::vector<Film> &films,
                      const std::vector<std::vector<AtGap>> &at);
nlohmann::ordered_json gap_json(const FilmBank &bank, const Film &film,
                                const std::vector<AtGap> &at);
std::string gap_page(const std::vector<Film> &films, const std::vector<std::vector<AtGap>> &at,
                     const nlohmann::ordered_json &json);

} // namespace calendem

#endif
