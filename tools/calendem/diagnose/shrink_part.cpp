// SPDX-License-Identifier: GPL-2.0-or-later
#include "compare/gap.h"
#include "diagnose/page.h"
#include "report/page.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {
namespace {

using nlohmann::json;

constexpr double kBar = 240.0;  // px of the longest bar
constexpr double kMissed = 2.0; // standard deviations beyond which an observable is not met

double number(const json &object, const char *key) {
  return object.contains(key) && object[key].is_number() ? object[key].get<double>() : std::nan("");
}

std::string interval(const json &gap) {
  return fmt::format("{} (90 %: {} to {})", shown(gap["value"], "{:.3g}"),
                     shown(gap.value("low90", json()), "{:.3g}"),
                     shown(gap.value("high90", json()), "{:.3g}"));
}

const json *model_of(const json &shrink, const std::string &role) {
  for (const json &m : shrink["models"])
    if (m["role"] == role)
      return &m;
  return nullptr;
}

/// Largest number that a bar must hold.
double largest(const json &models) {
  double most = 1e-300;
  for (const json &m : models)
    for (const char *of : {"gap", "predicted_gap"})
      for (const char *key : {"value", "high90"})
        if (const double v = m.contains(of) ? number(m[of], key) : 0.0; v > most)
          most = v;
  return most;
}

json bar_of(const json &m, double most) {
  const auto px = [&](double v) {
    return std::isfinite(v) ? json(fmt::format("{:.1f}", std::max(v, 0.0) / most * kBar)) : json();
  };
  std::string parameters;
  for (const auto &[name, value] : m["parameters"].items())
    parameters +=
        fmt::format("{}{} = {}", parameters.empty() ? "" : ", ", name, shown(value, "{:.3g}"));
  json bar = {{"role", m["role"]},
              {"hypothesis", m["hypothesis"]},
              {"parameters", parameters},
              {"gap", interval(m["gap"])},
              {"width", px(number(m["gap"], "value"))}};
  const double low = number(m["gap"], "low90"), high = number(m["gap"], "high90");
  if (std::isfinite(low) && std::isfinite(high))
    bar["whisker"] = {{"low", px(low)}, {"high", px(high)}};
  if (m.contains("predicted_gap"))
    bar["predicted"] = px(number(m["predicted_gap"], "value"));
  return bar;
}

json observable_of(const json &o) {
  const double sd = o["sd"];
  const auto off = [&](const char *key) {
    const double by = (number(o, key) - number(o, "measured")) / sd;
    return std::isfinite(by) ? shown(by, "{:+.1f}") : "–";
  };
  const std::string digits = format_by_error(o["sd"]);
  return {{"condition", o["condition"]},
          {"name", o["name"]},
          {"measured", shown(o["measured"], digits.c_str())},
          {"sd", shown(o["sd"], digits.c_str())},
          {"before", shown(o["before"], digits.c_str())},
          {"after", shown(o.value("after", json()), digits.c_str())},
          {"before_off", off("before")},
          {"after_off", off("after")}};
}

json image_row(const json &row) {
  const auto of = [&](const char *role, const char *key, const char *format) {
    return row.contains(role) ? shown(row[role].value(key, json()), format) : "–";
  };
  const std::string digits = format_by_error(row["sd"]);
  return {{"condition", row["condition"]},
          {"name", fmt::format("{}, {}", row["name"].get<std::string>(), shown_unit(row["unit"]))},
          {"measured", shown(row["measured"], digits.c_str())},
          {"sd", shown(row["sd"], digits.c_str())},
          {"before", of("before", "mean", digits.c_str())},
          {"after", of("after", "mean", digits.c_str())},
          {"before_off", of("before", "off", "{:+.1f}")},
          {"after_off", of("after", "off", "{:+.1f}")}};
}

/// Null where no image was held out.
json images_of(const json &shrink) {
  if (!shrink.contains("images"))
    return nullptr;
  json rows = json::array();
  for (const json &row : shrink["images"]["rows"])
    rows.push_back(image_row(row));
  return {{"rows", rows}, {"has_rows", !rows.empty()}, {"without", shrink["images"]["without"]}};
}

report::Series series_of(const json &curve) {
  using namespace report;
  const std::string role = curve["role"];
  Series s;
  s.name = role;
  s.x = curve["displacement_um"].get<std::vector<double>>();
  s.y = curve["pressure_MPa"].get<std::vector<double>>();
  if (role == "measured") {
    s.mark = Mark::points;
    s.symbol = Symbol::circle;
  } else if (role == "before") {
    s.colour = "#b4481c", s.dash = "7 4", s.symbol = Symbol::square;
  } else if (role == "after") {
    s.colour = "#0b62a8", s.symbol = Symbol::triangle;
  } else {
    s.colour = "#6b6f76", s.dash = role == "placebo" ? "2 4" : "10 3 2 3";
    s.symbol = role == "placebo" ? Symbol::none : Symbol::diamond;
  }
  return s;
}

bool has_reruns(const json &gap) {
  return gap.contains("shrink") && gap["shrink"].is_object() && gap["shrink"].contains("models");
}

/// What stays, and whether another effect or none would have done as well.
json words_of(const json &shrink) {
  json words = json::array();
  if (shrink.contains("in_words"))
    words.push_back(shrink["in_words"]);
  const json *before = model_of(shrink, "before"), *after = model_of(shrink, "after");
  if (before && after && number((*before)["gap"], "value") > 0.0)
    words.push_back(
        fmt::format("Still unexplained: {:.0f} % of the gap that the recalibrated base "
                    "model leaves.",
                    100.0 * number((*after)["gap"], "value") / number((*before)["gap"], "value")));
  for (const char *role : {"runner-up", "placebo"})
    if (const json *other = model_of(shrink, role); other && after) {
      const bool worse = number((*other)["gap"], "value") > number((*after)["gap"], "high90");
      words.push_back(fmt::format(
          "The {} ({}) leaves {}{}.", role, (*other)["hypothesis"].get<std::string>(),
          shown((*other)["gap"]["value"], "{:.3g}"),
          worse ? "" : ": not clearly more, so this shrinking does not single the effect out"));
    }
  std::string missed;
  for (const json &o : shrink.value("observables", json::array()))
    if (std::fabs(number(o, after ? "after" : "before") - number(o, "measured")) >
        kMissed * number(o, "sd"))
      missed += fmt::format("{}{}: {}", missed.empty() ? "" : "; ",
                            o["condition"].get<std::string>(), o["name"].get<std::string>());
  if (!after)
    words.push_back("Only the base model was run again: no effect is claimed or leads.");
  words.push_back(missed.empty() ? "Every observable is met within two standard deviations."
                                 : "Not met within two standard deviations: " + missed + ".");
  return words;
}

} // namespace

