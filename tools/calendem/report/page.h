// SPDX-License-Identifier: GPL-2.0-or-later
// A report as one self-contained HTML page: page.html filled with the report's JSON, its charts as
// SVG and its pictures as base64 PNG.
#ifndef CALENDEM_REPORT_PAGE_H
#define CALENDEM_REPORT_PAGE_H

#include <string>

#include "report/report.h"

namespace calendem::report {

std::string to_html(const Report &report);

} // namespace calendem::report

#endif
