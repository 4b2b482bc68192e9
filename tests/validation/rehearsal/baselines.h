// SPDX-License-Identifier: GPL-2.0-or-later
// Simpler ways to find what a model has wrong, on the data, errors and emulator of a diagnosis.
#ifndef CALENDEM_TESTS_REHEARSAL_BASELINES_H
#define CALENDEM_TESTS_REHEARSAL_BASELINES_H

#include "candidates.h"

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
///   5 %;
/// * the two below.
std::vector<Answer> baseline_answers(const Diagnosis &d);

/// Robust Bayesian synthetic likelihood with adjusted means (Frazier and Drovandi 2021): a normal likelihood
/// in which every observable (of a curve, all of it) is off by a multiple of its standard deviation that has a
/// Laplace prior of scale 1, as in the R package BSL. A change is named if its probability among the
/// model and all single changes and its Bayes factor reach what a diagnosis demands (kCertain, kStrong).
Answer by_robust_likelihood(const Diagnosis &d, const std::vector<Candidate> &all);

/// A base simulator against many augmented ones (Anau Montel, Alvey and Weniger 2025): matched filters of
/// each change, of middling shape and free size, and of a deviation of each observable ("unknown"), on what
/// the recalibrated model leaves. The most significant one is named if its p-value, corrected for all
/// by 2000 worlds in which the model is true, is below 5 %. The second answer is that of the sum of all
/// statistics: that something is off, but not what. It is never sure.
std::vector<Answer> by_augmentations(const Diagnosis &d, const std::vector<Candidate> &all);

} // namespace calendem

#endif
