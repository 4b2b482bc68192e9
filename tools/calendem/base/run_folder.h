// SPDX-License-Identifier: GPL-2.0-or-later
// The folder of a run, read: which files there are, each parsed once and checked in one way; the
// course of the run as columns. What a caller needs and cannot have is a Mistake that names the file
// and what to do.
#ifndef CALENDEM_BASE_RUN_FOLDER_H
#define CALENDEM_BASE_RUN_FOLDER_H

#include "base/csv_table.h"
#include "base/messages.h"
#include "base/toml_reader.h"
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace calendem {

/// In electrode.json: the settings as the recipe gave them; "recipe" has what a structure changed too.
constexpr const char *kRecipeGiven = "recipe_given";

/// The settings of its recipe, as electrode.json has them; empty where it has none.
std::map<std::string, std::string> recipe_in(const nlohmann::json &electrode);

using Column = std::vector<double>;

/// From one loss of contact to the next: rows of the curve.
struct Press {
  std::size_t top;  ///< of its maximum pressure
  std::size_t last; ///< of its release
};

struct Curve {
  std::vector<std::string> stage;
  std::map<std::string, Column> columns; ///< every numeric column of curve.csv, by its name

  bool has(const std::string &name) const { return columns.count(name) > 0; }
  const Column &operator[](const std::string &name) const { return columns.at(name); }
  std::size_t rows() const { return stage.size(); }
  std::size_t row_of_max_pressure() const;

  /// At least one of a curve with rows; one that has no release ends with the curve.
  std::vector<Press> presses() const;
  /// Rows of one branch: compression and dwell, or relaxation, joined to the other at its end.
  std::vector<std::size_t> compression() const;
  std::vector<std::size_t> relaxation() const;
};

/// Value of column `name` when the pressure first reaches `pressure` in compression, interpolated
/// between rows; NaN if it never does.
double at_first_crossing(const Curve &curve, double pressure_MPa, const std::string &name);

/// |P_top - P_bottom| / P_top of every row: the column `pressure_difference`, which is averaged
/// over a longer window than a row, or else from the row's own pressures.
Column imbalance(const Curve &curve);

/// Rows that press the film, and farther than any press before: below the largest pressure that it
/// was released from it loads elastically, as in a release. Of each row its pressure, and whether it
/// is of a release.
std::vector<std::size_t> first_loading(const Column &pressure, const std::vector<bool> &released);
std::vector<std::size_t> first_loading(const Curve &curve);

/// The largest imbalance over rows of first loading with P_top above `threshold_MPa`; NaN if none.
double worst_imbalance(const Curve &curve, double threshold_MPa);

/// The values of these rows, with NaN where rows between them are left out: a line ends there.
Column picked(const Column &values, const std::vector<std::size_t> &rows, double factor = 1);

class RunFolder {
public:
  explicit RunFolder(std::string folder) : folder_(std::move(folder)) {}

  const std::string &folder() const { return folder_; }
  std::string path_of(const std::string &name) const { return folder_ + "/" + name; }
  bool has(const std::string &name) const;

  /// The object in summary.json, electrode.json or another file; null where the file is missing,
  /// cut or damaged.
  const nlohmann::json &object(const std::string &name);
  const nlohmann::json &object(const std::string &name, Mistakes &mistakes);
  /// A number of summary.json; 0 and a mistake where it is none.
  double number(const std::string &key, Mistakes &mistakes);
  /// The rows that are whole; an empty table where the file is missing.
  const CsvTable &table(const std::string &name);
  /// The table's `columns`, by name; empty after a mistake: a column missing, a row cut short.
  std::map<std::string, Column>
  columns(const std::string &name, const std::vector<std::string> &columns, Mistakes &mistakes);
  /// curve.csv, which must have `columns` (and `stage`), two rows and a number in every cell of
  /// them. Empty after a mistake. Of a run that is not finished the last row may be cut short: it is
  /// left out, which is a note.
  Curve curve(const std::vector<std::string> &columns, Mistakes &mistakes, Mistakes &notes);
  /// 1 / tortuosity factor of the macropores through the plane at a moment of structure.json; 0: no
  /// path leads through; NaN: not measured.
  double inverse_tortuosity(const std::string &moment);
  /// case.toml, as run. Throws Failure(2) with every mistake of it.
  Settings settings() const;

  /// Why the run is not finished; empty: it is.
  std::string unfinished();
  /// Adds a mistake where it is not.
  void must_be_finished(Mistakes &mistakes);

private:
  std::string folder_;
  std::map<std::string, nlohmann::json> objects_;
  std::map<std::string, CsvTable> tables_;

  bool has_columns(const std::string &name, const std::vector<std::string> &columns,
                   Mistakes &mistakes);
  bool rows_are_whole(const std::string &name, Mistakes &mistakes, Mistakes &notes);
};

} // namespace calendem

#endif
