// SPDX-License-Identifier: GPL-2.0-or-later
#ifndef CALENDEM_TESTS_SUPPORT_PAGE_H
#define CALENDEM_TESTS_SUPPORT_PAGE_H

#include <nlohmann/json.hpp>
#include <string>

namespace calendem_test {

/// The page without what stands between <script> and </script>.
inline std::string without_scripts(std::string page) {
  for (auto at = page.find("<script"); at != std::string::npos; at = page.find("<script", at + 1)) {
    const auto begin = page.find('>', at) + 1;
    page.erase(begin, page.find("</script>", begin) - begin);
  }
  return page;
}

/// The object that the page holds for taking out; throws if it holds none.
inline nlohmann::json data_in(const std::string &page) {
  const std::string tag = "<script type=\"application/json\" id=\"data\">";
  const auto begin = page.find(tag) + tag.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

} // namespace calendem_test

#endif
