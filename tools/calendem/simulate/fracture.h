// SPDX-License-Identifier: GPL-2.0-or-later
// Which secondary particles are cracked: broken bonds, fragments by what still holds together, the
// surface of cracks, when it happened, and whether a threshold of broken bonds identifies it.
#ifndef CALENDEM_SIMULATE_FRACTURE_H
#define CALENDEM_SIMULATE_FRACTURE_H

#include <cmath>
#include <string>
#include <vector>

namespace calendem {

/// A bond between primaries i and j of a body, counted from 0, and when it broke [us].
struct BodyBond {
  int i, j;
  double broken_us = HUGE_VAL; ///< HUGE_VAL: never
};

struct BodyBonds {
  int body = 0, primaries = 0;
  std::vector<BodyBond> bonds;
};

/// A body at one moment.
struct FractureState {
  int bonds = 0, broken = 0;
  int parting = 0;      ///< broken bonds between primaries of different fragments
  int fragments = 1;    ///< pieces that intact bonds hold together; a single primary is one
  double largest = 1.0; ///< primaries of the largest fragment over all
  double broken_fraction() const { return bonds > 0 ? double(broken) / bonds : 0.0; }
  bool apart() const { return fragments > 1; }
};

/// Bonds that broke at `time_us` or before are gone.
FractureState state_at(const BodyBonds &body, double time_us);

/// A body is cracked when this share of its bonds is broken and it is apart. The paper speculates
/// 8-12 %, and once 13 %: 8 % is its lower end.
constexpr double kCrackedFraction = 0.08;
/// It is split when its largest fragment has less than this: more than chips are off.
constexpr double kSplitLargest = 0.9;
inline bool is_cracked(const FractureState &s) {
  return s.broken_fraction() >= kCrackedFraction && s.apart();
}
inline bool is_split(const FractureState &s) { return s.largest < kSplitLargest; }

/// First time [us] at which a body is cracked, or apart; HUGE_VAL: never.
double cracked_since(const BodyBonds &body);
double apart_since(const BodyBonds &body);

/// A row of curve.csv as far as cracks.csv repeats it.
struct MomentOfRun {
  double time_us, pressure_MPa;
  const char *stage;
};

/// cracks.csv: bodies with bonds that are apart, cracked, split at every moment, and the surface of
/// cracks [um2]: a broken bond stands for one face `face_um2` of its lattice cell, counted once.
std::string cracks_table(const std::vector<BodyBonds> &bodies,
                         const std::vector<MomentOfRun> &moments, double face_um2);

/// How a threshold of broken bonds agrees with lost connectivity over all bodies with bonds:
/// `above_apart` and `below_whole` are right; `above_whole` is a false positive, `below_apart` a
/// false negative.
struct ThresholdRow {
  int percent;
  int above_apart = 0, above_whole = 0, below_apart = 0, below_whole = 0;
  int above_split = 0, below_split = 0; ///< of those apart
};
std::vector<ThresholdRow> test_thresholds(const std::vector<BodyBonds> &bodies, double time_us);
/// thresholds.csv, thresholds of 5 to 20 %; agreement: share of bodies the threshold classifies
/// right, whether they are apart and whether they are split.
std::string thresholds_table(const std::vector<ThresholdRow> &rows);

} // namespace calendem

#endif
