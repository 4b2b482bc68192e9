// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"

#include <string>

#include <gtest/gtest.h>

using calendem::base64;

namespace {
std::string encoded(const std::string &text) {
  return base64(reinterpret_cast<const unsigned char *>(text.data()), text.size());
}
} // namespace

// Requirement: the test vectors of RFC 4648, section 10.
TEST(Base64, VectorsOfTheStandard) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xff\xff"), "////");
}
