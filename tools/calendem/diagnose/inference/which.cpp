// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/which.h"
#include "base/messages.h"
#include "base/random.h"
#include "diagnose/inference/base_beside_unknown.h"
#include "diagnose/inference/confounding.h"
#include "diagnose/inference/pairs.h"
#include "diagnose/inference/scatter.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem::inference {

namespace {

constexpr std::uint64_t kOfPlaces = 0xba5e; // of the stream of base parameters beside the unknown

Judged judge(const Problem &problem, const Hypothesis &hypothesis, const Matrix &unknown,
             const WhichSettings &settings) {
  Judged j;
  j.hypothesis = hypothesis;
  const Likelihood likelihood(problem, hypothesis, unknown);
  j.evidence = evidence(likelihood, settings.evidence);
  if (hypothesis.kind == Hypothesis::none || hypothesis.kind == Hypothesis::effects) {
    const auto deviance = [&](const Vector &s, Vector &gradient) {
      const double of_data = likelihood.deviance(s, gradient);
      gradient += 2.0 * s;
      return of_data + s.squaredNorm();
    };
    const Vector best = minimise(deviance, j.evidence.mode).at;
    Vector unused(best.size());
    j.adequacy_p = chance_beyond(likelihood.square(best, unused) + best.squaredNorm(),
                                 int(problem.observed.size()), problem.degrees_of_freedom);
  }
  return j;
}

/// One place of the unknown, as far as it counts.
struct Term {
  std::string place;
  double log_mass = 0.0; ///< ln of its share of the prior times its evidence
  Judged judged;
  Matrix anywhere;
};

/// Draws of the base parameters over all places, each as often as it is probable.
Matrix over_places(const Problem &problem, const std::vector<Term> &terms,
                   const std::map<std::string, double> &of_place) {
  const Eigen::Index count = terms.front().judged.evidence.draws.cols();
  Matrix out(problem.base_parameters, count);
  Random random(0, kOfPlaces);
  double passed = 0.0;
  Eigen::Index next = 0;
  for (const Term &t : terms) {
    passed += of_place.at(t.place);
    const Eigen::Index end =
        &t == &terms.back() ? count
                            : std::min(count, Eigen::Index(std::lround(passed * double(count))));
    if (end > next && t.place == kUnseenPlace)
      out.middleCols(next, end - next) =
          spread_over(t.judged.evidence.draws, end - next, random).topRows(problem.base_parameters);
    else if (end > next)
      out.middleCols(next, end - next) =
          base_beside_unknown(problem, t.judged, t.anywhere, end - next, random);
    next = std::max(next, end);
  }
  return out;
}

/// The unknown with its evidence averaged over places; parameters of effects are those of the best
/// place.
Judged judge_unknown(const Problem &problem, const WhichSettings &settings,
                     const std::vector<int> &best_effects, Which &w) {
  Judged best;
  double sum = 0.0, top = -INFINITY;
  std::vector<Term> terms;
  for (const UnknownPlace &place : unknown_places(problem, w, best_effects, settings.priors)) {
    const bool unseen = place.name == kUnseenPlace;
    Judged here = unseen ? w.of("none") : judge(problem, place.hypothesis, place.unknown, settings);
    here.hypothesis = place.hypothesis;
    here.place = place.name;
    const double mass = std::log(place.share) + here.evidence.log_evidence;
    terms.push_back({place.name, mass, here, place.anywhere});
    if (unseen || !(mass > top))
      continue;
    top = mass;
    best = std::move(here);
    w.unknown = place.unknown;
  }
  for (const Term &t : terms)
    sum += std::exp(t.log_mass - top);
  for (const Term &t : terms)
    best.of_place[t.place] += std::exp(t.log_mass - top) / sum;
  best.below_limits = best.of_place[kUnseenPlace]; // more of it once limits are known
  best.base_draws = over_places(problem, terms, best.of_place);
  const double shift = top + std::log(sum) - best.evidence.log_evidence;
  best.evidence.log_evidence += shift;
  best.evidence.laplace += shift;
  return best;
}

/// Effects by the evidence for them, the best first; none if the base model beats them all.
std::vector<int> ranked_effects(const Which &so_far) {
  std::vector<std::pair<double, int>> singles;
  for (const Judged &j : so_far.judged)
    if (j.hypothesis.single())
      singles.emplace_back(-j.evidence.log_evidence, j.hypothesis.on[0]);
  std::sort(singles.begin(), singles.end());
  std::vector<int> out;
  if (!singles.empty() && -singles[0].first >= so_far.of("none").evidence.log_evidence)
    for (const auto &[cost, effect] : singles)
      out.push_back(effect);
  return out;
}

/// Evidence of those pairs that have none yet: of one effect with every other where it is given
/// (otherwise -1), and of the most promising.
void judge_pairs(const Problem &problem, const std::vector<Promise> &pairs, int with, int promising,
                 const WhichSettings &settings, Which &w) {
  int rank = 0;
  for (const Promise &p : pairs) {
    const bool wanted = rank++ < promising || p.pair.on[0] == with || p.pair.on[1] == with;
    const bool known = std::any_of(w.judged.begin(), w.judged.end(), [&](const Judged &j) {
      return j.hypothesis.name == p.pair.name;
    });
    if (wanted && !known)
      w.judged.push_back(judge(problem, p.pair, Matrix(), settings));
  }
}

} // namespace

