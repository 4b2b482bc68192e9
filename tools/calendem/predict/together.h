// SPDX-License-Identifier: GPL-2.0-or-later
// What effects that act together change beyond the sum of what each changes alone.
//
// Under load the porosities that effects take add up; springback s is multiplied by each. With
// 1 - after = (1 - load) / (1 + s) the porosity after release is higher than the sum says: binder
// that yields takes springback of which friction has left little. Runs of three effects on two films
// (docs/validation/predictions.md) lie above the sum by 1.8 times that, +- 0.4.
#ifndef CALENDEM_PREDICT_TOGETHER_H
#define CALENDEM_PREDICT_TOGETHER_H

#include <vector>

namespace calendem {

struct Response {
  double porosity = 0.0, springback = 0.0; ///< after release, 0-1; see FilmNumber
};

/// Springback of the effects together less the sum: `base`, and what each effect changes alone.
double springback_beyond_sum(const Response &base, const std::vector<Response> &changes);
/// The same of the porosity after release, as the products give it.
double porosity_beyond_sum(const Response &base, const std::vector<Response> &changes);

/// What runs show of porosity_beyond_sum, and its standard deviation.
constexpr double kRunsOverRule = 1.8, kRunsOverRuleError = 0.4;

} // namespace calendem

#endif
