// SPDX-License-Identifier: GPL-2.0-or-later
// The lines of a data file: its header (how many particles, the box), the rows of the section
// Atoms, and what their words mean.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_DATA_ROWS_H
#define CALENDEM_ELECTRODE_STRUCTURE_DATA_ROWS_H

#include "base/messages.h"
#include "electrode/structure/particle_data.h"
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace calendem {

/// The whole word as a number, finite or not; nothing if it is none.
std::optional<double> number_in(const std::string &word);
std::optional<long> whole_number_in(const std::string &word);

/// "granular" is another name of "sphere".
std::string columns_name(const std::string &atom_style);

class AtomRows {
public:
  AtomRows(const std::string &atom_style, Mistakes &mistakes);

  /// `types`: as many as the header announces.
  void read(int line, const std::vector<std::string> &words, long types);

  size_t rows() const { return rows_; }               ///< good and bad
  bool molecules() const { return molecules_; }       ///< there is a column for them
  std::vector<DataParticle> &good() { return good_; } ///< in the units of the file

private:
  std::string style_;
  Mistakes &mistakes_;
  size_t rows_ = 0, width_ = 0;
  bool molecules_ = false;
  std::vector<DataParticle> good_;
  std::unordered_map<long, int> line_of_id_;

  bool has_its_columns(int line, size_t words);
};

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
