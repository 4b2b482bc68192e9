// SPDX-License-Identifier: GPL-2.0-or-later
// Files that make up an image: endings, numbered slices, the data file that a header names.
#ifndef CALENDEM_STRUCTURE_IMAGE_FILES_H
#define CALENDEM_STRUCTURE_IMAGE_FILES_H

#include <string>
#include <vector>

namespace calendem {

/// ".mhd" and so on, in small letters.
std::string image_ending(const std::string &file);
bool is_tiff(const std::string &file);

/// The file itself, or the slices of a pattern with one %d (%04d), by number. Throws Failure(2) if
/// none is there or a number is missing in between.
std::vector<std::string> files_of_series(const std::string &file);

/// Name of the data file that a .mhd or .nhdr header names, with its folder; empty if the data
/// follow the header. Throws Failure(2) if that file does not exist.
std::string data_file_of(const std::string &header);

/// Throws Failure(2) if the uncompressed data of a MetaImage or NRRD file is shorter than its
/// header announces: VTK's readers fill up what is missing without an error.
void check_raw_size(const std::string &file);

/// Throws Failure(2) if a page or its data lie beyond the end of a TIFF file: it is cut, and VTK
/// would read as many pages as are left.
void check_tiff_size(const std::string &file);

} // namespace calendem

#endif
