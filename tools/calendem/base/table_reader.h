// SPDX-License-Identifier: GPL-2.0-or-later
// Values of one table of a TOML file whose shape no list of keys can give (lists of tables, lists):
// each against its key, with the messages of all readers.
#ifndef CALENDEM_BASE_TABLE_READER_H
#define CALENDEM_BASE_TABLE_READER_H

#include "base/registry.h"
#include "base/toml_reader.h"
#include <filesystem>
#include <functional>

namespace calendem {

/// A key's fallback is its value where it is not given; empty: it must be given; "-": it may be
/// missing and is then empty or 0.
class TableReader {
public:
  /// `whole`: every line of the file could be read, so that a key that is not there is missing.
  TableReader(const std::string &file, bool whole, Mistakes &mistakes)
      : folder_(std::filesystem::absolute(file).parent_path()), whole_(whole), mistakes_(mistakes) {
  }

protected:
  std::filesystem::path folder_; ///< of the file
  bool whole_;
  Mistakes &mistakes_;

  /// Adds a mistake at the place of `at`; values are put into the text as by fmt::format.
  template <class... Values>
  void refuse(const toml::node &at, fmt::format_string<Values...> what, Values &&...values) {
    mistakes_.add(line_of(at), fmt::format(what, std::forward<Values>(values)...));
  }
  /// Calls `read` with each table of the list [[name]] and its node.
  void each_table(const toml::table &root, const std::string &name,
                  const std::function<void(const toml::table &)> &read);
  /// `prefix` is of the names in messages: "condition.".
  void report_unknown(const toml::table &table, const std::vector<std::string> &known,
                      const std::string &prefix = "");
  void unknown(const std::string &name, int line, const std::vector<std::string> &known);
  std::string text(const toml::table &table, const Key &key);
  std::optional<double> number(const toml::node &node, const Key &key);
  double number(const toml::table &table, const Key &key);
  /// Lists; empty where they are not given.
  std::vector<double> numbers(const toml::table &table, const Key &key);
  std::vector<std::string> texts(const toml::table &table, const std::string &key);
  /// Absolute; the file gives it relative to itself.
  std::string path(const toml::table &table, const Key &key);

private:
  void report_missing(const toml::table &table, const Key &key);
};

} // namespace calendem

#endif
