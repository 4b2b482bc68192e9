// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/image_files.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "electrode/structure/image_header.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <regex>

namespace calendem {
namespace fs = std::filesystem;
namespace {

const char *const kEndings[] = {".vti", ".mhd", ".mha", ".nrrd", ".nhdr", ".tif", ".tiff"};

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
  const bool meta = ending == ".mhd" || ending == ".mha";
  if (!meta && ending != ".nrrd" && ending != ".nhdr")
    return "";
  const ImageHeader h(header, meta ? "=" : ": ");
  const std::string name = meta                ? h.text("ElementDataFile")
                           : h.has("datafile") ? h.text("datafile")
                                               : h.text("data file");
  if (name.empty() || (meta && name == "LOCAL"))
    return "";
  if (name.find('%') != std::string::npos || name.rfind("LIST", 0) == 0)
    refuse_image(header,
                 fmt::format("the voxels are spread over several files ('{}'), which is not "
                             "read. Save them to one file.",
                             name.substr(0, 60)));
  const fs::path data = fs::path(header).parent_path() / name;
  std::error_code none;
  if (!fs::is_regular_file(data, none))
    refuse_image(header,
                 fmt::format("the data file '{}' that the header names is not there. Put it "
                             "beside the header.",
                             name.substr(0, 200)));
  return data.string();
}

std::string hash_of_image(const std::string &file) {
  std::string text;
  for (const std::string &slice : files_of_series(file))
    text += hash_of_file(slice);
  const std::string data = data_file_of(file);
  return hash_of_text(text + (data.empty() ? "" : hash_of_file(data)));
}

} // namespace calendem
