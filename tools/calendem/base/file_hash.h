// SPDX-License-Identifier: GPL-2.0-or-later
// SHA-256 (FIPS 180-4) by OpenSSL's libcrypto: 64 hex digits, as sha256sum prints them.
#ifndef CALENDEM_BASE_FILE_HASH_H
#define CALENDEM_BASE_FILE_HASH_H

#include <string>

namespace calendem {

std::string sha256(const std::string &bytes);
std::string sha256_of_file(const std::string &file); ///< empty when the file cannot be read

} // namespace calendem

#endif