std::vector<report::Chart> rerun_charts(const json &gap) {
  std::vector<report::Chart> charts;
  if (!has_reruns(gap))
    return charts;
  for (const json &curve : gap["shrink"].value("curves", json::array())) {
    const std::string condition = curve["condition"];
    auto at = std::find_if(charts.begin(), charts.end(),
                           [&](const report::Chart &c) { return c.title == condition; });
    if (at == charts.end()) {
      report::Chart c;
      c.id = fmt::format("held_out{}", charts.size());
      c.title = condition;
      c.x_label = "Displacement (µm)";
      c.y_label = "Pressure (MPa)";
      at = charts.insert(charts.end(), c);
    }
    at->series.push_back(series_of(curve));
  }
  for (report::Chart &chart : charts)
    chart.title += ": pressure against displacement";
  return charts;
}

json shrink_part(const json &gap) {
  if (!has_reruns(gap))
    return nullptr;
  const json &shrink = gap["shrink"];
  json bars = json::array(), observables = json::array();
  for (const json &m : shrink["models"])
    bars.push_back(bar_of(m, largest(shrink["models"])));
  for (const json &o : shrink.value("observables", json::array()))
    observables.push_back(observable_of(o));
  json part = {{"bars", bars},
               {"words", words_of(shrink)},
               {"observables", observables},
               {"has_observables", !observables.empty()},
               {"images", images_of(shrink)},
               {"charts", report::places_of(rerun_charts(gap))}};
  for (const char *ids : {"train", "held_out"})
    part[ids] = fmt::format("{}", fmt::join(shrink.value(ids, std::vector<std::string>()), ", "));
  const json &s = shrink.value("shrinkage", json::object());
  const auto percent = [&](const char *key) {
    return fmt::format("{:.0f}", 100.0 * number(s, key));
  };
  const double floor = number(shrink, "noise_floor");
  const bool seen = !(number(shrink, "before") <= floor && number(shrink, "after") <= floor);
  if (s.contains("value") && seen && std::isfinite(number(s, "value")))
    part["shrinkage"] = {
        {"value", percent("value")},
        {"low", percent("low90")},
        {"high", percent("high90")},
        {"predicted", std::isfinite(number(s, "predicted")) ? json(percent("predicted")) : json()}};
  return part;
}

} // namespace calendem