const Judged &Which::of(const std::string &name) const {
  for (const Judged &j : judged)
    if (j.hypothesis.name == name)
      return j;
  throw Failure(kBadInput, fmt::format("no hypothesis '{}' was computed", name));
}

Which which(const Problem &problem, const WhichSettings &settings) {
  Which w;
  const Matrix nothing;
  const auto effects = int(problem.effects.size());
  w.judged.push_back(judge(problem, {Hypothesis::none, {}, "none", 0.0}, nothing, settings));
  w.judged[0].below_limits = 1.0;
  w.base = linearise(problem, w.judged[0].evidence.mode);
  if (settings.noise)
    w.judged.push_back(judge(problem, {Hypothesis::noise, {}, "noise", 0.0}, nothing, settings));
  for (int e = 0; e < effects; ++e)
    w.judged.push_back(judge(problem, {Hypothesis::effects, {e}, problem.effects[e].name, 0.0},
                             nothing, settings));
  std::vector<int> ranked = ranked_effects(w);
  const std::vector<Promise> pairs =
      settings.pairs > 0 ? promising_pairs(problem, w) : std::vector<Promise>();
  judge_pairs(problem, pairs, ranked.empty() ? -1 : ranked[0], settings.pairs, settings, w);
  ranked.resize(std::min(ranked.size(), std::size_t(settings.beside)));
  const auto finish = [&] {
    w.judged.push_back(judge_unknown(problem, settings, ranked, w));
    decide(w, settings, effects);
  };
  finish();
  const std::size_t so_far = w.judged.size();
  for (int e = 0; e < effects; ++e) // what may act beside it
    if (problem.effects[std::size_t(e)].name == w.claim)
      judge_pairs(problem, pairs, e, 0, settings, w);
  if (w.judged.size() > so_far) {
    w.judged.erase(std::find_if(w.judged.begin(), w.judged.end(), [](const Judged &j) {
      return j.hypothesis.kind == Hypothesis::unknown;
    }));
    finish();
  }
  return w;
}

