// SPDX-License-Identifier: GPL-2.0-or-later
#include "report/page.h"
#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <vector>

namespace calendem::report {

NLOHMANN_JSON_SERIALIZE_ENUM(Mark,
                             {{Mark::line, "line"}, {Mark::points, "points"}, {Mark::area, "area"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Symbol, {{Symbol::none, "none"},
                                      {Symbol::circle, "circle"},
                                      {Symbol::square, "square"},
                                      {Symbol::triangle, "triangle"},
                                      {Symbol::diamond, "diamond"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Hatch, {{Hatch::solid, "solid"},
                                     {Hatch::rising, "rising"},
                                     {Hatch::falling, "falling"},
                                     {Hatch::dots, "dots"}})

Series line_through(const std::string &name, std::vector<double> x, std::vector<double> y,
                    const std::string &colour, const std::string &dash) {
  Series s;
  s.name = name;
  s.x = std::move(x);
  s.y = std::move(y);
  s.colour = colour;
  s.dash = dash;
  return s;
}

Series points_at(const std::string &name, std::vector<double> x, std::vector<double> y,
                 const std::string &colour, Symbol symbol) {
  Series s = line_through(name, std::move(x), std::move(y), colour);
  s.mark = Mark::points;
  s.symbol = symbol;
  return s;
}

nlohmann::json to_json(const Chart &chart) {
  nlohmann::json series = nlohmann::json::array(), limits = nlohmann::json::array();
  for (const auto &s : chart.series) {
    series.push_back({{"name", s.name},
                      {"axis", s.right_axis ? chart.right_label : chart.y_label},
                      {"right", s.right_axis},
                      {"mark", s.mark},
                      {"colour", s.colour},
                      {"dash", s.dash},
                      {"symbol", s.symbol},
                      {"hatch", s.hatch},
                      {"x", s.x},
                      {"y", s.y}});
    if (!s.base.empty())
      series.back()["base"] = s.base;
    if (!s.y_error.empty())
      series.back()["y_error"] = s.y_error;
  }
  for (const auto &limit : chart.limits)
    limits.push_back({{"y", limit.y}, {"label", limit.label}});
  return {{"id", chart.id},
          {"title", chart.title},
          {"x_label", chart.x_label},
          {"y_label", chart.y_label},
          {"right_label", chart.right_label},
          {"note", chart.note},
          {"y_top", chart.y_top},
          {"from_zero", chart.from_zero},
          {"limits", limits},
          {"series", series}};
}

nlohmann::ordered_json data_of(const Page &page) {
  nlohmann::ordered_json data = page.json;
  if (!page.charts.empty())
    data["charts"] = nlohmann::ordered_json::array();
  for (const Chart &chart : page.charts)
    data["charts"] += nlohmann::ordered_json(to_json(chart));
  return data;
}

nlohmann::json places_of(const std::vector<Chart> &charts) {
  nlohmann::json places = nlohmann::json::array();
  for (const Chart &chart : charts)
    places.push_back({{"id", chart.id}, {"title", chart.title}, {"note", chart.note}});
  return places;
}

namespace {

/// `prefix`: a file that the text belongs to.
void add_provenance(const std::string &name, const std::string &prefix,
                    const nlohmann::ordered_json &value, nlohmann::json &rows) {
  if (!value.is_structured()) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    rows.push_back({{"name", name}, {"text", prefix.empty() ? text : prefix + ", " + text}});
    return;
  }
  const bool is_file = value.is_object() && value.contains("file") && value.contains("hash");
  if (is_file)
    add_provenance(name, value["file"], value["hash"], rows);
  for (const auto &[key, part] : value.items()) {
    if (is_file && (key == "file" || key == "hash"))
      continue;
    const bool is_path = key.find_first_of("/.") != std::string::npos;
    std::string named = key;
    std::replace(named.begin(), named.end(), '_', ' ');
    if (is_path || value.is_array())
      add_provenance(name, is_path ? key : "", part, rows);
    else
      add_provenance(name.empty() ? named : fmt::format("{}: {}", name, named), "", part, rows);
  }
}

} // namespace

nlohmann::json provenance_rows(const nlohmann::ordered_json &provenance) {
  nlohmann::json rows = nlohmann::json::array();
  add_provenance("", "", provenance, rows);
  return rows;
}

std::string to_html(const Page &page) {
  nlohmann::json values = page.json;
  if (page.json.contains("provenance"))
    values["provenance_rows"] = provenance_rows(page.json["provenance"]);
  values.update(page.values);
  values["charts"] = places_of(page.charts);
  values["css"] = embedded::kPageCss;
  values["data"] = in_script(data_of(page).dump());
  values["script"] = embedded::kPageScript;
  if (!page.charts.empty())
    values["chart_scripts"] = {embedded::kD3, embedded::kChartScript};
  return fill_template(page.html, values);
}

namespace {

using nlohmann::json;
using Scopes = std::vector<const json *>;

const json *find(const Scopes &scopes, const std::string &key) {
  if (key == ".")
    return scopes.back();
  for (auto scope = scopes.rbegin(); scope != scopes.rend(); ++scope)
    if ((*scope)->is_object() && (*scope)->contains(key))
      return &(**scope)[key];
  return nullptr;
}

std::string words(const json *value) {
  if (value == nullptr || value->is_null())
    return "";
  return value->is_string() ? value->get<std::string>() : value->dump();
}

bool holds(const json *value) {
  if (value == nullptr || value->is_null() || (value->is_boolean() && !value->get<bool>()))
    return false;
  if (value->is_string())
    return !value->get<std::string>().empty();
  return !(value->is_array() && value->empty());
}

std::size_t fill_section(const std::string &text, std::size_t at, const std::string &tag,
                         Scopes &scopes, std::string *out);

/// Fills `text` from `at` on, up to the end of `section`, or of the text; returns the place behind it.
/// `out` null: what is filled is not wanted.
std::size_t fill(const std::string &text, std::size_t at, const std::string &section,
                 Scopes &scopes, std::string *out) {
  for (std::size_t open = text.find("{{", at);; open = text.find("{{", at)) {
    if (out)
      out->append(text, at, open - at);
    if (open == std::string::npos && section.empty())
      return text.size();
    const bool raw = open != std::string::npos && text.compare(open, 3, "{{{") == 0;
    const std::size_t braces = raw ? 3 : 2, end = text.find(raw ? "}}}" : "}}", open);
    if (open == std::string::npos || end == std::string::npos)
      throw std::logic_error("page template: a tag or section '" + section + "' is not closed");
    const std::string tag = text.substr(open + braces, end - open - braces), key = tag.substr(1);
    at = end + braces;
    if (tag[0] == '/' && key == section)
      return at;
    if (tag[0] == '#' || tag[0] == '^')
      at = fill_section(text, at, tag, scopes, out);
    else if (out)
      *out += raw ? words(find(scopes, tag)) : escaped(words(find(scopes, tag)));
  }
}

std::size_t fill_section(const std::string &text, std::size_t at, const std::string &tag,
                         Scopes &scopes, std::string *out) {
  const std::string key = tag.substr(1);
  const json *value = find(scopes, key);
  const bool positive = tag[0] == '#', shown = holds(value) == positive;
  if (!shown || !positive)
    return fill(text, at, key, scopes, shown ? out : nullptr);
  std::size_t end = at;
  const auto once = [&](const json &element) {
    scopes.push_back(&element);
    end = fill(text, at, key, scopes, out);
    scopes.pop_back();
  };
  if (!value->is_array())
    once(*value);
  else
    for (const json &element : *value)
      once(element);
  return end;
}

} // namespace

std::string escaped(const std::string &text) {
  std::string out;
  for (const char c : text)
    out += c == '&'   ? "&amp;"
           : c == '<' ? "&lt;"
           : c == '>' ? "&gt;"
           : c == '"' ? "&quot;"
                      : std::string(1, c);
  return out;
}

std::string fill_template(const std::string &text, const json &values) {
  Scopes scopes{&values};
  std::string out;
  fill(text, 0, "", scopes, &out);
  return out;
}

std::string in_script(std::string json) {
  for (auto at = json.find('<'); at != std::string::npos; at = json.find('<', at))
    json.replace(at, 1, "\\u003c"); // JSON has it in strings only
  return json;
}

} // namespace calendem::report
