// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/shown.h"
#include "predict/files.h"
#include "predict/film_charts.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>

namespace calendem {

extern const char *const kModelHtml;

namespace {

using Json = nlohmann::ordered_json;
using nlohmann::json;
using report::Chart;
using report::kSeriesColours;

json percent_row(const Json &row, std::initializer_list<const char *> keys) {
  json out;
  for (const char *key : keys)
    out[key] = row.contains(key) ? fmt::format("{:.1f}", kPercent * row[key].get<double>()) : "–";
  return out;
}

/// Intervals of films left out that hold as many measured values are taken at their word: 90 % of
/// them should, and of a dozen one or two more may miss.
constexpr double kReliable = 0.75;

std::string median_in_points(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  const std::size_t n = v.size();
  return n == 0 ? "–" : fmt::format("{:.1f}", kPercent * 0.5 * (v[(n - 1) / 2] + v[n / 2]));
}

/// How far porosities of films left out are off, by the model and by the rules of thumb.
struct LeftOutErrors {
  std::vector<double> off, heckel, meyer, width;
  int in50 = 0, in90 = 0;

  void add(const Json &r) {
    const double measured = r["measured"];
    in90 += measured >= r["low90"] && measured <= r["high90"];
    in50 += measured >= r["low50"] && measured <= r["high50"];
    width.push_back(r["high90"].get<double>() - r["low90"].get<double>());
    off.push_back(std::fabs(r["median"].get<double>() - measured));
    heckel.push_back(std::fabs(r["rules"]["Heckel"].get<double>() - measured));
    meyer.push_back(std::fabs(r["rules"]["Meyer"].get<double>() - measured));
  }
};

/// Films left out, with what the rules of thumb say, and how far each is off.
json left_out_part(const Json &model) {
  const Json &rows = model.at("left_out");
  if (rows.empty())
    return nullptr;
  json table = json::array(), others = json::array();
  LeftOutErrors errors;
  for (const Json &r : rows) {
    json row = percent_row(r, {"measured", "median", "low90", "high90"});
    row["film"] = r["film"];
    row["pressure"] = shown(r["pressure_MPa"], "{:.0f}");
    row["inside"] = r["measured"] >= r["low90"] && r["measured"] <= r["high90"] ? "yes" : "no";
    if (r["rules"].empty()) {
      row["number"] = reading_in_words(r["number"]);
      others.push_back(row);
      continue;
    }
    row["heckel"] = fmt::format("{:.1f}", kPercent * r["rules"]["Heckel"].get<double>());
    row["meyer"] = fmt::format("{:.1f}", kPercent * r["rules"]["Meyer"].get<double>());
    errors.add(r);
    table.push_back(row);
  }
  return {{"rows", table},
          {"others", others},
          {"any_others", !others.empty()},
          {"in90", fmt::format("{} of {}", errors.in90, table.size())},
          {"in50", fmt::format("{} of {}", errors.in50, table.size())},
          {"off", median_in_points(errors.off)},
          {"width", median_in_points(errors.width)},
          {"reliable", errors.in90 >= kReliable * double(table.size())},
          {"heckel_off", median_in_points(errors.heckel)},
          {"meyer_off", median_in_points(errors.meyer)}};
}

/// The films that the bank covers.
std::string films_in_words(const FilmBank &bank) {
  std::string out;
  for (const bank::Input &input : bank.film()) {
    const NameAndUnit in = in_words(input.name);
    out += fmt::format("{} {:g} to {:g}{}, ", in.name, input.low, input.high, in.unit);
  }
  return out + fmt::format("pressed to {:g} to {:g} MPa", bank.pressures().front(),
                           bank.pressures().back());
}

json confirmed_part(const Json &model) {
  json rows = json::array();
  for (const Json &r : model.value("confirmed", Json::array())) {
    const auto percent = [&](const char *key) { return kPercent * r.at(key).get<double>(); };
    rows.push_back(
        {{"film", r.at("film")},
         {"pressure", shown(r.at("pressure_MPa"), "{:.0f}")},
         {"measured", fmt::format("{:.1f} ± {:.1f}", percent("measured"), percent("sd"))},
         {"runs", r.at("runs").get<int>()},
         {"mean", fmt::format("{:.1f} ({:.1f} to {:.1f})", percent("mean"), percent("low"),
                              percent("high"))},
         {"emulated", fmt::format("{:.1f}", percent("emulated"))},
         {"off", shown(percent("mean") - percent("emulated"), "{:+.1f}") +
                     fmt::format(" ± {:.1f}", percent("error"))}});
  }
  return rows;
}

json heads_of(const Calibration &c) {
  json out = json::array();
  for (std::size_t m = 0; m < c.materials.size(); ++m)
    out.push_back("Probability" + of_material(c, m) + ", %");
  return out;
}

json effects_part(const Json &model) {
  json rows = json::array();
  for (const Json &e : model.at("effects"))
    for (const Json &m : e["materials"]) {
      const std::string material = m["material"];
      const auto text = m.contains("median") ? shown_alike({m["median"], m["low90"], m["high90"]})
                                             : std::vector<std::string>(3);
      rows.push_back({{"name", e["name"]},
                      {"material", material},
                      {"percent", fmt::format("{:.0f}", kPercent * m["probability"].get<double>())},
                      {"key", e["key"]},
                      {"median", text[0]},
                      {"low", text[1]},
                      {"high", text[2]}});
    }
  return rows;
}

constexpr double kShown = 0.02; // probability in any material

/// Sets of effects; those that are improbable in every material as one row.
json hypotheses_part(const Json &model) {
  json rows = json::array();
  std::vector<double> rest;
  int others = 0;
  const auto percents = [](const std::vector<double> &of) {
    json out = json::array();
    for (const double probability : of)
      out.push_back(fmt::format("{:.0f}", kPercent * probability));
    return out;
  };
  for (const Json &h : model.at("hypotheses")) {
    const std::vector<double> of = h["probability"];
    rest.resize(of.size());
    if (*std::max_element(of.begin(), of.end()) >= kShown) {
      rows.push_back({{"name", h["name"]}, {"percents", percents(of)}});
      continue;
    }
    ++others;
    std::transform(of.begin(), of.end(), rest.begin(), rest.begin(), std::plus<>());
  }
  if (others > 0)
    rows.push_back({{"name", fmt::format("{} others", others)}, {"percents", percents(rest)}});
  return rows;
}

json parameters_part(const Json &model) {
  json rows = json::array();
  for (const Json &p : model.at("parameters")) {
    const auto text = shown_alike({p["median"], p["low90"], p["high90"]});
    rows.push_back(
        {{"name", p["parameter"]},
         {"meaning", p["meaning"]},
         {"prior", shown(p["prior_low"], "{:g}") + " to " + shown(p["prior_high"], "{:g}")},
         {"median", text[0]},
         {"low", text[1]},
         {"high", text[2]}});
  }
  return rows;
}

constexpr double kFewDraws = 20.0;

json learnt_part(const Json &model) {
  json rows = json::array();
  for (const Json &l : model.at("learnt")) {
    const bool porosity = l["number"] == "porosity_after";
    const auto value = [&](const Json &of) {
      return fmt::format(porosity ? "{:.1f}" : "{:.0f}", kPercent * of.get<double>());
    };
    const Json &without = l["without"];
    const bool few = l["effective_draws"].get<double>() < kFewDraws;
    const double shift = l["shift_sd"];
    rows.push_back({{"film", l["film"]},
                    {"condition", l["condition"]},
                    {"number", reading_in_words(l["number"])},
                    {"measured", value(l["measured"])},
                    {"without", fmt::format("{} ({}–{})", value(without["median"]),
                                            value(without["low90"]), value(without["high90"]))},
                    {"gain", few ? "much" : shown(l["gain_nats"], "{:.2f}")},
                    {"moves", fmt::format("{} by {}{:.1f} sd", l["parameter"].get<std::string>(),
                                          shift < 0.0 ? "−" : "+", std::fabs(shift))}});
  }
  return rows;
}

json trade_offs_part(const Json &model) {
  json rows = json::array();
  for (const Json &t : model.at("trade_offs")) {
    const double r = t["correlation"];
    rows.push_back({{"first", t["first"]},
                    {"second", t["second"]},
                    {"correlation", fmt::format("{}{:.2f}", r < 0.0 ? "−" : "+", std::fabs(r))}});
  }
  return rows;
}

json crushing_part(const Json &model) {
  json rows = json::array();
  for (const Json &k : model.at("crushing")) {
    const Json &load = k["load_mN"];
    const auto text = shown_alike({load["median"], load["low90"], load["high90"]});
    rows.push_back({{"material", k["material"]},
                    {"diameter", shown(k["diameter_um"], "{:g}")},
                    {"measured", k.contains("measured") ? shown(k["measured"], "{:.3g}") + " ± " +
                                                              shown(k["sd"], "{:.2g}")
                                                        : "–"},
                    {"load", fmt::format("{} ({}–{})", text[0], text[1], text[2])}});
  }
  return rows;
}

json emulators_part(const Json &model) {
  json rows = json::array();
  for (const Json &e : model.at("emulators"))
    if (e["number"] == "porosity_after")
      rows.push_back({{"pressure", shown(e["pressure_MPa"], "{:.3g}")},
                      {"q2", shown(e["q2"], "{:.2f}")},
                      {"error", fmt::format("{:.2f}", kPercent * e["error"].get<double>())},
                      {"inside", fmt::format("{:.0f}", kPercent * e["inside_90"].get<double>())}});
  return rows;
}

/// The bank's files beside the rest.
json provenance_of(const Json &model) {
  Json all = {{"bank", model.at("bank")}};
  all.update(model.at("provenance"));
  return report::provenance_rows(all);
}

} // namespace

std::string model_page(const FilmBank &bank, const Calibration &c, const Json &model) {
  const auto pressures = spread_pressures(bank.pressures().front(), bank.pressures().back(), 25);
  report::Page page{kModelHtml, model};
  for (std::size_t k = 0; k < c.films.size(); ++k) {
    const PredictedFilm p = predicted(bank, c, c.films[k], pressures, 0.0);
    Chart chart =
        chart_of(fmt::format("film{}", k), c.films[k].name, "Total porosity after release (%)");
    add_bands(pressures, p.after, kPercent, kSeriesColours[0], chart);
    chart.series.push_back(points_of(c, int(k), kSeriesColours[5]));
    page.charts.push_back(chart);
  }
  page.values = {{"left_out_part", left_out_part(model)},
                 {"confirmed_rows", confirmed_part(model)},
                 {"any_confirmed", !model.value("confirmed", Json::array()).empty()},
                 {"probabilities", heads_of(c)},
                 {"effects_rows", effects_part(model)},
                 {"hypotheses_rows", hypotheses_part(model)},
                 {"parameters_rows", parameters_part(model)},
                 {"learnt_rows", learnt_part(model)},
                 {"any_learnt", !model.at("learnt").empty()},
                 {"trade_offs_rows", trade_offs_part(model)},
                 {"any_trade_off", !model.at("trade_offs").empty()},
                 {"crushing_rows", crushing_part(model)},
                 {"any_crushing", !model.at("crushing").empty()},
                 {"emulators_rows", emulators_part(model)},
                 {"bank_name", bank.spec().name},
                 {"films", films_in_words(bank)},
                 {"material", bank.recipe().material.name},
                 {"provenance_rows", provenance_of(model)}};
  return report::to_html(page);
}

} // namespace calendem
