// SPDX-License-Identifier: GPL-2.0-or-later
#include "structure/image_files.h"
#include "spec/messages.h"
#include "spec/provenance.h"
#include "structure/label_image.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

namespace calendem {
namespace fs = std::filesystem;
namespace {

const char *const kEndings[] = {".vti", ".mhd", ".mha", ".nrrd", ".nhdr", ".tif", ".tiff"};

std::string trimmed(const std::string &text) {
  const size_t from = text.find_first_not_of(" \t\r"), to = text.find_last_not_of(" \t\r");
  return from == std::string::npos ? "" : text.substr(from, to - from + 1);
}

struct Header {
  std::map<std::string, std::string> fields; ///< names in small letters
  long bytes = 0;                            ///< up to where data may begin
};

// "name = value" (MetaImage) or "name: value" (NRRD) up to the data.
Header read_header(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  const bool meta = image_ending(file)[1] == 'm';
  Header h;
  std::string line;
  while (std::getline(in, line) && line.size() < 4096) {
    h.bytes += long(line.size()) + 1;
    line = trimmed(line);
    if (!meta && line.empty())
      break;
    const size_t at = line.find(meta ? '=' : ':');
    if (at == std::string::npos)
      continue;
    std::string name = trimmed(line.substr(0, at));
    std::transform(name.begin(), name.end(), name.begin(), ::tolower);
    h.fields[name] = trimmed(line.substr(at + 1));
    if (meta && name == "elementdatafile")
      break;
  }
  return h;
}

long bytes_of_type(const std::string &type) {
  static const std::vector<std::pair<const char *, long>> sizes = {
      {"MET_CHAR", 1},      {"MET_UCHAR", 1},  {"MET_SHORT", 2},    {"MET_USHORT", 2},
      {"MET_INT", 4},       {"MET_UINT", 4},   {"MET_FLOAT", 4},    {"MET_LONG", 8},
      {"MET_ULONG", 8},     {"MET_DOUBLE", 8}, {"uchar", 1},        {"uint8", 1},
      {"int8", 1},          {"uint8_t", 1},    {"int8_t", 1},       {"signed char", 1},
      {"unsigned char", 1}, {"short", 2},      {"ushort", 2},       {"unsigned short", 2},
      {"int16", 2},         {"uint16", 2},     {"int16_t", 2},      {"uint16_t", 2},
      {"int", 4},           {"uint", 4},       {"unsigned int", 4}, {"int32", 4},
      {"uint32", 4},        {"int32_t", 4},    {"uint32_t", 4},     {"float", 4},
      {"double", 8}};
  for (const auto &[name, size] : sizes)
    if (type == name)
      return size;
  return 0;
}

// Bytes the header announces; 0 if it cannot be told (compressed, text, or fields missing).
long announced_bytes(const Header &h, bool meta) {
  const auto field = [&](const char *name) {
    const auto at = h.fields.find(name);
    return at == h.fields.end() ? std::string() : at->second;
  };
  if (meta && field("compresseddata") == "True")
    return std::atol(field("compresseddatasize").c_str());
  if (!meta && field("encoding") != "raw")
    return 0;
  long bytes = bytes_of_type(field(meta ? "elementtype" : "type"));
  std::istringstream sizes(field(meta ? "dimsize" : "sizes"));
  for (long n = 0; sizes >> n;)
    bytes *= n;
  return bytes;
}

} // namespace

std::string image_ending(const std::string &file) {
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), ::tolower);
  return ending;
}

bool is_tiff(const std::string &file) { return image_ending(file).rfind(".tif", 0) == 0; }

std::string readable_images() { return fmt::format("{}", fmt::join(kEndings, " ")); }

bool is_readable_image(const std::string &file) {
  const std::string ending = image_ending(file);
  return std::find(std::begin(kEndings), std::end(kEndings), ending) != std::end(kEndings);
}

std::vector<std::string> files_of_series(const std::string &file) {
  const std::regex place("%0?[0-9]*d");
  const std::string name = fs::path(file).filename().string();
  std::smatch hit;
  if (!is_tiff(file) || !std::regex_search(name, hit, place))
    return {file};
  const std::string before = hit.prefix(), after = hit.suffix();
  const fs::path folder = fs::absolute(file).parent_path();
  std::map<long, std::string> slices;
  if (fs::is_directory(folder))
    for (const auto &entry : fs::directory_iterator(folder)) {
      const std::string f = entry.path().filename().string();
      if (f.size() <= before.size() + after.size() || f.rfind(before, 0) != 0 ||
          f.compare(f.size() - after.size(), after.size(), after) != 0)
        continue;
      const std::string number = f.substr(before.size(), f.size() - before.size() - after.size());
      if (number.size() < 10 && number.find_first_not_of("0123456789") == std::string::npos)
        slices[std::stol(number)] = entry.path().string();
    }
  if (slices.empty())
    throw Failure(kBadInput, fmt::format("{}: no file has such a name. Give a pattern like "
                                         "slice_%04d.tif in a folder that holds the slices.",
                                         file));
  const long first = slices.begin()->first, last = slices.rbegin()->first;
  for (long k = first; k <= last; ++k)
    if (!slices.count(k))
      throw Failure(kBadInput, fmt::format("{}: slice {} is missing; there are {} to {}. All "
                                           "slices in between must be there.",
                                           file, k, first, last));
  std::vector<std::string> out;
  for (const auto &[number, f] : slices)
    out.push_back(f);
  return out;
}

std::string data_file_of(const std::string &header) {
  const std::string ending = image_ending(header);
  if (ending != ".mhd" && ending != ".mha" && ending != ".nhdr")
    return "";
  const Header h = read_header(header);
  const auto at = h.fields.find(ending[1] == 'm' ? "elementdatafile" : "data file");
  if (at == h.fields.end() || at->second == "LOCAL" || at->second.find('%') != std::string::npos ||
      at->second.rfind("LIST", 0) == 0)
    return "";
  const fs::path data = fs::path(header).parent_path() / at->second;
  if (!fs::is_regular_file(data))
    throw Failure(kBadInput, fmt::format("{}: the data file '{}' that the header names is not "
                                         "there. Put it beside the header.",
                                         header, at->second));
  return data.string();
}

void check_raw_size(const std::string &file) {
  const Header h = read_header(file);
  const auto encoding = h.fields.find("encoding");
  if (encoding != h.fields.end() &&
      std::regex_match(encoding->second, std::regex("ascii|te?xt", std::regex::icase)))
    throw Failure(kBadInput, fmt::format("{}: encoding: {} is not read, because VTK's reader takes "
                                         "wrong numbers from it; allowed are raw and gzip. Save it "
                                         "anew (unu save -e gzip).",
                                         file, encoding->second));
  const std::string data = data_file_of(file);
  const long wanted = announced_bytes(h, image_ending(file)[1] == 'm');
  const long there = data.empty() ? long(fs::file_size(file)) - h.bytes : long(fs::file_size(data));
  if (wanted > there)
    throw Failure(kBadInput, fmt::format("{}: the header announces {} bytes of voxels, {} are "
                                         "there: the file is cut. Copy it again.",
                                         file, wanted, std::max(there, 0L)));
}

std::string hash_of_image(const std::string &file) {
  std::string text;
  for (const std::string &slice : files_of_series(file))
    text += hash_of_file(slice);
  const std::string data = data_file_of(file);
  return hash_of_text(text + (data.empty() ? "" : hash_of_file(data)));
}

} // namespace calendem
