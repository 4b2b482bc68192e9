// SPDX-License-Identifier: GPL-2.0-or-later
// Pages of docs/reference that are made from the rows of keys and effects.
#ifndef CALENDEM_COMMANDS_REFERENCE_PAGES_H
#define CALENDEM_COMMANDS_REFERENCE_PAGES_H

#include "commands/generated_files.h"

namespace calendem {

std::vector<GeneratedFile> reference_pages();

} // namespace calendem

#endif
