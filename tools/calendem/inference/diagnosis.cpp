// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/diagnosis.h"
#include <algorithm>
#include <cmath>

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

/// Of the parameter whose scores are this row of the posterior's draws.
Recalibrated recalibrated(const Parameter &p, const std::string &effect, const Evidence &evidence,
                          Eigen::Index row) {
  std::vector<double> draws(evidence.draws.row(row).begin(), evidence.draws.row(row).end());
  std::sort(draws.begin(), draws.end());
  const auto at = [&](double share) {
    return p.prior.value(draws[std::size_t(share * double(draws.size() - 1))]);
  };
  return {effect, p.name, p.prior.value(evidence.mode[row]), at(0.05), at(0.95)};
}

std::vector<Recalibrated> parameters_of(const std::vector<Parameter> &base, const Judged &best) {
  std::vector<Recalibrated> list;
  for (const Parameter &p : base)
    list.push_back(recalibrated(p, "", best.evidence, Eigen::Index(list.size())));
  return list;
}

std::vector<Recalibrated> amplitudes_of(const Problem &problem, const Judged &best) {
  std::vector<Recalibrated> list;
  for (const int e : best.hypothesis.on)
    for (const Parameter &p : problem.effects[e].parameters)
      list.push_back(recalibrated(p, problem.effects[e].name, best.evidence,
                                  problem.base_parameters + Eigen::Index(list.size())));
  return list;
}

} // namespace

Diagnosis diagnose(const Model &model, const Bank &bank, const Vector &values,
                   const Settings &settings) {
  Diagnosis d;
  const Problem problem = model.problem(values);
  WhichSettings rules = settings.which;
  for (const std::string &name : model.poor_effects())
    rules.poor.push_back(name);
  d.blocks = problem.blocks;
  d.which = which(problem, rules);
  d.where = where(problem, d.which.base, settings.where);
  d.residual = residuals_of(model, values, d.which.base.mean.head(model.map().emulated()));
  for (WhereRow &row : d.where.rows)
    row.z = std::copysign(row.z, d.residual[row.block].residual);
  d.confounding = confounding(problem, d.which, settings.confounding);
  d.next = next_measurements(d.which, model.extensions(values), settings.next);
  d.parameters = parameters_of(bank.base, d.which.judged.front());
  d.amplitudes = amplitudes_of(problem, best_predicting(d.which));
  d.predictions = predictions(model, problem, d.which, values);
  d.emulators = model.quality();
  d.degrees_of_freedom = model.scatter().degrees_of_freedom;
  d.shrinkage = model.scatter().shrinkage;
  return d;
}

} // namespace calendem::inference
