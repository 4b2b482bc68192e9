// SPDX-License-Identifier: GPL-2.0-or-later
// Sizes of the secondary particles: the recipe's lognormal law by number, truncated.
#ifndef CALENDEM_ELECTRODE_PACK_SIZES_H
#define CALENDEM_ELECTRODE_PACK_SIZES_H

#include "base/random.h"
#include "base/recipe.h"
#include <functional>
#include <vector>

namespace calendem {

/// Lognormal law by number of the diameter [um], truncated to [low, high].
struct SizeLaw {
  double median, sigma_ln, low, high;

  /// Diameter below which the fraction q of the number lies.
  double quantile(double q) const;
  /// Share of the volume above `limit`; the third moment of a lognormal shifts ln(median) by
  /// 3 sigma^2.
  double volume_above(double limit) const;
  /// Diameter below which the fraction q of the volume lies.
  double volume_quantile(double q) const;
};

/// The law as measured, before the cell limits it.
SizeLaw measured_law(const Recipe &recipe);

/// Diameters [um], largest first, that together fill `volume` [um^3] as nearly as whole bodies can:
/// quantiles of the law in equal steps of number, with one random offset (stratified sampling), so
/// that even a small cell has the right mix.
std::vector<double> draw_diameters(const Recipe &recipe, double volume, Random &random);

/// The same from any law, given as its quantile function [um].
using Quantile = std::function<double(double)>;
std::vector<double> draw_diameters(const Quantile &law, double volume, Random &random);

/// Primaries per body: N s^3 nearest to the sphere's volume, at least 1; rounding is carried on
/// from body to body so that the sum is exactly `total`.
std::vector<int> primary_counts(const std::vector<double> &diameters, double lattice, int total);

} // namespace calendem

#endif
