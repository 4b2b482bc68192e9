// SPDX-License-Identifier: GPL-2.0-or-later
// Three-component vectors for the laws of this folder. Every operation is written so that
// exchanging the two particles of a pair changes signs only, never bits: both copies of a pair that
// straddles two processors then follow the same arithmetic.
#ifndef CALENDEM_PHYSICS_VECTOR3_H
#define CALENDEM_PHYSICS_VECTOR3_H

#include <cmath>

namespace calendem {

struct Vec3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

inline Vec3 load(const double *p) { return {p[0], p[1], p[2]}; }

inline void store(const Vec3 &v, double *p) {
  p[0] = v.x;
  p[1] = v.y;
  p[2] = v.z;
}

inline void add_to(const Vec3 &v, double *p) {
  p[0] += v.x;
  p[1] += v.y;
  p[2] += v.z;
}

inline void subtract_from(const Vec3 &v, double *p) {
  p[0] -= v.x;
  p[1] -= v.y;
  p[2] -= v.z;
}

inline Vec3 operator+(const Vec3 &a, const Vec3 &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3 &a, const Vec3 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(const Vec3 &a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(double s, const Vec3 &a) { return {s * a.x, s * a.y, s * a.z}; }

inline double dot(const Vec3 &a, const Vec3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

inline Vec3 cross(const Vec3 &a, const Vec3 &b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double norm_squared(const Vec3 &a) { return dot(a, a); }
inline double norm(const Vec3 &a) { return std::sqrt(dot(a, a)); }

/// `v`, or zero without a branch.
inline Vec3 select(bool condition, const Vec3 &v) {
  return {condition ? v.x : 0.0, condition ? v.y : 0.0, condition ? v.z : 0.0};
}

/// Part of `a` at right angles to the unit vector `n`.
inline Vec3 reject(const Vec3 &a, const Vec3 &n) { return a - dot(a, n) * n; }

} // namespace calendem

#endif
