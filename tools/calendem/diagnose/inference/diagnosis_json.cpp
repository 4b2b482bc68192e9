// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/gap_file.h"
#include "diagnose/inference/diagnosis.h"

namespace calendem::inference {
namespace {

using Json = nlohmann::ordered_json;

Json where_of(const Diagnosis &d) {
  Json rows = Json::array();
  for (const WhereRow &r : d.where.rows) {
    const Block &b = d.blocks[r.block];
    const BlockResidual &left = d.residual[r.block];
    rows.push_back(to_json(Place{b.name, b.stage, b.condition, "", left.residual, left.sd, r.z,
                                 r.share, r.significant}));
    rows.back()["worst_coordinate"] = left.worst_coordinate;
  }
  return rows;
}

Json evidence_of(const Judged &j) {
  Json out = {{"hypothesis", j.hypothesis.name},
              {"prior", j.hypothesis.prior},
              {"probability", j.probability},
              {"log_evidence", j.evidence.log_evidence},
              {"log_evidence_error", j.evidence.error},
              {"log_evidence_laplace", j.evidence.laplace},
              {"samples", j.evidence.samples},
              {"effective_samples", j.evidence.effective_samples},
              {"adequacy_p", j.adequacy_p},
              {"place", j.place}};
  if (!j.of_place.empty()) {
    out["places"] = j.of_place;
    out["by_misfit"] = j.by_misfit;
  }
  return out;
}

Json effects_of(const Diagnosis &d) {
  Json rows = Json::array();
  for (const EffectRange &r : d.ranges)
    rows.push_back({{"effect", r.effect},
                    {"inclusion", r.inclusion},
                    {"amplitude", r.amplitude.median},
                    {"low95", r.amplitude.low95},
                    {"high95", r.amplitude.high95},
                    {"below95", r.below95},
                    {"two_sided", r.two_sided},
                    {"limited", r.limited}});
  return rows;
}

Json beside_of(const Which &w) {
  Json rows = Json::array();
  for (const Companion &c : w.beside)
    rows.push_back({{"effect", c.effect}, {"probability", c.probability}, {"prior", c.prior}});
  return rows;
}

/// Runs of the hypothesis that leads among those that predict.
Json short_runs_of(const Which &w) {
  Json rows = Json::array();
  for (const ShortRuns &s : best_predicting(w).short_runs)
    rows.push_back(
        {{"effect", s.effect}, {"rival", s.rival}, {"cosine", s.cosine}, {"reached", s.reached}});
  return rows;
}

Json groups_of(const Diagnosis &d) {
  Json rows = Json::array();
  for (const EffectGroup &g : d.groups)
    rows.push_back({{"effects", g.effects},
                    {"with_none", g.with_none},
                    {"probability", g.probability},
                    {"acts_like", g.acts_like}});
  return rows;
}

Json parameters_of(const Diagnosis &d) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < d.parameters.size(); ++k) {
    const Recalibrated &p = d.parameters[k];
    const ParameterRange &r = d.parameters_of_all[k];
    rows.push_back({{"parameter", p.parameter},
                    {"mode", p.mode},
                    {"low90", p.low90},
                    {"high90", p.high90},
                    {"low95", r.all.low95},
                    {"high95", r.all.high95}});
    if (!r.moved_by.empty())
      rows.back()["moved_by"] = {{"effect", r.moved_by},
                                 {"median", r.moved.median},
                                 {"low95", r.moved.low95},
                                 {"high95", r.moved.high95}};
  }
  return rows;
}

Json which_of(const Diagnosis &d) {
  const Which &w = d.which;
  Json out = {{"claim", w.claim}, {"why", w.why}};
  for (const Judged &j : w.judged) {
    out["probability"][j.hypothesis.name] = j.probability;
    out["evidence"].push_back(evidence_of(j));
  }
  out["inclusion"] = w.inclusion;
  out["effects"] = effects_of(d);
  out["beside"] = beside_of(w);
  out["short_runs"] = short_runs_of(w);
  out["groups"] = groups_of(d);
  out["set95"] = w.set95;
  out["indistinguishable"] = d.confounding.indistinguishable;
  out["next_measurement"] = {{"what", ""}, {"expected_probability", 0.0}};
  out["measurements"] = Json::array();
  for (const NextMeasurement &n : d.next)
    out["measurements"].push_back({{"what", n.what},
                                   {"cost", n.cost},
                                   {"now", n.now},
                                   {"expected_probability", n.expected_probability},
                                   {"per_cost", n.per_cost}});
  if (!d.next.empty())
    out["next_measurement"] = out["measurements"][0];
  out["adequacy_p"] = w.adequacy_p;
  out["none_to_be_seen"] = w.none_to_be_seen;
  for (const Sensitivity &s : w.sensitivity)
    out["sensitivity"].push_back(
        {{"priors", s.change}, {"claim", s.claim}, {"probability", s.probability}});
  return out;
}

