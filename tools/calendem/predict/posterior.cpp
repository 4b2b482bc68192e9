// SPDX-License-Identifier: GPL-2.0-or-later
#include "predict/calibration.h"
#include <algorithm>
#include <map>
#include <numeric>

namespace calendem {

std::string name_of(const FilmBank &bank, const std::vector<int> &effects) {
  std::string out;
  for (const int effect : effects)
    out += (out.empty() ? "" : " + ") + bank.effects()[std::size_t(effect)].name;
  return out.empty() ? "none" : out;
}

std::vector<int> effects_of(const Material &material) {
  std::vector<int> out;
  for (const ActiveEffect &a : material.effects)
    out.push_back(a.effect);
  return out;
}

std::vector<EffectSet> effect_sets_of(const FilmBank &bank, const Calibration &c) {
  std::map<std::vector<int>, std::vector<double>> found;
  for (const Draw &draw : c.draws)
    for (std::size_t m = 0; m < c.materials.size(); ++m) {
      auto &probability = found[effects_of(draw.materials[m])];
      probability.resize(c.materials.size());
      probability[m] += 1.0 / double(c.draws.size());
    }
  std::vector<EffectSet> out;
  for (const auto &[effects, probability] : found)
    out.push_back({name_of(bank, effects), effects, probability});
  const auto most = [](const EffectSet &set) {
    return *std::max_element(set.probability.begin(), set.probability.end());
  };
  std::stable_sort(out.begin(), out.end(), [&](const EffectSet &a, const EffectSet &b) {
    return most(a) > most(b);
  });
  return out;
}

double acting(const Calibration &c, int effect, std::size_t material) {
  double sum = 0.0;
  for (const Draw &draw : c.draws) {
    const std::vector<int> on = effects_of(draw.materials[material]);
    sum += double(std::count(on.begin(), on.end(), effect));
  }
  return sum / double(c.draws.size());
}

std::vector<std::size_t> resampled(const std::vector<double> &weights, int count) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<std::size_t> out;
  double passed = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    passed += weights[k] / sum * count;
    while (double(out.size()) + 0.5 < passed && int(out.size()) < count)
      out.push_back(k);
  }
  return out;
}

} // namespace calendem
