// SPDX-License-Identifier: GPL-2.0-or-later
// A table of text with a header line; lines that begin with '#' are comments. Separator, decimals,
// quotes and encoding are found out: commas and points, as in the project's own tables, semicolons
// or tabs, decimal commas. Cells are kept as text, numbers are made on request (an empty or
// unreadable cell is NaN). Not a library: of those packaged libcsv knows no lines and no comments,
// fast-cpp-csv-parser wants the columns at compile time, VTK's reader does not say which rows are
// short; none of them guesses.
#ifndef CALENDEM_BASE_CSV_TABLE_H
#define CALENDEM_BASE_CSV_TABLE_H

#include <string>
#include <vector>

namespace calendem {

class CsvTable {
public:
  CsvTable() = default;
  /// Reads the table from the bytes of a file. Rows whose number of cells differs from the header's
  /// are not kept; their line numbers (from 1) are in `bad_lines()`.
  static CsvTable parse(const std::string &bytes);
  /// A file of another program: lines above the header are left out, a line of units below it is put
  /// into the names ("Kraft [N]"), without a header the names are 1, 2 ... `decimal`: '.' or ','; 0:
  /// find out.
  static CsvTable parse_export(const std::string &bytes, char decimal = 0);

  bool has(const std::string &column) const;
  std::vector<double> numbers(const std::string &column) const;
  std::vector<std::string> texts(const std::string &column) const;
  const std::vector<std::string> &header() const { return header_; }
  std::size_t rows() const { return rows_.size(); }
  const std::vector<int> &bad_lines() const { return bad_lines_; }
  /// Line of a row in the text, from 1.
  int line_of(std::size_t row) const { return lines_[row]; }
  int last_line() const { return last_line_; }
  /// What is wrong and what to do where the file can be read in two ways or not at all, or where two
  /// columns have one of these names, or any; empty: nothing.
  std::string ambiguous(const std::vector<std::string> &columns = {}) const;
  /// How it was read, if not as UTF-8 with commas and points: "semicolons between columns, ...".
  std::string guess() const;

private:
  CsvTable(const std::string &bytes, bool is_export, char decimal);
  int index_of(const std::string &column) const;
  void read(const std::string &text, bool is_export);
  void keep(std::vector<std::string> cells, int line);
  void find_decimal();
  std::string plain_number(const std::string &cell) const;

  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<int> bad_lines_, lines_;
  int last_line_ = 0;
  char separator_ = ',', decimal_ = 0; ///< 0: not known yet
  std::string encoding_, unclear_;
};

} // namespace calendem

#endif
