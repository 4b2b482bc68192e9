// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/bank.h"
#include "base/messages.h"
#include <algorithm>
#include <fmt/format.h>

namespace calendem::inference {

namespace {

const ModelledEffect *effect_named(const Bank &bank, const std::string &name) {
  for (const ModelledEffect &e : bank.effects)
    if (e.name == name)
      return &e;
  return nullptr;
}

void check_run(const Bank &bank, int number, const std::vector<bool> &may_lack,
               Mistakes &mistakes) {
  const BankRun &r = bank.runs[number];
  const ModelledEffect *effect = effect_named(bank, r.effect);
  const auto add = [&](const std::string &text) {
    mistakes.add(0, fmt::format("run {}: {}", number + 1, text));
  };
  if (!r.effect.empty() && !effect)
    return add(fmt::format("effect '{}' is not in the table of effects", r.effect));
  if (r.base.size() != Eigen::Index(bank.base.size()) ||
      r.values.size() != Eigen::Index(bank.observables.size()) ||
      r.amplitudes.size() != Eigen::Index(effect ? effect->parameters.size() : 0))
    return add(fmt::format("{} base parameters, {} amplitudes, {} observables; {}, {}, {} are due",
                           r.base.size(), r.amplitudes.size(), r.values.size(), bank.base.size(),
                           effect ? effect->parameters.size() : 0, bank.observables.size()));
  if (!r.base.allFinite() || !r.amplitudes.allFinite())
    add("a parameter is not a number");
  for (Eigen::Index i = 0; i < r.values.size(); ++i)
    if (!std::isfinite(r.values[i]) && !may_lack[std::size_t(i)])
      return add(key_of(bank.observables[i]) + " is not a number; leave the run out, or the "
                                               "observable in all runs and the experiment");
}

} // namespace

std::vector<std::pair<int, int>> pairs_of(const Bank &bank, const std::string &effect) {
  std::vector<std::pair<int, int>> pairs;
  for (int on = 0; on < int(bank.runs.size()); ++on) {
    if (bank.runs[on].effect != effect)
      continue;
    for (int off = 0; off < int(bank.runs.size()); ++off)
      if (bank.runs[off].effect.empty() && bank.runs[off].packing == bank.runs[on].packing &&
          bank.runs[off].base == bank.runs[on].base) {
        pairs.emplace_back(off, on);
        break;
      }
  }
  return pairs;
}

std::vector<int> runs_that_have(const Bank &bank, const std::vector<int> &observables) {
  std::vector<bool> has;
  for (const BankRun &run : bank.runs)
    has.push_back(run.values(observables).allFinite());
  for (const ModelledEffect &e : bank.effects)
    for (const auto &[off, on] : pairs_of(bank, e.name))
      has[std::size_t(on)] = has[std::size_t(on)] && has[std::size_t(off)];
  std::vector<int> out;
  for (std::size_t k = 0; k < has.size(); ++k)
    if (has[k])
      out.push_back(int(k));
  return out;
}

void check(const Bank &bank, const std::vector<int> &may_lack) {
  std::vector<bool> lacks(bank.observables.size(), false);
  for (const int k : may_lack)
    lacks[std::size_t(k)] = true;
  for (const Parameter &p : bank.base)
    check(p);
  Mistakes mistakes("bank of simulations", 10);
  for (const ModelledEffect &e : bank.effects) {
    bool amplitude = false;
    for (const Parameter &p : e.parameters) {
      check(p);
      amplitude |= p.amplitude;
    }
    if (!amplitude)
      mistakes.add(0, fmt::format("effect '{}' has no amplitude that switches it off", e.name));
  }
  for (int i = 0; i < int(bank.runs.size()); ++i)
    check_run(bank, i, lacks, mistakes);
  mistakes.stop_if_any();
  const auto count = [&](const std::string &effect) {
    return int(std::count_if(bank.runs.begin(), bank.runs.end(),
                             [&](const BankRun &r) { return r.effect == effect; }));
  };
  const int fewest = int(bank.base.size()) + kFewestRuns;
  if (count("") < fewest)
    mistakes.add(0, fmt::format("{} runs of the base model; at least {} for {} parameters",
                                count(""), fewest, bank.base.size()));
  for (const ModelledEffect &e : bank.effects) {
    const int pairs = int(pairs_of(bank, e.name).size());
    if (pairs < count(e.name))
      mistakes.add(0, fmt::format("effect '{}': {} of its {} runs have no base run of the same "
                                  "parameters and packing",
                                  e.name, count(e.name) - pairs, count(e.name)));
    if (pairs < kFewestRuns)
      mistakes.add(
          0, fmt::format("effect '{}': {} paired runs; at least {}", e.name, pairs, kFewestRuns));
  }
  mistakes.stop_if_any();
}

} // namespace calendem::inference
