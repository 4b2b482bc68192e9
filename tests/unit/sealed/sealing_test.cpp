// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "sealed/sealing.h"
#include "support/test_folder.h"
#include <fstream>
#include <nlohmann/json.hpp>

namespace {

using namespace calendem;
using calendem_test::test_folder;

// FIPS 180-4's example and the empty text.
TEST(Sealing, HashesAreSha256) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Sealing, ACommitmentChangesWithEveryByteOfTruthAndSalt) {
  const std::string salt = derived("secret", "salt of 001");
  const nlohmann::json truth = {{"answer", "friction"}, {"effects", {{"friction", 0.31}}}};
  const std::string sealed = commitment(salt, truth);
  const std::string text = truth.dump();
  for (std::size_t k = 0; k < text.size(); ++k) {
    std::string other = text;
    other[k] ^= 1;
    EXPECT_NE(sha256(salt + "\n" + other), sealed) << k;
  }
  EXPECT_EQ(sha256(salt + "\n" + text), sealed);
  EXPECT_NE(commitment(derived("secret", "salt of 002"), truth), sealed);
  EXPECT_NE(commitment(derived("Secret", "salt of 001"), truth), sealed);
}

TEST(Sealing, SecretsDiffer) {
  EXPECT_EQ(random_secret().size(), 64u);
  EXPECT_NE(random_secret(), random_secret());
  EXPECT_NE(derived_seed("secret", "truths"), derived_seed("secret", "order"));
}

TEST(Sealing, AFoldersHashCoversNamesAndBytes) {
  const auto folder = test_folder();
  std::ofstream(folder / "a") << "1";
  std::ofstream(folder / "b") << "2";
  const std::string hash = sha256_of_files(folder.string());
  std::ofstream(folder / "b") << "3";
  EXPECT_NE(sha256_of_files(folder.string()), hash);
  std::ofstream(folder / "b") << "2";
  EXPECT_EQ(sha256_of_files(folder.string()), hash);
  std::filesystem::rename(folder / "b", folder / "c");
  EXPECT_NE(sha256_of_files(folder.string()), hash);
}

TEST(Sealing, OnlyPlainFilesAreHandedOut) {
  const auto folder = test_folder();
  std::filesystem::create_symlink("/etc/hostname", folder / "curve.csv");
  EXPECT_THROW(sha256_of_files(folder.string()), Failure);
}

} // namespace
