// SPDX-License-Identifier: GPL-2.0-or-later
#include "measure/porosity.h"
#include <algorithm>
#include <cmath>

namespace calendem {

Porosity porosity(const Volumes &v) {
  Porosity p;
  p.total = 1.0 - (v.am + v.cbd_solid) / v.cell;
  p.macro = 1.0 - (v.am + v.cbd_envelope) / v.cell;
  p.nano = p.total - p.macro;
  return p;
}

std::vector<Slice> profile(const PhaseImage &image, const Density &density, double thickness) {
  const int wanted = std::max(1, int(std::lround(image.side(2) / thickness)));
  const int number = std::min(image.n[2], wanted);
  const size_t per_layer = size_t(image.n[0]) * image.n[1];
  std::vector<Slice> slices;
  for (int m = 0; m < number; ++m) {
    const int k = int(long(m) * image.n[2] / number), end = int(long(m + 1) * image.n[2] / number);
    std::array<size_t, 3> count = {0, 0, 0};
    for (size_t v = k * per_layer; v < end * per_layer; ++v)
      ++count[size_t(image.phase(v))];
    Slice s;
    s.from = k * image.voxel.z();
    s.to = end * image.voxel.z();
    const double all = double((end - k) * per_layer);
    s.fraction = {count[0] / all, count[1] / all, count[2] / all};
    s.porosity_total = 1.0 - density.am * s.fraction.am - density.cbd * s.fraction.cbd;
    slices.push_back(s);
  }
  return slices;
}

void count_bonds(const std::vector<BondAt> &bonds, std::vector<Slice> &slices) {
  for (const BondAt &b : bonds) {
    const auto above =
        std::find_if(slices.begin(), slices.end() - 1, [&](const Slice &s) { return b.z < s.to; });
    ++above->bonds;
    above->broken += b.broken;
  }
}

} // namespace calendem
