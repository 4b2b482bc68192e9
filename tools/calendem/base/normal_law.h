// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef CALENDEM_BASE_NORMAL_LAW_H
#define CALENDEM_BASE_NORMAL_LAW_H

#include <cmath>

namespace calendem {

/// Share of the standard normal law below z.
inline double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

} // namespace calendem

#endif
