// SPDX-License-Identifier: GPL-2.0-or-later
// SHA-256 (FIPS 180-4) and Base64 (RFC 4648, with padding) by OpenSSL's libcrypto.
#ifndef CALENDEM_BASE_ENCODING_H
#define CALENDEM_BASE_ENCODING_H

#include <cstddef>
#include <string>

namespace calendem {

std::string sha256(const std::string &bytes);
std::string sha256_of_file(const std::string &file); ///< empty when the file cannot be read

std::string base64(const unsigned char *bytes, std::size_t count);

} // namespace calendem

#endif
