// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef CALENDEM_BASE_PI_H
#define CALENDEM_BASE_PI_H

namespace calendem {

inline constexpr double kPi = 3.14159265358979323846;

} // namespace calendem

#endif
