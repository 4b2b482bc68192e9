// SPDX-License-Identifier: GPL-2.0-or-later
// A bank's runs as the emulator learns them: films, materials and effects as scaled numbers, and what
// each press left of a film.
#ifndef CALENDEM_BANK_TRAINING_H
#define CALENDEM_BANK_TRAINING_H

#include "bank/runs.h"
#include "inference/emulator.h"
#include "inference/quantities.h"

namespace calendem {

/// Numbers of a pressed film, 0-1 but for the modulus.
enum class FilmNumber {
  PorosityAfter, ///< total porosity after release
  Springback,    ///< (thickness after - at the maximum) / thickness at the maximum
  Cracked,       ///< share of NMC particles in pieces
  /// ln of the unloading modulus in GPa: secant of stress over strain of the thickness at the
  /// maximum, from 90 to 50 % of the largest pressure.
  LogModulus,
  Broken, ///< share of the bonds, after release
  /// 1 / tortuosity factor of the macropores through the plane, after release; 0: no path.
  InverseTortuosity,
  CbdNanoporosity ///< of the carbon-binder domain, after release
};
constexpr int kFilmNumbers = 7;

} // namespace calendem

namespace calendem::bank {

/// Value of a press; NaN: not known.
double value_of(FilmNumber number, const PressedFilm &film);

/// Prior of a quantity of film or material, or of an effect's amplitude.
inference::Parameter parameter_of(const Input &input);

/// Which of a bank's inputs are quantities and which effects, in the order in which emulators take
/// them. The last amplitude is that of the larger cell.
struct Space {
  explicit Space(const Bank &bank);

  std::vector<int> quantities, effects;         ///< places in Design::inputs
  std::vector<inference::Parameter> priors;     ///< of the quantities
  std::vector<inference::Parameter> amplitudes; ///< of the effects
};

/// Pressures of the case's presses [MPa]. Throws Failure(2) where these are fewer than three.
std::vector<double> pressures_of(const Bank &bank);

/// Output of a number after the press to the k-th of `pressures`.
inline int output_of(FilmNumber number, std::size_t k, std::size_t pressures) {
  return int(number) * int(pressures) + int(k);
}

/// Pressures at which the compression under load is an output [MPa].
const std::vector<double> &loading_pressures();
/// Compression at the k-th of them: displacement over the thickness before.
inline int loading_output(std::size_t k, std::size_t pressures) {
  return kFilmNumbers * int(pressures) + int(k);
}
/// Places in kReleasedTo of the releases that are outputs.
inline constexpr std::array<std::size_t, 5> kReleases = {1, 3, 5, 7, 9};
/// What is recovered from the k-th of `pressures` to the j-th of these, over the thickness at the
/// maximum.
inline int release_output(std::size_t k, std::size_t j, std::size_t pressures) {
  return loading_output(loading_pressures().size(), pressures) + int(k * kReleases.size() + j);
}
inline int count_of_outputs(std::size_t pressures) {
  return release_output(pressures, 0, pressures);
}

inference::TrainingRuns training_of(const Runs &runs);

/// The emulator with the hyperparameters that a file beside the table keeps; where there is none, or
/// it is of another table, they are fitted and written there if that can be done.
inference::Emulator emulator_of(const Runs &runs, const std::string &table);

} // namespace calendem::bank

#endif
