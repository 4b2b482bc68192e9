// SPDX-License-Identifier: GPL-2.0-or-later
// The VTK time series of a run: which frames there are, and their contents. Lengths in um.
#ifndef CALENDEM_MEASURE_FRAMES_H
#define CALENDEM_MEASURE_FRAMES_H

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/messages.h"

namespace calendem {

using Point = std::array<double, 3>;

struct FrameFile {
  double time_us;
  std::string path;
};

struct ParticleFrame {
  std::vector<Point> centre;
  std::vector<double> radius;
  std::vector<int> body; ///< 0 = CBD
};

struct BondFrame {
  std::vector<Point> from, to;
  std::vector<bool> intact;
  std::vector<int> body;
  std::vector<std::pair<int, int>> tags; ///< of its primaries, lower first; empty: not in the file
};

struct PlatenFrame {
  std::vector<std::vector<Point>> outlines; ///< closed polygons: collector, platen
};

/// Frames listed in a .pvd file, by time. Whatever cannot be read is added to `mistakes`.
std::vector<FrameFile> read_series(const std::string &pvd, Mistakes &mistakes);
ParticleFrame read_particles(const std::string &file, Mistakes &mistakes);
BondFrame read_bonds(const std::string &file, Mistakes &mistakes);
PlatenFrame read_platen(const std::string &file, Mistakes &mistakes);

/// The frame closest to `time_us`; `frames` must not be empty.
const FrameFile &closest(const std::vector<FrameFile> &frames, double time_us);

} // namespace calendem

#endif
