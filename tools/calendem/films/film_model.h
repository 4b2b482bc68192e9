// SPDX-License-Identifier: GPL-2.0-or-later
// One film's readings for the inference: what the bank's emulator predicts of them, and every error of
// readings, press, emulator and packings.
#ifndef CALENDEM_FILMS_FILM_MODEL_H
#define CALENDEM_FILMS_FILM_MODEL_H

#include "films/film_readings.h"

namespace calendem {

/// Readings whose errors of the model are alike at like pressures.
std::string kind_of(const Observable &observable);
/// Pressure at which it was read, or that the film was pressed to [MPa].
double pressure_of(const Reading &reading);

class FilmModel {
public:
  /// Correlations are those at the material `middle`. `cells`: how many of the bank's the sample is as
  /// large as; 0: very many.
  FilmModel(const FilmBank &bank, const Film &film, const std::vector<Reading> &readings,
            double cells, const Material &middle);

  inference::FilmData data(const ModelError &error, double sizes) const;
  inference::FilmPredictions predict(const std::vector<Material> &materials,
                                     const std::vector<PressInstruments> &presses) const;
  inference::Vector per_porosity() const { return readings_.per_porosity(outputs_); }

private:
  FilmReadings readings_;
  double cells_;
  inference::Matrix correlation_;                 ///< between `used_`
  inference::Matrix slopes_;                      ///< data x `used_`
  inference::Matrix emulator_, scatter_;          ///< correlations of their errors between data
  inference::Vector outputs_;                     ///< at the middle
  std::vector<int> used_;                         ///< outputs on which any reading depends
  std::vector<std::vector<Eigen::Index>> places_; ///< places in them on which each depends

  double variance(Eigen::Index reading, const inference::Vector &sd) const;
};

} // namespace calendem

#endif
