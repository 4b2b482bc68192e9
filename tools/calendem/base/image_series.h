// SPDX-License-Identifier: GPL-2.0-or-later
// An image in one file, or in a numbered series of slices.
#ifndef CALENDEM_BASE_IMAGE_SERIES_H
#define CALENDEM_BASE_IMAGE_SERIES_H

#include <string>
#include <vector>

namespace calendem {

/// ".mhd" and so on, in small letters.
std::string image_ending(const std::string &file);
bool is_tiff(const std::string &file);

/// The file itself, or the slices of a pattern with one %d (%04d), by number. Throws Failure(2) if
/// none is there or a number is missing in between.
std::vector<std::string> files_of_series(const std::string &file);

} // namespace calendem

#endif
