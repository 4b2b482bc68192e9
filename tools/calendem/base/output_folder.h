// SPDX-License-Identifier: GPL-2.0-or-later
// Folders that results go into.
#ifndef CALENDEM_BASE_OUTPUT_FOLDER_H
#define CALENDEM_BASE_OUTPUT_FOLDER_H

#include <cstdint>
#include <string>

namespace calendem {

/// Bytes left on the disk of `folder`; the largest number if that cannot be found out.
std::uintmax_t room_on_disk(const std::string &folder);

/// Makes the folder of -o. Throws Failure(2) if it cannot be written or its disk has less than
/// `room` bytes left.
void make_output_folder(const std::string &folder, std::uintmax_t room = 0);

} // namespace calendem

#endif
