// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/changes.h"
#include <algorithm>
#include <map>
#include <numeric>

namespace calendem::inference {
namespace {

using Eigen::Index;

// Two changes exclude each other where their correlation over the draws is below this.
constexpr double kExclusive = -0.2;
// A group grows until it holds this.
constexpr double kWhole = 0.95;

double odds_of(double p) { return p / (1.0 - p); }

Vector any_of(const Changes &c, const std::vector<int> &of) {
  Vector out = Vector::Zero(c.on.rows());
  for (const int k : of)
    out = out.cwiseMax(c.on.col(k));
  return out;
}

double correlation_of(const Vector &a, const Vector &b, const Vector &weights) {
  const double pa = weights.dot(a), pb = weights.dot(b), spread = pa * (1.0 - pa) * pb * (1.0 - pb);
  return spread > 0.0 ? (weights.dot(a.cwiseProduct(b)) - pa * pb) / std::sqrt(spread) : 0.0;
}

bool is_certain(double probability, double bayes_factor) {
  return probability >= kCertain && bayes_factor >= kStrong;
}

/// Places of the changes, the most probable first.
std::vector<int> by_probability(const Changes &c) {
  std::vector<int> out(c.all.size());
  std::iota(out.begin(), out.end(), 0);
  std::stable_sort(out.begin(), out.end(), [&](int a, int b) {
    return c.all[std::size_t(a)].probability > c.all[std::size_t(b)].probability;
  });
  return out;
}

/// A group about the most probable change: others that exclude it and add most.
std::vector<int> exclusive_group(const Changes &c) {
  std::vector<int> out = {by_probability(c).front()};
  for (;;) {
    const Vector any = any_of(c, out);
    double most = c.weights.dot(any);
    int next = -1;
    for (int k = 0; k < int(c.all.size()) && most < kWhole; ++k)
      if (std::find(out.begin(), out.end(), k) == out.end() &&
          correlation_of(any, c.on.col(k), c.weights) < kExclusive)
        if (const double with = c.weights.dot(any.cwiseMax(c.on.col(k))); with > most) {
          most = with;
          next = k;
        }
    if (next < 0)
      return out;
    out.push_back(next);
  }
}

bool is_something_alone(const Changes &c, const std::vector<int> &of) {
  return of.size() == 1 && c.all[std::size_t(of.front())].kind == Change::something;
}

/// Changes that sets have, the most probable first.
std::vector<int> changes_in(const Changes &c, const std::vector<ChangeSet> &sets) {
  std::vector<int> out;
  for (const int k : by_probability(c))
    if (std::any_of(sets.begin(), sets.end(), [&](const ChangeSet &s) {
          return std::find(s.changes.begin(), s.changes.end(), k) != s.changes.end();
        }))
      out.push_back(k);
  return out;
}

/// Places of the changes that the data speak for.
std::vector<int> spoken_for(const Changes &c) {
  std::vector<int> out;
  for (int k = 0; k < int(c.all.size()); ++k)
    if (c.all[std::size_t(k)].bayes_factor > 1.0)
      out.push_back(k);
  return out;
}

std::vector<int> set_of_draw(const Changes &c, const std::vector<int> &of, Index draw) {
  std::vector<int> out;
  for (const int k : of)
    if (c.on(draw, k) > 0.0)
      out.push_back(k);
  return out;
}

} // namespace

double Changes::probability(const std::vector<int> &of) const {
  return weights.dot(any_of(*this, of));
}

double Changes::bayes_factor(const std::vector<int> &of) const {
  double none = 1.0;
  for (const int k : of)
    none *= 1.0 - all[std::size_t(k)].prior;
  const double least = 0.5 / double(on.rows());
  return odds_of(std::clamp(probability(of), least, 1.0 - least)) / odds_of(1.0 - none);
}

Changes changes_of(const PosteriorProblem &problem, const Posterior &posterior, int film,
                   double shows) {
  const int material = problem.films[std::size_t(film)].material;
  Changes out;
  for (int e = 0; e < int(problem.effects.size()); ++e) {
    const EffectPrior &prior = problem.effects[std::size_t(e)];
    if (prior.probability <= 0.0 || prior.probability >= 1.0)
      continue;
    const bool has = is_of_model(prior);
    out.all.push_back({has             ? Change::absent
                       : prior.of_film ? Change::fault
                                       : Change::added,
                       e, has ? 1.0 - prior.probability : prior.probability});
  }
  if (problem.understated > 0.0)
    out.all.push_back({Change::understated, -1, problem.understated});
  if (problem.films[std::size_t(film)].discrepancy.size() > 0)
    out.all.push_back({Change::something, -1, 0.5 * (1.0 - problem.discrepancy.scaled(shows))});
  const auto draws = Index(posterior.draws.size());
  out.on.resize(draws, Index(out.all.size()));
  out.weights.resize(draws);
  for (Index d = 0; d < draws; ++d) {
    const Draw &draw = posterior.draws[std::size_t(d)];
    out.weights[d] = draw.weight;
    for (std::size_t k = 0; k < out.all.size(); ++k) {
      const Change &change = out.all[k];
      const bool is =
          change.kind == Change::something     ? draw.discrepancy > shows
          : change.kind == Change::understated ? draw.understatement[film] > 1.0
          : change.kind == Change::fault
              ? acts(draw.faults(change.effect, film))
              : acts(draw.amplitudes(change.effect, material)) == (change.kind == Change::added);
      out.on(d, Index(k)) = is;
    }
  }
  for (int k = 0; k < int(out.all.size()); ++k) {
    out.all[std::size_t(k)].probability = out.probability({k});
    out.all[std::size_t(k)].bayes_factor = out.bayes_factor({k});
  }
  return out;
}

std::vector<ChangeSet> ranked_sets(const Changes &c, double share) {
  const std::vector<int> of = spoken_for(c);
  std::map<std::vector<int>, double> sets;
  for (Index d = 0; d < c.on.rows(); ++d)
    sets[set_of_draw(c, of, d)] += c.weights[d];
  std::vector<ChangeSet> all;
  for (const auto &[set, probability] : sets)
    all.push_back({set, probability});
  std::stable_sort(all.begin(), all.end(), [](const ChangeSet &a, const ChangeSet &b) {
    return a.probability > b.probability;
  });
  double sum = 0.0;
  std::size_t count = 0;
  while (count < all.size() && sum < share)
    sum += all[count++].probability;
  all.resize(count);
  return all;
}

std::vector<int> sets_of_draws(const Changes &c, const std::vector<ChangeSet> &sets) {
  const std::vector<int> of = spoken_for(c);
  std::vector<int> out;
  for (Index d = 0; d < c.on.rows(); ++d) {
    const std::vector<int> set = set_of_draw(c, of, d);
    const auto at = std::find_if(sets.begin(), sets.end(),
                                 [&](const ChangeSet &s) { return s.changes == set; });
    out.push_back(int(at - sets.begin()));
  }
  return out;
}

Verdict verdict_of(const Changes &c, double adequacy, bool significant) {
  Verdict out;
  if (c.all.empty())
    return out;
  for (const int k : by_probability(c))
    if (const Change &change = c.all[std::size_t(k)];
        is_certain(change.probability, change.bayes_factor)) {
      out.changes.push_back(k);
      out.probability = change.probability;
    }
  std::vector<int> every(c.all.size());
  std::iota(every.begin(), every.end(), 0);
  if (!out.changes.empty())
    out.kind = Verdict::explained;
  else if (const std::vector<int> group = exclusive_group(c);
           is_certain(c.probability(group), c.bayes_factor(group))) {
    out.kind = Verdict::one_of;
    out.changes = group;
  } else if (significant || c.bayes_factor(every) >= kMention) {
    out.kind = Verdict::one_of;
    out.changes = changes_in(c, ranked_sets(c));
  }
  if (adequacy < kFits || is_something_alone(c, out.changes))
    out.kind = Verdict::something_else;
  if (out.kind != Verdict::explained)
    out.probability = c.probability(out.changes);
  return out;
}

double adequacy_of(const PosteriorProblem &problem, const Posterior &posterior) {
  const auto states = film_states(problem, posterior.draws);
  std::vector<int> films(problem.films.size());
  std::iota(films.begin(), films.end(), 0);
  double out = 0.0;
  for (std::size_t d = 0; d < posterior.draws.size(); ++d) {
    const Residuals data = residuals_of(problem, films, states[d], posterior.draws[d]);
    const double square = Cholesky(data.covariance).matrixL().solve(data.residual).squaredNorm();
    out += posterior.draws[d].weight *
           chance_beyond(square, int(data.residual.size()), problem.degrees_of_freedom);
  }
  return out;
}

} // namespace calendem::inference
