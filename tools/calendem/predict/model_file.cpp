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
#include <set>

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

Json parameters_of(const FilmBank &bank, const Calibration &c) {
  Json out = Json::array();
  for (std::size_t m = 0; m < c.materials.size(); ++m)
    for (std::size_t k = 0; k < bank.material().size(); ++k) {
      std::vector<double> values;
      for (const Draw &d : c.draws)
        values.push_back(d.materials[m].parameters[k]);
      Json row = {{"parameter", bank.material()[k].name + of_material(c, m)},
                  {"prior_low", bank.material()[k].prior.a},
                  {"prior_high", bank.material()[k].prior.b}};
      row.update(spread_of(values));
      out.push_back(row);
    }
  const auto add = [&](const char *name, double low, double high, const auto &value) {
    std::vector<double> values;
    for (const Draw &d : c.draws)
      values.push_back(value(d));
    Json row = {{"parameter", name}, {"prior_low", low}, {"prior_high", high}};
    row.update(spread_of(values));
    out.push_back(row);
  };
  add("missed_points", 100.0 * c.error.low, 100.0 * c.error.high,
      [](const Draw &d) { return 100.0 * d.missed.sd; });
  add("missed_shared", 0.0, 1.0, [](const Draw &d) { return d.missed.shared; });
  if (c.materials.size() > 1)
    add("materials_alike", 0.0, 1.0, [](const Draw &d) { return d.alike; });
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

namespace {

template <class Value>
double middle_of(const std::vector<const Draw *> &draws, const Value &value) {
  std::vector<double> values;
  for (const Draw *d : draws)
    values.push_back(value(*d));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// Empty where the bank takes the nanoporosity for known.
std::string nanoporosity_line(const FilmBank &bank, const std::vector<const Draw *> &draws,
                              std::size_t material) {
  if (bank.spec().nanoporosity_within <= 0.0)
    return "";
  const double points =
      middle_of(draws, [&](const Draw &d) { return d.materials[material].parameters.back(); });
  return fmt::format("# In the recipe: cbd.nanoporosity_percent {:.1f} {}\n", std::fabs(points),
                     points < 0.0 ? "lower" : "higher");
}

/// Lines of a case, each key once: the first that is added stays.
class CaseLines {
public:
  explicit CaseLines(const Settings &of_bank) : of_bank_(of_bank) {}

  void add(const std::string &key, double value) { add_text(key, fmt::format("{:.4g}", value)); }
  /// Keeps those that the bank's case gives.
  void keep(const std::vector<Key> &keys) {
    for (const Key &key : keys)
      if (of_bank_.line(key.name) > 0)
        keep(key);
  }
  /// All that the material of an electrode could give otherwise: an effect that is off too.
  void keep_material() {
    const auto switches = [](const Key &key) {
      return std::any_of(effects().begin(), effects().end(), [&](const Effect &e) {
        return !e.settings.empty() && e.settings.front().name == key.name;
      });
    };
    for (const Key &key : case_keys())
      if (describes_material(key, false) && of_bank_.followed_by(key.name).empty() &&
          (key.name.rfind("effects.", 0) != 0 || switches(key) || of_bank_.line(key.name) > 0))
        keep(key);
  }
  std::string text() const {
    std::string out;
    for (const auto &[table, lines] : tables_)
      out += fmt::format("\n[{}]\n{}", table, lines);
    return out;
  }

private:
  Settings of_bank_;
  std::map<std::string, std::string> tables_;
  std::set<std::string> there_;

  void keep(const Key &key) {
    const std::string &value = of_bank_.text(key.name);
    add_text(key.name, wants_text(key) ? Json(value).dump() : value);
  }
  void add_text(const std::string &key, const std::string &value) {
    if (!there_.insert(key).second)
      return;
    const std::size_t dot = key.rfind('.');
    tables_[key.substr(0, dot)] += fmt::format("{} = {}\n", key.substr(dot + 1), value);
  }
};

} // namespace

namespace {

EffectSet most_probable(const FilmBank &bank, const Calibration &c, std::size_t material) {
  const std::vector<EffectSet> sets = effect_sets_of(bank, c);
  return *std::max_element(sets.begin(), sets.end(), [&](const EffectSet &a, const EffectSet &b) {
    return a.probability[material] < b.probability[material];
  });
}

} // namespace

std::string case_of(const FilmBank &bank, const Calibration &c, std::size_t of_those) {
  const EffectSet best = most_probable(bank, c, of_those);
  const std::vector<int> &effects = best.effects;
  std::vector<const Draw *> of;
  for (const Draw &d : c.draws)
    if (effects_of(d.materials[of_those]) == effects)
      of.push_back(&d);
  const auto middle = [&](const auto &value) { return middle_of(of, value); };
  CaseLines lines(read_case(bank.spec().case_file, bank.recipe()));
  std::size_t material = 0;
  for (const bank::Input &p : bank.spec().design.inputs)
    if (!p.is_film() && !p.is_effect()) {
      const double value =
          middle([&](const Draw &d) { return d.materials[of_those].parameters[material]; });
      ++material;
      for (const std::string &key : p.keys)
        lines.add(key.substr(5), value);
    }
  std::string of_recipe = nanoporosity_line(bank, of, of_those);
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const Effect effect = find_effect(bank.effects()[std::size_t(effects[k])].name);
    const double value =
        middle([&](const Draw &d) { return key_value(bank, d.materials[of_those].effects[k]); });
    for (const std::string &key : effect.parameter.keys)
      if (effect.in_recipe)
        of_recipe += fmt::format("# In the recipe: {} = {:.4g}\n", key, value);
      else
        lines.add(key, value);
    if (!effect.in_recipe)
      lines.keep(effect.settings);
  }
  for (const inference::Parameter &e : bank.effects()) // of a material that has it on
    if (const Effect &off = find_effect(e.name); !off.in_recipe)
      for (const std::string &key : off.parameter.keys)
        lines.add(key, std::stod(off.parameter.off));
  lines.keep_material();
  std::string out = fmt::format(
      "{}{} ({}, {:.0f} %): the middle of its draws, each\n"
      "# parameter by itself. Put the folder of your electrode here.\nelectrode = \"electrode\"\n",
      kHeadOfCase, of_material(c, of_those), best.name, 100.0 * best.probability[of_those]);
  return out + of_recipe + lines.text();
}

} // namespace calendem