namespace {

constexpr int kDraws = 60;                    // of a posterior, for the moments of what it predicts
constexpr std::uint64_t kDataStream = 0x4e87; // of the stream of simulated data

/// What a hypothesis expects of the new features, given the old.
struct Forecast {
  double probability = 0.0;
  Vector mean;
  Cholesky covariance;
  double log_determinant = 0.0;
};

/// The hypotheses that count, their probabilities made to sum to 1.
std::vector<const Judged *> leading(const Which &which, const NextSettings &settings) {
  std::vector<const Judged *> some;
  double sum = 0.0;
  for (const Judged &j : which.judged)
    if (int(some.size()) < settings.leading && sum < settings.covered) {
      some.push_back(&j);
      sum += j.probability;
    }
  return some;
}

/// The unknown has no idea of new features beyond their own discrepancy.
Matrix extended_unknown(const Which &which, const Problem &extended) {
  Matrix all = extended.discrepancy;
  const auto old = which.unknown.rows();
  all.topLeftCorner(old, old) = which.unknown;
  all.topRightCorner(old, all.cols() - old).setZero();
  all.bottomLeftCorner(all.rows() - old, old).setZero();
  return all;
}

Forecast forecast(const Judged &judged, const Problem &p, const Matrix &unknown) {
  const Likelihood likelihood(p, judged.hypothesis, unknown);
  const auto old = p.observed.size(), added = Eigen::Index(p.features.size()) - old;
  const Matrix &draws = judged.evidence.draws;
  const int n = std::min(kDraws, int(draws.cols()));
  Matrix means(added, n), rest = Matrix::Zero(added, added);
  for (int k = 0; k < n; ++k) {
    const Vector scores = draws.col(k * draws.cols() / n);
    const Prediction at = likelihood.predict(scores);
    const Matrix c = likelihood.covariance(scores, at);
    const Matrix gain =
        Cholesky(c.topLeftCorner(old, old)).solve(c.topRightCorner(old, added)).transpose();
    means.col(k) = at.mean.tail(added) + gain * (p.observed - at.mean.head(old));
    rest += (c.bottomRightCorner(added, added) - gain * c.topRightCorner(old, added)) / n;
  }
  Forecast f;
  f.probability = judged.probability;
  f.mean = means.rowwise().mean();
  const Matrix apart = means.colwise() - f.mean;
  f.covariance = Cholesky(rest + apart * apart.transpose() / std::max(1, n - 1));
  const Matrix lower = f.covariance.matrixL();
  f.log_determinant = 2.0 * lower.diagonal().array().log().sum();
  return f;
}

/// Mean over simulated data of the probability that the hypothesis they come from is given.
double expected(const std::vector<Forecast> &forecasts, const NextSettings &settings) {
  Random random(settings.seed, kDataStream);
  const auto n = forecasts.front().mean.size();
  double sum = 0.0;
  Vector normal(n);
  for (const Forecast &truth : forecasts)
    for (int k = 0; k < settings.simulations; ++k) {
      for (double &v : normal)
        v = random.normal();
      const Vector data = truth.mean + truth.covariance.matrixL() * normal;
      double all = 0.0, own = 0.0;
      for (const Forecast &f : forecasts) {
        const double square = f.covariance.matrixL().solve(data - f.mean).squaredNorm();
        const double p =
            f.probability * std::exp(log_student_t(square, f.log_determinant, int(n), kNormal) +
                                     0.5 * truth.log_determinant);
        all += p;
        own += &f == &truth ? p : 0.0;
      }
      sum += truth.probability * (all > 0.0 ? own / all : 0.0) / settings.simulations;
    }
  return sum;
}

} // namespace

std::vector<NextMeasurement> next_measurements(const Which &which,
                                               const std::vector<Extension> &candidates,
                                               const NextSettings &settings) {
  const auto some = leading(which, settings);
  double sum = 0.0, now = 0.0;
  for (const Judged *j : some)
    sum += j->probability;
  for (const Judged *j : some)
    now += j->probability * j->probability / (sum * sum);
  std::vector<NextMeasurement> list;
  for (const Extension &candidate : candidates) {
    const Matrix unknown = extended_unknown(which, candidate.extended);
    std::vector<Forecast> forecasts;
    for (const Judged *j : some) {
      forecasts.push_back(forecast(*j, candidate.extended, unknown));
      forecasts.back().probability /= sum;
    }
    NextMeasurement next{candidate.what, candidate.cost, now, expected(forecasts, settings), 0.0};
    next.per_cost = next.cost > 0.0 ? (next.expected_probability - now) / next.cost : 0.0;
    list.push_back(next);
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const NextMeasurement &a, const NextMeasurement &b) {
                     return a.expected_probability > b.expected_probability;
                   });
  return list;
}

} // namespace calendem::inference
