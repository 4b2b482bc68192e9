// SPDX-License-Identifier: GPL-2.0-or-later
// The circle constant.
#ifndef CALENDEM_PHYSICS_PI_H
#define CALENDEM_PHYSICS_PI_H

namespace calendem {

inline constexpr double kPi = 3.14159265358979323846;

} // namespace calendem

#endif
