// SPDX-License-Identifier: GPL-2.0-or-later
// Random numbers that are the same on every platform: SplitMix64 streams by (seed, purpose).
#ifndef CALENDEM_BASE_RANDOM_H
#define CALENDEM_BASE_RANDOM_H

#include "physics/pi.h"
#include "physics/weibull_strength.h"
#include <Eigen/Geometry>
#include <cmath>

namespace calendem {

class Random {
public:
  Random(std::uint64_t seed, std::uint64_t purpose)
      : state_(split_mix(seed) ^ split_mix(~purpose)) {}

  /// Uniform in (0, 1).
  double uniform() {
    state_ += 0x9e3779b97f4a7c15ULL;
    return (static_cast<double>(split_mix(state_) >> 11) + 0.5) / 9007199254740992.0;
  }
  double normal() {
    const double length = std::sqrt(-2.0 * std::log(uniform()));
    return length * std::cos(2.0 * kPi * uniform());
  }
  // Braces: the draws follow in the order written, with every compiler.
  Eigen::Vector3d uniform3() { return Eigen::Vector3d{uniform(), uniform(), uniform()}; }
  Eigen::Vector3d direction() { return Eigen::Vector3d{normal(), normal(), normal()}.normalized(); }
  Eigen::Quaterniond rotation() {
    return Eigen::Quaterniond{normal(), normal(), normal(), normal()}.normalized();
  }

private:
  std::uint64_t state_;
};

} // namespace calendem

#endif
