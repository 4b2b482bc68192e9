// SPDX-License-Identifier: GPL-2.0-or-later
// Files whose columns are named: dumps of LAMMPS and LIGGGHTS, tables of spheres. Their rows are
// brought into the order of atom_style bpm/sphere.
#include "base/csv_table.h"
#include "electrode/structure/particle_data.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <functional>
#include <sstream>

namespace calendem {
namespace {

using Words = std::vector<std::string>;
using ValueAt = std::function<std::string(size_t)>; // the word in a column

const char *const kStyle = "bpm/sphere"; // id molecule type diameter density x y z

std::string text_of(double v) { return fmt::format("{:.17g}", v); }

// A word that is no number stays as it is: the row is refused with it.
template <class Function> std::string changed(const std::string &word, const Function &f) {
  const std::optional<double> v = number_in(word);
  return v ? text_of(f(*v)) : word;
}

class NamedColumns {
public:
  explicit NamedColumns(const Words &names) : names_(names) {
    for (std::string &name : names_)
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return char(std::tolower(c)); });
  }

  /// Place of the first column that has one of these names; size() if none has.
  size_t at(std::initializer_list<const char *> names) const {
    const auto is = [&](const std::string &n) {
      return std::find(names.begin(), names.end(), n) != names.end();
    };
    return size_t(std::find_if(names_.begin(), names_.end(), is) - names_.begin());
  }
  bool has(std::initializer_list<const char *> names) const { return at(names) < names_.size(); }
  bool has_place(char axis) const { return plain(axis) < size() || scaled(axis) < size(); }
  bool has_size() const { return has({"diameter", "d", "radius", "r"}); }
  size_t size() const { return names_.size(); }

  /// What a row cannot do without; empty: nothing.
  std::string missing(bool types, bool densities) const {
    std::string out;
    const auto add = [&](bool there, const std::string &what) {
      out += there ? "" : (out.empty() ? "" : ", ") + what;
    };
    for (const char axis : {'x', 'y', 'z'})
      add(has_place(axis), std::string(1, axis));
    add(has_size(), "radius or diameter");
    add(!types || has({"type"}), "type");
    add(!densities || has({"density", "rho", "mass"}), "density or mass");
    return out;
  }

  /// `number`: the id where there is no column for it; places are those in the box.
  Words row(const ValueAt &value, long number, double density, const Eigen::Vector3d &low,
            const Eigen::Vector3d &high) const {
    const auto word = [&](std::initializer_list<const char *> names, const std::string &otherwise) {
      return has(names) ? value(at(names)) : otherwise;
    };
    Words out = {word({"id"}, std::to_string(number)), word({"mol", "molecule", "body"}, "0"),
                 word({"type"}, "1"), word({"diameter", "d"}, "")};
    if (out[3].empty())
      out[3] = changed(value(at({"radius", "r"})), [](double r) { return 2.0 * r; });
    const double d = number_in(out[3]).value_or(0.0);
    out.push_back(word({"density", "rho"}, ""));
    if (out[4].empty())
      out[4] = changed(word({"mass"}, text_of(density * kPi / 6.0 * d * d * d)),
                       [&](double m) { return m / (kPi / 6.0 * d * d * d); });
    for (int axis = 0; axis < 3; ++axis) {
      const char name = char('x' + axis);
      out.push_back(plain(name) < size() ? value(plain(name))
                                         : changed(value(scaled(name)), [&](double s) {
                                             return low[axis] + s * (high[axis] - low[axis]);
                                           }));
    }
    return out;
  }

private:
  Words names_;

  size_t place(char axis, std::initializer_list<const char *> endings) const {
    for (const char *ending : endings) {
      const auto name = std::find(names_.begin(), names_.end(), axis + std::string(ending));
      if (name != names_.end())
        return size_t(name - names_.begin());
    }
    return size();
  }
  size_t plain(char axis) const { return place(axis, {"", "u"}); }
  size_t scaled(char axis) const { return place(axis, {"s", "su"}); }
};

// One frame of a dump.
class Frame {
public:
  Frame(const DataFormat &format, Mistakes &mistakes) : format_(format), mistakes_(mistakes) {}

  void line(int number, const Words &words) {
    if (words.empty())
      return;
    if (words[0] == "ITEM:")
      item(number, words);
    else if (item_ == "NUMBER OF ATOMS")
      atoms_ = whole_number_in(words[0]).value_or(-1);
    else if (item_ == "BOX BOUNDS")
      bounds(number, words);
    else if (item_ == "ATOMS")
      rows_.emplace_back(number, words);
  }

