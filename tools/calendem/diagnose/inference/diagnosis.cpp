// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/diagnosis.h"
#include "diagnose/inference/hypothesis.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem::inference {

namespace {

std::vector<BlockResidual> residuals_of(const Model &model, const Vector &values,
                                        const Vector &predicted) {
  const Vector off = model.map().observables_of(predicted) - values;
  std::vector<BlockResidual> list;
  for (const Block &b : model.map().blocks()) {
    const Vector here = off(b.members), sd = model.sd()(b.members);
    Eigen::Index worst = 0;
    here.cwiseQuotient(sd).cwiseAbs().maxCoeff(&worst);
    const double n = double(here.size());
    list.push_back({std::copysign(here.norm() / std::sqrt(n), here.sum()), sd.norm() / std::sqrt(n),
                    model.observables()[b.members[worst]].coordinate});
  }
  return list;
}

/// With scores that count from the prior, where the problem's do not.
Which in_scores_of_the_prior(const Problem &problem, const Which &which) {
  Which out = which;
  if (!problem.scores_of_the_prior)
    return out;
  const Eigen::Index n = problem.base_parameters;
  for (Judged &j : out.judged) {
    Evidence &e = j.evidence;
    if (e.mode.size() < n)
      continue;
    e.mode.head(n) = problem.scores_of_the_prior(e.mode.head(n));
    for (Matrix *draws : {&e.draws, &j.base_draws})
      for (Eigen::Index k = 0; k < draws->cols(); ++k)
        draws->col(k).head(n) = problem.scores_of_the_prior(draws->col(k).head(n));
  }
  return out;
}

std::vector<Recalibrated> parameters_of(const std::vector<Parameter> &base, const Judged &best,
                                        const std::vector<ParameterRange> &ranges) {
  std::vector<Recalibrated> list;
  for (std::size_t j = 0; j < base.size(); ++j)
    list.push_back({base[j].name, base[j].prior.value(best.evidence.mode[Eigen::Index(j)]),
                    ranges[j].all.low90, ranges[j].all.high90});
  return list;
}

std::vector<FittedEffect> effects_of(const Problem &problem, const Which &which) {
  std::vector<FittedEffect> list;
  const Judged &best = best_predicting(which);
  Eigen::Index score = problem.base_parameters;
  for (const int e : best.hypothesis.on) {
    const ModelledEffect &effect = problem.effects[std::size_t(e)];
    for (int k = 0; k < int(effect.parameters.size()); ++k) {
      const Parameter &p = effect.parameters[std::size_t(k)];
      const Range r = range_of(problem, which, e, k);
      list.push_back(
          {effect.name, p.name, p.prior.value(best.evidence.mode[score++]), r.low90, r.high90});
    }
  }
  return list;
}

/// What can be seen at some place is not nothing, though every explanation of it may be.
void heed_where(const Where &where, double claim_probability, Which &which) {
  const bool seen = std::any_of(where.rows.begin(), where.rows.end(),
                                [](const WhereRow &row) { return row.significant; });
  const double none = which.of("none").probability;
  for (Sensitivity &s : which.sensitivity)
    if (seen && s.claim == "none" && s.probability < claim_probability)
      s.claim = "undecided";
  if (which.claim != "none" || !seen || none >= claim_probability)
    return;
  which.claim = "undecided";
  which.why =
      fmt::format("A difference is significant, but each effect that would explain it is "
                  "too small to be distinguished from none, which has {:.3g}; a claim needs {:g}.",
                  none, claim_probability);
}

} // namespace

Discrimination discriminate(const Model &model, const Problem &problem,
                            const DiagnosisSettings &settings) {
  WhichSettings rules = settings.which;
  for (const std::string &name : model.poor_effects())
    rules.poor.push_back(name);
  rules.noise_seen = !problem.point_noise.empty();
  Discrimination t;
  t.which = which(problem, rules);
  t.confounding = confounding(problem, t.which, settings.confounding);
  std::vector<double> limits;
  for (const DetectionLimit &l : t.confounding.limits)
    limits.push_back(l.against_none);
  set_limits(t.which, problem, limits);
  set_short_runs(t.which, problem);
  decide(t.which, rules, int(problem.effects.size()));
  return t;
}

