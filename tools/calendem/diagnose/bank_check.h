// SPDX-License-Identifier: GPL-2.0-or-later
// How well a bank can diagnose, without a simulation more: every packing is left out in turn, and
// its runs, with a laboratory's noise, are samples of which the others know nothing. Or samples are
// drawn from the bank's own predictions: what it could distinguish if its stated errors were exact.
#ifndef CALENDEM_DIAGNOSE_BANK_CHECK_H
#define CALENDEM_DIAGNOSE_BANK_CHECK_H

#include <string>
#include <vector>

namespace calendem {

struct BankCheckOptions {
  std::string bank, table, folder;
  int jobs = 1;       ///< packings or draws at a time
  int draws = 0;      ///< 0: packings are left out; else draws of the base model and each effect
  double cells = 1.0; ///< of the bank, that a drawn sample is as large as
};

/// One diagnosis. A sample of a left-out packing is as large as the bank's cell.
struct CheckedDiagnosis {
  std::string effect;              ///< that was on; empty: none
  int base_point = 0, packing = 0; ///< of a drawn sample: both the draw's number
  bool left_out = false;           ///< the effect may not be named: right is "unknown"
  double amplitude = 0.0;          ///< of the effect
  double limit = 0.0; ///< amplitude from which on it can be distinguished from none; NaN: never
  std::string most_probable; ///< hypothesis
  double its_probability = 0.0, of_truth = 0.0, of_unknown = 0.0;
  std::string claim;
  double adequacy_p = 0.0;
  std::vector<bool> held; ///< of each base parameter: by its 90 % interval

  std::string truth() const { return left_out ? "unknown" : effect.empty() ? "none" : effect; }
  bool above_limit() const { return amplitude >= limit || -amplitude >= limit; }
};

/// The claim of a diagnosis is an effect, a pair or a fault of the press.
bool names_effect(const std::string &claim);

/// diagnoses.csv, and back.
std::string table_of(const std::vector<CheckedDiagnosis> &cases);
std::vector<CheckedDiagnosis> diagnoses_in(const std::string &table);

/// Summary lines, with 90 % intervals over packings or draws.
std::vector<std::string> summary_of(const std::vector<CheckedDiagnosis> &cases);

/// Writes samples/ and diagnoses.csv (after every packing) into the folder and prints the summary.
/// Rows that a folder has from the same program, bank and table are not made again. Every effect is
/// diagnosed twice: with all effects, and without itself. Throws Failure(2) for a bank without its
/// table, or of fewer than three packings.
/// Drawn samples have base parameters and amplitudes from their priors and errors as the model
/// says: emulators, covariance and priors of the effects are right by construction, the shape of
/// the unknown is not. What is missed beyond that on left-out packings, the bank misses.
void check_bank(const BankCheckOptions &options);

} // namespace calendem

#endif
