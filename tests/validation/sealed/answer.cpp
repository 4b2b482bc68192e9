// SPDX-License-Identifier: GPL-2.0-or-later
#include "sealed/answer.h"
#include "base/gap_file.h"
#include "base/liggghts_job.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "diagnose/bank_check.h"
#include "diagnose/inference/scatter.h"
#include "diagnose/rerun.h"
#include "sealed/make.h"
#include "sealed/sealing.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>

namespace calendem {

namespace fs = std::filesystem;
namespace {

constexpr const char *kFiles[] = {"gap.json", "gap_without.json", "baselines.json"};
constexpr const char *kShrink = "shrink.json";

/// Takes the names "001", "002", ... in commitment.json.
std::vector<std::string> ids_of(const std::string &folder) {
  const nlohmann::json j =
      nlohmann::json::parse(bytes_of(folder + "/commitment.json"), nullptr, false);
  if (!j.is_object() || !j.contains("cases") || !j["cases"].is_object())
    throw Failure(kBadInput, fmt::format("{}/commitment.json holds no cases. Take handed_out as "
                                         "sealed make wrote it.",
                                         folder));
  std::vector<std::string> ids;
  for (const auto &[id, hash] : j["cases"].items())
    ids.push_back(id);
  return ids;
}

/// The experiment, whose files all lie in its own folder.
Experiment experiment_in(const std::string &folder) {
  sha256_of_files(folder); // plain files only
  const Experiment e = read_experiment(folder + "/experiment.toml");
  std::vector<std::string> paths = {e.electrode};
  for (const Condition &c : e.conditions)
    paths.insert(paths.end(), {c.curve, c.labels_before, c.labels_after});
  for (const std::string &path : paths)
    if (!path.empty() && fs::path(path).parent_path() != fs::path(folder))
      throw Failure(kBadInput, fmt::format("{}/experiment.toml names {}, which is not in its "
                                           "folder. Take handed_out as it was made.",
                                           folder, path));
  return e;
}

/// The effect that the diagnosis finds most probable, alone or in a pair.
std::string most_probable_effect(const inference::Which &which) {
  std::string name;
  double most = -1.0;
  for (const auto &[effect, probability] : which.inclusion)
    if (probability > most) {
      most = probability;
      name = effect;
    }
  return name;
}

class Answering {
public:
  explicit Answering(const AnswerOptions &o)
      : o_(o), table_(read_bank_table(read_bank_spec(o.bank), o.table)), ids_(ids_of(o.handed_out)),
        of_bank_(sha256(bytes_of(o.bank) + bytes_of(o.table))),
        of_reruns_(o.rerun_packings == 0
                       ? ""
                       : fmt::format("{} {}", o.rerun_packings, sha256(bytes_of(o.liggghts)))) {
    for (const std::string &name : table_.spec.effects)
      without_[name] = without_effects(table_, {name});
  }

  int cases() const { return int(ids_.size()); }

  void answer(int k) {
    const std::string &id = ids_[std::size_t(k)], from = o_.handed_out + "/" + id;
    const std::string identity = identity_of(id);
    if (is_answered(id, identity))
      return;
    fs::create_directories(o_.folder + "/" + id);
    nlohmann::ordered_json full, less = {{"without", ""}},
                                 simple = {{"named", nlohmann::ordered_json::object()}};
    if (is_intervention(from))
      full = diagnosed_change(experiment_in(from + "/before"), experiment_in(from + "/after"),
                              table_, 0.0)
                 .gap;
    else
      answer_one(experiment_in(from), full, less, simple);
    write(id, kFiles[0], full, identity);
    write(id, kFiles[1], less, identity);
    write(id, kFiles[2], simple, identity);
    fmt::print("sealed: case {}: {}\n", id, full["which"]["claim"].get<std::string>());
    std::cout << std::flush;
  }

