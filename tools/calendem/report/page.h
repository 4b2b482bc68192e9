// SPDX-License-Identifier: GPL-2.0-or-later
// The one way to a page: the object it shows, what its template needs beside it, and its charts.
#ifndef CALENDEM_REPORT_PAGE_H
#define CALENDEM_REPORT_PAGE_H

#include "report/chart.h"

namespace calendem::report {

struct Page {
  const char *html = nullptr;  ///< template, see page_template.h
  nlohmann::ordered_json json; ///< the object that is shown; the template sees its members
  nlohmann::json values = nlohmann::json::object(); ///< texts and tables made from it, and pictures
  std::vector<Chart> charts = {};                   ///< the template's {{#charts}}; ids are unique
};

/// What the page holds for taking out: `json`, and the charts as its member "charts".
nlohmann::ordered_json data_of(const Page &page);

/// One file that needs no other and no network.
std::string to_html(const Page &page);

/// Some of a page's charts as a section of a template: [{id, title, note}].
nlohmann::json places_of(const std::vector<Chart> &charts);

} // namespace calendem::report

#endif
