// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/plain_text.h"
#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace calendem {
namespace {

const std::pair<const char *, const char *> kNoTexts[] = {
    {"\x1f\x8b", "is compressed (gzip). Unpack it: gunzip FILE"},
    {"PK\3\4", "is a ZIP archive, as .xlsx and .ods files are. Save the sheet as CSV"},
    {"\xd0\xcf\x11\xe0", "is an Excel file (.xls). Save the sheet as CSV"},
    {"%PDF", "is a PDF file. Export the numbers as CSV"}};

std::string utf8(char32_t c) {
  const auto byte = [](char32_t value) { return char(static_cast<unsigned char>(value)); };
  if (c < 0x80)
    return {byte(c)};
  if (c < 0x800)
    return {byte(0xC0 | c >> 6), byte(0x80 | (c & 63))};
  if (c < 0x10000)
    return {byte(0xE0 | c >> 12), byte(0x80 | (c >> 6 & 63)), byte(0x80 | (c & 63))};
  return {byte(0xF0 | c >> 18), byte(0x80 | (c >> 12 & 63)), byte(0x80 | (c >> 6 & 63)),
          byte(0x80 | (c & 63))};
}

/// Bytes of the UTF-8 character at `at`; 0: it is none.
std::size_t length_at(const std::string &text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  const std::size_t n = first < 0x80                    ? 1
                        : first >= 0xC2 && first < 0xE0 ? 2
                        : first >= 0xE0 && first < 0xF0 ? 3
                        : first >= 0xF0 && first < 0xF5 ? 4
                                                        : 0;
  for (std::size_t k = 1; k < n; ++k)
    if (at + k >= text.size() || (static_cast<unsigned char>(text[at + k]) & 0xC0) != 0x80)
      return 0;
  return n;
}

bool is_utf8(const std::string &text) {
  for (std::size_t at = 0, n = 0; at < text.size(); at += n)
    if ((n = length_at(text, at)) == 0)
      return false;
  return true;
}

/// Byte of a pair that is the high one: 0 or 1; -1: not UTF-16. Without a mark nearly all of the
/// high bytes are 0 and none of the low ones.
int high_byte(const std::string &bytes) {
  if (bytes.rfind("\xFF\xFE", 0) == 0 || bytes.rfind("\xFE\xFF", 0) == 0)
    return bytes[0] == '\xFF' ? 1 : 0;
  const std::size_t pairs = std::min<std::size_t>(bytes.size() / 2, 200);
  std::size_t zeros[2] = {0, 0};
  for (std::size_t k = 0; k < 2 * pairs; ++k)
    zeros[k % 2] += bytes[k] == '\0';
  for (const int high : {0, 1})
    if (pairs > 1 && zeros[high] > 0.9 * double(pairs) && zeros[1 - high] == 0)
      return high;
  return -1;
}

std::string from_utf16(const std::string &bytes, int high) {
  const auto unit = [&](std::size_t k) {
    return char32_t(static_cast<unsigned char>(bytes[2 * k + std::size_t(high)])) << 8 |
           static_cast<unsigned char>(bytes[2 * k + 1 - std::size_t(high)]);
  };
  const std::size_t units = bytes.size() / 2;
  std::string out;
  for (std::size_t k = unit(0) == 0xFEFF ? 1 : 0; k < units; ++k) {
    char32_t c = unit(k);
    if (c >= 0xD800 && c < 0xDC00 && k + 1 < units)
      c = 0x10000 + ((c - 0xD800) << 10) + ((unit(++k) - 0xDC00) & 0x3FF);
    out += utf8(c >= 0xD800 && c < 0xE000 ? U'?' : c);
  }
  return out;
}

std::string with_plain_ends(const std::string &text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t k = 0; k < text.size(); ++k)
    if (text[k] != '\r')
      out += text[k];
    else if (k + 1 == text.size() || text[k + 1] != '\n')
      out += '\n';
  return out;
}

} // namespace

PlainText plain_text(const std::string &bytes) {
  for (const auto &[begin, what] : kNoTexts)
    if (bytes.rfind(begin, 0) == 0)
      return {"", "", fmt::format("{}.", what)};
  PlainText out{bytes, "UTF-8", ""};
  if (const int high = high_byte(bytes); high >= 0)
    out = {from_utf16(bytes, high), "UTF-16", ""};
  else if (bytes.rfind("\xEF\xBB\xBF", 0) == 0)
    out.text.erase(0, 3);
  else if (!is_utf8(bytes)) {
    out = {"", "Latin-1", ""};
    for (const char c : bytes)
      out.text += utf8(static_cast<unsigned char>(c));
  }
  const auto odd = std::find_if(out.text.begin(), out.text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 32 && (c < '\t' || c > '\r');
  });
  if (odd != out.text.end())
    return {"", "",
            fmt::format("is no text: its byte {} is {}. Give the text that was exported.",
                        odd - out.text.begin() + 1, int(*odd))};
  out.text = with_plain_ends(out.text);
  return out;
}

bool ends(const std::string &text, const std::string &ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

} // namespace calendem
