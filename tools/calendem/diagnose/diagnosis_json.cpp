// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/gap_file.h"
#include "diagnose/diagnosis.h"
#include <fmt/format.h>

namespace calendem {

using inference::Change;
using inference::Verdict;
using Json = nlohmann::ordered_json;
namespace {

using Eigen::Index;

const Reading &reading_of(const Diagnosis &d, int datum) {
  return d.measured.readings[std::size_t(d.readings[std::size_t(datum - first_datum(d))])];
}

Json where_json(const Diagnosis &d) {
  Json out = Json::array();
  for (const inference::BlockResidual &r : d.where.rows) {
    const inference::Block &b = d.blocks[std::size_t(r.block)];
    const Observable &worst = reading_of(d, r.worst).observable;
    Place place;
    place.observable = b.name;
    place.stage = b.stage;
    place.condition = b.condition;
    place.unit = worst.unit;
    place.residual = r.residual;
    place.sd = r.sd;
    place.z = r.z;
    place.share = r.share;
    place.significant = r.significant;
    out.push_back(to_json(place));
    if (b.members.size() > 1)
      out.back()["worst_coordinate"] = worst.coordinate;
  }
  return out;
}

/// Range of a value over weighted draws.
Json range_json(const std::vector<double> &values, const std::vector<double> &weights) {
  const inference::CredibleRange range = inference::credible_range(values, weights);
  return {{"value", range.median}, {"low90", range.low90}, {"high90", range.high90}};
}

/// Values of an effect's key over the draws in which it acts; null: in none.
Json amplitude_json(const Diagnosis &d, int effect) {
  const inference::Parameter &parameter = d.of.effects[std::size_t(effect)];
  const EffectParameter &key = find_effect(parameter.name).parameter;
  std::vector<double> values, weights;
  for (const inference::Draw &draw : d.posterior.draws) {
    const double score = inference::amplitudes_of(d.of.problem, draw, d.film)[effect];
    if (!inference::acts(score))
      continue;
    values.push_back(key.value(parameter.prior.value(score)));
    weights.push_back(draw.weight);
  }
  if (values.empty())
    return nullptr;
  Json out = {{"key", key.keys.front()}};
  out.update(range_json(values, weights));
  return out;
}

const char *kind_of(Change::Kind kind) {
  const char *const names[] = {"added", "absent", "fault", "understated", "something"};
  return names[int(kind)];
}

Json changes_json(const Diagnosis &d) {
  Json out = Json::array();
  for (int k = 0; k < int(d.changes.all.size()); ++k) {
    const Change &c = d.changes.all[std::size_t(k)];
    Json row = {{"name", name_of(d, k)},
                {"kind", kind_of(c.kind)},
                {"prior", c.prior},
                {"probability", c.probability},
                {"bayes_factor", c.bayes_factor}};
    if (c.effect >= 0) {
      row["effect"] = d.of.effects[std::size_t(c.effect)].name;
      if (c.kind != Change::absent)
        row["amplitude"] = amplitude_json(d, c.effect);
    }
    out.push_back(row);
  }
  return out;
}

std::vector<std::string> names_of(const Diagnosis &d, const std::vector<int> &changes) {
  std::vector<std::string> out;
  for (const int k : changes)
    out.push_back(name_of(d, k));
  return out;
}

const char *answer_of(Verdict::Kind kind) {
  const char *const names[] = {"explained", "one of these", "something else", "nothing to see"};
  return names[int(kind)];
}

std::string claim_of(const Diagnosis &d) {
  switch (d.verdict.kind) {
  case Verdict::explained:
    return fmt::format("{}", fmt::join(names_of(d, d.verdict.changes), " + "));
  case Verdict::one_of:
    return "undecided";
  case Verdict::something_else:
    return "unknown";
  default:
    return "none";
  }
}

Json which_json(const Diagnosis &d) {
  Json sets = Json::array(), further = Json::array();
  for (const inference::ChangeSet &s : d.sets)
    sets.push_back({{"changes", names_of(d, s.changes)}, {"probability", s.probability}});
  for (const FurtherMeasurement &m : d.further)
    further.push_back({{"observable", m.observable},
                       {"pressure_MPa", m.pressure},
                       {"sd", m.sd},
                       {"unit", m.unit},
                       {"information", m.gain.information},
                       {"expected_probability", m.gain.probability}});
  return {{"claim", claim_of(d)},
          {"answer", answer_of(d.verdict.kind)},
          {"named", names_of(d, d.verdict.changes)},
          {"probability", d.verdict.probability},
          {"adequacy_p", d.adequacy},
          {"changes", changes_json(d)},
          {"set95", sets},
          {"now", d.now},
          {"measurements", further},
          {"rule",
           {{"certain", inference::kCertain},
            {"strong", inference::kStrong},
            {"mention", inference::kMention},
            {"fits", inference::kFits}}}};
}

bool is_porosity(const Observable &o) { return o.unit == "%" && o.name == "total porosity"; }

/// Root mean square of the porosities' residuals [points]; null: none was measured.
Json porosity_points(const Diagnosis &d, const inference::FittedModel &model) {
  double squares = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < d.readings.size(); ++k)
    if (const Index at = first_datum(d) + Index(k);
        is_porosity(reading_of(d, int(at)).observable)) {
      squares += model.residual[at] * model.residual[at];
      ++count;
    }
  return count > 0 ? Json(std::sqrt(squares / count)) : Json();
}

Json shrink_json(const Diagnosis &d) {
  const inference::StandardisedGap before = inference::standardised_gap(d.model, d.blocks),
                                   after = inference::standardised_gap(d.explained, d.blocks);
  return {{"hypothesis", names_of(d, d.leading)},
          {"before", before.value},
          {"after", after.value},
          {"fraction", before.value > 0.0 ? 1.0 - after.value / before.value : 0.0},
          {"noise", before.noise},
          {"noise_floor", before.noise_most},
          {"porosity_points",
           {{"before", porosity_points(d, d.model)}, {"after", porosity_points(d, d.explained)}}},
          {"runs", nullptr}};
}

Json parameters_json(const Diagnosis &d) {
  Json out = Json::array();
  const int material = d.measured.films[std::size_t(d.film)].material;
  for (std::size_t p = 0; p < d.of.parameters.size(); ++p) {
    const auto of = [&](const inference::Posterior &posterior) {
      std::vector<double> values, weights;
      for (const inference::Draw &draw : posterior.draws) {
        values.push_back(d.of.parameters[p].prior.value(draw.scores(Index(p), material)));
        weights.push_back(draw.weight);
      }
      return range_json(values, weights);
    };
    out.push_back({{"parameter", d.of.parameters[p].name},
                   {"model", of(d.model.posterior)},
                   {"all", of(d.posterior)}});
  }
  return out;
}

Json predictions_json(const Diagnosis &d) {
  Json out = Json::array();
  for (std::size_t k = 0; k < d.readings.size(); ++k) {
    const Index at = first_datum(d) + Index(k);
    const Reading &r = reading_of(d, int(at));
    const Observable &o = r.observable;
    out.push_back({{"condition", r.condition},
                   {"observable", o.curve.empty() ? o.name : o.curve},
                   {"stage", o.stage},
                   {"coordinate", o.coordinate},
                   {"pressure_MPa", o.pressure > 0.0 ? o.pressure : r.pressure},
                   {"unit", o.unit},
                   {"measured", o.measured},
                   {"sd", std::sqrt(d.model.covariance(at, at))},
                   {"model", o.measured - d.model.residual[at]},
                   {"explained", o.measured - d.explained.residual[at]}});
  }
  return out;
}

} // namespace

Json to_json(const Diagnosis &d, const FilmBank &bank) {
  Json out = new_gap(d.experiment, where_json(d), d.where.threshold, -1.0);
  out["bank"] = bank.spec().name;
  out["inside_bank"] = d.outside.empty();
  out["outside"] = d.outside;
  out["which"] = which_json(d);
  out["shrink"] = shrink_json(d);
  out["parameters"] = parameters_json(d);
  out["predictions"] = predictions_json(d);
  out["not_said"] = d.warnings;
  put_in_words(out);
  return out;
}

} // namespace calendem
