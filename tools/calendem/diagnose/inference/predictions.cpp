// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/predictions.h"
#include <algorithm>

namespace calendem::inference {

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

} // namespace calendem::inference
