// SPDX-License-Identifier: GPL-2.0-or-later
// What the data leave of every effect and parameter, averaged over the hypotheses.
#ifndef CALENDEM_DIAGNOSE_INFERENCE_AVERAGED_H
#define CALENDEM_DIAGNOSE_INFERENCE_AVERAGED_H

#include "diagnose/inference/confounding.h"
#include "diagnose/inference/which.h"

namespace calendem::inference {

/// A quantity's median and the intervals that hold 90 and 95 % of its posterior.
struct Range {
  double median = 0.0, low90 = 0.0, high90 = 0.0, low95 = 0.0, high95 = 0.0;
};

/// Range of the first amplitude of an effect, where it acts: alone, in a pair, or beside something
/// unknown.
struct EffectRange {
  std::string effect;
  double inclusion = 0.0; ///< that it acts, alone or in a pair
  Range amplitude;        ///< two-sided
  double below95 = 0.0;   ///< with 95 %, if it acts at all
  bool two_sided = false; ///< its amplitude may have either sign: an interval limits it
  bool limited = false;   ///< by four fifths of what the prior alone allows, or less
};
std::vector<EffectRange> effect_ranges(const Problem &problem, const Which &which);

/// Range of any parameter of an effect, by its place among them.
Range range_of(const Problem &problem, const Which &which, int effect, int parameter);

/// Range of a base parameter over all hypotheses, each as wide as it leaves it, and under the
/// effect of the table that moves it most.
struct ParameterRange {
  Range all;
  std::string moved_by; ///< empty: no effect that the data leave moves it by half its 95 % interval
  Range moved;
};
std::vector<ParameterRange> parameter_ranges(const std::vector<Parameter> &base,
                                             const Which &which);

/// Effects that these data cannot tell from each other at their fitted amplitudes.
struct EffectGroup {
  std::vector<std::string> effects;
  bool with_none = false;   ///< nor from none: what acts may be nothing
  double probability = 0.0; ///< that one of them acts, or something that acts like one of them
  double acts_like = 0.0;   ///< the latter's share of it
};
/// Most probable first; an effect that can be told from all others is a group of its own.
std::vector<EffectGroup> effect_groups(const Which &which, const Confounding &confounding);

} // namespace calendem::inference

#endif
