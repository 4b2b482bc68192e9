// SPDX-License-Identifier: GPL-2.0-or-later
// Text as other programs write it: its encoding, its ends of lines, what is no text at all.
#ifndef CALENDEM_BASE_PLAIN_TEXT_H
#define CALENDEM_BASE_PLAIN_TEXT_H

#include <string>

namespace calendem {

struct PlainText {
  std::string text;     ///< UTF-8 without a byte-order mark, lines end with '\n'
  std::string encoding; ///< "UTF-8", "UTF-16", "Latin-1"
  std::string wrong;    ///< what it is if it is no text, and what to do; `text` is empty then
};

/// UTF-8 and UTF-16 with or without a mark, else Latin-1; lines that end with LF, CR LF or CR.
PlainText plain_text(const std::string &bytes);

bool ends(const std::string &text, const std::string &ending);

} // namespace calendem

#endif
