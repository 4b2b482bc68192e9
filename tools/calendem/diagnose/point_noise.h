// SPDX-License-Identifier: GPL-2.0-or-later
// How rough a measured curve is beside what its stated errors make it.
#ifndef CALENDEM_DIAGNOSE_POINT_NOISE_H
#define CALENDEM_DIAGNOSE_POINT_NOISE_H

#include "diagnose/bank/bank_table.h"
#include "diagnose/inference/problem.h"

namespace calendem {

/// Of the release of every covered curve, if it has eight rows and more: second differences, less
/// their mean over the bank, squared in the covariance of stated errors and bank. There the part
/// that base parameters and effects move (a linear fit of all points) counts whole, the rest, the
/// packings' scatter, by 1 / `cells`. Not of the loading: small films yield in jerks, far from
/// normal (its score had a standard deviation of 2 on 480 curves whose errors were as stated, that
/// of the release 0.99).
std::vector<inference::PointNoise> point_noise_of(const Experiment &experiment,
                                                  const BankTable &table, double cells);

} // namespace calendem

#endif
