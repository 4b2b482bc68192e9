// SPDX-License-Identifier: GPL-2.0-or-later
// Where a film is cut between ranks, so that each has the same share of the work. Knows no host.
#ifndef CALENDEM_FILM_CUTS_H
#define CALENDEM_FILM_CUTS_H

#include <algorithm>
#include <cstddef>
#include <vector>

namespace calendem {

/// Work of the busiest slab over the mean; a layer belongs to the slab that its lower face is in. 1
/// without any work.
inline double busiest_slab(const std::vector<double> &work, const std::vector<double> &cuts) {
  const std::size_t slabs = cuts.size() - 1;
  std::vector<double> of_slab(slabs, 0.0);
  double all = 0.0;
  for (std::size_t n = 0, k = 0; n < work.size(); ++n) {
    while (k + 1 < slabs && n >= cuts[k + 1] * work.size())
      ++k;
    of_slab[k] += work[n];
    all += work[n];
  }
  return all > 0.0 ? *std::max_element(of_slab.begin(), of_slab.end()) * slabs / all : 1.0;
}

/// Cuts [0-1, of the film's height] between slabs of equal work.
/// `work`: of equal layers, from below; not negative. `old`: the cuts so far, with 0 and 1 at the
/// ends. A cut goes at most half of the way to its old neighbours: then a particle changes to a
/// slab beside its own at most, which is as far as the host moves it. Without any work the cuts
/// stay.
inline std::vector<double> cuts_of_equal_work(const std::vector<double> &work,
                                              const std::vector<double> &old) {
  double all = 0.0;
  for (const double w : work)
    all += w;
  std::vector<double> cuts = old;
  if (!(all > 0.0))
    return cuts;
  const std::size_t slabs = old.size() - 1;
  double below = 0.0;
  std::size_t layer = 0;
  for (std::size_t k = 1; k < slabs; ++k) {
    const double share = all * k / slabs;
    while (layer + 1 < work.size() && below + work[layer] < share)
      below += work[layer++];
    const double part = work[layer] > 0.0 ? (share - below) / work[layer] : 0.0;
    const double wanted = (layer + std::min(part, 1.0)) / work.size();
    cuts[k] = std::min(std::max(wanted, 0.5 * (old[k - 1] + old[k])), 0.5 * (old[k] + old[k + 1]));
  }
  return cuts;
}

} // namespace calendem

#endif
