// SPDX-License-Identifier: GPL-2.0-or-later
// The law of data whose covariance was estimated from few samples, and tail probabilities of squared
// distances.
#ifndef CALENDEM_INFERENCE_STUDENT_T_H
#define CALENDEM_INFERENCE_STUDENT_T_H

#include "inference/numerics.h"

namespace calendem::inference {

constexpr double kNormal = 1e6; ///< from here on a t distribution is computed as normal

/// ln density of the multivariate t distribution of a residual whose square in its scale matrix is
/// `square` (Kotz and Nadarajah 2004, eq. 1.1).
double log_student_t(double square, double log_determinant, int n, double degrees_of_freedom);

/// Probability that a squared distance in n dimensions exceeds `square`: chi-squared, or n times
/// Fisher's F with `degrees_of_freedom` where the covariance was estimated (Hotelling).
double chance_beyond(double square, int n, double degrees_of_freedom);

/// |z| of a normal variable with the same two-sided chance as `square` has in n dimensions.
double equivalent_z(double square, int n);

} // namespace calendem::inference

#endif
