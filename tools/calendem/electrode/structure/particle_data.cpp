// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/particle_data.h"
#include "base/plain_text.h"
#include "base/recipe.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace calendem {

namespace {

// Sections of other atom styles and of settings: their rows are not needed here.
bool is_of_others(const std::string &section) {
  static const std::regex kOthers("(Pair|PairIJ|Bond|Angle|Dihedral|Improper) Coeffs|(Atom|Bond|"
                                  "Angle) Type Labels|(Bond|Angle|Dihedral|Improper|Ellipsoid|Line|"
                                  "Triangle)s|Bodies|Velocities|Masses");
  return std::regex_match(section, kOthers);
}

// One go through a file, line by line.
class Reader {
public:
  Reader(const DataFormat &format, Mistakes &mistakes)
      : format_(format), mistakes_(mistakes), header_(mistakes),
        atoms_(format.atom_style, mistakes) {}

  void line(const std::string &text) {
    if (++number_ == 1) // a title
      return;
    const size_t comment = text.find('#');
    const std::vector<std::string> words = words_of(text.substr(0, comment));
    if (words.empty())
      return;
    if (std::isalpha(static_cast<unsigned char>(words[0][0])))
      section(joined(words), comment == std::string::npos ? "" : text.substr(comment + 1));
    else if (section_.empty())
      header_.read(number_, words);
    else if (section_ == "Atoms")
      atoms_.read(number_, words, header_.types());
    else if (section_ == "Atom Type Labels" && words.size() == 2)
      atoms_.name_type(words[0], words[1]);
    else
      ++rows_[section_];
  }

  ParticleData finish(bool ends_with_newline) {
    header_.check();
    check_counts(ends_with_newline);
    return in_the_box(atoms_, header_.low(), header_.high(), format_, mistakes_);
  }
  const std::string &style() const { return style_; }

private:
  const DataFormat &format_;
  Mistakes &mistakes_;
  DataHeader header_;
  AtomRows atoms_;
  int number_ = 0;
  std::string section_, style_;
  std::map<std::string, long> rows_; ///< of the sections that are left out

  void section(const std::string &name, const std::string &comment) {
    if (name == "Atoms" && atoms_.rows() > 0)
      mistakes_.add(number_, "a second section Atoms: every particle may occur once. Give one "
                             "structure for each file.");
    else if (name == "Atoms" || is_of_others(name)) {
      section_ = name;
      rows_[name];
      if (name == "Atoms")
        style_ = joined(words_of(comment));
    } else
      mistakes_.add(number_,
                    "'{}' is neither a row of numbers nor a section of a data file (Atoms, "
                    "Velocities, ...). Correct or remove it.",
                    name.substr(0, 60));
  }

  void check_counts(bool ends_with_newline) {
    const long announced = header_.atoms(), rows = long(atoms_.rows());
    if (number_ > 0 && !rows_.count("Atoms"))
      mistakes_.add(0, "it has no section Atoms: it is cut or not a data file. A dump is not one; "
                       "write the structure with write_data.");
    else if (announced > 0 && rows != announced)
      mistakes_.add(0,
                    "line {} announces {} atoms, the section Atoms has {} rows: the file is cut or "
                    "was changed by hand. Give the whole file.",
                    header_.atoms_line(), announced, rows);
    else if (section_ == "Atoms" && !ends_with_newline)
      mistakes_.add(number_,
                    "the last row does not end with a newline: its last number may be cut. "
                    "Give the whole file, or end it with a newline if it is whole.");
    if (rows_.count("Velocities") && announced > 0 && rows_["Velocities"] != announced)
      mistakes_.add(
          0,
          "the section Velocities has {} rows for {} atoms: the file is cut. Give the whole file.",
          rows_["Velocities"], announced);
  }
};

constexpr const char *kColumnsAreNamed = "by the file itself";

// False for a row that lies where it cannot.
bool put_into_box(DataParticle &p, const Eigen::Vector3d &low, const Eigen::Vector3d &high,
                  const DataFormat &format, Mistakes &mistakes) {
  constexpr double kRounding = 1e-6, kFarthest = 1e4; // in sides of the box
  p.diameter *= format.length_um;
  p.density *= format.density_g_cm3;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = low[axis], hi = high[axis], side = hi - lo;
    const double from = p.x[axis] - lo;
    const bool periodic = axis < 2 || format.z_periodic;
    if (!std::isfinite(side)) // reported already
      return false;
    if (std::fabs(from - 0.5 * side) > (periodic ? kFarthest : 0.5 + kRounding) * side) {
      const char name = char('x' + axis);
      mistakes.add(
          p.line, "particle {} lies outside the box: {} = {:g}, {}lo and {}hi are {:g} and {:g}{}.",
          p.id, name, p.x[axis], name, name, lo, hi,
          periodic ? ", more than 10000 boxes away"
                   : ", not periodic. Give structure.boundary as "
                     "in the script, or the right box");
      return false;
    }
    p.x[axis] = format.length_um * (periodic ? from - side * std::floor(from / side) : from);
  }
  return true;
}

} // namespace

ParticleData in_the_box(AtomRows &rows, const Eigen::Vector3d &low, const Eigen::Vector3d &high,
                        const DataFormat &format, Mistakes &mistakes) {
  ParticleData out;
  out.box = format.length_um * (high - low);
  out.molecules = rows.molecules();
  out.labels = rows.labels();
  for (DataParticle &p : rows.good())
    if (put_into_box(p, low, high, format, mistakes))
      out.particles.push_back(p);
  return out;
}

