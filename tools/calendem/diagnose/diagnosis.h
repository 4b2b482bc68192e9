// SPDX-License-Identifier: GPL-2.0-or-later
// The diagnosis of one experiment: what the bank's emulator, its posterior and the rule of the
// inference (inference/changes.h) say of it. Numbers only.
#ifndef CALENDEM_DIAGNOSE_DIAGNOSIS_H
#define CALENDEM_DIAGNOSE_DIAGNOSIS_H

#include "films/film_problem.h"
#include "inference/changes.h"
#include "inference/fitted_model.h"
#include "inference/further_data.h"
#include "predict/calibration.h"

namespace calendem {

struct DiagnosisOptions {
  std::vector<std::string> acting;    ///< effects of the user's model
  const Calibration *prior = nullptr; ///< what other films taught; none
  int particles = 256;                ///< of the sampler
};

/// Readings that were not made but could be, together.
struct FurtherMeasurement {
  std::string observable, unit;
  double pressure = 0.0; ///< largest [MPa]
  double sd = 0.0;       ///< of the reading
  inference::ExpectedGain gain;
};

struct Diagnosis {
  std::string experiment;
  std::vector<std::string> outside;  ///< in what the data lie outside the bank; empty: in nothing
  std::vector<std::string> warnings; ///< what is left out or assumed
  MeasuredFilms measured;
  FilmProblem of;                       ///< asks `measured` and the bank
  int film = 0;                         ///< the experiment's, the last
  std::vector<int> readings;            ///< of the film, places in `measured`
  std::vector<inference::Block> blocks; ///< of the film's readings among all data
  inference::Posterior posterior;
  inference::Changes changes;
  std::vector<inference::ChangeSet> sets; ///< that reach 95 %
  double adequacy = 0.0;
  inference::Verdict verdict;
  std::vector<int> leading; ///< changes of the leading hypothesis; empty: none
  double now = 0.0;         ///< expected probability of the right set without a further measurement
  inference::FittedModel model, explained; ///< the user's, and with the leading hypothesis
  inference::ResidualTable where;          ///< of the user's model, recalibrated
  std::vector<FurtherMeasurement> further; ///< the most telling first
};

/// Place of a film's first reading among all data.
Eigen::Index first_datum(const Diagnosis &diagnosis);

/// "friction", "no friction", "noise", "unknown".
std::string name_of(const Diagnosis &diagnosis, int change);

/// The bank has to outlive it. Throws Failure(2) as add_readings.
Diagnosis diagnosed(const Experiment &experiment, const FilmBank &bank,
                    const DiagnosisOptions &options);

/// Measurements of the experiment's film at the bank's pressures that were not made, without gains;
/// `readings`: adds what each reads, and its places.
std::vector<FurtherMeasurement> further_measurements(const Experiment &experiment,
                                                     const FilmBank &bank,
                                                     const MeasuredFilms &measured, int film,
                                                     MeasuredFilms &with,
                                                     std::vector<std::vector<int>> &places);

/// By how much the error of a curve's first contact shifts each reading of the film, as a model's
/// errors and residuals let it be expected. All readings of a condition's curve share the error.
inference::Vector fitted_zeros(const Diagnosis &diagnosis, const inference::FittedModel &model);

/// gap.json without hashes of files (docs/reference/gap.md).
nlohmann::ordered_json to_json(const Diagnosis &diagnosis, const FilmBank &bank);

/// Adds to gap.json what a reader is told: "headline", "meaning", "next" of "which"; "in_words" of
/// "shrink"; "said".
void put_in_words(nlohmann::ordered_json &gap);

/// gap.html of gap.json; it computes nothing.
std::string diagnosis_page(const nlohmann::ordered_json &gap);

} // namespace calendem

#endif
