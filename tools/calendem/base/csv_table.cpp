// SPDX-License-Identifier: GPL-2.0-or-later

#include "base/csv_table.h"
#include "base/plain_text.h"
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <set>
#include <tuple>

namespace calendem {
namespace {

using Cells = std::vector<std::string>;
struct Line {
  Cells cells;
  int number; ///< of the line in the text, from 1
};

std::string trimmed(const std::string &text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos)
    return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// The cell that begins at `at`, which moves to its end: the separator, the line's end or the
/// text's. In quotes it may hold these; "" stands for a quote.
std::string take_cell(const std::string &text, std::size_t &at, char separator) {
  const std::size_t quote = text.find_first_not_of(' ', at);
  if (quote != std::string::npos && text[quote] == '"') {
    std::string cell;
    for (at = quote + 1; at < text.size(); ++at)
      if (text[at] != '"')
        cell += text[at];
      else if (at + 1 < text.size() && text[at + 1] == '"')
        cell += text[++at];
      else
        break;
    at = std::min(text.find_first_of(std::string{separator, '\n'}, at), text.size());
    return trimmed(cell);
  }
  const std::size_t from = at;
  at = std::min(text.find_first_of(std::string{separator, '\n'}, at), text.size());
  return trimmed(text.substr(from, at - from));
}

/// Lines that are neither empty nor comments; `last`: how many there are of all.
std::vector<Line> split(const std::string &text, char separator, int &last) {
  std::vector<Line> out;
  int number = 1;
  for (std::size_t at = 0; at < text.size(); ++at, ++number) {
    const std::size_t from = at, first = text.find_first_not_of(" \t", at);
    if (first == std::string::npos || text[first] == '#' || text[first] == '\n') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    Line line{{take_cell(text, at, separator)}, number};
    while (at < text.size() && text[at] == separator)
      line.cells.push_back(take_cell(text, ++at, separator));
    number += int(std::count(text.begin() + long(from), text.begin() + long(at), '\n'));
    last = number;
    out.push_back(std::move(line));
  }
  return out;
}

/// Digits, points, commas and blanks between them, and an exponent.
bool looks_like_number(const std::string &cell) {
  return cell.find_first_of("0123456789") != std::string::npos &&
         cell.find_first_not_of("0123456789., +-eE") == std::string::npos &&
         std::string("eE").find(cell[0]) == std::string::npos;
}

/// Place of the first row of numbers, two of them at least, that others of as many cells follow.
std::size_t first_row(const std::vector<Line> &lines) {
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Cells &cells = lines[k].cells;
    if (std::count_if(cells.begin(), cells.end(), looks_like_number) > 1 &&
        (k + 1 == lines.size() || lines[k + 1].cells.size() == cells.size()))
      return k;
  }
  return lines.size();
}

/// How badly the lines fit: those of another number of cells than the header's, cells that are no
/// numbers; the least is best.
std::tuple<bool, std::size_t, std::size_t> misfit(const std::vector<Line> &lines,
                                                  std::size_t begin) {
  if (begin >= lines.size())
    return {true, 0, 0};
  const std::size_t width = lines[begin > 0 ? begin - 1 : 0].cells.size();
  std::size_t other = 0, texts = 0;
  for (std::size_t k = begin; k < lines.size(); ++k) {
    other += lines[k].cells.size() != lines[begin].cells.size() ||
             (begin == 1 && lines[k].cells.size() != width);
    texts += std::size_t(std::count_if(lines[k].cells.begin(), lines[k].cells.end(),
                                       [](const auto &c) { return !looks_like_number(c); }));
  }
  return {width < 2 && lines[begin].cells.size() < 2, other, texts};
}

char find_separator(const std::string &text, bool is_export) {
  constexpr std::size_t kLook = 1 << 16;
  const std::string sample = text.substr(0, text.rfind('\n', kLook));
  char best = ',';
  std::tuple<bool, std::size_t, std::size_t> least{true, -1, -1};
  for (const char separator : {',', ';', '\t'}) {
    int none = 0;
    const std::vector<Line> lines = split(sample, separator, none);
    const auto found = misfit(lines, is_export ? first_row(lines) : 1);
    if (found < least) {
      least = found;
      best = separator;
    }
  }
  return best;
}

/// Behind each mark stand three digits and no more.
bool in_groups(const std::string &cell, char mark) {
  for (std::size_t at = cell.find(mark); at != std::string::npos; at = cell.find(mark, at + 1))
    if (std::min(cell.find_first_not_of("0123456789", at + 1), cell.size()) - at != 4)
      return false;
  return true;
}

/// What one number says of the decimals: '.', ',', or 0: it may be read in two ways; ' ': nothing.
char decimal_in(const std::string &cell) {
  const auto points = std::count(cell.begin(), cell.end(), '.'),
             commas = std::count(cell.begin(), cell.end(), ',');
  if (!looks_like_number(cell) || points + commas == 0)
    return ' ';
  if (points > 0 && commas > 0)
    return cell.rfind('.') > cell.rfind(',') ? '.' : ',';
  const char mark = points > 0 ? '.' : ',', other = points > 0 ? ',' : '.';
  if (points + commas > 1)
    return in_groups(cell, mark) ? other : ' '; // thousands, or a date
  const std::size_t at = cell.find(mark), digits = cell.find_first_of("0123456789"),
                    behind = cell.find_first_not_of("0123456789", at + 1);
  const std::size_t before = at - std::min(at, digits),
                    after = std::min(behind, cell.size()) - at - 1;
  const bool group = after == 3 && before > 0 && before < 4 && cell[digits] != '0';
  return group ? '\0' : mark;
}

} // namespace