ParticleData parse_particle_data(const std::string &file, const DataFormat &format,
                                 std::string &style, Mistakes &mistakes) {
  const std::string text = unpacked_text(file, mistakes);
  const PlainText plain = plain_text(text.substr(0, 200));
  if (!plain.wrong.empty() || plain.encoding == "UTF-16") {
    mistakes.add(0, "this is no data file: it " +
                        (plain.wrong.empty() ? "is UTF-16. Save it as UTF-8." : plain.wrong));
    return {};
  }
  style = "";
  if (const ParticleFile kind = kind_of_particle_file(text); kind != ParticleFile::Data) {
    style = kColumnsAreNamed;
    if (kind == ParticleFile::Other) {
      mistakes.add(0,
                   "this is no data file of LAMMPS or LIGGGHTS (no line announces atoms), no dump "
                   "(ITEM: TIMESTEP) and no table of spheres (a first line that names x, y, z and "
                   "r or d). It begins with '{}'. Give one of these.",
                   plain.text.substr(0, std::min<size_t>(plain.text.find('\n'), 60)));
      return {};
    }
    return kind == ParticleFile::Dump ? parse_dump(text, format, mistakes)
                                      : parse_sphere_table(text, format, mistakes);
  }
  if (format.frame != "last")
    mistakes.add(
        0, "structure.frame is \"{}\", but a data file has one frame. Remove it, or give a dump.",
        format.frame);
  std::istringstream in(text);
  Reader reader(format, mistakes);
  std::string line;
  bool newline = true;
  while (std::getline(in, line)) {
    newline = !in.eof();
    reader.line(line);
  }
  style = reader.style();
  return reader.finish(newline);
}

ParticleData read_particle_data(const std::string &file, const DataFormat &format,
                                Mistakes &mistakes) {
  std::string style;
  const ParticleData data = parse_particle_data(file, format, style, mistakes);
  const int before = mistakes.count();
  if (style != kColumnsAreNamed)
    check_columns(file, format, style, data, mistakes);
  if (mistakes.count() == before)
    check_units(format, data, mistakes);
  return data;
}

namespace {

const char *const kStyles[] = {"sphere", "bpm/sphere", "hybrid"};
const char *const kNoSpheres[] = {"angle",     "atomic",   "body",      "bond",
                                  "charge",    "dipole",   "ellipsoid", "full",
                                  "molecular", "template", "line",      "tri"};

size_t densities(const ParticleData &data) {
  std::set<double> all;
  for (const DataParticle &p : data.particles)
    all.insert(p.density);
  return all.size();
}

double median(const ParticleData &data, double DataParticle::*value) {
  std::vector<double> all;
  for (const DataParticle &p : data.particles)
    all.push_back(p.*value);
  std::nth_element(all.begin(), all.begin() + long(all.size() / 2), all.end());
  return all[all.size() / 2];
}

bool plausible(double diameter, double density) {
  return diameter >= 0.05 && diameter <= 100.0 && density >= 0.01 && density <= 25.0;
}

// False if the file names no style that is known.
bool named_style_fits(const std::string &stated, const std::string &style, Mistakes &mistakes) {
  const std::string name = columns_name(style);
  const auto is = [&](const char *known) { return name == known; };
  if (std::any_of(std::begin(kNoSpheres), std::end(kNoSpheres), is))
    mistakes.add(0,
                 "its section says 'Atoms # {}'; atoms of that style are not spheres with diameter "
                 "and density. Write it with atom_style sphere.",
                 style);
  else if (std::none_of(std::begin(kStyles), std::end(kStyles), is))
    return false;
  else if (columns_name(stated) != name)
    mistakes.add(0,
                 "its section says 'Atoms # {0}', structure.atom_style is \"{1}\". Give "
                 "structure.atom_style = \"{0}\".",
                 style, stated);
  return true;
}

} // namespace

void check_columns(const std::string &file, const DataFormat &format, const std::string &style,
                   const ParticleData &data, Mistakes &mistakes) {
  if (named_style_fits(format.atom_style, style, mistakes))
    return;
  const bool sound = mistakes.empty();
  const size_t of_file = densities(data);
  for (const char *other : kStyles) {
    if (columns_name(format.atom_style) == other)
      continue;
    DataFormat tried = format;
    tried.atom_style = other;
    std::string none;
    Mistakes wrong(file, 0);
    const ParticleData theirs = parse_particle_data(file, tried, none, wrong);
    if (wrong.empty() && (!sound || (of_file > 3 && of_file >= 2 * densities(theirs))))
      mistakes.add(0,
                   "its columns look like those of atom_style {0} ({1}), not of {2} ({3}){4}. Give "
                   "structure.atom_style as in the script that wrote it.",
                   other, columns_of(other), format.atom_style, columns_of(format.atom_style),
                   sound ? ": the densities differ as places do" : "");
  }
}

void check_units(const DataFormat &format, const ParticleData &data, Mistakes &mistakes) {
  if (data.particles.empty())
    return;
  const double diameter = median(data, &DataParticle::diameter),
               density = median(data, &DataParticle::density);
  if (plausible(diameter, density))
    return;
  std::string looks;
  for (const char *units : {"micro", "si", "cgs"}) {
    const DataUnits f = units_named(units);
    if (plausible(diameter / format.length_um * f.length_um,
                  density / format.density_g_cm3 * f.density_g_cm3))
      looks += fmt::format(" In units {} it would be {:.4g} um and {:.4g} g/cm3.", units,
                           diameter / format.length_um * f.length_um,
                           density / format.density_g_cm3 * f.density_g_cm3);
  }
  mistakes.add(0,
               "the median sphere is {:.4g} um wide and weighs {:.4g} g/cm3 in the units stated; "
               "0.05 to 100 um and 0.01 to 25 g/cm3 are plausible. Give structure.units as in the "
               "script that wrote the file.{}",
               diameter, density, looks);
}

} // namespace calendem
