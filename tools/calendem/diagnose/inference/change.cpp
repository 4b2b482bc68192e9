// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/inference/change.h"
#include "diagnose/inference/hypothesis.h"

namespace calendem::inference {

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
  Problem p = model.problem(values);
  const Matrix factor = Cholesky(base.covariance).matrixL();
  const auto scores = [mean = base.mean, factor](const Vector &s) {
    return Vector(mean + factor * s);
  };
  const Vector before = model.map().features_of(predicted);
  p.scatter *= 2.0;
  p.predict = [predict = p.predict, scores, before,
               emulated = model.map().emulated()](const Vector &s, const std::vector<Applied> &on) {
    const Vector at = scores(s);
    const Prediction off = predict(at, {});
    Prediction out{Vector::Zero(off.mean.size()), Vector::Zero(off.mean.size())};
    out.mean.head(emulated) = before.head(emulated);
    if (on.empty())
      return out;
    const Prediction with = predict(at, on);
    out.mean += with.mean - off.mean;
    out.variance = (with.variance - off.variance).cwiseMax(0.0);
    return out;
  };
  p.slopes = [slopes = p.slopes, scores, factor](const Vector &s, const std::vector<Applied> &on) {
    const Vector at = scores(s);
    const Slopes off = slopes(at, {});
    Slopes out = on.empty() ? off : slopes(at, on);
    const auto chain = [&](Matrix &with, const Matrix &without) {
      with.leftCols(s.size()) = Matrix((with.leftCols(s.size()) - without) * factor);
    };
    chain(out.mean, off.mean);
    chain(out.variance, off.variance);
    return out;
  };
  return p;
}

} // namespace calendem::inference
