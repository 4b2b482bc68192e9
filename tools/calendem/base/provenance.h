// SPDX-License-Identifier: GPL-2.0-or-later
// SHA-256 (FIPS 180-4) and Base64 (RFC 4648, with padding) by OpenSSL's libcrypto.
// Where a result comes from (version, inputs, seeds), and the files it goes into.
#ifndef CALENDEM_BASE_PROVENANCE_H
#define CALENDEM_BASE_PROVENANCE_H

#include <cstddef>
#include <string>

namespace calendem {

std::string sha256(const std::string &bytes);
std::string sha256_of_file(const std::string &file); ///< empty when the file cannot be read

std::string base64(const unsigned char *bytes, std::size_t count);

/// 64-bit FNV-1a of a file's bytes as 16 hex digits; empty if it cannot be read.
std::string hash_of_file(const std::string &file);
std::string hash_of_text(const std::string &text);

/// Hash of all files below `folder`, by name and bytes, in the order of their names.
std::string hash_of_folder(const std::string &folder);

/// True if that JSON file exists and its "identity" is this one.
bool made_of(const std::string &json_file, const std::string &identity);

std::string version();

/// ../share/calendem/input_scripts, seen from this program's folder.
std::string input_scripts();
/// The path of a program in this one's folder.
std::string program_beside(const std::string &name);
/// The LIGGGHTS program beside this one: liggghts-calendem where installed, else liggghts.
std::string liggghts_program();

/// The file's bytes; empty if it cannot be read.
std::string text_of_file(const std::string &file);

/// The text is in the file's last line or close to its end: that of a file that is cut is not.
bool ends_with(const std::string &file, const std::string &text);

/// Name beside it for what is not whole yet; of this process, as tasks of a cluster may write the same
/// file at the same time.
std::string part_of(const std::string &name);

/// Where a file of that name is written: what a link points to. Throws Failure(2) where that is no
/// regular file, or in no folder.
std::string place_of(const std::string &given);

/// Writes via a file of this process beside it that is renamed when complete, so that several may
/// write it at once; a link stays one. Throws Failure(2) on a full disk, or where `name` is no
/// regular file.
void write_file(const std::string &name, const std::string &content);

} // namespace calendem

#endif
