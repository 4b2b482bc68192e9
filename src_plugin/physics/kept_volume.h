// SPDX-License-Identifier: GPL-2.0-or-later
// A soft sphere keeps its volume: what its contacts displace comes out where its surface is free.
// Flats at the distances r_j from its centre cut caps off a sphere of the grown radius R',
//   4/3 pi R'^3 - sum of pi h_j^2 (R' - h_j/3) = 4/3 pi R^3,   h_j = R' - r_j
// R: radius without contacts [um]. The surface of it that is free is 4 pi R'^2 - sum of 2 pi R' h_j:
// none from sum h_j = 2 R' on, where nothing can come out any more and the sphere is full. With z
// equal flats it is full at
//   (r/R)^3 = (1 - t)^2/(1 - t/2),  t = 2/z
// in a cubic cell (z = 6) at 0.982, in that of fcc (z = 12) at 0.977 of the cell's volume: what the
// corners still hold is counted as full.
// A contact of overlap d [um] displaces the lens pi R_eff d^2, which n soft spheres share:
//   r = R - u,  pi R u^2 = pi R_eff d^2/n,  u = d sqrt(R_eff/(n R))
// R_eff: effective radius [um]. u = d at a wall, d/2 of equal soft spheres.
// Range: caps that do not overlap. Spheres that touch only as grown do not count. Source: growth of
// the radius with contact and volume in compacts, Fischmeister and Arzt, Powder Metall. 26 (1983)
// 82; one apparent radius for all contacts of a sphere, and its limit of 1.5 R, Zunker and Kamrin, J.
// Mech. Phys. Solids 183 (2024) 105493 (MDR, part II). Deviations: they add increments of the
// displaced volume; here R' solves the balance (by Newton, a step each update). Verified by
// tests/unit/physics/kept_volume_test.cpp, tests/verification/ductile_contact.
#ifndef CALENDEM_PHYSICS_KEPT_VOLUME_H
#define CALENDEM_PHYSICS_KEPT_VOLUME_H

#include "pi.h"
#include <cmath>

namespace calendem {

/// What a flat at a distance [um] from the centre cuts off a sphere of radius `grown` [um].
struct Cap {
  double volume, area; ///< [um3]; of the sphere's surface [um2]

  Cap(double grown, double distance) {
    const double h = std::fmax(grown - distance, 0.0);
    volume = kPi * h * h * (grown - h / 3.0);
    area = 2.0 * kPi * grown * h;
  }
};

/// Depth u [um] of the flat that stands for a contact; soft_spheres: 1 or 2 of the pair.
inline double flat_depth(double overlap, double R_eff, double radius, int soft_spheres) {
  return overlap * std::sqrt(R_eff / (soft_spheres * radius));
}

/// A sphere among its contacts.
struct KeptVolume {
  static constexpr double kFull = 0.02; ///< free share of the surface from which on it is full
  static constexpr double kFree = 0.05; ///< from which on it no longer is
  static constexpr double kMostGrowth = 0.5, kMostStep = 0.02; ///< of the radius; the step's too

  double growth = 0.0; ///< R' - R [um]
  bool full = false;

  /// Sums over the caps at the present growth, volume [um3] and area [um2]; radius R [um].
  void update(double radius, double cap_volume, double cap_area) {
    const double grown = radius + growth, surface = 4.0 * kPi * grown * grown;
    const double free = surface - cap_area;
    full = free < (full ? kFree : kFull) * surface;
    const double kept = 4.0 / 3.0 * kPi * radius * radius * radius;
    const double lacks = kept - (surface * grown / 3.0 - cap_volume);
    if (full && lacks > 0.0)
      return;
    const double most = kMostStep * radius;
    const double step = lacks / std::fmax(free, kFull * surface);
    growth += std::fmin(std::fmax(step, -most), most);
    growth = std::fmin(std::fmax(growth, 0.0), kMostGrowth * radius);
  }
};

} // namespace calendem

#endif
