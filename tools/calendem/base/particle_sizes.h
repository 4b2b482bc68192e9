// SPDX-License-Identifier: GPL-2.0-or-later
// Powders as laboratories know them: percentiles D10, D50, D90 by volume fix the lognormal law by
// number that recipes are made of. The third moment of a lognormal shifts ln(median) by 3 sigma^2.
#ifndef CALENDEM_BASE_PARTICLE_SIZES_H
#define CALENDEM_BASE_PARTICLE_SIZES_H

#include "base/recipe.h"
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

/// particles.d10_volume_um, d50_volume_um, d90_volume_um; 0: not given.
std::vector<Key> volume_percentile_keys();
/// The keys with these after particles.sigma_ln.
std::vector<Key> with_volume_percentiles(std::vector<Key> keys);

/// Sets particles.median_um and sigma_ln, and the percentiles to 0, where percentiles are given: two
/// or three, or one beside sigma_ln. Three must lie within 10 % of one law, the scatter of an
/// instrument.
void take_sizes_by_volume(Settings &settings, const std::vector<Key> &keys, Mistakes &mistakes);

/// The law's medians by number and by volume; empty where the recipe's sizes are not its law's.
std::string sizes_in_words(const Recipe &recipe);

} // namespace calendem

#endif
