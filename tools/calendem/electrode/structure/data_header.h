// SPDX-License-Identifier: GPL-2.0-or-later
// The lines of a data file before its first section: how many particles, the box.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_DATA_HEADER_H
#define CALENDEM_ELECTRODE_STRUCTURE_DATA_HEADER_H

#include "base/messages.h"
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace calendem {

std::vector<std::string> words_of(const std::string &line);
/// The words from `first` on with one blank between them.
std::string joined(const std::vector<std::string> &words, size_t first = 0);

class DataHeader {
public:
  explicit DataHeader(Mistakes &mistakes) : mistakes_(mistakes) {}

  void read(int line, const std::vector<std::string> &words);
  /// What is missing, once all lines were read.
  void check();

  long atoms() const { return atoms_; } ///< announced; -1: not
  int atoms_line() const { return atoms_line_; }
  long types() const { return types_; }
  /// Corners of the box; not finite where the file does not give them.
  const Eigen::Vector3d &low() const { return low_; }
  const Eigen::Vector3d &high() const { return high_; }

private:
  Mistakes &mistakes_;
  long atoms_ = -1, types_ = LONG_MAX;
  int atoms_line_ = 0, types_line_ = 0;              ///< 0: there is none
  std::array<bool, 3> side_ = {false, false, false}; ///< there is a line for it
  Eigen::Vector3d low_ = Eigen::Vector3d::Constant(NAN), high_ = low_;

  void read_count(int line, const std::string &name, const std::string &word, size_t numbers);
  void read_side(int line, int axis, const std::vector<std::string> &words, size_t numbers);
  void read_tilt(int line, const std::vector<std::string> &words, size_t numbers);
};

} // namespace calendem

#endif
