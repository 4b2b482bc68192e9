// SPDX-License-Identifier: GPL-2.0-or-later
#include "inference/posterior.h"
#include "inference/moves.h"
#include <algorithm>

namespace calendem::inference {
namespace {

using Eigen::Index;

constexpr std::uint64_t kOtherStream = 0x07e3; // of the material that was not measured
// Steps of the parameters adapt to an accepted share between these.
constexpr double kFewAccepted = 0.2, kManyAccepted = 0.5, kLeastStep = 0.02;

/// One pass over all blocks, with moves that adapt.
class Sweep {
public:
  Sweep(Ensemble &ensemble, TemperatureStep &record)
      : ensemble_(ensemble), record_(record),
        steps_(std::size_t(ensemble.problem().materials), 1.0) {}

  void run() {
    const int materials = ensemble_.problem().materials;
    record_.switches = record_.parameters = 0.0;
    for (int m = 0; m < materials; ++m) {
      const std::vector<LocalModel> models = local_models(ensemble_, m);
      double &step = steps_[std::size_t(m)];
      double moved = move_switches(ensemble_, m, models);
      const double accepted =
          ensemble_.problem().parameters > 0 ? move_parameters(ensemble_, m, models, step) : 1.0;
      moved += move_switches(ensemble_, m, models);
      record_.switches += 0.5 * moved / materials;
      record_.parameters += accepted / materials;
      if (accepted < kFewAccepted)
        step = std::max(kLeastStep, 0.6 * step);
      else if (accepted > kManyAccepted)
        step = std::min(1.0, 1.3 * step);
    }
    move_errors(ensemble_);
  }

private:
  Ensemble &ensemble_;
  TemperatureStep &record_;
  std::vector<double> steps_;
};

} // namespace

Vector amplitudes_of(const PosteriorProblem &problem, const Draw &draw, int film) {
  Vector out = draw.amplitudes.col(problem.films[std::size_t(film)].material);
  for (std::size_t e = 0; e < problem.effects.size(); ++e)
    if (problem.effects[e].of_film)
      out[Index(e)] = draw.faults(Index(e), film);
  return out;
}

Posterior sample_posterior(const PosteriorProblem &problem, const SamplerSettings &settings) {
  Posterior out;
  Ensemble ensemble(problem, settings);
  TemperatureStep record;
  Sweep sweep(ensemble, record);
  while (ensemble.temperature() < 1.0) {
    out.log_evidence += ensemble.heat(settings.least_share, record.effective);
    record.temperature = ensemble.temperature();
    for (int k = 0; k < settings.sweeps; ++k)
      sweep.run();
    out.steps.push_back(record);
  }
  for (int k = 1; k <= settings.final_sweeps; ++k) {
    sweep.run();
    if (k % settings.keep_every == 0)
      for (const Particle &p : ensemble.particles())
        out.draws.push_back(with_another_material(problem, p.draw, settings.seed ^ kOtherStream,
                                                  std::uint64_t(out.draws.size())));
  }
  out.steps.push_back(record);
  for (Draw &d : out.draws)
    d.weight = 1.0 / double(out.draws.size());
  out.particles = settings.particles;
  out.states = ensemble.states();
  return out;
}

} // namespace calendem::inference
