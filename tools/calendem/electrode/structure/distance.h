// SPDX-License-Identifier: GPL-2.0-or-later
// Exact distance transform on voxels.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_DISTANCE_H
#define CALENDEM_ELECTRODE_STRUCTURE_DISTANCE_H

#include <array>
#include <vector>

namespace calendem {

/// Distance [unit of `cell`] from every cell's centre to the face between inside and outside: > 0
/// outside, < 0 inside; half a cell is taken off because the face lies between two centres.
/// Felzenszwalb & Huttenlocher, Theory of Computing 8 (2012) 415, algorithm 1, per axis.
std::vector<float> signed_distance(const std::vector<char> &inside, const std::array<int, 3> &n,
                                   double cell);

} // namespace calendem

#endif
