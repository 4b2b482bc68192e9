// SPDX-License-Identifier: GPL-2.0-or-later
// Which open voxels lie on a path through the image.
#include "measure/diffusion.h"

namespace calendem {
namespace {

class Walk {
public:
  Walk(const DiffusionGrid &grid, int axis)
      : grid_(grid), axis_(axis), step_{1, size_t(grid.n[0]), size_t(grid.n[0]) * grid.n[1]} {}

  int place(size_t v, int axis) const { return int(v / step_[axis] % grid_.n[axis]); }

  /// Voxel at the side -1 or 1 along an axis. `turns`: +-1 if that crosses the periodic face of the
  /// axis of the walk. False if there is none.
  bool next(size_t v, int axis, int side, size_t &w, int &turns) const {
    const int at = place(v, axis) + side;
    turns = 0;
    w = v + size_t(side) * step_[axis];
    if (at >= 0 && at < grid_.n[axis])
      return true;
    if (!grid_.periodic || axis == 2)
      return false;
    w -= size_t(side) * step_[axis] * size_t(grid_.n[axis]);
    turns = axis == axis_ ? side : 0;
    return true;
  }

  /// All open voxels connected to those of the first or last layer, without the periodic face.
  std::vector<char> from_end(int layer) const {
    std::vector<char> reached(grid_.diffusivity.size(), 0);
    std::vector<size_t> front;
    for (size_t v = 0; v < reached.size(); ++v)
      if (place(v, axis_) == layer && grid_.diffusivity[v] > 0.0F) {
        reached[v] = 1;
        front.push_back(v);
      }
    while (!front.empty()) {
      const size_t v = front.back();
      front.pop_back();
      each_open_neighbour(v, [&](size_t w, int) {
        if (!reached[w]) {
          reached[w] = 1;
          front.push_back(w);
        }
      });
    }
    return reached;
  }

  /// Visits the part that holds `start`; true if it meets itself in another cell along the axis.
  bool meets_itself(size_t start, std::vector<int> &turn, std::vector<size_t> &part) const {
    bool meets = false;
    turn[start] = 0;
    part = {start};
    for (size_t p = 0; p < part.size(); ++p) {
      const size_t v = part[p];
      each_open_neighbour(v, [&](size_t w, int turns) {
        if (turn[w] == kUnseen) {
          turn[w] = turn[v] + turns;
          part.push_back(w);
        } else if (turn[w] != turn[v] + turns)
          meets = true;
      });
    }
    return meets;
  }

  static constexpr int kUnseen = std::numeric_limits<int>::min();

private:
  const DiffusionGrid &grid_;
  int axis_;
  size_t step_[3];

  template <class Visit> void each_open_neighbour(size_t v, Visit visit) const {
    size_t w = 0;
    int turns = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int side : {-1, 1})
        if (next(v, axis, side, w, turns) && grid_.diffusivity[w] > 0.0F)
          visit(w, turns);
  }
};

} // namespace

std::vector<char> on_paths(const DiffusionGrid &grid, int axis) {
  const Walk walk(grid, axis);
  if (!grid.periodic || axis == 2) {
    std::vector<char> from_first = walk.from_end(0);
    const std::vector<char> from_last = walk.from_end(grid.n[axis] - 1);
    for (size_t v = 0; v < from_first.size(); ++v)
      from_first[v] = char(from_first[v] & from_last[v]);
    return from_first;
  }
  std::vector<char> out(grid.diffusivity.size(), 0);
  std::vector<int> turn(out.size(), Walk::kUnseen);
  std::vector<size_t> part;
  for (size_t v = 0; v < out.size(); ++v)
    if (grid.diffusivity[v] > 0.0F && turn[v] == Walk::kUnseen && walk.meets_itself(v, turn, part))
      for (const size_t w : part)
        out[w] = 1;
  return out;
}

} // namespace calendem
