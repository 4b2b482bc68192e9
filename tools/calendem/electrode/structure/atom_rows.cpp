// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/atom_rows.h"
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace calendem {
namespace {

struct Columns {
  const char *style, *names;
  int type, diameter, density, x, molecule; ///< places in a row; -1: there is none
  size_t fewest, most;                      ///< without the three image flags
};

// atom_style in the manuals of LAMMPS and LIGGGHTS: read_data, section Atoms. In both, `hybrid`
// puts the place before what its first style adds, here sphere (granular), then the molecule.
constexpr Columns kColumns[] = {
    {"sphere", "id type diameter density x y z", 1, 2, 3, 4, -1, 7, 7},
    {"bpm/sphere", "id molecule type diameter density x y z", 2, 3, 4, 5, 1, 8, 8},
    {"hybrid", "id type x y z diameter density [molecule]", 1, 5, 6, 2, 7, 7, 8}};

const Columns &columns(const std::string &atom_style) {
  const std::string name = columns_name(atom_style);
  for (const Columns &c : kColumns)
    if (name == c.style)
      return c;
  return kColumns[0];
}

// Reads words of one row and keeps what is wrong with them.
class Row {
public:
  explicit Row(const std::vector<std::string> &words) : words_(words) {}
  const std::string &wrong() const { return wrong_; }

  double number(const std::string &name, size_t column, bool positive) {
    const std::optional<double> v = number_in(words_[column]);
    if (!v || !std::isfinite(*v))
      note(fmt::format("{} '{}' is no finite number", name, words_[column].substr(0, 40)));
    else if (positive && !(*v > 0.0))
      note(fmt::format("{} {} is not above 0", name, words_[column].substr(0, 40)));
    return v.value_or(0.0);
  }
  long whole(const std::string &name, size_t column, long low, long high, const char *why = "") {
    const std::optional<long> v = whole_number_in(words_[column]);
    if (!v)
      note(fmt::format("{} '{}' is no whole number", name, words_[column].substr(0, 40)));
    else if (*v < low || *v > high)
      note(fmt::format("{} {} is not between {} and {}{}", name, *v, low, high, why));
    return v.value_or(0);
  }

private:
  const std::vector<std::string> &words_;
  std::string wrong_;
  void note(const std::string &text) { wrong_ += (wrong_.empty() ? "" : "; ") + text; }
};

} // namespace

std::optional<double> number_in(const std::string &word) {
  char *end = nullptr;
  const double v = std::strtod(word.c_str(), &end);
  return word.empty() || end != word.c_str() + word.size() ? std::nullopt : std::optional(v);
}

std::optional<long> whole_number_in(const std::string &word) {
  long v = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), v);
  return error != std::errc() || end != word.data() + word.size() ? std::nullopt : std::optional(v);
}

std::string columns_name(const std::string &atom_style) {
  return atom_style == "granular" ? "sphere" : atom_style;
}

std::string columns_of(const std::string &atom_style) { return columns(atom_style).names; }

AtomRows::AtomRows(const std::string &atom_style, Mistakes &mistakes)
    : style_(atom_style), mistakes_(mistakes) {}

bool AtomRows::has_its_columns(int line, size_t words) {
  const Columns &c = columns(style_);
  const auto fits = [&](size_t n) { return n >= c.fewest && n <= c.most; };
  if (!fits(words) && !(words > 3 && fits(words - 3)))
    mistakes_.add(line, fmt::format("the row has {} columns; atom_style {} has '{}' and, if "
                                    "wanted, 3 image flags. Give structure.atom_style as in the "
                                    "script that wrote the file, and the whole file.",
                                    words, style_, c.names));
  else if (width_ != 0 && words != width_)
    mistakes_.add(line, fmt::format("the row has {} columns, those before it {}: it is cut or of "
                                    "another file. Give the file as it was written.",
                                    words, width_));
  else {
    width_ = words;
    return true;
  }
  return false;
}

void AtomRows::read(int line, const std::vector<std::string> &words, long types) {
  ++rows_;
  if (!has_its_columns(line, words.size()))
    return;
  const Columns &c = columns(style_);
  const bool flags = words.size() - 3 >= c.fewest;
  molecules_ = c.molecule >= 0 && words.size() - (flags ? 3 : 0) > size_t(c.molecule);
  Row row(words);
  DataParticle p;
  p.line = line;
  p.id = row.whole("id", 0, 1, LONG_MAX);
  p.type = static_cast<int>(row.whole("type", c.type, 1, types, ", the atom types of the header"));
  p.diameter = row.number("diameter", c.diameter, true);
  p.density = row.number("density", c.density, true);
  for (int axis = 0; axis < 3; ++axis)
    p.x[axis] = row.number(std::string(1, char('x' + axis)), c.x + axis, false);
  if (molecules_)
    p.molecule = row.whole("molecule", c.molecule, 0, LONG_MAX);
  for (int axis = 0; flags && axis < 3; ++axis)
    row.whole("image flag", words.size() - 3 + axis, -1000000, 1000000);
  if (!row.wrong().empty()) {
    mistakes_.add(line, fmt::format("{} (columns: {}).", row.wrong(), c.names));
    return;
  }
  const auto [seen, fresh] = line_of_id_.emplace(p.id, line);
  if (!fresh)
    mistakes_.add(line, fmt::format("particle {} is there twice, first in line {}. Every id may "
                                    "stand once; take the copy out.",
                                    p.id, seen->second));
  else
    good_.push_back(p);
}

} // namespace calendem
