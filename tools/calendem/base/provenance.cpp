// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"
#include "base/messages.h"
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <openssl/evp.h>
#include <openssl/sha.h>
#include <random>
#include <unistd.h>
#include <vector>

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

namespace fs = std::filesystem;

std::string hash_of_text(const std::string &text) {
  std::uint64_t h = 0xcbf29ce484222325ULL;
  for (unsigned char c : text)
    h = (h ^ c) * 0x100000001b3ULL;
  return fmt::format("{:016x}", h);
}

std::string text_of_file(const std::string &file) {
  if (fs::is_directory(file))
    throw Failure(kBadInput, file + " is a folder; a file is needed.");
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

bool ends_with(const std::string &file, const std::string &text) {
  std::ifstream in(file, std::ios::binary);
  std::string tail(text.size() + 10, ' ');
  in.seekg(-std::streamoff(tail.size()), std::ios::end);
  in.read(tail.data(), std::streamsize(tail.size()));
  return in && tail.find(text) != std::string::npos;
}

std::string hash_of_file(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    return "";
  return hash_of_text({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
}

bool made_of(const std::string &json_file, const std::string &identity) {
  std::ifstream in(json_file);
  const nlohmann::json old = nlohmann::json::parse(in, nullptr, false);
  return old.is_object() && old.value("identity", "") == identity;
}

std::string hash_of_folder(const std::string &folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto &entry : fs::recursive_directory_iterator(folder, error))
    if (entry.is_regular_file())
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  std::string text;
  for (const std::string &file : files)
    text += fs::path(file).lexically_relative(folder).string() + " " + hash_of_file(file) + "\n";
  return hash_of_text(text);
}

std::string version() { return CALENDEM_VERSION; }

namespace {
fs::path program_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}
} // namespace

std::string input_scripts() {
  return fs::weakly_canonical(program_folder() / "../share/calendem/input_scripts").string();
}

std::string program_beside(const std::string &name) { return (program_folder() / name).string(); }

std::string liggghts_program() {
  const fs::path installed = program_folder() / "liggghts-calendem";
  return (fs::exists(installed) ? installed : program_folder() / "liggghts").string();
}

std::string place_of(const std::string &given) {
  std::error_code none;
  const std::string name =
      fs::is_symlink(given, none) ? fs::weakly_canonical(given, none).string() : given;
  if (fs::exists(name, none) && !fs::is_regular_file(name, none))
    throw Failure(kBadInput, "'{}' is not a regular file and cannot be written. Give another name.",
                  given);
  const fs::path folder = fs::path(name).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, none))
    throw Failure(kBadInput,
                  "cannot write '{}': there is no folder '{}'. Make it, or give another name.",
                  given, folder.string());
  return name;
}

std::string part_of(const std::string &name) {
  static const unsigned host = std::random_device{}(); // pids of two machines may be the same
  return fmt::format("{}.{}-{:08x}.part", name, getpid(), host);
}

void write_file(const std::string &given, const std::string &content) {
  const std::string name = place_of(given);
  const std::string part = part_of(name);
  std::ofstream out(part, std::ios::binary);
  out << content;
  out.close();
  std::error_code error;
  if (out)
    fs::rename(part, name, error);
  if (!out || error) {
    std::error_code none;
    fs::remove(part, none);
    throw Failure(kBadInput,
                  "cannot write '{}'. Is the disk full or the folder read-only? What was there "
                  "before is kept.",
                  name);
  }
}

} // namespace calendem
