// SPDX-License-Identifier: GPL-2.0-or-later
#include "sealed/sealing.h"
#include "base/messages.h"
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

namespace calendem {
namespace {

std::string hex(const unsigned char *bytes, std::size_t n) {
  std::string out;
  for (std::size_t k = 0; k < n; ++k)
    out += fmt::format("{:02x}", bytes[k]);
  return out;
}

} // namespace

std::string bytes_of(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw Failure(kBadInput, fmt::format("{} cannot be read. Is the folder complete?", file));
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string sha256_of_files(const std::string &folder) {
  std::map<std::string, std::string> hashes;
  for (const auto &entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.is_symlink())
      throw Failure(kBadInput, fmt::format("{} is no plain file; what was handed out holds nothing "
                                           "else. Take it as it was made.",
                                           entry.path().string()));
    hashes[entry.path().filename().string()] = sha256(bytes_of(entry.path().string()));
  }
  std::string all;
  for (const auto &[name, hash] : hashes)
    all += name + " " + hash + "\n";
  return sha256(all);
}

bool is_intervention(const std::string &folder) {
  return std::filesystem::is_directory(folder + "/after");
}

std::string sha256_of_case(const std::string &folder) {
  if (!is_intervention(folder))
    return sha256_of_files(folder);
  for (const auto &entry : std::filesystem::directory_iterator(folder))
    if (const auto name = entry.path().filename(); name != "before" && name != "after")
      throw Failure(kBadInput, fmt::format("{} lies beside what was measured before and after; "
                                           "nothing else was handed out. Take it as it was made.",
                                           entry.path().string()));
  return sha256(sha256_of_files(folder + "/before") + sha256_of_files(folder + "/after"));
}

std::vector<std::string> samples_in(const std::string &folder) {
  std::vector<std::string> out;
  while (std::filesystem::exists(fmt::format("{}/{}", folder, out.size())))
    out.push_back(fmt::format("{}/{}", folder, out.size()));
  return out;
}

std::string sha256_of_samples(const std::string &folder) {
  std::string hashes;
  for (const std::string &sample : samples_in(folder))
    hashes += sha256_of_files(sample) + sha256_of_files(sample + "_without");
  return sha256(hashes);
}

void must_be(const std::string &is, const std::string &should, const std::string &what) {
  if (is != should)
    throw Failure(kCheckFailed, fmt::format("{} is not what its hash says: SHA-256 {}, written "
                                            "down is {}. Nothing is scored.",
                                            what, is, should.empty() ? "none" : should));
}

nlohmann::json json_of(const std::string &file) {
  const nlohmann::json j = nlohmann::json::parse(bytes_of(file), nullptr, false);
  if (!j.is_object())
    throw Failure(kBadInput, fmt::format("{} is cut or damaged: it holds no JSON object.", file));
  return j;
}

std::string random_secret() {
  std::ifstream in("/dev/urandom", std::ios::binary);
  unsigned char bytes[32];
  if (!in.read(reinterpret_cast<char *>(bytes), sizeof bytes))
    throw Failure(kBadInput, "/dev/urandom cannot be read: there is no secret to seal truths with. "
                             "Give --seed for a round that is not sealed.");
  return hex(bytes, sizeof bytes);
}

std::string derived(const std::string &secret, const std::string &purpose) {
  return sha256(secret + "\n" + purpose);
}

std::uint64_t derived_seed(const std::string &secret, const std::string &purpose) {
  return std::stoull(derived(secret, purpose).substr(0, 16), nullptr, 16);
}

std::string commitment(const std::string &salt, const nlohmann::json &truth) {
  return sha256(salt + "\n" + truth.dump());
}

} // namespace calendem
