// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/effects.h"
#include "base/key.h"
#include "base/messages.h"
#include "base/recipe.h"
#include "registry/settings.h"
#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace calendem {

const Effect &find_effect(const std::string &name) {
  const auto at = std::find_if(effects().begin(), effects().end(),
                               [&](const Effect &e) { return e.name == name; });
  if (at != effects().end())
    return *at;
  std::vector<std::string> names;
  for (const Effect &e : effects())
    names.push_back(e.name);
  throw Failure(kBadInput, fmt::format("there is no effect '{}'. Did you mean '{}'? Known are {}.",
                                       name, closest(name, names), fmt::join(names, ", ")));
}

const Key &key_of(const Effect &e) {
  const std::vector<Key> &keys = e.in_recipe ? recipe_keys() : case_keys();
  return *std::find_if(keys.begin(), keys.end(),
                       [&](const Key &k) { return k.name == e.parameter.keys.front(); });
}

std::string folder_of_tests(const Effect &e) {
  const bool bare = e.verification.find('/') == std::string::npos;
  return (bare ? "verification/" : "") + e.verification;
}

nlohmann::json to_json(const Effect &e) {
  const EffectParameter &a = e.parameter;
  return {{"name", e.name},
          {"layer", e.layer},
          {"what", e.what},
          {"keys", a.keys},
          {"keys_of", e.in_recipe ? "recipe" : "case"},
          {"off", a.off},
          {"low", a.low},
          {"high", a.high},
          {"prior", a.spread == Spread::Uniform ? "uniform" : "log-uniform"},
          {"stronger_when", a.scale == AmplitudeScale::Reciprocal ? "smaller" : "larger"},
          {"simulated", !e.instrument},
          {"moves", e.moves},
          {"source", e.source},
          {"law", "src_plugin/physics/" + e.law},
          {"verification", e.verification}};
}

} // namespace calendem
