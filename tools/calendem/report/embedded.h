// SPDX-License-Identifier: GPL-2.0-or-later
// Text files of this folder, compiled in by CMakeLists.txt (embedded.cpp.in).
#ifndef CALENDEM_REPORT_EMBEDDED_H
#define CALENDEM_REPORT_EMBEDDED_H

namespace calendem {
extern const char *const kPageHtml; ///< page.html
}

namespace calendem::report::embedded {

extern const char *const kPageCss;  ///< page.css
extern const char *const kExplorer; ///< explorer.js
extern const char *const kThree;    ///< three.js of the distribution (libjs-three, MIT licence)
extern const char *const kOrbitControls; ///< its controls
extern const char *const kTable1;        ///< reference/table1.csv
extern const char *const kPaperBonds;    ///< reference/paper_bonds.csv

} // namespace calendem::report::embedded

#endif
