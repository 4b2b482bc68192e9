// SPDX-License-Identifier: GPL-2.0-or-later
#include "sealed/truths.h"
#include "base/case.h"
#include "base/messages.h"
#include "base/random.h"
#include "diagnose/bank/bank_table.h"
#include "sealed/round_file.h"
#include "sealed/sealing.h"
#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numeric>
#include <set>

namespace calendem {
namespace {

constexpr char kNull[] = "null";

/// 0 to n - 1 (Fisher and Yates).
std::vector<std::size_t> in_random_order(std::size_t n, const std::string &secret,
                                         const std::string &what) {
  std::vector<std::size_t> out(n);
  std::iota(out.begin(), out.end(), 0);
  Random random(derived_seed(secret, what), 0);
  for (std::size_t k = n; k > 1; --k)
    std::swap(out[k - 1], out[std::size_t(random.uniform() * double(k))]);
  return out;
}

/// Draws one truth after the other.
class Drawing {
public:
  Drawing(const Round &round, const std::string &secret)
      : round_(round), random_(derived_seed(secret, "truths"), 0) {
    for (const BankParameter &p : round.bank.parameters)
      strata_.push_back(in_random_order(std::size_t(round.null_packings), secret, p.name));
  }

  /// `turn`: whose turn it is to be given its number of samples.
  Truth truth(const std::string &block, const std::vector<std::string> &names, std::size_t turn,
              double low = 0.0, double high = 1.0) {
    const bool shares = round_.shared_samples && !sets_.empty() && block != kNull;
    Truth t = shares ? sets_[drawn_++ % sets_.size()] : samples_drawn(turn);
    t.block = block;
    for (const std::string &name : names)
      if (name == "noise")
        t.understated = round_.least_understated +
                        random_.uniform() * (round_.most_understated - round_.least_understated);
      else if (name == kNothing)
        continue;
      else if (find_hidden(name))
        t.hidden.push_back(name);
      else
        t.effects.emplace_back(name, value(effect_of(round_.bank, name).parameter, low, high));
    if (shares)
      t.pressure_error *= t.understated;
    else
      t.pressure_error = 0.01 * round_.noise.pressure_percent * t.understated * random_.normal();
    if (block == kNull)
      sets_.push_back(t);
    return t;
  }

  std::vector<unsigned long> packings(int samples) {
    const std::size_t n = std::size_t(round_.repeats) * std::size_t(samples) *
                          (round_.disc_for_each_pressure ? round_.bank.pressures.size() : 1);
    std::vector<unsigned long> out;
    for (std::size_t k = 0; k < n; ++k) // far from the bank's own seeds, which count from 1
      out.push_back(static_cast<unsigned long>(1e6 + 4e9 * 0.99 * random_.uniform()));
    return out;
  }

private:
  const Round &round_;
  Random random_;
  std::vector<Truth> sets_; ///< the nulls
  std::size_t drawn_ = 0;   ///< truths beside them
  std::vector<std::vector<std::size_t>>
      strata_; ///< of each base parameter: a set's part of its prior

  Truth samples_drawn(std::size_t turn) {
    Truth t;
    t.samples = round_.samples[turn % round_.samples.size()];
    t.packings = packings(t.samples);
    for (std::size_t k = 0; k < round_.bank.parameters.size(); ++k) {
      const BankParameter &p = round_.bank.parameters[k];
      double share = random_.uniform();
      if (round_.shared_samples)
        share = (double(strata_[k][sets_.size()]) + share) / double(round_.null_packings);
      t.base.push_back(prior_value(p.low, p.high, p.spread, share));
    }
    return t;
  }

