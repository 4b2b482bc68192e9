// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/pages.h"
#include "diagnose/compare/gap.h"
#include "report/page.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

extern const char *const kModelHtml, *const kPredictionHtml, *const kDesignHtml;

namespace {

using Json = nlohmann::ordered_json;
using nlohmann::json;
using report::Chart;
using report::kSeriesColours;
using report::kSeriesSymbols;
using report::Mark;
using report::Series;

constexpr double kPercent = 100.0;
constexpr std::size_t kMostFilms = 6; // in a chart

/// The colour, mixed with white: `share` of it is left.
std::string tint(const std::string &colour, double share) {
  std::string out = "#";
  for (std::size_t k = 1; k < 7; k += 2)
    out += fmt::format("{:02x}",
                       int(255.0 - share * (255 - std::stoi(colour.substr(k, 2), nullptr, 16))));
  return out;
}

/// One part of the bands, times a scale.
std::vector<double> part_of(const std::vector<Band> &bands, double Band::*part, double scale) {
  std::vector<double> out;
  for (const Band &b : bands)
    out.push_back(scale * b.*part);
  return out;
}

Series line_of(const std::string &name, const std::vector<double> &x, const std::vector<double> &y,
               const std::string &colour) {
  Series s;
  s.name = name;
  s.x = x;
  s.y = y;
  s.colour = colour;
  return s;
}

/// The bands of one number as areas and a line.
void add_bands(const std::vector<double> &x, const std::vector<Band> &bands, double scale,
               const std::string &colour, Chart &chart) {
  Series wide = line_of("90 %", x, part_of(bands, &Band::high90, scale), tint(colour, 0.2)),
         half = line_of("50 %", x, part_of(bands, &Band::high50, scale), tint(colour, 0.4));
  wide.mark = half.mark = Mark::area;
  wide.base = part_of(bands, &Band::low90, scale);
  half.base = part_of(bands, &Band::low50, scale);
  chart.series.push_back(wide);
  chart.series.push_back(half);
  chart.series.push_back(line_of("median", x, part_of(bands, &Band::median, scale), colour));
}

/// One of several: its median, and the ends of its 90 % dashed.
void add_edges(const std::string &name, const std::vector<double> &x,
               const std::vector<Band> &bands, double scale, std::size_t number, Chart &chart) {
  const std::string colour = kSeriesColours[number % kSeriesColours.size()];
  Series middle = line_of(name, x, part_of(bands, &Band::median, scale), colour);
  middle.symbol = kSeriesSymbols[number % kSeriesSymbols.size()];
  chart.series.push_back(middle);
  for (double Band::*edge : {&Band::low90, &Band::high90}) {
    Series s = line_of("", x, part_of(bands, edge, scale), colour);
    s.dash = "4 3";
    chart.series.push_back(s);
  }
}

Chart chart_of(const std::string &id, const std::string &title, const std::string &y) {
  Chart c;
  c.id = id;
  c.title = title;
  c.x_label = "Pressure (MPa)";
  c.y_label = y;
  return c;
}

Series points_of(const Calibration &c, int film, const std::string &colour) {
  Series s;
  s.name = "measured";
  s.mark = Mark::points;
  s.symbol = report::Symbol::circle;
  s.colour = colour;
  for (const Datum &d : c.data)
    if (d.film == film && d.number == FilmNumber::PorosityAfter) {
      s.x.push_back(d.pressure);
      s.y.push_back(kPercent * d.measured);
      s.y_error.push_back(kPercent * d.sd);
    }
  return s;
}

json percent_row(const Json &row, std::initializer_list<const char *> keys) {
  json out;
  for (const char *key : keys)
    out[key] = row.contains(key) ? fmt::format("{:.1f}", kPercent * row[key].get<double>()) : "–";
  return out;
}

/// Films left out, with what the rules of thumb say, and how far each is off.
json left_out_part(const Json &model) {
  const Json &rows = model.at("left_out");
  if (rows.empty())
    return nullptr;
  json table = json::array();
  std::vector<double> off, heckel, meyer;
  int in50 = 0, in90 = 0;
  for (const Json &r : rows) {
    json row = percent_row(r, {"measured", "median", "low90", "high90"});
    const double measured = r["measured"];
    row["film"] = r["film"];
    row["pressure"] = shown(r["pressure_MPa"], "{:.0f}");
    row["heckel"] = fmt::format("{:.1f}", kPercent * r["rules"]["Heckel"].get<double>());
    row["meyer"] = fmt::format("{:.1f}", kPercent * r["rules"]["Meyer"].get<double>());
    const bool inside = measured >= r["low90"] && measured <= r["high90"];
    row["inside"] = inside ? "yes" : "no";
    in90 += inside;
    in50 += measured >= r["low50"] && measured <= r["high50"];
    off.push_back(std::fabs(r["median"].get<double>() - measured));
    heckel.push_back(std::fabs(r["rules"]["Heckel"].get<double>() - measured));
    meyer.push_back(std::fabs(r["rules"]["Meyer"].get<double>() - measured));
    table.push_back(row);
  }
  const auto median = [](std::vector<double> v) {
    std::sort(v.begin(), v.end());
    const std::size_t n = v.size();
    return fmt::format("{:.1f}", kPercent * 0.5 * (v[(n - 1) / 2] + v[n / 2]));
  };
  return {{"rows", table},
          {"in90", fmt::format("{} of {}", in90, rows.size())},
          {"in50", fmt::format("{} of {}", in50, rows.size())},
          {"off", median(off)},
          {"heckel_off", median(heckel)},
          {"meyer_off", median(meyer)}};
}

json hypotheses_part(const Json &model) {
  json rows = json::array();
  for (const Json &h : model.at("hypotheses")) {
    std::string values;
    for (const Json &e : h["effects"])
      values += fmt::format("{}{} = {} (90 %: {} to {})", values.empty() ? "" : "; ",
                            e["key"].get<std::string>(), shown(e["median"], "{:.3g}"),
                            shown(e["low90"], "{:.3g}"), shown(e["high90"], "{:.3g}"));
    rows.push_back({{"name", h["name"]},
                    {"percent", fmt::format("{:.0f}", kPercent * h["probability"].get<double>())},
                    {"value", values},
                    {"samples", shown(h["effective_samples"], "{:.0f}")}});
  }
  return rows;
}

json parameters_part(const Json &model) {
  json rows = json::array();
  for (const Json &p : model.at("parameters"))
    rows.push_back({{"name", p["parameter"]},
                    {"prior", fmt::format("{:g} to {:g}", p["prior_low"].get<double>(),
                                          p["prior_high"].get<double>())},
                    {"median", shown(p["median"], "{:.3g}")},
                    {"low", shown(p["low90"], "{:.3g}")},
                    {"high", shown(p["high90"], "{:.3g}")}});
  return rows;
}

json emulators_part(const Json &model) {
  json rows = json::array();
  for (const Json &e : model.at("emulators"))
    if (e["number"] == "porosity_after")
      rows.push_back({{"pressure", shown(e["pressure_MPa"], "{:g}")},
                      {"q2", shown(e["q2"], "{:.2f}")},
                      {"error", fmt::format("{:.2f}", kPercent * e["error"].get<double>())},
                      {"own", fmt::format("{:.2f}", kPercent * e["own_error"].get<double>())}});
  return rows;
}

} // namespace

