// SPDX-License-Identifier: GPL-2.0-or-later
// The gap at which a roll carries a given line load. A mill sets the force and its roll floats; on
// an endless web force and gap are steady, so the gap is the one whose passage carries the load. A
// cell sees its own passage only, and what the load will be is known when it is over: passages are
// tried, each from the electrode as packed, until the load agrees. A trial is a run at a gap in
// every respect; the last one is the result.
#ifndef CALENDEM_SIMULATE_ROLLING_H
#define CALENDEM_SIMULATE_ROLLING_H

#include "simulate/collect.h"

namespace calendem {

constexpr int kMostTrials = 12;

/// The last pass of a run at `gap`.
struct TrialPassage {
  double gap = 0.0;       ///< set [um]
  double line_load = 0.0; ///< [N/mm]
  double touch = 0.0;     ///< gap at which the film is met [um]
};

/// The gap to try next, from the nearest on both sides: a film's load grows about exponentially.
/// Where one side is missing, from `touch`, where the film carries nothing and its load begins as
/// the square of the depth. Stays above `lowest`, and goes at most half of the way there at once.
/// Breaks scatter the loads of single runs: where a narrower gap carried less, the runs count as
/// their mean. One run that carried by chance what others of its kind do not, misleads nobody.
double next_gap(const std::vector<TrialPassage> &done, double asked, double lowest);

/// The trials in a folder so far, kept in it as rehearsals.csv, and the gap of the next one.
class LineLoadSearch {
public:
  /// `lowest` [um]: no film can be thinner. Without `resume` what is in the folder does not count.
  LineLoadSearch(const std::string &folder, const Settings &asked, double lowest, bool resume);

  /// The case of the next run.
  const Settings &settings() const { return now_; }
  /// Looks at the run that has ended; true if another is needed and may help, for which the folder
  /// is made ready.
  bool next_trial_needed();

private:
  std::string file_, folder_;
  Settings now_;
  double asked_, lowest_;
  std::vector<TrialPassage> done_;

  void set_gap();
};

/// Trials that were not the last, for summary.json.
nlohmann::json rehearsals_in(const std::string &folder);

/// What is wrong; "" when the last pass carries what was asked for, or nothing was.
std::string line_load_missed(const std::vector<RawRow> &rows, const Settings &settings);

} // namespace calendem

#endif
