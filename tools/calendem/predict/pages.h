// SPDX-License-Identifier: GPL-2.0-or-later
// Pages and tables of what was calibrated, predicted and chosen.
#ifndef CALENDEM_PREDICT_PAGES_H
#define CALENDEM_PREDICT_PAGES_H

#include "predict/model_file.h"
#include <optional>

namespace calendem {

/// Predictions at all draws for every film that the model was calibrated on, and the page.
std::string model_page(const FilmBank &bank, const Calibration &calibration,
                       const nlohmann::ordered_json &model);

/// A row for each film and pressure; percent and MPa.
std::string prediction_table(const FilmBank &bank, const std::vector<PredictedFilm> &films);
nlohmann::ordered_json to_json(const FilmBank &bank, const std::vector<PredictedFilm> &films);
std::string prediction_page(const Calibration &calibration, const std::vector<PredictedFilm> &films,
                            const nlohmann::ordered_json &json);

/// What a film's pressures offer.
struct Design {
  Film film;
  std::vector<Chance> chances;
  PredictedFilm predicted;                ///< at the same pressures
  std::size_t best = 0;                   ///< as best_of
  std::optional<PredictedFilm> confirmed; ///< by runs of its own at that pressure
  Chance confirmed_chance;
};
nlohmann::ordered_json to_json(const FilmBank &bank, const Target &target,
                               const std::vector<Design> &designs);
std::string design_page(const Target &target, const std::vector<Design> &designs,
                        const nlohmann::ordered_json &json);

} // namespace calendem

#endif