  /// Base model, effect and placebo are run again where an effect is claimed.
  void run_again(int k) {
    const std::string &id = ids_[std::size_t(k)], here = o_.folder + "/" + id;
    const std::string identity = sha256(identity_of(id) + of_reruns_);
    if (made_of(here + "/" + kShrink, identity))
      return;
    fs::remove(here + "/" + kShrink);
    if (is_intervention(o_.handed_out + "/" + id) ||
        !names_effect(read_diagnosis(here + "/" + kFiles[0]).at("which").at("claim")))
      return;
    const Experiment experiment = experiment_in(o_.handed_out + "/" + id);
    const Diagnosed d = diagnosed(experiment, table_, 0.0, models_);
    std::vector<RerunModel> models = models_to_rerun(experiment, table_, d, 0.0);
    models.erase(std::remove_if(models.begin(), models.end(),
                                [](const RerunModel &m) { return m.role == "runner-up"; }),
                 models.end());
    if (models.empty())
      return;
    RerunOptions options;
    options.packings = o_.rerun_packings;
    options.cells = cells_of(experiment, table_.spec);
    options.study.folder = here + "/rerun";
    options.study.calendem = calendem_beside();
    options.study.liggghts = o_.liggghts;
    options.study.jobs = o_.jobs;
    try {
      nlohmann::ordered_json shrink = rerun(experiment, table_, models, options);
      write(id, kShrink, shrink, identity);
    } catch (const Failure &f) {
      if (f.exit_status() == kBadInput || stop_requested() != 0)
        throw;
      fmt::print("sealed: case {} could not be run again: {}\n", id, f.what());
    }
  }

  void write_list() const {
    nlohmann::ordered_json j = {
        {"commitment_sha256", sha256(bytes_of(o_.handed_out + "/commitment.json"))}};
    for (const std::string &id : ids_)
      for (const char *file : {kFiles[0], kFiles[1], kFiles[2], kShrink})
        if (const std::string path = o_.folder + "/" + id + "/" + file; fs::exists(path))
          j["sha256"][id + "/" + file] = sha256(bytes_of(path));
    j["provenance"] = {{"calendem", version()},
                       {"bank_sha256", sha256(bytes_of(o_.bank))},
                       {"bank_table_sha256", sha256(bytes_of(o_.table))}};
    write_file(o_.folder + "/answers.json", j.dump(1) + "\n");
  }

private:
  const AnswerOptions &o_;
  BankTable table_;
  std::map<std::string, BankTable> without_;
  std::vector<std::string> ids_;
  std::string of_bank_, of_reruns_; // hashes
  SharedModels models_;

  void answer_one(const Experiment &experiment, nlohmann::ordered_json &full,
                  nlohmann::ordered_json &less, nlohmann::ordered_json &simple) {
    const Diagnosed d = diagnosed(experiment, table_, 0.0, models_);
    full = d.gap;
    simple["named"] = baselines(d.model->problem(d.data.experiment.values), d.diagnosis);
    const std::string name = most_probable_effect(d.diagnosis.which);
    if (!name.empty())
      less = diagnosed(experiment, without_.at(name), 0.0, models_).gap;
    less["without"] = name;
  }

  /// Hash of all that the answer to a case depends on.
  std::string identity_of(const std::string &id) const {
    return sha256(of_bank_ + sha256_of_case(o_.handed_out + "/" + id) + version());
  }

  bool is_answered(const std::string &id, const std::string &identity) const {
    return std::all_of(std::begin(kFiles), std::end(kFiles), [&](const char *file) {
      return made_of(o_.folder + "/" + id + "/" + file, identity);
    });
  }

