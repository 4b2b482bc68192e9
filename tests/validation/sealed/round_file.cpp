// SPDX-License-Identifier: GPL-2.0-or-later
#include "sealed/round_file.h"
#include "base/table_reader.h"
#include "base/toml_reader.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem {

namespace {

const char *const kPlus = " + ";
const char *const kOne = "one for all pressures", *const kEach = "one for each pressure";
const char *const kOther = "other specimens", *const kSame = "the same specimens";

class Reader : TableReader {
public:
  using TableReader::TableReader;

  void read_head(const toml::table &t, Round &out) {
    report_unknown(t, {"name", "bank", "null_packings", "null_draws", "amplitudes", "samples",
                       "specimens", "shared_samples", "paired_runs", "open", "pairs", "faults",
                       "other_numerics", "interventions", "interventions_on", "repeats"});
    out.name = text(t, {"name", "", "withheld", 0, 0, "", "for reports", "", true});
    if (const std::string bank = path(t, {"bank", "", "", 0, 0, "", "bank (TOML)", "", true});
        !bank.empty())
      out.bank = read_bank_spec(bank);
    const auto whole = [&](const char *name, const char *fallback, double most) {
      return int(number(t, {name, "", fallback, 0, most, "", "number of", "", false, true}));
    };
    out.null_packings = whole("null_packings", "12", 1000);
    out.null_draws = whole("null_draws", "100", 100000);
    out.amplitudes = whole("amplitudes", "3", 100);
    read_samples(t, out.samples);
    out.repeats = int(number(t, {"repeats", "", "1", 1, 100, "", "specimens", "", false, true}));
    out.disc_for_each_pressure = text(t, {"specimens", "", kOne, 0, 0, "", "that are pressed",
                                          std::string(kOne) + "|" + kEach}) == kEach;
    out.paired_runs = text(t, {"paired_runs", "", "no", 0, 0, "",
                               "truths run without their effects too", "no|yes"}) == "yes";
    out.shared_samples =
        text(t, {"shared_samples", "", "no", 0, 0, "",
                 "truths with a cause on the samples of the nulls", "no|yes"}) == "yes";
    if (out.shared_samples && out.null_packings == 0)
      mistakes_.add(line_of(t), "shared_samples: null_packings is 0, but the samples are those of "
                                "the nulls. Give at least 1.");
    if (out.null_draws < out.null_packings)
      mistakes_.add(line_of(t), fmt::format("null_draws is {}, null_packings {}: every packing "
                                            "needs a draw.",
                                            out.null_draws, out.null_packings));
    out.open = lists(t, "open", out.bank, "noise");
    out.pairs = lists(t, "pairs", out.bank, "noise");
    out.faults = lists(t, "faults", out.bank, "noise");
    out.other_numerics = lists(t, "other_numerics", out.bank, "noise");
    out.interventions = lists(t, "interventions", out.bank, kNothing);
    out.same_specimens_after =
        text(t, {"interventions_on", "", kOther, 0, 0, "", "that are pressed after the change",
                 std::string(kOther) + "|" + kSame}) == kSame;
  }

  void read_noise(const toml::table &t, Round &round) {
    MeasurementNoise &out = round.noise;
    report_unknown(t, {"pressure_percent", "displacement_um", "thickness_um", "porosity_percent",
                       "cracked_fraction", "understated_by"});
    // at least what the file can write: a value without error is no measurement
    out.pressure_percent = number(t, {"pressure_percent", "", "1", 0.01, 20, "%", "sd"});
    out.displacement_um = number(t, {"displacement_um", "", "0.02", 1e-4, 10, "um", "sd"});
    out.thickness_um = number(t, {"thickness_um", "", "0.05", 1e-4, 10, "um", "sd"});
    out.porosity_percent = number(t, {"porosity_percent", "", "0.3", 1e-3, 10, "%", "sd"});
    out.cracked_fraction = number(t, {"cracked_fraction", "", "0.03", 1e-4, 1, "", "sd"});
    const auto factors = numbers(t, {"understated_by", "", "-", 1, 20, "", "least and most"});
    if (factors.empty())
      return;
    if (factors.size() != 2 || factors[0] > factors[1])
      return mistakes_.add(line_of(*t.get("understated_by")),
                           "understated_by must be [least, most].");
    round.least_understated = factors[0];
    round.most_understated = factors[1];
  }

private:
  void read_samples(const toml::table &t, std::vector<int> &out) {
    const Key key = {"samples", "", "1", 1, 1000, "", "number of", "", false, true};
    if (!t.contains("samples") || !t.get("samples")->is_array()) {
      out = {int(number(t, key))};
      return;
    }
    out.clear();
    for (const double n : numbers(t, key))
      out.push_back(int(n));
    if (out.empty())
      mistakes_.add(line_of(*t.get("samples")),
                    "samples is an empty list; give a number or [2, 10].");
  }

  std::vector<std::vector<std::string>> lists(const toml::table &t, const char *key,
                                              const BankSpec &bank, const char *special) {
    std::vector<std::string> known = bank.effects;
    for (const HiddenChange &c : hidden_changes())
      known.push_back(c.name);
    known.push_back(special);
    std::vector<std::vector<std::string>> out;
    for (const std::string &text : texts(t, key)) {
      out.push_back(names_in(text));
      for (const std::string &name : out.back())
        if (std::find(known.begin(), known.end(), name) == known.end())
          mistakes_.add(line_of(*t.get(key)),
                        fmt::format("{}: '{}' is no effect of the bank, no hidden change and not "
                                    "{}. Did you mean '{}'?",
                                    key, name, special, closest(name, known)));
    }
    return out;
  }
};

} // namespace

std::vector<std::string> names_in(const std::string &text) {
  std::vector<std::string> out;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(kPlus, from), text.size());
    out.push_back(text.substr(from, to - from));
    from = to + 3;
  }
  return out;
}

std::string joined(const std::vector<std::string> &names) {
  return fmt::format("{}", fmt::join(names, kPlus));
}

Round read_round(const std::string &file) {
  Mistakes mistakes(file, 20);
  Round out;
  out.file = file;
  const TomlFile parsed = parse_toml(file, mistakes);
  Reader reader(file, parsed.whole, mistakes);
  for (const auto &[key, node] : parsed.root)
    if (key.str() == "round" && node.is_table())
      reader.read_head(*node.as_table(), out);
    else if (key.str() == "noise" && node.is_table())
      reader.read_noise(*node.as_table(), out);
    else
      mistakes.add(line_of(node), fmt::format("unknown '{}'; a round has tables [round] and "
                                              "[noise].",
                                              key.str()));
  if (parsed.whole && !parsed.root.contains("round"))
    mistakes.add(0, "has no table [round].");
  mistakes.stop_if_any();
  return out;
}

} // namespace calendem