std::string model_page(const FilmBank &bank, const Calibration &c, const Json &model) {
  const auto pressures =
      spread_pressures(bank.spec().pressures.front(), bank.spec().pressures.back(), 25);
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
                 {"hypotheses_rows", hypotheses_part(model)},
                 {"parameters_rows", parameters_part(model)},
                 {"emulators_rows", emulators_part(model)},
                 {"bank_name", bank.spec().name}};
  return report::to_html(page);
}

namespace {

struct Number {
  const char *name, *title;
  const std::vector<Band> PredictedFilm::*bands;
  double scale;
};
const std::vector<Number> &numbers() {
  static const std::vector<Number> all = {
      {"porosity_after_percent", "Total porosity after release (%)", &PredictedFilm::after,
       kPercent},
      {"porosity_under_load_percent", "Total porosity under load (%)", &PredictedFilm::under_load,
       kPercent},
      {"springback_percent", "Springback of the thickness (%)", &PredictedFilm::springback,
       kPercent},
      {"cracked_percent", "Cracked particles (%)", &PredictedFilm::cracked, kPercent},
      {"unloading_modulus_GPa", "Unloading modulus (GPa)", &PredictedFilm::modulus, 1.0}};
  return all;
}

Json band_json(const Band &b, double scale) {
  return {{"median", scale * b.median},
          {"low50", scale * b.low50},
          {"high50", scale * b.high50},
          {"low90", scale * b.low90},
          {"high90", scale * b.high90}};
}

Json film_json(const FilmBank &bank, const Film &f) {
  Json out = {{"name", f.name}, {"loading_mg_cm2", f.loading}};
  for (std::size_t k = 0; k < f.recipe.size(); ++k)
    out[bank.film()[k].name] = f.recipe[k];
  return out;
}

} // namespace