Diagnosis diagnose(const Model &model, const Bank &bank, const Vector &values,
                   const DiagnosisSettings &settings, const std::vector<PointNoise> &point_noise) {
  Problem problem = model.problem(values);
  problem.point_noise = point_noise;
  Diagnosis d = diagnose(model, problem, bank, values, settings);
  d.next = next_measurements(d.which, model.extensions(values), settings.next);
  return d;
}

Diagnosis diagnose(const Model &model, const Problem &problem, const Bank &bank,
                   const Vector &values, const DiagnosisSettings &settings) {
  Diagnosis d;
  d.blocks = problem.blocks;
  Discrimination t = discriminate(model, problem, settings);
  d.which = std::move(t.which);
  d.confounding = std::move(t.confounding);
  d.where = where(problem, d.which.base, settings.where);
  heed_where(d.where, settings.which.claim_probability, d.which);
  d.residual = residuals_of(model, values, d.which.base.mean.head(model.map().emulated()));
  for (WhereRow &row : d.where.rows)
    row.z = std::copysign(row.z, d.residual[row.block].residual);
  const Which shown = in_scores_of_the_prior(problem, d.which);
  d.ranges = effect_ranges(problem, d.which);
  d.parameters_of_all = parameter_ranges(bank.base, shown);
  d.parameters = parameters_of(bank.base, shown.judged.front(), d.parameters_of_all);
  d.effects = effects_of(problem, d.which);
  d.groups = effect_groups(d.which, d.confounding);
  d.predictions = predictions(model, problem, d.which, values);
  d.emulators = model.quality();
  d.degrees_of_freedom = model.scatter().degrees_of_freedom;
  d.shrinkage = model.scatter().shrinkage;
  return d;
}

const Judged &best_predicting(const Which &which) {
  return *std::find_if(which.judged.begin(), which.judged.end(), [](const Judged &j) {
    return j.hypothesis.kind == Hypothesis::none || j.hypothesis.kind == Hypothesis::effects;
  });
}

Predictions predictions(const Model &model, const Problem &problem, const Which &which,
                        const Vector &measured) {
  const Judged &best = best_predicting(which);
  const Likelihood likelihood(problem, best.hypothesis, which.unknown);
  const auto shown = [&](const Vector &features) {
    return model.map().observables_of(features.head(model.map().emulated()));
  };
  return {best.hypothesis.name,
          model.observables(),
          measured,
          model.measurement().diagonal().cwiseSqrt(),
          model.sd(),
          shown(which.base.mean),
          shown(likelihood.predict(best.evidence.mode).mean)};
}

KnownBase recalibrated(const Model &model, const Vector &values, Vector &predicted) {
  const Problem problem = model.problem(values);
  const Hypothesis none{Hypothesis::none, {}, "none", 0.0};
  const Matrix nothing;
  const Evidence found = evidence(Likelihood(problem, none, nothing), {});
  predicted =
      model.map().observables_of(problem.predict(found.mode, {}).mean.head(model.map().emulated()));
  return {found.mode, found.covariance};
}

Problem change_of(const Model &model, const Vector &values, const Vector &predicted,
                  const KnownBase &base) {
  Problem p = model.problem(values, Part::change);
  const Matrix factor = Cholesky(base.covariance).matrixL();
  const auto scores = [mean = base.mean, factor](const Vector &s) {
    return Vector(mean + factor * s);
  };
  p.scores_of_the_prior = scores;
  const auto after = [before = Vector(model.map().features_of(predicted)),
                      emulated = model.map().emulated()](Prediction change) {
    change.mean.head(emulated) += before.head(emulated);
    return change;
  };
  p.scatter *= 2.0; // of two discs; what the effect adds is of one
  p.degrees_of_freedom =
      mixed_degrees(p.measurement, p.scatter, model.scatter().degrees_of_freedom);
  p.predict = [change = p.predict, scores, after](const Vector &s, const std::vector<Applied> &on) {
    return after(change(scores(s), on));
  };
  p.slopes = [change = p.slopes, scores, factor, after](const Vector &s,
                                                        const std::vector<Applied> &on) {
    Slopes out = change(scores(s), on);
    for (Matrix *along : {&out.mean, &out.variance, &out.scatter})
      along->leftCols(s.size()) = Matrix(along->leftCols(s.size()) * factor);
    out.here = after(std::move(out.here));
    return out;
  };
  return p;
}

} // namespace calendem::inference
