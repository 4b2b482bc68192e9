// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/data_header.h"
#include "electrode/structure/atom_rows.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

namespace calendem {
namespace {

const char *const kSides[] = {"xlo xhi", "ylo yhi", "zlo zhi"};

// Of other atom styles and of settings: their numbers are not needed here.
const char *const kOthers[] = {"bonds",
                               "angles",
                               "dihedrals",
                               "impropers",
                               "crossterms",
                               "ellipsoids",
                               "lines",
                               "triangles",
                               "bodies",
                               "bond types",
                               "angle types",
                               "dihedral types",
                               "improper types",
                               "extra bond per atom",
                               "extra angle per atom",
                               "extra dihedral per atom",
                               "extra improper per atom",
                               "extra special per atom"};

} // namespace

std::vector<std::string> words_of(const std::string &line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;)
    words.push_back(word);
  return words;
}

std::string joined(const std::vector<std::string> &words, size_t first) {
  return fmt::format("{}", fmt::join(words.begin() + long(first), words.end(), " "));
}

void DataHeader::read(int line, const std::vector<std::string> &words) {
  const auto word =
      std::find_if(words.begin(), words.end(), [](const auto &w) { return !number_in(w); });
  const size_t numbers = size_t(word - words.begin());
  const std::string name = joined(words, numbers);
  const auto side = std::find(kSides, kSides + 3, name);
  if (name == "atoms" || name == "atom types")
    read_count(line, name, words[0], numbers);
  else if (side != kSides + 3)
    read_side(line, int(side - kSides), words, numbers);
  else if (name == "xy xz yz" || name == "avec" || name == "bvec" || name == "cvec")
    read_tilt(line, words, numbers);
  else if (std::find(std::begin(kOthers), std::end(kOthers), name) == std::end(kOthers))
    mistakes_.add(line, fmt::format("'{}' is no header line such as '100 atoms', '4 atom types' or "
                                    "'0 12 xlo xhi'. Correct or remove it.",
                                    joined(words).substr(0, 60)));
}

void DataHeader::read_count(int line, const std::string &name, const std::string &word,
                            size_t numbers) {
  const long n = numbers == 1 ? whole_number_in(word).value_or(0) : 0;
  (name == "atoms" ? atoms_ : types_) = n;
  (name == "atoms" ? atoms_line_ : types_line_) = line;
  if (n < 1 || n > INT_MAX)
    mistakes_.add(line, fmt::format("the number of {} is '{}'; it must be one whole number from 1 "
                                    "to {}.",
                                    name, word.substr(0, 40), INT_MAX));
}

void DataHeader::read_side(int line, int axis, const std::vector<std::string> &words,
                           size_t numbers) {
  side_[axis] = true;
  if (numbers == 2) {
    low_[axis] = *number_in(words[0]);
    high_[axis] = *number_in(words[1]);
  }
  if (std::isfinite(high_[axis] - low_[axis]) && high_[axis] > low_[axis])
    return;
  low_[axis] = high_[axis] = NAN;
  mistakes_.add(line, fmt::format("the box side '{}' needs two finite numbers, the lower first.",
                                  joined(words).substr(0, 80)));
}

void DataHeader::read_tilt(int line, const std::vector<std::string> &words, size_t numbers) {
  bool straight = words.back() == "yz" && numbers == 3;
  for (size_t k = 0; k < numbers; ++k)
    straight = straight && *number_in(words[k]) == 0.0;
  if (!straight)
    mistakes_.add(line, fmt::format("the box is tilted ('{}'); only boxes with right angles are "
                                    "read. Run the simulation in such a box.",
                                    joined(words).substr(0, 80)));
}

void DataHeader::check() {
  if (atoms_line_ == 0)
    mistakes_.add(0, "no line 'N atoms' stands before its first section; it is needed to see that "
                     "no particle is lost.");
  if (types_line_ == 0)
    mistakes_.add(0, "no line 'N atom types' stands before its first section.");
  for (int axis = 0; axis < 3; ++axis)
    if (!side_[axis])
      mistakes_.add(0, fmt::format("no line 'lo hi {}' with the box stands before its first "
                                   "section.",
                                   kSides[axis]));
}

} // namespace calendem
