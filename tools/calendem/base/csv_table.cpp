// SPDX-License-Identifier: GPL-2.0-or-later

#include "base/csv_table.h"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <sstream>

namespace calendem {
namespace {

std::string trimmed(const std::string &text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos)
    return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> split(const std::string &line) {
  std::vector<std::string> cells;
  std::string::size_type start = 0;
  while (true) {
    const auto comma = line.find(',', start);
    cells.push_back(trimmed(line.substr(start, comma - start)));
    if (comma == std::string::npos)
      return cells;
    start = comma + 1;
  }
}

double number(const std::string &cell) {
  char *end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  const bool whole = !cell.empty() && end != nullptr && *end == '\0';
  return whole ? value : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

CsvTable CsvTable::parse(const std::string &text) {
  CsvTable table;
  const std::string mark = "\xEF\xBB\xBF"; // that spreadsheets put before UTF-8
  std::istringstream lines(text.rfind(mark, 0) == 0 ? text.substr(mark.size()) : text);
  std::string line;
  for (int n = 1; std::getline(lines, line); ++n) {
    line = trimmed(line);
    if (line.empty() || line.front() == '#')
      continue;
    table.last_line_ = n;
    auto cells = split(line);
    if (table.header_.empty())
      table.header_ = std::move(cells);
    else if (cells.size() != table.header_.size())
      table.bad_lines_.push_back(n);
    else {
      table.rows_.push_back(std::move(cells));
      table.lines_.push_back(n);
    }
  }
  return table;
}

int CsvTable::index_of(const std::string &column) const {
  for (std::size_t i = 0; i < header_.size(); ++i)
    if (header_[i] == column)
      return static_cast<int>(i);
  return -1;
}

std::string CsvTable::ambiguous(const std::vector<std::string> &columns) const {
  std::set<std::string> seen;
  for (const std::string &column : header_)
    if (const bool read = columns.empty() || std::count(columns.begin(), columns.end(), column) > 0;
        read && !column.empty() && !seen.insert(column).second)
      return "has two columns '" + column + "'. Rename or remove one.";
  return "";
}

bool CsvTable::has(const std::string &column) const { return index_of(column) >= 0; }

std::vector<std::string> CsvTable::texts(const std::string &column) const {
  std::vector<std::string> values;
  const int index = index_of(column);
  if (index < 0)
    return values;
  for (const auto &row : rows_)
    values.push_back(row[static_cast<std::size_t>(index)]);
  return values;
}

std::vector<double> CsvTable::numbers(const std::string &column) const {
  std::vector<double> values;
  for (const auto &cell : texts(column))
    values.push_back(number(cell));
  return values;
}

} // namespace calendem
