// SPDX-License-Identifier: GPL-2.0-or-later
// Reproducible random vectors for tests of the laws.
#ifndef CALENDEM_TESTS_RANDOM_VECTOR_H
#define CALENDEM_TESTS_RANDOM_VECTOR_H

#include <random>

#include "physics/vector3.h"

namespace calendem {

class RandomVectors {
public:
  explicit RandomVectors(unsigned seed) : engine_(seed) {}
  double number(double low, double high) {
    return low + (high - low) * (engine_() / 4294967296.0); // the same on every library
  }
  Vec3 vector(double size) {
    const double x = number(-size, size), y = number(-size, size), z = number(-size, size);
    return {x, y, z};
  }
  Vec3 unit() {
    for (;;) {
      const Vec3 a = vector(1.0);
      if (norm(a) > 0.1 && norm(a) <= 1.0)
        return (1.0 / norm(a)) * a;
    }
  }

private:
  std::mt19937 engine_;
};

} // namespace calendem

#endif