Json matrix(const Matrix &m) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    rows.push_back(std::vector<double>(m.row(i).begin(), m.row(i).end()));
  return rows;
}

Json confounding_of(const Diagnosis &d) {
  const Confounding &c = d.confounding;
  Json out = {{"effects", c.effects},
              {"cosine", matrix(c.cosine)},
              {"log_odds", matrix(c.log_odds)},
              {"absorbed", std::vector<double>(c.absorbed.begin(), c.absorbed.end())}};
  for (const DetectionLimit &l : c.limits)
    out["detection_limit"].push_back({{"effect", l.effect},
                                      {"amplitude", l.amplitude},
                                      {"rival", l.rival},
                                      {"against_none", l.against_none}});
  return out;
}

std::string name_of(const Block &b) { return b.name + ", " + b.stage + ", " + b.condition; }

Json conflicts_of(const Diagnosis &d) {
  Json rows = Json::array();
  for (const Conflict &c : d.where.conflicts)
    rows.push_back(
        {{"one", name_of(d.blocks[c.one])}, {"other", name_of(d.blocks[c.other])}, {"p", c.p}});
  return rows;
}

Json conflict_matrix_of(const Diagnosis &d) {
  Json names = Json::array();
  for (const Block &b : d.blocks)
    names.push_back(name_of(b));
  return {{"blocks", names}, {"p", matrix(d.where.conflict)}};
}

Json emulators_of(const Diagnosis &d) {
  Json rows = Json::array();
  for (const EmulatorQuality &q : d.emulators) {
    Json row = {{"effect", q.effect.empty() ? "base" : q.effect},
                {"runs", q.runs},
                {"q2", q.q2},
                {"error", q.error},
                {"poor", q.poor}};
    for (const Quality &f : q.feature)
      row["q2_of_features"].push_back(learnt_share(f.error * f.error - f.scatter * f.scatter,
                                                   f.spread * f.spread - f.scatter * f.scatter));
    rows.push_back(row);
  }
  return rows;
}

Json predictions_of(const Predictions &p) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < p.of.size(); ++k) {
    const auto i = Eigen::Index(k);
    rows.push_back({{"observable", p.of[k].name},
                    {"stage", p.of[k].stage},
                    {"condition", p.of[k].condition},
                    {"coordinate", p.of[k].coordinate},
                    {"measured", p.measured[i]},
                    {"sd_measurement", p.sd_measurement[i]},
                    {"sd", p.sd[i]},
                    {"base", p.base[i]},
                    {"best", p.after[i]}});
  }
  return {{"best", p.best}, {"observables", rows}};
}

} // namespace

Json to_json(const Diagnosis &d, const std::string &experiment) {
  Json out = new_gap(experiment, where_of(d), d.where.threshold, d.degrees_of_freedom);
  out["scatter"]["shrinkage"] = d.shrinkage;
  out["which"] = which_of(d);
  out["conflicts"] = conflicts_of(d);
  out["conflict_matrix"] = conflict_matrix_of(d);
  for (const StageFit &s : d.where.stages)
    out["stages"].push_back({{"stage", s.stage},
                             {"scores", std::vector<double>(s.scores.begin(), s.scores.end())},
                             {"sd", std::vector<double>(s.sd.begin(), s.sd.end())}});
  out["confounding"] = confounding_of(d);
  out["parameters"] = parameters_of(d);
  out["fitted_effects"] = Json::array();
  for (const FittedEffect &e : d.effects)
    out["fitted_effects"].push_back({{"effect", e.effect},
                                     {"parameter", e.parameter},
                                     {"mode", e.mode},
                                     {"low90", e.low90},
                                     {"high90", e.high90}});
  out["predictions"] = predictions_of(d.predictions);
  out["emulators"] = emulators_of(d);
  return out;
}

} // namespace calendem::inference