void CsvTable::keep(Cells cells, int line) {
  if (cells.size() != header_.size())
    bad_lines_.push_back(line);
  else {
    rows_.push_back(std::move(cells));
    lines_.push_back(line);
  }
}

void CsvTable::read(const std::string &text, bool is_export) {
  std::vector<Line> lines = split(text, separator_, last_line_);
  std::size_t begin = is_export ? first_row(lines) : std::min<std::size_t>(1, lines.size());
  if (begin > 0)
    header_ = lines[begin - 1].cells;
  if (is_export && begin < lines.size()) {
    const std::size_t width = lines[begin].cells.size();
    const bool units =
        begin > 1 && lines[begin - 2].cells.size() == width &&
        std::all_of(header_.begin(), header_.end(), [](const auto &c) { return c.size() < 9; }) &&
        header_.size() == width;
    for (std::size_t k = 0; units && k < width; ++k) {
      const std::string &unit = header_[k], name = lines[begin - 2].cells[k];
      header_[k] = unit.empty() ? name : fmt::format("{} [{}]", name, trimmed(unit));
    }
    if (begin == 0 || header_.size() != width) {
      header_.clear();
      for (std::size_t k = 1; k <= width; ++k)
        header_.push_back(fmt::format("{}", k));
    }
  }
  for (; begin < lines.size(); ++begin)
    keep(std::move(lines[begin].cells), lines[begin].number);
}

void CsvTable::find_decimal() {
  std::string seen[3]; // a number with a decimal point, with a comma, with either
  for (const Cells &row : rows_)
    for (const std::string &cell : row)
      if (const char mark = decimal_in(cell); mark != ' ')
        if (std::string &first = seen[mark == '.' ? 0 : mark == ',' ? 1 : 2]; first.empty())
          first = cell;
  if (!seen[0].empty() && !seen[1].empty())
    unclear_ = fmt::format("has numbers with decimal points ('{}') and with decimal commas ('{}'). "
                           "Save it with one of them.",
                           seen[0], seen[1]);
  else if (seen[0].empty() && seen[1].empty() && !seen[2].empty()) {
    std::string digits = seen[2], fraction = seen[2];
    digits.erase(std::remove_if(digits.begin(), digits.end(), ::ispunct), digits.end());
    std::replace(fraction.begin(), fraction.end(), ',', '.');
    unclear_ = fmt::format("can be read in two ways: '{}' is {} or {}. Save it without groups of "
                           "thousands, and with more or fewer than three decimals.",
                           seen[2], fraction, digits);
  }
  decimal_ = seen[1].empty() ? '.' : ',';
}

std::string CsvTable::plain_number(const std::string &cell) const {
  if (separator_ == ',' && cell.find(',') == std::string::npos)
    return cell;
  const char group = decimal_ == ',' ? '.' : ',';
  if (!in_groups(cell.substr(0, cell.find(decimal_)), group))
    return "";
  std::string out = cell;
  out.erase(std::remove_if(out.begin(), out.end(), [&](char c) { return c == group || c == ' '; }),
            out.end());
  std::replace(out.begin(), out.end(), ',', '.');
  return out;
}

CsvTable::CsvTable(const std::string &bytes, bool is_export, char decimal) : decimal_(decimal) {
  const PlainText text = plain_text(bytes);
  unclear_ = text.wrong;
  encoding_ = text.encoding;
  separator_ = find_separator(text.text, is_export);
  read(text.text, is_export);
  if (decimal == 0 && separator_ == ',' && text.text.find('"') == std::string::npos)
    decimal_ = '.';
  else if (decimal == 0)
    find_decimal();
}

CsvTable CsvTable::parse(const std::string &bytes) { return {bytes, false, 0}; }

CsvTable CsvTable::parse_export(const std::string &bytes, char decimal) {
  return {bytes, true, decimal};
}

int CsvTable::index_of(const std::string &column) const {
  for (std::size_t i = 0; i < header_.size(); ++i)
    if (header_[i] == column)
      return static_cast<int>(i);
  return -1;
}

std::string CsvTable::ambiguous(const std::vector<std::string> &columns) const {
  if (!unclear_.empty())
    return unclear_;
  std::set<std::string> seen;
  for (const std::string &column : header_)
    if (const bool read = columns.empty() || std::count(columns.begin(), columns.end(), column) > 0;
        read && !column.empty() && !seen.insert(column).second)
      return "has two columns '" + column + "'. Rename or remove one.";
  return "";
}

std::string CsvTable::guess() const {
  std::string out;
  const auto add = [&](const char *text) { out += (out.empty() ? "" : ", ") + std::string(text); };
  if (!encoding_.empty() && encoding_ != "UTF-8")
    add(encoding_.c_str());
  if (separator_ != ',')
    add(separator_ == ';' ? "semicolons between columns" : "tabs between columns");
  if (decimal_ == ',')
    add("decimal commas");
  else if (separator_ != ',')
    add("decimal points");
  return out;
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
  for (const auto &cell : texts(column)) {
    const std::string text = plain_number(cell);
    char *end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool whole = !text.empty() && end != nullptr && *end == '\0';
    values.push_back(whole ? value : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

} // namespace calendem