std::string prediction_table(const FilmBank &bank, const std::vector<PredictedFilm> &films) {
  std::string out = "film";
  for (const BankParameter &p : bank.film())
    out += "," + p.name;
  out += ",pressure_MPa";
  for (const Number &n : numbers())
    for (const char *part : {"median", "low50", "high50", "low90", "high90"})
      out += fmt::format(",{}_{}", n.name, part);
  out += "\n";
  for (const PredictedFilm &f : films)
    for (std::size_t k = 0; k < f.pressures.size(); ++k) {
      out += "\"" + f.film.name + "\"";
      for (const double x : f.film.recipe)
        out += fmt::format(",{:g}", x);
      out += fmt::format(",{:g}", f.pressures[k]);
      for (const Number &n : numbers()) {
        const Band &b = (f.*n.bands)[k];
        for (const double x : {b.median, b.low50, b.high50, b.low90, b.high90})
          out += fmt::format(",{:.4g}", n.scale * x);
      }
      out += "\n";
    }
  return out;
}

Json to_json(const FilmBank &bank, const std::vector<PredictedFilm> &films) {
  Json out = Json::array();
  for (const PredictedFilm &f : films) {
    Json row = film_json(bank, f.film);
    row["beyond"] = f.beyond;
    row["by"] = f.runs == 0 ? Json("emulators") : Json{{"runs", f.runs}};
    row["predicted"] = Json::array();
    for (std::size_t k = 0; k < f.pressures.size(); ++k) {
      Json at = {{"pressure_MPa", f.pressures[k]}};
      for (const Number &n : numbers())
        at[n.name] = band_json((f.*n.bands)[k], n.scale);
      row["predicted"].push_back(at);
    }
    out.push_back(row);
  }
  return {{"films", out}};
}

std::string prediction_page(const Calibration &c, const std::vector<PredictedFilm> &films,
                            const Json &json_of) {
  report::Page page{kPredictionHtml, json_of};
  for (const Number &n : numbers()) {
    Chart chart = chart_of(n.name, n.title, n.title);
    if (films.size() == 1)
      add_bands(films[0].pressures, films[0].*n.bands, n.scale, kSeriesColours[0], chart);
    for (std::size_t k = 0; k < films.size() && films.size() > 1 && k < kMostFilms; ++k)
      add_edges(films[k].film.name, films[k].pressures, films[k].*n.bands, n.scale, k, chart);
    for (std::size_t f = 0; f < c.films.size() && n.bands == &PredictedFilm::after; ++f)
      if (films.size() == 1 && is_same_film(c.films[f], films[0].film))
        chart.series.push_back(points_of(c, int(f), kSeriesColours[5]));
    if (films.size() > 1)
      chart.note = "Dashed: the ends of the 90 % intervals.";
    if (films.size() > kMostFilms)
      chart.note +=
          fmt::format(" The first {} of {} films; the table has all.", kMostFilms, films.size());
    page.charts.push_back(chart);
  }
  json rows = json::array();
  for (const PredictedFilm &f : films)
    for (std::size_t k = 0; k < f.pressures.size(); ++k) {
      json row = {{"film", f.film.name}, {"pressure", fmt::format("{:.3g}", f.pressures[k])}};
      for (const Number &n : numbers()) {
        const Band &b = (f.*n.bands)[k];
        row["cells"].push_back(fmt::format("{:.3g} ({:.3g}–{:.3g})", n.scale * b.median,
                                           n.scale * b.low90, n.scale * b.high90));
      }
      rows.push_back(row);
    }
  json beyond = json::array();
  for (const PredictedFilm &f : films)
    for (const std::string &text : f.beyond)
      beyond.push_back(f.film.name + ": " + text);
  json own = json::array();
  for (const PredictedFilm &f : films)
    if (f.runs > 0)
      own.push_back(
          fmt::format("{}: by {} runs of its own at each pressure, each with another draw of the "
                      "material, on another packing",
                      f.film.name, f.runs));
  const bool cracks = std::any_of(c.data.begin(), c.data.end(),
                                  [](const Datum &d) { return d.number == FilmNumber::Cracked; });
  page.values = {{"rows", rows},
                 {"beyond_rows", beyond},
                 {"own_rows", own},
                 {"not_measured",
                  cracks ? "Springback and modulus were" : "Springback, cracks and modulus were"}};
  return report::to_html(page);
}

