// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/image_series.h"
#include "base/messages.h"
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <regex>

namespace calendem {

namespace fs = std::filesystem;

std::string image_ending(const std::string &file) {
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), ::tolower);
  return ending;
}

bool is_tiff(const std::string &file) { return image_ending(file).rfind(".tif", 0) == 0; }

namespace {

/// Digits of a number in the place "%04d", filled up with zeros; 0: as many as it has.
int width_of(const std::string &place) {
  constexpr long kMost = 9;
  return place[1] == '0' ? int(std::min(kMost, std::strtol(&place[1], nullptr, 10))) : 0;
}

} // namespace

std::vector<std::string> files_of_series(const std::string &file) {
  const std::regex place("%0?[0-9]*d");
  const std::string name = fs::path(file).filename().string();
  std::smatch hit;
  if ((!is_tiff(file) && image_ending(file) != ".png") || !std::regex_search(name, hit, place))
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
  const auto name_of = [&](long k) {
    return before + fmt::format("{:0{}}", k, width_of(hit.str())) + after;
  };
  if (slices.empty())
    throw Failure(kBadInput,
                  "{}: no file has such a name, as {} or {}. Give a pattern like slice_%04d.tif in "
                  "a folder that holds the slices.",
                  file, name_of(0), name_of(1));
  const long first = slices.begin()->first, last = slices.rbegin()->first;
  for (long k = first; k <= last; ++k)
    if (!slices.count(k))
      throw Failure(
          kBadInput,
          "{}: slice {} is missing ({}); there are {} to {}. All slices in between must be there.",
          file, k, name_of(k), first, last);
  std::vector<std::string> out;
  for (const auto &[number, f] : slices)
    out.push_back(f);
  return out;
}

} // namespace calendem
