// SPDX-License-Identifier: GPL-2.0-or-later
// Base64 (RFC 4648, with padding), for pictures inside the page.
#ifndef CALENDEM_BASE_BASE64_H
#define CALENDEM_BASE_BASE64_H

#include <cstddef>
#include <string>

namespace calendem {

std::string base64(const unsigned char *bytes, std::size_t count);

} // namespace calendem

#endif
