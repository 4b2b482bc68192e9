// SPDX-License-Identifier: GPL-2.0-or-later
// Which body each primary belongs to, as the body map's file says. It has rows `tag body`, body >=
// 1; '#' starts a comment. Atoms without a row belong to none. A comment `# tag body, N rows` says
// how many rows must follow.
#ifndef CALENDEM_BODY_MAP_H
#define CALENDEM_BODY_MAP_H

#include "pointers.h"
#include <map>
#include <string>
#include <vector>

namespace LAMMPS_NS {

class BodyMap : protected Pointers {
public:
  /// Messages name the fix `owner`.
  BodyMap(class LAMMPS *lmp, class Fix *owner) : Pointers(lmp), owner_(owner) {}

  /// Reads the bodies of the atoms that are there; all ranks call.
  void read(const std::string &file);
  /// 0: none. Before read() all have none.
  int of_tag(int tag) const { return static_cast<size_t>(tag) < of_tag_.size() ? of_tag_[tag] : 0; }
  int highest() const;
  /// Diameter of the sphere of its primaries' volume [um].
  double diameter(int body) const { return diameter_.at(body); }

private:
  class Fix *owner_;
  std::vector<int> of_tag_;
  std::map<int, double> diameter_;

  std::string read_rows(const std::string &file);
  std::string read_row(const char *line, int row, const std::string &file, int *rows);
  void measure();
};

} // namespace LAMMPS_NS

#endif
