// SPDX-License-Identifier: GPL-2.0-or-later
#include "candidates.h"
#include <algorithm>

namespace calendem {

using Eigen::Index;
using inference::Change;
using inference::Matrix;
using inference::Vector;

std::vector<Candidate> candidates_of(const Diagnosis &d) {
  const std::vector<int> model = inference::effects_of_model(d.of.problem);
  std::vector<Candidate> out = {{-1, model}};
  for (int k = 0; k < int(d.changes.all.size()); ++k) {
    const Change &c = d.changes.all[std::size_t(k)];
    if (c.effect < 0)
      continue;
    out.push_back({k, model});
    std::vector<int> &acting = out.back().acting;
    if (c.kind == Change::absent)
      acting.erase(std::find(acting.begin(), acting.end(), c.effect));
    else
      acting.push_back(c.effect);
    std::sort(acting.begin(), acting.end());
  }
  return out;
}

inference::FilmPredictions predicted_with(const Diagnosis &d, const Candidate &c,
                                          const Matrix &scores, const Matrix &amplitudes) {
  return d.of.problem.predict(
      d.film, scores,
      inference::with_others_off(amplitudes, c.acting, d.of.problem.effects.size()));
}

Matrix mean_changes(const Diagnosis &d, const std::vector<Candidate> &all) {
  Vector scores = Vector::Zero(d.of.problem.parameters);
  for (const inference::Draw &draw : d.model.posterior.draws)
    scores += draw.weight * draw.scores.col(0);
  Matrix out(Index(d.readings.size()), Index(all.size()));
  for (Index k = 0; k < out.cols(); ++k) {
    const Candidate &c = all[std::size_t(k)];
    out.col(k) = predicted_with(d, c, scores, Matrix::Zero(Index(c.acting.size()), 1)).mean;
  }
  return out.rightCols(out.cols() - 1).colwise() - out.col(0);
}

Matrix deviations_of(const Diagnosis &d) {
  Matrix out = Matrix::Zero(Index(d.readings.size()), Index(d.blocks.size()));
  for (std::size_t b = 0; b < d.blocks.size(); ++b)
    for (const int k : d.blocks[b].members)
      out(k - first_datum(d), Index(b)) = std::sqrt(d.model.covariance(k, k));
  return out;
}

} // namespace calendem
