// SPDX-License-Identifier: GPL-2.0-or-later
// Points that fill the unit cube evenly, and random numbers, the same on every machine.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_SOBOL_POINTS_H
#define CALENDEM_DIAGNOSE_INFERENCE_SOBOL_POINTS_H

#include "diagnose/inference/linear.h"
#include <cstdint>

namespace calendem::inference {

/// dimension x count points in (0, 1): Boost's Sobol sequence (Joe and Kuo's direction numbers),
/// shifted modulo 1 by a vector that `shift` seeds (Cranley and Patterson 1976). 0: not shifted.
Matrix sobol_points(int dimension, int count, std::uint64_t shift);

/// The same as standard normal scores.
Matrix sobol_normals(int dimension, int count, std::uint64_t shift);

/// Quantile of the standard normal distribution, 0 < share < 1.
double normal_quantile(double share);

} // namespace calendem::inference

#endif
