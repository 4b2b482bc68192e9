// SPDX-License-Identifier: GPL-2.0-or-later
// Short names for what every file of the diagnosis computes with.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_LINEAR_H
#define CALENDEM_DIAGNOSE_INFERENCE_LINEAR_H

#include <Eigen/Dense>

namespace calendem::inference {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using Cholesky = Eigen::LLT<Matrix>;

} // namespace calendem::inference

#endif
