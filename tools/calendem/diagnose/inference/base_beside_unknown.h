// SPDX-License-Identifier: GPL-2.0-or-later
// Base parameters where something unknown acts: it may move what they move, too.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_BASE_BESIDE_UNKNOWN_H
#define CALENDEM_DIAGNOSE_INFERENCE_BASE_BESIDE_UNKNOWN_H

#include "diagnose/inference/which.h"

namespace calendem::inference {

/// One draw of the base parameters' scores [base parameters x draws] for each draw of the unknown's
/// posterior. The evidence keeps the discrepancy off what recalibration can do, for there nothing
/// tells the two apart; the parameters must not profit from that. Here the discrepancy has the
/// covariance `anywhere` (of one standard deviation, times the draw's size squared), and the scores
/// are drawn from the posterior that is linear about `base`:
///   precision 1 + J^T C^-1 J, mean precision^-1 J^T C^-1 (observed - effects - mean + J at),
/// C the base's covariance and the discrepancy's. Kennedy and O'Hagan, J. R. Stat. Soc. B 63 (2001)
/// 425, section 4.5, for one size at a time.
Matrix base_beside_unknown(const Problem &problem, const Linearised &base, const Judged &unknown,
                           const Matrix &anywhere);

} // namespace calendem::inference

#endif
