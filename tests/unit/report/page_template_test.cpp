// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/page.h"

#include <gtest/gtest.h>

using calendem::report::fill_template;
using nlohmann::json;

// Requirement: values are escaped, so that a directory's name cannot become markup.
TEST(PageTemplate, EscapesUnlessRaw) {
  const json values = {{"name", "<b>&\"run\""}};
  EXPECT_EQ(fill_template("{{name}}", values), "&lt;b&gt;&amp;&quot;run&quot;");
  EXPECT_EQ(fill_template("{{{name}}}", values), "<b>&\"run\"");
}

// Requirement: sections repeat over arrays, hide on false, empty, null and missing; names are found
// outwards.
TEST(PageTemplate, Sections) {
  const json values = {{"unit", "MPa"},         {"rows", {{{"p", 1}}, {{"p", 2}}}},
                       {"no", false},           {"words", {"a", "b"}},
                       {"none", json::array()}, {"text", "x"}};
  EXPECT_EQ(fill_template("{{#rows}}{{p}} {{unit}};{{/rows}}", values), "1 MPa;2 MPa;");
  EXPECT_EQ(fill_template("{{#words}}{{.}}{{/words}}{{#no}}no{{/no}}{{#none}}no{{/none}}", values),
            "ab");
  EXPECT_EQ(fill_template("{{^none}}empty{{/none}}{{^text}}no{{/text}}{{#missing}}no{{/missing}}",
                          values),
            "empty");
  EXPECT_EQ(fill_template("{{#text}}[{{.}}]{{/text}}", values), "[x]");
}

// Requirement: a section inside a section of the same name belongs to the inner value.
TEST(PageTemplate, NestedSameName) {
  const json values = {{"a", {{{"a", {1, 2}}}}}};
  EXPECT_EQ(fill_template("{{#a}}<{{#a}}{{.}}{{/a}}>{{/a}}", values), "<12>");
}

// Requirement: a mistake in the template is not silent.
TEST(PageTemplate, UnclosedSectionThrows) {
  EXPECT_THROW(fill_template("{{#a}}x", json{{"a", true}}), std::logic_error);
  EXPECT_THROW(fill_template("{{a", json::object()), std::logic_error);
}
