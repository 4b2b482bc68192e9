// SPDX-License-Identifier: GPL-2.0-or-later
// What effects that act together change beyond the sum of what each changes alone.
//
// The strongest decides. Of the effects that lower the porosity under load only the strongest counts:
// binder that has yielded is no softer for nanopores that collapse too. Of the springback the strongest
// leaves the share that it leaves alone, each other one that share to the power kOthers. What raises
// either is added. Porosity after release: 1 - after = (1 - load) / (1 + springback).
// Source: runs of three effects on two films, docs/validation/predictions.md.
#ifndef CALENDEM_PREDICT_TOGETHER_H
#define CALENDEM_PREDICT_TOGETHER_H

#include <vector>

namespace calendem {

struct Response {
  double porosity = 0.0, springback = 0.0; ///< after release, 0-1; see FilmNumber
};

constexpr double kOthers = 0.4;
/// Standard deviation of what is beyond the sum, in parts of it.
constexpr double kBeyondSumError = 0.2;

/// The effects together less the sum: `base`, and what each effect changes alone.
Response beyond_sum(const Response &base, const std::vector<Response> &changes);

} // namespace calendem

#endif
