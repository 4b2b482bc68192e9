// SPDX-License-Identifier: GPL-2.0-or-later
// A TOML file as a tree. A line that is no TOML is a mistake and is left out, so that the mistakes
// of the other lines are found in the same go. A file of another kind than the wanted one (a recipe
// given to a verb that takes a case) is one message, not one for each of its keys.
#ifndef CALENDEM_BASE_TOML_FILE_H
#define CALENDEM_BASE_TOML_FILE_H

#include "base/messages.h"
#include <string>
#include <toml++/toml.h>

namespace calendem {

struct TomlFile {
  toml::table root;
  bool whole = false; ///< every line could be read: a key that is not there is missing
};

/// Missing, unreadable and empty files are mistakes too.
TomlFile parse_toml(const std::string &file, Mistakes &mistakes);

inline int line_of(const toml::node &node) { return static_cast<int>(node.source().begin.line); }

/// A value as a message shows it: `"text"`, `3.5`, `a table`.
std::string shown(const toml::node &node);

enum class FileKind { Recipe, Film, Tomogram, Case, Experiment, Study, Bank, Round };

/// As parse_toml. Throws Failure(2) if the file's tables are those of another kind.
TomlFile parse_toml(const std::string &file, FileKind wanted, Mistakes &mistakes);

} // namespace calendem

#endif
