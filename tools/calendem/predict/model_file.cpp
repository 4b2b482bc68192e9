// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/case.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "base/registry.h"
#include "effects/effects.h"
#include "predict/crushed.h"
#include "predict/files.h"
#include "predict/film_sheet.h"
#include "predict/learnt.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {

using Json = nlohmann::ordered_json;
namespace {

Json films_of(const FilmBank &bank, const Calibration &c) {
  Json out = Json::array();
  for (const Film &f : c.films) {
    Json row = {{"name", f.name},
                {"material", f.material},
                {"loading_mg_cm2", f.loading},
                {"nanoporosity", f.nanoporosity},
                {"sizes", f.sizes}};
    for (std::size_t k = 0; k < f.recipe.size(); ++k)
      row["recipe"][bank.film()[k].name] = f.recipe[k];
    out.push_back(row);
  }
  return out;
}

Json data_of(const Calibration &c) {
  Json out = Json::array();
  for (const Datum &d : c.data)
    out.push_back({{"film", d.film},
                   {"condition", d.condition},
                   {"number", name_of(d.number)},
                   {"pressure_MPa", d.pressure},
                   {"pressure_sd_relative", d.pressure_sd},
                   {"measured", d.measured},
                   {"sd", d.sd}});
  return out;
}

Json draws_of(const FilmBank &bank, const Calibration &c) {
  Json out = Json::array();
  for (const Draw &d : c.draws) {
    Json row = {{"missed_sd", d.missed.sd},
                {"missed_shared", d.missed.shared},
                {"alike", d.alike},
                {"materials", Json::array()}};
    for (const Material &m : d.materials) {
      Json of = {{"effects", Json::object()}};
      for (const ActiveEffect &a : m.effects)
        of["effects"][bank.effects()[std::size_t(a.effect)].name] = a.amplitude;
      for (std::size_t k = 0; k < bank.material().size(); ++k)
        of[bank.material()[k].name] = m.parameters[k];
      row["materials"].push_back(of);
    }
    out.push_back(row);
  }
  return out;
}

Json left_out_json(const std::vector<LeftOut> &rows) {
  Json out = Json::array();
  for (const LeftOut &r : rows) {
    Json row = {{"film", r.film},
                {"condition", r.condition},
                {"number", name_of(r.number)},
                {"pressure_MPa", r.pressure},
                {"measured", r.measured},
                {"median", r.predicted.median},
                {"low50", r.predicted.low50},
                {"high50", r.predicted.high50},
                {"low90", r.predicted.low90},
                {"high90", r.predicted.high90},
                {"rules", r.rules}};
    out.push_back(row);
  }
  return out;
}

/// Middle, and the interval that holds 90 %, of a number of the draws.
Json spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[std::size_t(std::lround(share * double(values.size() - 1)))];
  };
  return {{"median", at(0.5)}, {"low90", at(0.05)}, {"high90", at(0.95)}};
}

/// What the bank's parameter of that name is.
std::string meaning_of(const FilmBank &bank, const std::string &parameter) {
  for (const bank::Input &input : bank.spec().design.inputs)
    for (const Key &key : case_keys())
      if (input.name == parameter && input.keys.front() == "case." + key.name)
        return key.meaning.substr(0, key.meaning.find(", eq."));
  return "nanoporosity of carbon and binder, above the recipe's";
}

Json parameters_of(const FilmBank &bank, const Calibration &c) {
  Json out = Json::array();
  for (std::size_t m = 0; m < c.materials.size(); ++m)
    for (std::size_t k = 0; k < bank.material().size(); ++k) {
      std::vector<double> values;
      for (const Draw &d : c.draws)
        values.push_back(d.materials[m].parameters[k]);
      Json row = {{"parameter", bank.material()[k].name + of_material(c, m)},
                  {"meaning", meaning_of(bank, bank.material()[k].name)},
                  {"prior_low", bank.material()[k].prior.a},
                  {"prior_high", bank.material()[k].prior.b}};
      row.update(spread_of(values));
      out.push_back(row);
    }
  const auto add = [&](const char *name, const char *meaning, double low, double high,
                       const auto &value) {
    std::vector<double> values;
    for (const Draw &d : c.draws)
      values.push_back(value(d));
    Json row = {
        {"parameter", name}, {"meaning", meaning}, {"prior_low", low}, {"prior_high", high}};
    row.update(spread_of(values));
    out.push_back(row);
  };
  add("missed_points", "model error: its standard deviation in points of porosity",
      100.0 * c.error.low, 100.0 * c.error.high, [](const Draw &d) { return 100.0 * d.missed.sd; });
  add("missed_shared", "part of its variance that all films of one material share", 0.0, 1.0,
      [](const Draw &d) { return d.missed.shared; });
  if (c.materials.size() > 1)
    add("materials_alike", "correlation between the materials", 0.0, 1.0,
        [](const Draw &d) { return d.alike; });
  return out;
}

Json learnt_of(const FilmBank &bank, const Calibration &c) {
  Json out = Json::array();
  const std::vector<LeftOutDatum> lessons = left_out_data_of(bank, c);
  for (std::size_t k = 0; k < lessons.size(); ++k) {
    const Datum &d = c.data[k];
    const LeftOutDatum &l = lessons[k];
    Json row = {{"film", c.films[std::size_t(d.film)].name},
                {"condition", d.condition},
                {"number", name_of(d.number)},
                {"pressure_MPa", d.pressure},
                {"measured", d.measured}};
    row.update(Json{{"without", band_json(l.without, 1.0)},
                    {"gain_nats", l.gain},
                    {"parameter", l.parameter},
                    {"shift_sd", l.shift},
                    {"effective_draws", l.effective}});
    out.push_back(row);
  }
  return out;
}

