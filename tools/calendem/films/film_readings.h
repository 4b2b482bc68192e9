// SPDX-License-Identifier: GPL-2.0-or-later
// What the bank's emulator predicts of the readings of one film, as a press shows them.
#ifndef CALENDEM_FILMS_FILM_READINGS_H
#define CALENDEM_FILMS_FILM_READINGS_H

#include "films/emulated_run.h"
#include "films/film_problem.h"
#include <map>

namespace calendem {

/// Predicts the readings of one film. Outputs are those of outputs_of_runs.
class FilmReadings {
public:
  /// `bank` has to outlive it.
  FilmReadings(const FilmBank &bank, const Film &film, std::vector<Reading> readings);

  const std::vector<Reading> &readings() const { return readings_; }
  const std::vector<int> &outputs() const { return outputs_; }
  inference::Expectation emulated(const std::vector<const Material *> &materials,
                                  const std::vector<int> &outputs) const {
    return bank_.emulated(film_, materials, outputs);
  }

  struct Values {
    inference::Vector at, by_log_pressure; ///< with the film pressed more
  };
  Values values(const inference::Vector &outputs, const PressInstruments &press) const;
  /// Change of the readings by the outputs.
  inference::Matrix slopes(const inference::Vector &outputs) const;
  /// A derivative of each reading, by what `of` picks; 0 where it has none.
  inference::Vector derivatives(Derivative Observable::*of, const inference::Vector &outputs) const;
  /// What one of porosity is in each reading: how the model's discrepancy is weighed.
  inference::Vector per_porosity(const inference::Vector &outputs) const;

private:
  const FilmBank &bank_;
  Film film_;
  std::vector<Reading> readings_;
  std::vector<int> outputs_;
  std::map<double, std::pair<EmulatedRun, EmulatedRun>> runs_; ///< by pressure
};

} // namespace calendem

#endif
