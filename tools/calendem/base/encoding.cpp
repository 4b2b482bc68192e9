// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/encoding.h"
#include "base/provenance.h"
#include <fmt/format.h>
#include <fstream>
#include <openssl/evp.h>
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
  return std::ifstream(file) ? sha256(text_of_file(file)) : "";
}

std::string base64(const unsigned char *bytes, std::size_t count) {
  std::string text((count + 2) / 3 * 4 + 1, '\0'); // with the zero that EVP_EncodeBlock ends with
  EVP_EncodeBlock(reinterpret_cast<unsigned char *>(text.data()), bytes, int(count));
  text.pop_back();
  return text;
}

} // namespace calendem