Json crushing_json(const FilmBank &bank, const Calibration &c) {
  Json out = Json::array();
  for (const Crushing &k : crushing_of(bank, c)) {
    Json row = {{"material", c.materials[std::size_t(k.material)]},
                {"diameter_um", k.diameter},
                {"load_mN", band_json(k.load, 1.0)}};
    if (k.measured > 0.0) {
      row["measured"] = k.measured;
      row["sd"] = k.sd;
    }
    out.push_back(row);
  }
  return out;
}

Json trade_offs_json(const FilmBank &bank, const Calibration &c) {
  Json out = Json::array();
  for (const TradeOff &t : trade_offs_of(bank, c))
    out.push_back({{"first", t.first}, {"second", t.second}, {"correlation", t.correlation}});
  return out;
}

/// How well packings that were left out are predicted.
Json emulators_of(const FilmBank &bank) {
  Json out = Json::array();
  for (int n = 0; n < kFilmNumbers; ++n) { // none of a number that the bank does not have
    if (!bank.knows(FilmNumber(n)))
      continue;
    const std::vector<inference::Accuracy> accuracy = bank.accuracy(FilmNumber(n));
    for (std::size_t k = 0; k < accuracy.size(); ++k)
      out.push_back({{"number", name_of(FilmNumber(n))},
                     {"pressure_MPa", bank.pressures()[k]},
                     {"q2", accuracy[k].q2},
                     {"error", accuracy[k].error},
                     {"inside_50", accuracy[k].inside_50},
                     {"inside_90", accuracy[k].inside_90}});
  }
  return out;
}

Json hypotheses_of(const FilmBank &bank, const Calibration &c) {
  Json out = Json::array();
  for (const EffectSet &set : effect_sets_of(bank, c))
    out.push_back({{"name", set.name}, {"probability", set.probability}});
  return out;
}

/// How probably each acts in each material, and the values of its key where it does.
Json effects_json(const FilmBank &bank, const Calibration &c) {
  Json out = Json::array();
  for (std::size_t e = 0; e < bank.effects().size(); ++e) {
    const std::string &name = bank.effects()[e].name;
    Json row = {{"name", name},
                {"key", find_effect(name).parameter.keys.front()},
                {"materials", Json::array()}};
    for (std::size_t m = 0; m < c.materials.size(); ++m) {
      std::vector<double> values;
      for (const Draw &d : c.draws)
        for (const ActiveEffect &a : d.materials[m].effects)
          if (a.effect == int(e))
            values.push_back(key_value(bank, a));
      Json of = {{"material", c.materials[m]}, {"probability", acting(c, int(e), m)}};
      if (!values.empty())
        of.update(spread_of(values));
      row["materials"].push_back(of);
    }
    out.push_back(row);
  }
  return out;
}

} // namespace

Json to_json(const std::vector<Confirmed> &rows) {
  Json out = Json::array();
  for (const Confirmed &r : rows)
    out.push_back({{"film", r.film},
                   {"pressure_MPa", r.pressure},
                   {"measured", r.measured},
                   {"sd", r.sd},
                   {"runs", r.runs},
                   {"mean", r.mean},
                   {"low", r.low},
                   {"high", r.high},
                   {"emulated", r.emulated},
                   {"error", r.error}});
  return out;
}

std::vector<std::string> files_beside(const bank::Bank &spec) {
  std::vector<std::string> out = {spec.recipe_file, spec.case_file};
  if (!spec.crushing_file.empty())
    out.push_back(spec.crushing_file);
  return out;
}

namespace {

/// The bank's files, so that a model can be moved: relative to input_scripts/ of any installation
/// where the bank ships with it, otherwise to the model's folder.
Json bank_json(const bank::Bank &spec, const std::string &folder) {
  namespace fs = std::filesystem;
  const fs::path file = fs::weakly_canonical(spec.file);
  const fs::path shipped = file.lexically_relative(input_scripts());
  const bool ships = !shipped.empty() && *shipped.begin() != "..";
  Json beside = Json::array();
  for (const std::string &other : files_beside(spec))
    beside.push_back(
        {{"file",
          fs::absolute(other).lexically_normal().lexically_relative(file.parent_path()).string()},
         {"hash", hash_of_file(other)}});
  const fs::path from = fs::absolute(folder).lexically_normal();
  return {{"file", (ships ? shipped : file.lexically_relative(from)).string()},
          {"hash", hash_of_file(spec.file)},
          {"table_hash", hash_of_file(bank::table_of(spec))},
          {"beside", beside}};
}

} // namespace

Json to_json(const FilmBank &bank, const Calibration &c, const std::vector<LeftOut> &rows,
             const std::string &folder) {
  return {{"bank", bank_json(bank.spec(), folder)},
          {"materials", c.materials},
          {"films", films_of(bank, c)},
          {"data", data_of(c)},
          {"model_error",
           {{"numerics", c.error.numerics}, {"low", c.error.low}, {"high", c.error.high}}},
          {"hypotheses", hypotheses_of(bank, c)},
          {"effects", effects_json(bank, c)},
          {"parameters", parameters_of(bank, c)},
          {"learnt", learnt_of(bank, c)},
          {"trade_offs", trade_offs_json(bank, c)},
          {"crushing", crushing_json(bank, c)},
          {"emulators", emulators_of(bank)},
          {"left_out", left_out_json(rows)},
          {"draws", draws_of(bank, c)},
          {"provenance", {{"calendem", version()}, {"hashes", "64-bit FNV-1a"}}}};
}

} // namespace calendem
