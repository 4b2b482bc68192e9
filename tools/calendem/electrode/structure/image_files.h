// SPDX-License-Identifier: GPL-2.0-or-later
// Files that make up an image: endings, numbered slices, the data file that a header names.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_IMAGE_FILES_H
#define CALENDEM_ELECTRODE_STRUCTURE_IMAGE_FILES_H

#include <string>
#include <vector>

namespace calendem {

/// ".mhd" and so on, in small letters.
std::string image_ending(const std::string &file);
bool is_tiff(const std::string &file);

/// The file itself, or the slices of a pattern with one %d (%04d), by number. Throws Failure(2) if
/// none is there or a number is missing in between.
std::vector<std::string> files_of_series(const std::string &file);

/// Name of the data file that a MetaImage or NRRD header names, with its folder; empty if the data
/// follow the header. Throws Failure(2) if that file does not exist or the data are in several.
std::string data_file_of(const std::string &header);

} // namespace calendem

#endif
