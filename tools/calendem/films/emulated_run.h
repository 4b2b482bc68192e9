// SPDX-License-Identifier: GPL-2.0-or-later
// The run of a film to one pressure, as the bank's emulator predicts it: what a measurement is compared
// with.
#ifndef CALENDEM_FILMS_EMULATED_RUN_H
#define CALENDEM_FILMS_EMULATED_RUN_H

#include "compare/gap.h"
#include "films/film_bank.h"

namespace calendem {

/// Outputs of the bank's emulator from which a run is made: numbers after each press, compression under
/// load, releases.
std::vector<int> outputs_of_runs(const FilmBank &bank);

/// Makes runs of one film to one pressure. Between the bank's presses by `cubic_weights` in the
/// logarithm of the pressure.
class EmulatedRun {
public:
  EmulatedRun(const FilmBank &bank, const Film &film, double pressure);

  /// `outputs`: values of outputs_of_runs.
  SimulatedRun of(const inference::Vector &outputs) const;

private:
  double pressure_, porosity_before_, solid_column_;
  std::size_t presses_;
  inference::Vector by_press_;            ///< weights of the presses
  inference::Matrix by_loading_;          ///< points of the curve x outputs of the loading
  inference::Matrix by_release_;          ///< points of the curve x releases
  std::vector<double> loading_, release_; ///< pressures of the points, increasing

  double number(FilmNumber number, const inference::Vector &outputs) const;
};

/// The run as a press shows it.
SimulatedRun shown_by(const PressInstruments &press, const SimulatedRun &run);

} // namespace calendem

#endif
