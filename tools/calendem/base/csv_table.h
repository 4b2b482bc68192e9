// SPDX-License-Identifier: GPL-2.0-or-later
// A comma-separated table with a header line; lines that begin with '#' are comments,
// a byte-order mark is skipped. Cells are kept as text, numbers are made on request (an empty or
// unreadable cell is NaN). No quoting: none of the project's tables needs it. Not a library: of those
// packaged libcsv knows no lines and no comments, fast-cpp-csv-parser wants the columns at
// compile time, VTK's reader does not say which rows are short.
#ifndef CALENDEM_BASE_CSV_TABLE_H
#define CALENDEM_BASE_CSV_TABLE_H

#include <string>
#include <vector>

namespace calendem {

class CsvTable {
public:
  /// Reads the table from `text`. Rows whose number of cells differs from the header's are not
  /// kept; their line numbers (from 1) are in `bad_lines()`.
  static CsvTable parse(const std::string &text);

  bool has(const std::string &column) const;
  std::vector<double> numbers(const std::string &column) const;
  std::vector<std::string> texts(const std::string &column) const;
  const std::vector<std::string> &header() const { return header_; }
  std::size_t rows() const { return rows_.size(); }
  const std::vector<int> &bad_lines() const { return bad_lines_; }
  /// Line of a row in the text, from 1.
  int line_of(std::size_t row) const { return lines_[row]; }
  int last_line() const { return last_line_; }
  /// What is wrong and what to do where two columns have one of these names, or any; empty: nothing.
  std::string ambiguous(const std::vector<std::string> &columns = {}) const;

private:
  int index_of(const std::string &column) const;

  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<int> bad_lines_, lines_;
  int last_line_ = 0;
};

} // namespace calendem

#endif