  ParticleData finish(bool ends_with_newline) {
    if (side_ != 3 || !(atoms_ >= 1) || !columns_.size()) {
      mistakes_.add(0, "the frame of the dump is cut: it needs ITEM: NUMBER OF ATOMS, BOX BOUNDS "
                       "and ATOMS with the names of its columns. Name a whole one by "
                       "structure.frame.");
      return {};
    }
    if (long(rows_.size()) != atoms_ || !ends_with_newline)
      mistakes_.add(0,
                    "the frame of the dump is cut: it announces {} atoms and has {} rows{}. Name "
                    "an earlier one by structure.frame.",
                    atoms_, rows_.size(), ends_with_newline ? "" : ", the last without an end");
    AtomRows rows(kStyle, mistakes_, joined(names_));
    for (const auto &[number, words] : rows_)
      if (words.size() != columns_.size())
        mistakes_.add(
            number,
            "the row has {} columns, ITEM: ATOMS names {}. Give the file as it was written.",
            words.size(), columns_.size());
      else
        rows.read(number,
                  columns_.row([&w = words](size_t k) { return w[k]; }, 0,
                               1.0 / format_.density_g_cm3, low_, high_),
                  INT_MAX);
    ParticleData out = in_the_box(rows, low_, high_, format_, mistakes_);
    out.molecules = columns_.has({"mol", "molecule", "body"});
    return out;
  }

private:
  const DataFormat &format_;
  Mistakes &mistakes_;
  std::string item_;
  long atoms_ = -1;
  int side_ = 0; // sides that were read
  Eigen::Vector3d low_ = Eigen::Vector3d::Constant(NAN), high_ = low_;
  Words names_;
  NamedColumns columns_{{}};
  std::vector<std::pair<int, Words>> rows_;

  void item(int number, const Words &words) {
    item_ = joined(words, 1);
    if (item_.rfind("ATOMS", 0) == 0) {
      item_ = "ATOMS";
      names_ = Words(words.begin() + 2, words.end());
      columns_ = NamedColumns(names_);
      const std::string missing = columns_.missing(true, format_.densities);
      if (!missing.empty() || !columns_.has({"id"}))
        mistakes_.add(number,
                      "the dump has no column {}{}; it has '{}'. Write a dump custom with id type "
                      "x y z radius density{}.",
                      columns_.has({"id"}) ? "" : "id ", missing, joined(names_),
                      missing.find("density") == std::string::npos
                          ? ""
                          : ", or take structure.densities = \"recipe\"");
      if (!missing.empty() || !columns_.has({"id"}))
        columns_ = NamedColumns({});
    } else if (item_.rfind("BOX BOUNDS", 0) == 0) {
      item_ = "BOX BOUNDS";
      check_boundary(number, {words.begin() + 3, words.end()});
    }
  }

  // "pp pp ff", perhaps behind "xy xz yz"; old dumps say nothing.
  void check_boundary(int number, const Words &words) {
    const Words last(words.end() - std::min<long>(3, long(words.size())), words.end());
    if (last.size() != 3 || last[0].size() != 2)
      return;
    for (int axis = 0; axis < 3; ++axis)
      if (const bool wanted = axis < 2 || format_.z_periodic; (last[axis] == "pp") != wanted)
        mistakes_.add(number, "the dump's box is {}periodic along {} ('{}'). {}",
                      wanted ? "not " : "", "xyz"[axis], joined(last),
                      axis < 2 ? "Films that are periodic in x and y are read."
                               : "Give structure.boundary as in the script.");
  }

  void bounds(int number, const Words &words) {
    const auto value = [&](size_t k) {
      return k < words.size() ? number_in(words[k]).value_or(NAN) : NAN;
    };
    if (words.size() == 4 || (words.size() == 3 && value(2) != 0.0))
      mistakes_.add(number, "the box is tilted ('{}'); only boxes with right angles are read.",
                    joined(words).substr(0, 80));
    else if (side_ == 3 || !std::isfinite(value(1) - value(0)) || !(value(1) > value(0)))
      mistakes_.add(number, "the box side '{}' needs two finite numbers, the lower first.",
                    joined(words).substr(0, 80));
    else {
      low_[side_] = value(0);
      high_[side_++] = value(1);
    }
  }
};

// Offsets of the frames, the line before each, and its time step.
struct FrameStart {
  size_t at;
  int line;
  std::string step;
};

std::vector<FrameStart> frames_of(const std::string &text) {
  std::vector<FrameStart> out;
  int line = 0;
  for (size_t at = 0; at < text.size(); ++line) {
    const size_t end = std::min(text.find('\n', at), text.size());
    if (text.compare(at, 14, "ITEM: TIMESTEP") == 0) {
      const Words step = words_of(text.substr(std::min(end + 1, text.size()), 30));
      out.push_back({at, line, step.empty() ? "" : step[0]});
    }
    at = end + 1;
  }
  return out;
}

// "0, 5, 10 ... 90"
std::string steps_of(const std::vector<FrameStart> &frames) {
  constexpr size_t kShown = 3;
  std::string out;
  for (size_t k = 0; k < std::min(kShown, frames.size()); ++k)
    out += (k == 0 ? "" : ", ") + frames[k].step;
  return frames.size() > kShown ? out + " ... " + frames.back().step : out;
}