Json to_json(const FilmBank &bank, const Target &t, const std::vector<Design> &designs) {
  Json out = Json::array();
  for (const Design &d : designs) {
    Json row = film_json(bank, d.film);
    row["beyond"] = d.predicted.beyond;
    row["best"] = {{"pressure_MPa", d.chances[d.best].pressure},
                   {"probability", d.chances[d.best].both},
                   {"assured", d.chances[d.best].assured},
                   {"porosity_after_percent", band_json(d.predicted.after[d.best], kPercent)},
                   {"cracked_percent", band_json(d.predicted.cracked[d.best], kPercent)},
                   {"springback_percent", band_json(d.predicted.springback[d.best], kPercent)}};
    if (d.confirmed)
      row["confirmed"] = {{"runs", d.confirmed->runs},
                          {"probability", d.confirmed_chance.both},
                          {"porosity_after_percent", band_json(d.confirmed->after[0], kPercent)},
                          {"cracked_percent", band_json(d.confirmed->cracked[0], kPercent)}};
    row["chances"] = Json::array();
    for (const Chance &c : d.chances)
      row["chances"].push_back({{"pressure_MPa", c.pressure},
                                {"porosity", c.porosity},
                                {"cracked", c.cracked},
                                {"both", c.both},
                                {"assured", c.assured}});
    out.push_back(row);
  }
  return {{"target",
           {{"porosity_percent", kPercent * t.porosity},
            {"within_points", kPercent * t.within},
            {"cracked_below_percent", kPercent * t.cracked_below}}},
          {"films", out}};
}

std::string design_page(const Target &t, const std::vector<Design> &designs, const Json &json_of) {
  report::Page page{kDesignHtml, json_of};
  Chart chance = chart_of("chance", "Probability of meeting the target", "Probability (%)"),
        pareto = chart_of("pareto", "What porosity costs", "Cracked particles (%)");
  pareto.x_label = "Total porosity after release (%)";
  pareto.note = "Along the pressure, from right to left: median of the porosity, and bands of the "
                "cracked particles.";
  json rows = json::array();
  for (std::size_t k = 0; k < designs.size(); ++k) {
    const Design &d = designs[k];
    std::vector<double> pressures, both;
    for (const Chance &c : d.chances) {
      pressures.push_back(c.pressure);
      both.push_back(kPercent * c.both);
    }
    chance.series.push_back(
        line_of(d.film.name, pressures, both, kSeriesColours[k % kSeriesColours.size()]));
    chance.series.back().symbol = kSeriesSymbols[k % kSeriesSymbols.size()];
    const std::vector<double> porosity = part_of(d.predicted.after, &Band::median, kPercent);
    if (designs.size() == 1)
      add_bands(porosity, d.predicted.cracked, kPercent, kSeriesColours[0], pareto);
    else
      add_edges(d.film.name, porosity, d.predicted.cracked, kPercent, k, pareto);
    const Band &after = d.predicted.after[d.best], &cracked = d.predicted.cracked[d.best];
    rows.push_back({{"film", d.film.name},
                    {"pressure", fmt::format("{:.0f}", d.chances[d.best].pressure)},
                    {"probability", fmt::format("{:.0f}", kPercent * d.chances[d.best].both)},
                    {"assured", fmt::format("{:.0f}", kPercent * d.chances[d.best].assured)},
                    {"porosity", fmt::format("{:.1f} ({:.1f}–{:.1f})", kPercent * after.median,
                                             kPercent * after.low90, kPercent * after.high90)},
                    {"cracked", fmt::format("{:.0f} ({:.0f}–{:.0f})", kPercent * cracked.median,
                                            kPercent * cracked.low90, kPercent * cracked.high90)}});
    if (d.confirmed)
      rows.back()["confirmed"] = fmt::format(
          "{} runs: {:.0f} %, porosity {:.1f} ({:.1f}–{:.1f})", d.confirmed->runs,
          kPercent * d.confirmed_chance.both, kPercent * d.confirmed->after[0].median,
          kPercent * d.confirmed->after[0].low90, kPercent * d.confirmed->after[0].high90);
  }
  page.charts = {chance, pareto};
  page.values = {
      {"rows", rows},
      {"any_confirmed", std::any_of(designs.begin(), designs.end(),
                                    [](const Design &d) { return d.confirmed.has_value(); })},
      {"porosity", fmt::format("{:g}", kPercent * t.porosity)},
      {"within", fmt::format("{:g}", kPercent * t.within)},
      {"cracked_below",
       t.cracked_below < 1.0 ? json(fmt::format("{:g}", kPercent * t.cracked_below)) : json()}};
  return report::to_html(page);
}

} // namespace calendem
