// SPDX-License-Identifier: GPL-2.0-or-later
// What a TOML file is for, told by its tables: a recipe given to a verb that takes a case is one
// message, not one for each of its keys.
#ifndef CALENDEM_BASE_FILE_KIND_H
#define CALENDEM_BASE_FILE_KIND_H

#include "base/toml_file.h"

namespace calendem {

enum class FileKind { Recipe, Film, Tomogram, Case, Experiment, Study, Bank, Round };

/// As parse_toml. Throws Failure(2) if the file's tables are those of another kind.
TomlFile parse_toml(const std::string &file, FileKind wanted, Mistakes &mistakes);

} // namespace calendem

#endif