// Blanks between columns become commas where the header has no other separator.
std::string with_separators(const std::string &text) {
  const size_t from = text.find_first_not_of("#% \t");
  std::string out;
  if (from == std::string::npos)
    return out;
  if (text.substr(from, text.find('\n', from) - from).find_first_of(",;\t") != std::string::npos)
    return text.substr(from);
  std::istringstream in(text.substr(from));
  for (std::string line; std::getline(in, line);)
    out += fmt::format("{}\n", fmt::join(words_of(line), ","));
  return out;
}

} // namespace

ParticleFile kind_of_particle_file(const std::string &text) {
  const std::string first = text.substr(0, std::min(text.find_first_of("\r\n"), size_t(1000)));
  if (first.rfind("ITEM:", 0) == 0)
    return ParticleFile::Dump;
  std::string names = first;
  std::replace_if(
      names.begin(), names.end(), [](char c) { return std::strchr(",;\"#%", c) != nullptr; }, ' ');
  const NamedColumns columns(words_of(names));
  constexpr size_t kHead = 2000; // bytes; the title of a data file may name its columns
  const std::string head = text.substr(0, kHead);
  const auto has = [&](const char *part) { return head.find(part) != std::string::npos; };
  if (!has(" atoms") && columns.missing(false, false).empty() && columns.has({"x"}) &&
      columns.has({"y"}) && columns.has({"z"}))
    return ParticleFile::Table;
  const bool data = has(" atoms") || has(" atom types") || has("lo xhi") || has("\nAtoms");
  return data || text.empty() ? ParticleFile::Data : ParticleFile::Other;
}

ParticleData parse_dump(const std::string &text, const DataFormat &format, Mistakes &mistakes) {
  const std::vector<FrameStart> frames = frames_of(text);
  auto chosen = frames.end();
  if (format.frame == "last" && !frames.empty())
    chosen = frames.end() - 1;
  else
    chosen = std::find_if(frames.begin(), frames.end(),
                          [&](const FrameStart &f) { return f.step == format.frame; });
  if (chosen == frames.end()) {
    mistakes.add(0,
                 "structure.frame is \"{}\", but the dump's frames are of the steps {}. Give one "
                 "of them, or \"last\".",
                 format.frame, steps_of(frames));
    return {};
  }
  const size_t end = chosen + 1 == frames.end() ? text.size() : (chosen + 1)->at;
  std::istringstream in(text.substr(chosen->at, end - chosen->at));
  Frame frame(format, mistakes);
  int number = chosen->line;
  bool newline = true;
  for (std::string line; std::getline(in, line);) {
    newline = !in.eof();
    frame.line(++number, words_of(line));
  }
  return frame.finish(newline);
}

namespace {

std::vector<std::vector<double>> numbers_of(const CsvTable &table) {
  std::vector<std::vector<double>> out;
  for (const std::string &name : table.header())
    out.push_back(table.numbers(name));
  return out;
}

} // namespace

ParticleData parse_sphere_table(const std::string &text, const DataFormat &format,
                                Mistakes &mistakes) {
  const CsvTable table = CsvTable::parse(with_separators(text));
  if (const std::string unclear = table.ambiguous(); !unclear.empty())
    mistakes.add(0, unclear);
  for (const int line : table.bad_lines())
    mistakes.add(line,
                 "the row has other columns than the header. Give the file as it was written.");
  if (!(format.side_x > 0.0) || !(format.side_y > 0.0) || format.z_periodic)
    mistakes.add(0, "a table of spheres has no box: {}.",
                 format.z_periodic ? "give structure.boundary = \"p p f\""
                                   : "give the recipe's cell.x_um and cell.y_um, the "
                                     "sides along which it is periodic");
  if (format.frame != "last")
    mistakes.add(0, "structure.frame is for dumps; a table has one frame. Remove it.");
  const NamedColumns columns(table.header());
  if (const std::string missing = columns.missing(false, format.densities); !missing.empty())
    mistakes.add(1, "the table has no column {}. Add it, or take structure.densities = \"recipe\".",
                 missing);
  if (!mistakes.empty())
    return {};
  // As high as its centres lie; a row without a height is refused as such.
  Eigen::Vector3d low(0.0, 0.0, HUGE_VAL),
      high(format.side_x / format.length_um, format.side_y / format.length_um, -HUGE_VAL);
  for (const double z : table.numbers(table.header()[columns.at({"z"})]))
    if (std::isfinite(z)) {
      low.z() = std::min(low.z(), z);
      high.z() = std::max(high.z(), z);
    }
  AtomRows rows(kStyle, mistakes, joined(table.header()));
  const std::vector<std::vector<double>> values = numbers_of(table);
  for (size_t k = 0; k < table.rows(); ++k)
    rows.read(table.line_of(k),
              columns.row([&](size_t column) { return text_of(values[column][k]); }, long(k) + 1,
                          1.0 / format.density_g_cm3, low, high),
              INT_MAX);
  ParticleData out = in_the_box(rows, low, high, format, mistakes);
  out.molecules = columns.has({"mol", "molecule", "body"});
  return out;
}

} // namespace calendem
