// SPDX-License-Identifier: GPL-2.0-or-later
// The files that are made from the rows of settings, effects and contact laws (registry/): parts of
// the input scripts, so that plain LIGGGHTS can run them, and pages of docs/reference.
#ifndef CALENDEM_COMMANDS_GENERATED_FILES_H
#define CALENDEM_COMMANDS_GENERATED_FILES_H

#include <string>
#include <vector>

namespace calendem {

struct GeneratedFile {
  std::string path; ///< from the repository's top
  std::string text;
};

std::vector<GeneratedFile> generated_files();

std::vector<GeneratedFile> reference_pages();

} // namespace calendem

#endif
