// SPDX-License-Identifier: GPL-2.0-or-later
// Spheres of LAMMPS and LIGGGHTS (data files, dumps) and of tables x y z r, and whether a file can
// have the columns and the units that its user states.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_PARTICLE_DATA_H
#define CALENDEM_ELECTRODE_STRUCTURE_PARTICLE_DATA_H

#include "base/messages.h"
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace calendem {

/// What a data file does not say of itself; the script that wrote it does.
struct DataFormat {
  std::string atom_style = "sphere"; ///< sphere = granular, bpm/sphere, hybrid (of those first)
  double length_um = 1.0;            ///< one unit of length
  double density_g_cm3 = 1.0;        ///< one unit of density
  bool z_periodic = false;           ///< x and y always are
  bool densities = true;             ///< wanted; else those that a dump or table lacks are 1 g/cm3
  std::string frame = "last";        ///< of a dump, or its time step
  double side_x = 0.0, side_y = 0.0; ///< of a table's box [um]; 0: not known
};

struct DataParticle {
  long id = 0;
  int type = 0;
  long molecule = 0; ///< 0: of none
  double diameter = 0.0, density = 0.0;
  Eigen::Vector3d x; ///< from the lower corner of the box; inside it where the box is periodic
  int line = 0;      ///< of the file
};

struct ParticleData {
  Eigen::Vector3d box = Eigen::Vector3d::Zero(); ///< sides
  bool molecules = false;                        ///< the rows have a column for them
  std::map<std::string, std::string> labels;     ///< number of each of Atom Type Labels
  std::vector<DataParticle> particles;           ///< in the order of the file
};

/// Columns of a row by atom_style, for messages.
std::string columns_of(const std::string &atom_style);

/// Lengths come in um, densities in g/cm3. Velocities and masses by type are counted and left out.
/// Mistakes: rows that are no sphere, ids that are there twice, fewer or more rows than announced,
/// spheres outside the box, a tilted box, columns or units that cannot be the stated ones.
ParticleData read_particle_data(const std::string &file, const DataFormat &format,
                                Mistakes &mistakes);

/// What its first line says, and of a data file a line of its header or its section Atoms.
enum class ParticleFile { Data, Dump, Table, Other };
ParticleFile kind_of_particle_file(const std::string &text);

/// A frame of a dump, whose columns are named. Further mistakes: another box than the stated
/// boundary, a frame that is not there or cut, columns that lack place, size, type or density.
ParticleData parse_dump(const std::string &text, const DataFormat &format, Mistakes &mistakes);
/// A table whose header names x, y, z and r or d; ids are the rows' numbers and types 1 where it
/// names none. Its box has the sides of the format and no height.
ParticleData parse_sphere_table(const std::string &text, const DataFormat &format,
                                Mistakes &mistakes);

/// As read_particle_data(), without these checks; `style`: what stands behind `Atoms #`.
ParticleData parse_particle_data(const std::string &file, const DataFormat &format,
                                 std::string &style, Mistakes &mistakes);

/// Against the style that the file names; where it names none, against the other columns: a file
/// that only they make sound, or in which only they give few densities, is taken for theirs.
void check_columns(const std::string &file, const DataFormat &format, const std::string &style,
                   const ParticleData &data, Mistakes &mistakes);

/// Secondary particles and CBD are 0.05 to 100 um wide and weigh 0.01 to 25 g/cm3.
void check_units(const DataFormat &format, const ParticleData &data, Mistakes &mistakes);

// The lines of a data file: its header (how many particles, the box), the rows of the section
// Atoms, and what their words mean.

/// The whole word as a number, finite or not; nothing if it is none.
std::optional<double> number_in(const std::string &word);
std::optional<long> whole_number_in(const std::string &word);

/// "granular" is another name of "sphere".
std::string columns_name(const std::string &atom_style);

class AtomRows {
public:
  /// `columns`: for messages, those of the file where they are not the style's.
  AtomRows(const std::string &atom_style, Mistakes &mistakes, const std::string &columns = "");

  /// Rows may name the type so (section Atom Type Labels).
  void name_type(const std::string &number, const std::string &label) {
    number_of_label_[label] = number;
  }
  /// `types`: as many as the header announces.
  void read(int line, std::vector<std::string> words, long types);

  size_t rows() const { return rows_; }         ///< good and bad
  bool molecules() const { return molecules_; } ///< there is a column for them
  const std::map<std::string, std::string> &labels() const { return number_of_label_; }
  std::vector<DataParticle> &good() { return good_; } ///< in the units of the file

private:
  std::string style_, columns_;
  Mistakes &mistakes_;
  size_t rows_ = 0, width_ = 0;
  bool molecules_ = false;
  std::vector<DataParticle> good_;
  std::unordered_map<long, int> line_of_id_;

  std::map<std::string, std::string> number_of_label_;

  bool has_its_columns(int line, size_t words);
};

/// The good rows in um and g/cm3 from the corner `low` of the box, those in it where it is periodic; a
/// mistake for each that lies outside where it is not.
ParticleData in_the_box(AtomRows &rows, const Eigen::Vector3d &low, const Eigen::Vector3d &high,
                        const DataFormat &format, Mistakes &mistakes);

/// The bytes of a file, unpacked if it is packed by gzip. A mistake where it is cut.
std::string unpacked_text(const std::string &file, Mistakes &mistakes);

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
  int atoms_line_ = 0, types_line_ = 0;                               ///< 0: there is none
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero(), edge_ = origin_; ///< of LAMMPS' general box
  std::array<bool, 3> side_ = {false, false, false};                  ///< there is a line for it
  Eigen::Vector3d low_ = Eigen::Vector3d::Constant(NAN), high_ = low_;

  void read_count(int line, const std::string &name, const std::string &word, size_t numbers);
  void read_side(int line, int axis, const std::vector<std::string> &words, size_t numbers);
  void read_edge(int line, const std::vector<std::string> &words, size_t numbers);
  void read_tilt(int line, const std::vector<std::string> &words, size_t numbers);
};

} // namespace calendem

#endif