  double value(const EffectParameter &p, double low, double high) {
    return prior_value(p.low, p.high, p.spread, low + (high - low) * random_.uniform());
  }
};

/// Every key that some truth moves, with the value of the bank's recipe and case.
struct Usual {
  std::map<std::string, std::string> values;
  std::map<std::string, std::string> follows; ///< key, the one that it follows unless it is changed
};

/// Keys that the truth changes beyond the bank's own, with their values; all but the packing.
std::map<std::string, std::string> changed_keys(const Round &round, const Truth &t,
                                                const Usual &usual) {
  std::map<std::string, std::string> out = usual.values;
  std::set<std::string> hidden;
  for (std::size_t k = 0; k < round.bank.parameters.size(); ++k)
    for (const std::string &key : round.bank.parameters[k].keys)
      out[key] = fmt::format("{}", t.base[k]);
  for (const auto &[name, value] : t.effects)
    for (const std::string &key : find_effect(name).parameter.keys)
      out[find_effect(name).column(key)] = fmt::format("{}", value);
  for (const std::string &name : t.hidden)
    for (const ChangedKey &c : find_hidden(name)->keys) {
      out[c.key] =
          c.value.empty() ? fmt::format("{:.6g}", c.factor * std::stod(out.at(c.key))) : c.value;
      hidden.insert(c.key);
    }
  for (const auto &[key, other] : usual.follows)
    if (const auto at = out.find(other); at != out.end() && !hidden.count(key))
      out[key] = at->second;
  return out;
}

Usual usual_values(const Round &round, const std::vector<Truth> &truths) {
  const Recipe of_bank = read_recipe(round.bank.recipe_file);
  const Settings &recipe = of_bank.settings;
  const Settings settings = read_case(round.bank.case_file, of_bank);
  Usual out;
  const auto add = [&](const std::string &key) {
    const std::size_t dot = key.find('.') + 1;
    const Settings &of = key[0] == 'r' ? recipe : settings;
    out.values[key] = of.text(key.substr(dot));
    if (const std::string other = of.followed_by(key.substr(dot)); !other.empty())
      out.follows[key] = key.substr(0, dot) + other;
  };
  for (const BankParameter &p : round.bank.parameters)
    std::for_each(p.keys.begin(), p.keys.end(), add);
  for (const Truth &t : truths) {
    for (const auto &effect : t.effects)
      for (const std::string &key : find_effect(effect.first).parameter.keys)
        add(find_effect(effect.first).column(key));
    for (const std::string &name : t.hidden)
      for (const ChangedKey &c : find_hidden(name)->keys)
        add(c.key);
  }
  return out;
}

} // namespace

bool has_cause(const Truth &t) {
  return !t.effects.empty() || std::any_of(t.hidden.begin(), t.hidden.end(), [](const auto &name) {
    return !find_hidden(name)->numerics;
  });
}

Truth without_cause(Truth t) {
  t.effects.clear();
  t.hidden.erase(std::remove_if(t.hidden.begin(), t.hidden.end(),
                                [](const auto &name) { return !find_hidden(name)->numerics; }),
                 t.hidden.end());
  return t;
}

std::optional<Truth> companion(const Round &round, const Truth &truth) {
  std::optional<Truth> out;
  if (truth.block == kIntervention) {
    out = without_cause(truth);
    out->packings = truth.packings_before;
  } else if (round.paired_runs && has_cause(truth)) {
    out = without_cause(truth);
  }
  return out;
}

std::vector<Truth> with_pairs(const Round &round, std::vector<Truth> truths) {
  const std::size_t drawn = truths.size();
  for (std::size_t k = 0; k < drawn; ++k)
    if (const auto other = companion(round, truths[k]))
      truths.push_back(*other);
  return truths;
}

std::string right_answer(const Truth &t, const BankSpec &bank) {
  for (const std::string &name : t.hidden)
    if (!find_hidden(name)->numerics)
      return "unknown";
  std::vector<std::string> names;
  for (const std::string &name : bank.effects)
    for (const auto &effect : t.effects)
      if (effect.first == name)
        names.push_back(name);
  if (names.empty())
    return t.understated > 1.0 ? "noise" : "none";
  return joined(names);
}

std::vector<Truth> draw_truths(const Round &round, const std::string &secret) {
  Drawing drawing(round, secret);
  std::vector<Truth> out;
  for (int k = 0; k < round.null_packings; ++k) {
    out.push_back(drawing.truth(kNull, {}, std::size_t(k)));
    out.back().draws = round.null_draws / round.null_packings +
                       (k < round.null_draws % round.null_packings ? 1 : 0);
  }
  for (std::size_t e = 0; e < round.bank.effects.size(); ++e)
    for (int k = 0; k < round.amplitudes; ++k)
      out.push_back(drawing.truth("single", {round.bank.effects[e]}, e + std::size_t(k),
                                  double(k) / round.amplitudes, double(k + 1) / round.amplitudes));
  const auto add = [&](const char *block, const std::vector<std::vector<std::string>> &list) {
    for (std::size_t k = 0; k < list.size(); ++k)
      out.push_back(drawing.truth(block, list[k], k));
  };
  add("open", round.open);
  add("pair", round.pairs);
  add("fault", round.faults);
  add("other", round.other_numerics);
  add(kIntervention, round.interventions);
  const std::size_t sets = round.shared_samples ? std::size_t(round.null_packings) : out.size();
  const std::vector<std::size_t> order = in_random_order(sets, secret, "sets");
  for (std::size_t k = 0; k < out.size(); ++k) {
    Truth &t = out[k];
    t.set = order[k % sets];
    if (t.block == kIntervention)
      t.packings_before = round.same_specimens_after ? t.packings : drawing.packings(t.samples);
  }
  return out;
}

std::vector<Truth> truths_of_sets(const Round &round, const std::string &secret, int sets) {
  if (!round.shared_samples && sets > 0)
    throw Failure(kBadInput,
                  fmt::format("--sets {} needs a round of shared samples: {} has no sets.", sets,
                              round.file));
  std::vector<Truth> out = draw_truths(round, secret);
  if (!round.shared_samples)
    return out;
  std::stable_sort(out.begin(), out.end(),
                   [](const Truth &a, const Truth &b) { return a.set < b.set; });
  if (sets > 0)
    out.erase(std::remove_if(out.begin(), out.end(),
                             [&](const Truth &t) { return t.set >= std::size_t(sets); }),
              out.end());
  return out;
}

std::size_t runs_of(const Round &round, const Truth &t) {
  return std::size_t(round.repeats) * std::size_t(t.samples) * round.bank.pressures.size();
}

TruthRuns truth_runs(const Round &round, const std::vector<Truth> &truths) {
  TruthRuns out;
  Study &study = out.study;
  study.file = round.file;
  study.name = round.name;
  study.recipe_file = round.bank.recipe_file;
  study.case_file = round.bank.case_file;
  study.keep_all = false;
  const Usual usual = usual_values(round, truths);
  for (const auto &[key, value] : usual.values)
    study.columns.push_back(key);
  study.columns.insert(study.columns.end(), {"recipe.seed", "case.platen.max_pressure_MPa"});
  std::vector<std::vector<std::string>> rows;
  std::map<std::vector<std::string>, std::size_t> known;
  for (const Truth &t : truths) {
    std::vector<std::string> changed;
    for (const auto &[key, value] : changed_keys(round, t, usual))
      changed.push_back(value);
    const std::vector<double> &pressures = round.bank.pressures;
    double offset = 0.0; // that the press shows too much
    for (const std::string &name : t.hidden)
      offset += find_hidden(name)->press.pressure_offset_MPa;
    for (std::size_t k = 0; k < runs_of(round, t); ++k) {
      std::vector<std::string> row = changed;
      row.push_back(
          fmt::format("{}", t.packings[round.disc_for_each_pressure ? k : k / pressures.size()]));
      row.push_back(fmt::format(
          "{:.6g}", pressures[k % pressures.size()] * (1.0 + t.pressure_error) - offset));
      const auto [at, is_new] = known.emplace(row, rows.size());
      out.of_truths.push_back(at->second);
      if (is_new)
        rows.push_back(row);
    }
  }
  Mistakes mistakes(round.file, 20);
  add_runs(study, rows, mistakes);
  mistakes.stop_if_any();
  return out;
}

nlohmann::json to_json(const Truth &t, const BankSpec &bank) {
  nlohmann::json effects = nlohmann::json::object(), base = nlohmann::json::object();
  for (const auto &[name, value] : t.effects)
    effects[name] = value;
  for (std::size_t k = 0; k < bank.parameters.size(); ++k)
    base[bank.parameters[k].name] = t.base[k];
  return {{"block", t.block},
          {"answer", right_answer(t, bank)},
          {"effects", effects},
          {"hidden", t.hidden},
          {"samples", t.samples},
          {"parameters", base},
          {"understated", t.understated},
          {"packing_seeds", t.packings},
          {"packing_seeds_before", t.packings_before},
          {"pressure_error", t.pressure_error}};
}

} // namespace calendem
