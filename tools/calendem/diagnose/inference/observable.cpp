// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/observable.h"
#include "base/messages.h"
#include <fmt/format.h>
#include <map>

namespace calendem::inference {

std::string key_of(const ObservableId &o) {
  return fmt::format("{}|{}|{}|{:.6g}", o.name, o.stage, o.condition, o.coordinate);
}

std::vector<Block> blocks_of(const std::vector<ObservableId> &all) {
  std::vector<Block> blocks;
  for (int i = 0; i < int(all.size()); ++i) {
    const ObservableId &o = all[i];
    auto at = blocks.begin();
    while (at != blocks.end() &&
           !(at->name == o.name && at->stage == o.stage && at->condition == o.condition))
      ++at;
    if (at == blocks.end())
      at = blocks.insert(at, {o.name, o.stage, o.condition, {}});
    at->members.push_back(i);
  }
  return blocks;
}

std::vector<int> places_in(const std::vector<ObservableId> &all,
                           const std::vector<ObservableId> &wanted) {
  std::map<std::string, int> place;
  for (int i = 0; i < int(all.size()); ++i)
    place.emplace(key_of(all[i]), i);
  std::vector<int> places;
  std::string missing;
  for (const ObservableId &o : wanted) {
    const auto at = place.find(key_of(o));
    if (at == place.end())
      missing += "\n  " + key_of(o);
    else
      places.push_back(at->second);
  }
  if (!missing.empty())
    throw Failure(kBadInput, "the bank of simulations lacks observables of the experiment. Make "
                             "it again with them, or leave them out:" +
                                 missing);
  return places;
}

void check(const ObservableVector &e) {
  const auto n = Eigen::Index(e.of.size());
  if (n == 0 || e.values.size() != n || e.covariance.rows() != n || e.covariance.cols() != n)
    throw Failure(kBadInput,
                  fmt::format("{} observables with {} values and a covariance of {} x {}: give at "
                              "least one, and as many values and rows",
                              n, e.values.size(), e.covariance.rows(), e.covariance.cols()));
  for (Eigen::Index i = 0; i < n; ++i)
    if (!std::isfinite(e.values[i]) || !(e.covariance(i, i) > 0.0))
      throw Failure(kBadInput, fmt::format("{}: value {:g}, variance {:g}; a number and a variance "
                                           "above 0 are needed. Leave out what was not measured",
                                           key_of(e.of[i]), e.values[i], e.covariance(i, i)));
  const bool symmetric = e.covariance.isApprox(e.covariance.transpose(), 1e-10);
  if (!symmetric || Cholesky(e.covariance).info() != Eigen::Success)
    throw Failure(kBadInput, "the covariance of the measurement is not symmetric and positive "
                             "definite: no correlation may reach 1");
}

} // namespace calendem::inference
