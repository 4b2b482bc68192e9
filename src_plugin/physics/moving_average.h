// SPDX-License-Identifier: GPL-2.0-or-later
// Average of a signal over the last `window` samples, from kBlocks block sums: no running sum that
// drifts, and a state of fixed size that restarts write as it is. The window is exact to one block
// (1/32 of it). Before it is full the average runs over what there is. Signals that are compared
// with each other are averaged alike: over a steady change both then belong to half a window ago.
// Verified by tests/unit/physics/moving_average_test.cpp.
#ifndef CALENDEM_PHYSICS_MOVING_AVERAGE_H
#define CALENDEM_PHYSICS_MOVING_AVERAGE_H

#include <cmath>

namespace calendem {

struct MovingAverage {
  static constexpr int kBlocks = 32;

  double block_length = 1.0; ///< samples per block, >= 1
  double blocks[kBlocks] = {};
  double filled = 0.0;  ///< complete blocks, at most kBlocks
  double next = 0.0;    ///< block to be overwritten next
  double partial = 0.0; ///< sum of the block under way
  double count = 0.0;   ///< samples in it

  void set_window(double samples) {
    const double length = samples / kBlocks;
    block_length = length < 1.0 ? 1.0 : std::round(length);
  }

  /// Returns true when a block was completed.
  bool add(double sample) {
    partial += sample;
    count += 1.0;
    if (count < block_length)
      return false;
    add_block(partial / count);
    partial = count = 0.0;
    return true;
  }

  /// A whole block at once, whose samples had this mean.
  void add_block(double mean) {
    blocks[static_cast<int>(next)] = mean;
    next = next + 1.0 < kBlocks ? next + 1.0 : 0.0;
    filled = filled < kBlocks ? filled + 1.0 : filled;
  }

  bool empty() const { return filled <= 0.0 && count <= 0.0; }

  double value() const {
    if (filled <= 0.0)
      return count > 0.0 ? partial / count : 0.0;
    double sum = 0.0;
    for (int b = 0; b < static_cast<int>(filled); ++b)
      sum += blocks[b];
    return sum / filled;
  }
};

} // namespace calendem

#endif
