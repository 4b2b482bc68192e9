// SPDX-License-Identifier: GPL-2.0-or-later
#include "withheld/make.h"
#include "base/child.h"
#include "base/job_pool.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/random.h"
#include "simulate/study.h"
#include "withheld/sealing.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
namespace fs = std::filesystem;
namespace {

/// One noise draw of one truth.
struct Case {
  int truth = 0, draw = 0;
};

/// The secret of the folder; made at the first call.
std::string secret_of(const MakeOptions &o) {
  const std::string file = o.folder + "/sealed/secret";
  const std::string wanted = o.seed ? fmt::format("not sealed: {}", *o.seed) : "";
  if (fs::exists(file)) {
    const std::string there = bytes_of(file);
    if (o.seed && there != wanted)
      throw Failure(kBadInput, fmt::format("{} holds another secret than --seed {}. Take another "
                                           "folder.",
                                           file, *o.seed));
    return there;
  }
  const std::string secret = o.seed ? wanted : random_secret();
  write_file(file, secret);
  return secret;
}

void run_truths(const Study &study, const StudyOptions &options) {
  try {
    make_study(study, options);
  } catch (const Failure &f) {
    if (f.exit_status() == kBadInput || stop_requested() != 0)
      throw;
    fmt::print("withheld: {}\nTruths with such runs are left out.\n", f.what());
  }
}

/// What the press shows of each truth; empty where a run is not usable.
std::vector<std::vector<PressedSamples>> shown_runs(const std::vector<std::string> &folders,
                                                    std::size_t samples, std::size_t pressures) {
  const std::size_t runs = samples * pressures; // of a truth
  std::vector<std::vector<PressedSamples>> out(folders.size() / runs);
  for (std::size_t t = 0; t < out.size(); ++t) {
    const auto first = folders.begin() + std::ptrdiff_t(t * runs);
    if (std::find(first, first + std::ptrdiff_t(runs), "") != first + std::ptrdiff_t(runs))
      continue;
    out[t].resize(pressures);
    for (std::size_t k = 0; k < runs; ++k)
      out[t][k % pressures].push_back(read_simulated_run(first[std::ptrdiff_t(k)]));
  }
  return out;
}

/// In an order that tells nothing (Fisher and Yates).
std::vector<Case> shuffled_cases(const std::vector<Truth> &truths,
                                 const std::vector<std::vector<PressedSamples>> &shown,
                                 const std::string &secret) {
  std::vector<Case> cases;
  for (std::size_t t = 0; t < truths.size(); ++t)
    for (int d = 0; d < truths[t].draws && !shown[t].empty(); ++d)
      cases.push_back({int(t), d});
  Random random(derived_seed(secret, "order"), 0);
  for (std::size_t k = cases.size(); k > 1; --k)
    std::swap(cases[k - 1], cases[std::size_t(random.uniform() * double(k))]);
  return cases;
}

} // namespace

void seal_round(const std::string &folder, const Round &round, const std::vector<Truth> &truths,
                const std::vector<std::vector<PressedSamples>> &shown, const std::string &secret) {
  const std::vector<Case> cases = shuffled_cases(truths, shown, secret);
  if (cases.empty())
    throw Failure(kSimulationFailed, "withheld: no truth has all its runs; see sealed/study/runs.");
  nlohmann::json sealed = {{"round", round.name}, {"cases", nlohmann::json::array()}};
  nlohmann::json open = {{"commitment", "SHA-256 of a salt, a line's end and the truth"},
                         {"calendem", version()},
                         {"cases", nlohmann::json::object()}};
  fs::remove_all(folder + "/handed_out");
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const Truth &truth = truths[std::size_t(cases[k].truth)];
    const std::string id = fmt::format("{:03}", k + 1), here = folder + "/handed_out/" + id;
    hand_out(here, id, round, truth, shown[std::size_t(cases[k].truth)],
             derived_seed(secret, "noise of " + id));
    nlohmann::json t = to_json(truth, round.bank);
    t["id"] = id;
    t["point"] = cases[k].truth;
    t["noise_draw"] = cases[k].draw;
    t["handed_out_sha256"] = sha256_of_files(here);
    const std::string salt = derived(secret, "salt of " + id);
    sealed["cases"].push_back({{"salt", salt}, {"truth", t}});
    open["cases"][id] = commitment(salt, t);
  }
  write_file(folder + "/sealed/truth.json", sealed.dump(1) + "\n");
  write_file(folder + "/handed_out/commitment.json", open.dump(1) + "\n");
  fmt::print("withheld: {0} cases of {1} truths, {2}/handed_out\nNext: copy handed_out away from "
             "sealed, then calendem withheld answer COPY -o ANSWERS\n",
             cases.size(),
             std::count_if(shown.begin(), shown.end(), [](const auto &s) { return !s.empty(); }),
             folder);
}

void make_round(const MakeOptions &given) {
  MakeOptions o = given;
  o.folder = fs::absolute(o.folder).lexically_normal().string();
  const Round round = read_round(o.round_file);
  if (const Recipe r = read_recipe(round.bank.recipe_file); r.shapes.given() || r.structure.given())
    throw Failure(kBadInput,
                  fmt::format("{} takes shapes or a structure from other files, which "
                              "would be handed out too. Give a recipe that stands alone.",
                              round.bank.recipe_file));
  make_output_folder(o.folder);
  fs::create_directories(o.folder + "/sealed");
  fs::permissions(o.folder + "/sealed", fs::perms::owner_all);
  const std::string secret = secret_of(o);
  const std::vector<Truth> truths = draw_truths(round, secret);
  const Study study = truth_study(round, truths);
  StudyOptions options;
  options.folder = o.folder + "/sealed/study";
  options.liggghts = o.liggghts;
  options.jobs = o.jobs;
  run_truths(study, options);
  const auto shown = shown_runs(finished_runs(study, options), std::size_t(round.samples),
                                round.bank.pressures.size());
  seal_round(o.folder, round, truths, shown, secret);
}

} // namespace calendem
