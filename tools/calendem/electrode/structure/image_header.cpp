// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/image_header.h"
#include "base/messages.h"
#include "electrode/structure/atom_rows.h"
#include "electrode/structure/data_header.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>

namespace calendem {
namespace {

std::string trimmed(const std::string &text) {
  const size_t from = text.find_first_not_of(" \t\r"), to = text.find_last_not_of(" \t\r");
  return from == std::string::npos ? "" : text.substr(from, to - from + 1);
}

} // namespace

void refuse_image(const std::string &file, const std::string &what) {
  throw Failure(kBadInput, fmt::format("{}: {}", file, what));
}

ImageHeader::ImageHeader(const std::string &file, const std::string &separator)
    : file_(file), separator_(separator) {
  std::ifstream in(file, std::ios::binary);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    bytes_ += long(line.size()) + 1;
    if (in.eof() || line.size() > 1000 || line.find('\0') != std::string::npos)
      break;
    if (!line.empty() && line.back() == '\r')
      line.pop_back();
    if (take(number, line))
      return;
  }
  if (!in.eof() || !line.empty() || !has("data file"))
    refuse_image(file,
                 "its header does not end: it is cut or of another format. Give the file as the "
                 "program that segmented it wrote it.");
}

// True for the last line.
bool ImageHeader::take(int number, const std::string &line) {
  const bool nrrd = separator_ != "=";
  if (nrrd && (number == 1 || line.empty() || line[0] == '#'))
    return number > 1 && line.empty();
  if (nrrd && line.find(":=") != std::string::npos)
    return false;
  const size_t at = line.find(separator_);
  const std::string name = trimmed(line.substr(0, at));
  if (at == std::string::npos || name.empty() || name.find_first_of(":=") != std::string::npos)
    refuse_image(file_, fmt::format("line {} of the header is not 'name{} value': '{}'; it is "
                                    "damaged or of another format. Give the file "
                                    "as the program that segmented it wrote it.",
                                    number, separator_ == "=" ? " =" : ":", line.substr(0, 60)));
  if (!fields_.emplace(name, trimmed(line.substr(at + separator_.size()))).second)
    refuse_image(file_,
                 fmt::format("line {}: '{}' is there twice in the header. Save the image anew.",
                             number, name));
  return name == "ElementDataFile";
}

std::string ImageHeader::text(const std::string &name) const {
  const auto at = fields_.find(name);
  return at == fields_.end() ? "" : at->second;
}

std::array<long, 3> ImageHeader::axes(const std::string &name) const {
  const std::vector<std::string> words = words_of(text(name));
  std::array<long, 3> n = {0, 0, 0};
  for (size_t k = 0; k < 3 && words.size() == 3; ++k)
    n[k] = whole_number_in(words[k]).value_or(0);
  return n;
}

long ImageHeader::type_size(const std::string &name, const std::vector<Type> &types) const {
  for (const Type &t : types)
    if (text(name) == t.name)
      return t.bytes;
  refuse_image(file_,
               fmt::format("the header's '{}' is '{}', which is not read. Save the labels as "
                           "whole numbers of 1, 2 or 4 bytes.",
                           name, text(name).substr(0, 60)));
}

void ImageHeader::check_numbers(const std::string &name, size_t wanted) const {
  const std::vector<std::string> words = words_of(text(name));
  const auto finite = [](const std::string &w) {
    return std::isfinite(number_in(w).value_or(NAN));
  };
  if (has(name) && (words.size() != wanted || !std::all_of(words.begin(), words.end(), finite)))
    refuse_image(file_,
                 fmt::format("the header's '{}' is '{}'; it must be {} numbers. Save the image "
                             "anew.",
                             name, text(name).substr(0, 60), wanted));
}

void ImageHeader::check_is(const std::string &name, const std::vector<std::string> &allowed) const {
  if (has(name) && std::find(allowed.begin(), allowed.end(), text(name)) == allowed.end())
    refuse_image(file_,
                 fmt::format("the header's '{}' is '{}'; allowed is {}. Save the image anew.", name,
                             text(name).substr(0, 60), fmt::join(allowed, " or ")));
}

void ImageHeader::need(const std::string &name) const {
  if (!has(name))
    refuse_image(file_,
                 fmt::format("the header has no '{}': it is cut or of another format. Save the "
                             "image anew.",
                             name));
}

void check_axes(const std::string &file, const std::array<long, 3> &n, long bytes,
                double most_per_byte) {
  const double voxels = double(n[0]) * double(n[1]) * double(n[2]);
  if (std::min({n[0], n[1], n[2]}) < 1 || voxels > double(kMostVoxels))
    refuse_image(file,
                 fmt::format("the header announces {} x {} x {} voxels; three whole numbers from "
                             "1 are wanted, {} voxels in all at most. Save the image anew, or a "
                             "part of it.",
                             n[0], n[1], n[2], kMostVoxels));
  if (voxels > most_per_byte * double(bytes))
    refuse_image(file,
                 fmt::format("the header announces {} x {} x {} voxels, more than {} bytes of "
                             "data can hold: the file is cut. Copy it again.",
                             n[0], n[1], n[2], bytes));
}

void check_length(const std::string &file, double announced, long there) {
  if (announced > double(there))
    refuse_image(file, fmt::format("the header announces {:.0f} bytes of voxels, {} are there: the "
                                   "file is cut. Copy it again.",
                                   announced, std::max(there, 0L)));
}

} // namespace calendem
