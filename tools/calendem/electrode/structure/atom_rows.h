// SPDX-License-Identifier: GPL-2.0-or-later
// Rows of the section Atoms of a data file, and what words of such a file mean.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_ATOM_ROWS_H
#define CALENDEM_ELECTRODE_STRUCTURE_ATOM_ROWS_H

#include "electrode/structure/particle_data.h"
#include <optional>
#include <unordered_map>

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

} // namespace calendem

#endif
