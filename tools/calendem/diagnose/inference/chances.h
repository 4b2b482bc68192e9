// SPDX-License-Identifier: GPL-2.0-or-later
// Tail probabilities of squared distances, and what they would be of a normal variable.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_CHANCES_H
#define CALENDEM_DIAGNOSE_INFERENCE_CHANCES_H

namespace calendem::inference {

/// Probability that a squared distance in n dimensions exceeds `square`: chi-squared, or n times
/// Fisher's F with `degrees_of_freedom` where the covariance was estimated (Hotelling).
double chance_beyond(double square, int n, double degrees_of_freedom);

/// |z| of a normal variable with the same two-sided chance as `square` has in n dimensions.
double equivalent_z(double square, int n);

} // namespace calendem::inference

#endif
