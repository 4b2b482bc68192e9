// SPDX-License-Identifier: GPL-2.0-or-later
// make_run DIR [strong|unfinished]: writes a made-up run directory (see make_run.h).
#include <iostream>
#include <string>

#include "support/make_run.h"

int main(int count, char **words) {
  if (count < 2) {
    std::cerr << "usage: make_run DIR [strong|unfinished]\n";
    return 1;
  }
  calendem::tests::MadeRun options;
  const std::string kind = count > 2 ? words[2] : "";
  if (kind == "strong")
    options.broken_at_max = 0.08;
  options.finished = kind != "unfinished";
  calendem::tests::make_run(words[1], options);
  return 0;
}
