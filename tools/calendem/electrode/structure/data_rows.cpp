// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/particle_data.h"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <memory>
#include <regex>
#include <sstream>
#include <vtk_zlib.h>

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
      note(fmt::format("{} '{}' is not a finite number", name, words_[column].substr(0, 40)));
    else if (positive && !(*v > 0.0))
      note(fmt::format("{} {} is not above 0", name, words_[column].substr(0, 40)));
    return v.value_or(0.0);
  }
  long whole(const std::string &name, size_t column, long low, long high, const char *why = "") {
    const std::optional<long> v = whole_number_in(words_[column]);
    if (!v)
      note(fmt::format("{} '{}' is not a whole number", name, words_[column].substr(0, 40)));
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

std::string unpacked_text(const std::string &file, Mistakes &mistakes) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose);
  std::string text, part(1 << 20, '\0');
  int read = 0;
  while (in && (read = gzread(in.get(), part.data(), unsigned(part.size()))) > 0)
    text.append(part, 0, size_t(read));
  int state = Z_OK;
  if (in)
    gzerror(in.get(), &state);
  if (!in || text.empty())
    mistakes.add(0, "cannot be read or is empty. Give a data file or dump of LAMMPS or LIGGGHTS.");
  else if (read < 0 || (state != Z_OK && state != Z_STREAM_END))
    mistakes.add(0, "does not unpack (gzip): it is cut or damaged. Copy it again.");
  return text;
}

std::string columns_name(const std::string &atom_style) {
  return atom_style == "granular" ? "sphere" : atom_style;
}

std::string columns_of(const std::string &atom_style) { return columns(atom_style).names; }

AtomRows::AtomRows(const std::string &atom_style, Mistakes &mistakes, const std::string &columns)
    : style_(atom_style), columns_(columns.empty() ? columns_of(atom_style) : columns),
      mistakes_(mistakes) {}

bool AtomRows::has_its_columns(int line, size_t words) {
  const Columns &c = columns(style_);
  const auto fits = [&](size_t n) { return n >= c.fewest && n <= c.most; };
  if (!fits(words) && !(words > 3 && fits(words - 3)))
    mistakes_.add(
        line,
        "the row has {} columns; atom_style {} has '{}' and, if wanted, 3 image flags. Give "
        "structure.atom_style as in the script that wrote the file, and the whole file.",
        words, style_, c.names);
  else if (width_ != 0 && words != width_)
    mistakes_.add(line,
                  "the row has {} columns, those before it {}: it is cut or of another file. Give "
                  "the file as it was written.",
                  words, width_);
  else {
    width_ = words;
    return true;
  }
  return false;
}

void AtomRows::read(int line, std::vector<std::string> words, long types) {
  ++rows_;
  if (!has_its_columns(line, words.size()))
    return;
  const Columns &c = columns(style_);
  if (const auto label = number_of_label_.find(words[size_t(c.type)]);
      label != number_of_label_.end())
    words[size_t(c.type)] = label->second;
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
    mistakes_.add(line, "{} (columns: {}).", row.wrong(), columns_);
    return;
  }
  const auto [seen, fresh] = line_of_id_.emplace(p.id, line);
  if (!fresh)
    mistakes_.add(
        line,
        "particle {} occurs twice, first in line {}. Every id may occur once; remove the copy.",
        p.id, seen->second);
  else
    good_.push_back(p);
}

namespace {

const char *const kSides[] = {"xlo xhi", "ylo yhi", "zlo zhi"};

// Sections of other atom styles and of settings: their numbers are not needed here.
bool is_of_others(const std::string &name) {
  static const std::regex kOthers(
      "(bond|angle|dihedral|improper)(s| types)|(crossterm|ellipsoid|line|"
      "triangle)s|bodies|extra (bond|angle|dihedral|improper|special) "
      "per atom");
  return std::regex_match(name, kOthers);
}

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
  else if (name == "avec" || name == "bvec" || name == "cvec" || name == "abc origin")
    read_edge(line, words, numbers);
  else if (name == "xy xz yz")
    read_tilt(line, words, numbers);
  else if (!is_of_others(name))
    mistakes_.add(line,
                  "'{}' is not a header line such as '100 atoms', '4 atom types' or '0 12 xlo "
                  "xhi'. Correct or remove it.",
                  joined(words).substr(0, 60));
}

void DataHeader::read_count(int line, const std::string &name, const std::string &word,
                            size_t numbers) {
  const long n = numbers == 1 ? whole_number_in(word).value_or(0) : 0;
  (name == "atoms" ? atoms_ : types_) = n;
  (name == "atoms" ? atoms_line_ : types_line_) = line;
  if (n < 1 || n > INT_MAX)
    mistakes_.add(line, "the number of {} is '{}'; it must be one whole number from 1 to {}.", name,
                  word.substr(0, 40), INT_MAX);
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
  mistakes_.add(line, "the box side '{}' needs two finite numbers, the lower first.",
                joined(words).substr(0, 80));
}

// "ax ay az avec" and so on, "x y z abc origin"
void DataHeader::read_edge(int line, const std::vector<std::string> &words, size_t numbers) {
  if (numbers != 3)
    return read_tilt(line, words, numbers);
  Eigen::Vector3d v;
  for (int axis = 0; axis < 3; ++axis)
    v[axis] = *number_in(words[size_t(axis)]);
  if (words[3] == "abc")
    origin_ = v;
  else {
    const int axis = words[3][0] - 'a';
    edge_[axis] = v[axis];
    v[axis] = 0.0;
    if (v != Eigen::Vector3d::Zero())
      return read_tilt(line, words, numbers);
  }
  for (int axis = 0; axis < 3; ++axis)
    if (edge_[axis] != 0.0)
      read_side(line, axis,
                {fmt::format("{:.17g}", origin_[axis]),
                 fmt::format("{:.17g}", origin_[axis] + edge_[axis]), words[3]},
                2);
}

void DataHeader::read_tilt(int line, const std::vector<std::string> &words, size_t numbers) {
  bool straight = words.back() == "yz" && numbers == 3; // edges come here where they are not
  for (size_t k = 0; k < numbers; ++k)
    straight = straight && *number_in(words[k]) == 0.0;
  if (!straight)
    mistakes_.add(line,
                  "the box is tilted ('{}'); only boxes with right angles are read. Run the "
                  "simulation in such a box.",
                  joined(words).substr(0, 80));
}

void DataHeader::check() {
  if (atoms_line_ == 0)
    mistakes_.add(0, "no line 'N atoms' stands before its first section; it is needed to see that "
                     "no particle is lost.");
  if (types_line_ == 0)
    mistakes_.add(0, "no line 'N atom types' stands before its first section.");
  for (int axis = 0; axis < 3; ++axis)
    if (!side_[axis])
      mistakes_.add(0, "no line 'lo hi {}' with the box stands before its first section.",
                    kSides[axis]);
}

} // namespace calendem
