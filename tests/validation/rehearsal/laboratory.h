// SPDX-License-Identifier: GPL-2.0-or-later
// Runs of a bank as films of a laboratory, and what the user's model of them has wrong.
#ifndef CALENDEM_TESTS_REHEARSAL_LABORATORY_H
#define CALENDEM_TESTS_REHEARSAL_LABORATORY_H

#include "base/experiment.h"
#include "base/random.h"
#include "films/film_bank.h"

namespace calendem {

/// What the user's model of a film has wrong.
struct Truth {
  enum Kind { none, absent, single, pair }; ///< absent: the model has an effect that does not act
  Kind kind = none;
  std::vector<std::string> acting;  ///< in the model
  std::vector<std::string> changes; ///< as name_of a diagnosis has them
};
inline constexpr const char *kKinds[] = {"none", "absent", "single", "pair"};

/// A run as a laboratory reports it, pressed to about 50 and 150 MPa: porosity after within 0.3 points, cracked
/// particles within 3 %, curves within 0.05 um and counted from a first touch that is known to 1 um.
class Laboratory {
public:
  /// Files are written into `folder`; `bank` has to outlive it.
  Laboratory(const FilmBank &bank, std::string folder) : bank_(bank), folder_(std::move(folder)) {}
  Experiment measure(const bank::Run &run, std::uint64_t seed) const;
  /// model.toml, the case of the user's model: effects that act in the middle of the bank's range, the others off.
  void write_model(const Truth &truth) const;

private:
  const FilmBank &bank_;
  std::string folder_;

  std::string recipe_of(const bank::Run &run) const;
  std::string condition_of(const bank::Run &run, const bank::PressedFilm &press,
                           Random &random) const;
};

/// Two of each run: of none and absent, and of single and pair, by turns; which effect, by chance.
std::vector<Truth> truths_of(const bank::Bank &spec, const bank::Run &run, int turn);

} // namespace calendem

#endif
