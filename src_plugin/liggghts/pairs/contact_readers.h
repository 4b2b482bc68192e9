// SPDX-License-Identifier: GPL-2.0-or-later
// Styles of the host that read contact flags or histories in the lists of pairs during a step. With
// one of them in the script the loop over pairs writes both back in every step. A style of your own
// that reads them has its row here. What other styles do is on the page
// docs/reference/host_styles.md, each with its test.
#ifndef CALENDEM_CONTACT_READERS_H
#define CALENDEM_CONTACT_READERS_H

#include "compute.h"
#include "fix.h"
#include "modify.h"
#include <algorithm>
#include <cstring>

namespace LAMMPS_NS {

constexpr const char *kFixesThatReadContacts[] = {"heat/gran/conduction"};
constexpr const char *kComputesThatReadContacts[] = {"contact/atom/gran"};

inline bool contacts_are_read(const Modify &modify) {
  const auto any = [](const auto &styles, const char *style) {
    return std::any_of(std::begin(styles), std::end(styles),
                       [&](const char *s) { return !strcmp(s, style); });
  };
  for (int k = 0; k < modify.nfix; ++k)
    if (any(kFixesThatReadContacts, modify.fix[k]->style))
      return true;
  for (int k = 0; k < modify.ncompute; ++k)
    if (any(kComputesThatReadContacts, modify.compute[k]->style))
      return true;
  return false;
}

} // namespace LAMMPS_NS

#endif
