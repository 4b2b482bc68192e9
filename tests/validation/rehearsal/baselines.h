// SPDX-License-Identifier: GPL-2.0-or-later
// Simpler ways to find what a model has wrong, on the data, errors and emulator of a diagnosis.
#ifndef CALENDEM_TESTS_REHEARSAL_BASELINES_H
#define CALENDEM_TESTS_REHEARSAL_BASELINES_H

#include "diagnose/diagnosis.h"

namespace calendem {

/// A method's answer: nothing, one change, or several of which it does not know which.
struct Answer {
  std::string method;
  std::vector<std::string> named; ///< as name_of has them, the best first
  bool sure = false;              ///< all of `named` are so; else one of them
};

/// All ask for a single change of an effect or a fault of the press.
/// * cosine: the change whose mean effect is most parallel to the residual of the recalibrated model,
///   from a cosine of 0.85 on, where the residual is larger than noise (5 %);
/// * history matching (Craig et al. 1997): changes under which some of 512 prior draws miss no reading
///   by more than three standard deviations, where none of the model alone does;
/// * BIC (Schwarz 1978): the change with the least, if it is 6 below the model's (Kass and Raftery 1995);
/// * likelihood ratio: the change with the largest, if its p-value times the number of changes is below
///   5 %; the one fixed test among the trials-corrected ones of Anau Montel et al. 2024.
std::vector<Answer> baseline_answers(const Diagnosis &d);

} // namespace calendem

#endif