  void write(const std::string &id, const char *file, nlohmann::ordered_json &j,
             const std::string &identity) const {
    j["identity"] = identity;
    write_file(o_.folder + "/" + id + "/" + file, j.dump(1) + "\n");
  }
};

} // namespace

void check_handed_out(const std::string &folder) {
  const fs::path at = fs::canonical(folder);
  const auto refuse = [](const fs::path &found) {
    throw Failure(kBadInput, fmt::format("truths lie within reach: {}. Copy handed_out to a folder "
                                         "of its own and answer that.",
                                         found.string()));
  };
  const auto reveals = [](const fs::path &p) {
    return p.filename() == "sealed" || p.filename() == "truth.json";
  };
  for (const auto &entry : fs::directory_iterator(at.parent_path()))
    if (reveals(entry.path()))
      refuse(entry.path());
  for (const auto &entry : fs::recursive_directory_iterator(at))
    if (reveals(entry.path()) || entry.is_symlink())
      refuse(entry.path());
}

void answer_round(const AnswerOptions &given) {
  AnswerOptions o = given;
  if (!fs::is_directory(o.handed_out))
    throw Failure(kBadInput, fmt::format("there is no folder '{}'. Give handed_out as sealed "
                                         "make wrote it.",
                                         o.handed_out));
  o.handed_out = fs::canonical(o.handed_out).string();
  check_handed_out(o.handed_out);
  Answering answering(o);
  make_output_folder(o.folder);
  const FolderLock lock(o.folder);
  in_parallel(answering.cases(), o.jobs, [&](int k) { answering.answer(k); });
  for (int k = 0; k < answering.cases() && o.rerun_packings > 0 && stop_requested() == 0; ++k)
    answering.run_again(k);
  if (stop_requested() != 0)
    throw Failure(kSimulationFailed, "sealed: stopped on request. The answers given are kept; the "
                                     "same command goes on.");
  answering.write_list();
  fmt::print(
      "sealed: {} answers, {}/answers.json\nNext, where the truths are: sealed score DIR {}\n",
      answering.cases(), o.folder, o.folder);
}

namespace {
using inference::Matrix;
using inference::Problem;
using inference::Vector;

/// Residual and signatures in units in which noise and recalibration have covariance 1.
struct Whitened {
  Vector residual;
  std::vector<std::vector<Vector>> signatures; ///< of each effect, two
};

Whitened whitened(const Problem &problem, const inference::Linearised &base) {
  const Eigen::LLT<Matrix> root(inference::recalibrated_covariance(base));
  const auto white = [&](const Vector &v) { return Vector(root.matrixL().solve(v)); };
  Whitened out;
  // before recalibration within the priors: r + J at, whose covariance is S + J J^T
  out.residual = white(problem.observed - base.mean + base.sensitivity * base.at);
  for (int e = 0; e < int(problem.effects.size()); ++e) {
    out.signatures.emplace_back();
    const Eigen::Index n = Eigen::Index(problem.effects[std::size_t(e)].parameters.size());
    for (const double score : {-1.0, 1.0})
      out.signatures.back().push_back(
          white(problem.predict(base.at, {{e, Vector::Constant(n, score)}}).mean - base.mean));
  }
  return out;
}

/// The effect with the largest value, by its better signature.
template <typename Value> std::string best(const Problem &problem, const Whitened &w, Value value) {
  std::string name = "none";
  double most = 0.0;
  for (std::size_t e = 0; e < w.signatures.size(); ++e)
    for (const Vector &s : w.signatures[e])
      if (const double v = s.norm() > 0.0 ? value(s) : 0.0; v > most) {
        most = v;
        name = problem.effects[e].name;
      }
  return name;
}

std::string by_largest_residual(const Problem &problem, const inference::Diagnosis &d,
                                const Whitened &w) {
  if (d.where.rows.empty() || !d.where.rows.front().significant)
    return "none";
  const std::vector<int> members =
      inference::features_by_block(problem)[std::size_t(d.where.rows.front().block)];
  return best(problem, w, [&](const Vector &s) { return Vector(s(members)).norm() / s.norm(); });
}

std::string by_cosine(const Problem &problem, const Whitened &w) {
  if (inference::chance_beyond(w.residual.squaredNorm(), int(w.residual.size()),
                               problem.degrees_of_freedom) > 0.05)
    return "none";
  return best(problem, w,
              [&](const Vector &s) { return s.dot(w.residual) / (s.norm() * w.residual.norm()); });
}

std::string by_bic(const Problem &problem, const inference::Which &which) {
  std::string name = "none";
  double least = INFINITY;
  for (const inference::Judged &j : which.judged) {
    if (j.hypothesis.kind != inference::Hypothesis::none && !j.hypothesis.single())
      continue;
    const inference::Likelihood likelihood(problem, j.hypothesis, Matrix());
    const double bic = -2.0 * likelihood.log(j.evidence.mode) +
                       likelihood.dimension() * std::log(double(problem.observed.size()));
    if (bic < least) {
      least = bic;
      name = j.hypothesis.name;
    }
  }
  return name;
}

std::string by_implausibility(const Problem &problem, const inference::Which &which) {
  constexpr double kImplausible = 3.0;
  std::string name = "none";
  double least = INFINITY;
  for (const inference::Judged &j : which.judged) {
    const bool none = j.hypothesis.kind == inference::Hypothesis::none;
    if (!none && !j.hypothesis.single())
      continue;
    const inference::Likelihood likelihood(problem, j.hypothesis, Matrix());
    const inference::Prediction at = likelihood.predict(j.evidence.mode);
    const double implausibility =
        ((problem.observed - at.mean).array().abs() /
         inference::covariance_about(problem, at).diagonal().array().sqrt())
            .maxCoeff();
    if (none && implausibility < kImplausible)
      return "none";
    if (!none && implausibility < least) {
      least = implausibility;
      name = j.hypothesis.name;
    }
  }
  return name;
}

} // namespace

std::map<std::string, std::string> baselines(const Problem &problem,
                                             const inference::Diagnosis &d) {
  const Whitened w = whitened(problem, d.which.base);
  return {{"always none", "none"},
          {"largest residual", by_largest_residual(problem, d, w)},
          {"cosine match", by_cosine(problem, w)},
          {"BIC", by_bic(problem, d.which)},
          {"history matching", by_implausibility(problem, d.which)}};
}

} // namespace calendem
