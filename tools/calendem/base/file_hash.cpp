// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/file_hash.h"

#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <openssl/sha.h>

namespace calendem {

std::string sha256(const std::string &bytes) {
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size(), digest);
  std::string out;
  for (const unsigned char byte : digest)
    out += fmt::format("{:02x}", byte);
  return out;
}

std::string sha256_of_file(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    return "";
  return sha256({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
}

} // namespace calendem
