// SPDX-License-Identifier: GPL-2.0-or-later
// How far simulations are from measurements that nothing was fitted to.
#ifndef CALENDEM_DIAGNOSE_HELD_OUT_H
#define CALENDEM_DIAGNOSE_HELD_OUT_H

#include "diagnose/inference/observable.h"

namespace calendem {

/// A number with the interval that holds 90 % of its resamples; NaN: not known.
struct Estimate {
  double value = 0.0, low90 = 0.0, high90 = 0.0;
};

/// Held-out observables: what was measured, and a column for each simulated packing.
struct HeldOut {
  std::vector<inference::Block> blocks; ///< each counts the same
  inference::Vector measured, sd;       ///< sd > 0: of measurement and sample
};

/// Adds to the deviations what the measured sample scatters by itself: the variance of packings,
/// pooled over the models (columns: packings), over the number of cells it is as large as.
void add_sample_scatter(const std::vector<inference::Matrix> &models, double cells,
                        HeldOut &held_out);

/// Root mean square of (mean over packings - measured) / sd, freed of what measurement noise and
/// the scatter of that mean add to it; 0 where they explain all. In standard deviations of the
/// measurement and the sample. `scatter`: squares of the standard errors of `mean`.
double gap_of(const HeldOut &held_out, const inference::Vector &mean,
              const inference::Vector &scatter, double noises = 1.0);

/// The same from packings (columns, two at least). The interval is of resamples of noise and
/// packings (t).
Estimate gap_of_packings(const HeldOut &held_out, const inference::Matrix &simulated);

/// 1 - gap after / gap before, packing by packing (the same columns); NaN where
/// there is no gap before.
Estimate shrinkage_of(const HeldOut &held_out, const inference::Matrix &before,
                      const inference::Matrix &after);

/// The gap that a model without any would show at most, with 95 % probability, by the noise and the
/// scatter of these packings.
double noise_floor(const HeldOut &held_out, const inference::Matrix &simulated);

/// Value and 90 % interval of numbers of equal weight.
Estimate interval_of(double value, std::vector<double> draws);

} // namespace calendem

#endif
