// SPDX-License-Identifier: GPL-2.0-or-later
// Scatter between packings from few of them.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_SCATTER_H
#define CALENDEM_DIAGNOSE_INFERENCE_SCATTER_H

#include "diagnose/inference/gaussian_process.h"
#include "inference/student_t.h"

namespace calendem::inference {

struct Scatter {
  Matrix covariance;
  double degrees_of_freedom = 0.0;
  double shrinkage = 0.0; ///< weight of no correlation, 0-1
};

/// Correlations of the columns of `residuals` (rows: packings or runs), moved towards none by the
/// weight that minimises the expected square error (Ledoit and Wolf 2004 with the target of
/// Schaefer and Strimmer, Stat. Appl. Genet. Mol. Biol. 4 (2005) 32, target D).
Matrix shrunk_correlation(const Matrix &residuals, double &weight);

/// Covariance of samples (rows) about their mean: variances as they are, correlations shrunk.
Scatter shrunk_covariance(const Matrix &samples);

/// Scatter pooled over a bank: a part between packings and one between runs of a packing, each
/// with its variances from the emulators' marginal likelihood and the correlations of their
/// residuals' means by packing, or of what is left beside these. Degrees of freedom by
/// Satterthwaite from packings and runs, less what the expectation used up; median of features.
/// The shrinkage is the parts' by their traces. `residuals`: runs x features, of runs that all have;
/// `packing`: of these runs.
Scatter pooled_scatter(const std::vector<GaussianProcess> &features, const Matrix &residuals,
                       const std::vector<int> &packing);

/// Residuals of emulators of the same runs: runs x features.
Matrix residuals_of(const std::vector<GaussianProcess> &features);

} // namespace calendem::inference

#endif
