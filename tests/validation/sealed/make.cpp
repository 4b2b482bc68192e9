// SPDX-License-Identifier: GPL-2.0-or-later
#include "sealed/make.h"
#include "base/liggghts_job.h"
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "base/random.h"
#include "sealed/round_file.h"
#include "sealed/sealing.h"
#include "simulate/study.h"
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

/// What the press shows of each truth, whose runs follow each other in `folders`; empty where one is not usable.
std::vector<std::vector<PressedSamples>> shown_runs(const std::vector<std::string> &folders,
                                                    const Round &round,
                                                    const std::vector<Truth> &truths) {
  const std::size_t pressures = round.bank.pressures.size();
  std::vector<std::vector<PressedSamples>> out(truths.size());
  auto first = folders.begin(), end = first;
  for (std::size_t t = 0; t < out.size(); ++t) {
    const std::size_t runs = runs_of(round, truths[t]),
                      of_repeat = runs / std::size_t(round.repeats);
    first = end;
    end += std::ptrdiff_t(runs);
    if (std::find(first, end, "") != end)
      continue;
    out[t].resize(pressures * std::size_t(round.repeats));
    for (std::size_t k = 0; k < runs; ++k)
      out[t][k / of_repeat * pressures + k % pressures].push_back(
          read_simulated_run(first[std::ptrdiff_t(k)]));
  }
  return out;
}

bool usable(const PressedTruth &t) {
  return !t.shown.empty() && (t.truth.block != kIntervention || !t.without_cause.empty());
}

/// In an order that reveals nothing (Fisher and Yates).
std::vector<Case> shuffled_cases(const std::vector<PressedTruth> &truths,
                                 const std::string &secret) {
  std::vector<Case> cases;
  for (std::size_t t = 0; t < truths.size(); ++t)
    for (int d = 0; d < truths[t].truth.draws && usable(truths[t]); ++d)
      cases.push_back({int(t), d});
  Random random(derived_seed(secret, "order"), 0);
  for (std::size_t k = cases.size(); k > 1; --k)
    std::swap(cases[k - 1], cases[std::size_t(random.uniform() * double(k))]);
  return cases;
}

/// Area of the truth's own cell [um2].
double area_of(const Round &round, const Truth &truth) {
  double area = read_recipe(round.bank.recipe_file).area();
  for (const std::string &name : truth.hidden)
    for (const ChangedKey &c : find_hidden(name)->keys)
      if (c.key == "recipe.cell.x_um" || c.key == "recipe.cell.y_um")
        area *= c.factor;
  return area;
}

/// Each sample's own experiments with the cause and without it, as if they were the whole case. The
/// samples of all repeats count: what chance does in one, it does not in another.
void seal_samples(const std::string &folder, const std::string &id, const Round &round,
                  const PressedTruth &pressed, std::uint64_t noise) {
  const std::size_t samples = std::size_t(pressed.truth.samples),
                    pressures = round.bank.pressures.size();
  for (std::size_t k = 0; k < samples * std::size_t(round.repeats); ++k)
    for (const bool with : {true, false}) {
      const std::vector<PressedSamples> &all = with ? pressed.shown : pressed.without_cause;
      std::vector<PressedSamples> one;
      for (std::size_t p = 0; p < pressures; ++p)
        one.push_back({all[k / samples * pressures + p][k % samples]});
      hand_out(fmt::format("{}/{}{}", folder, k, with ? "" : "_without"), id, round,
               with ? pressed.truth : without_cause(pressed.truth), one, noise);
    }
}

/// Two experiments with errors of their own; the press, with its error of pressure, is one.
void hand_out_intervention(const std::string &folder, const std::string &id, const Round &round,
                           const PressedTruth &pressed, const std::string &secret) {
  hand_out(folder + "/before", id + ", before", round, without_cause(pressed.truth),
           pressed.without_cause, derived_seed(secret, "noise before " + id));
  hand_out(folder + "/after", id + ", after", round, pressed.truth, pressed.shown,
           derived_seed(secret, "noise of " + id));
}

} // namespace

void seal_round(const std::string &folder, const Round &round,
                const std::vector<PressedTruth> &truths, const std::string &secret) {
  const std::vector<Case> cases = shuffled_cases(truths, secret);
  if (cases.empty())
    throw Failure(kSimulationFailed, "sealed: no truth has all its runs; see sealed/study/runs.");
  nlohmann::json sealed = {{"round", round.name}, {"cases", nlohmann::json::array()}};
  nlohmann::json open = {{"commitment", "SHA-256 of a salt, a line's end and the truth"},
                         {"calendem", version()},
                         {"cases", nlohmann::json::object()}};
  const std::string without = folder + "/sealed/without_cause/",
                    samples = folder + "/sealed/samples/";
  for (const std::string &old : {folder + "/handed_out", without, samples})
    fs::remove_all(old);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const PressedTruth &pressed = truths[std::size_t(cases[k].truth)];
    const std::string id = fmt::format("{:03}", k + 1),
                      here = fmt::format("{}/handed_out/{}", folder, id);
    const std::uint64_t noise = derived_seed(secret, "noise of " + id);
    const bool intervention = pressed.truth.block == kIntervention;
    if (intervention)
      hand_out_intervention(here, id, round, pressed, secret);
    else
      hand_out(here, id, round, pressed.truth, pressed.shown, noise);
    nlohmann::json t = to_json(pressed.truth, round.bank);
    if (!intervention && !pressed.without_cause.empty()) {
      hand_out(without + id, id, round, without_cause(pressed.truth), pressed.without_cause, noise);
      t["without_cause_sha256"] = sha256_of_files(without + id);
      if (pressed.truth.samples * round.repeats > 1) {
        seal_samples(samples + id, id, round, pressed, noise);
        t["samples_sha256"] = sha256_of_samples(samples + id);
      }
    }
    t["id"] = id;
    t["point"] = pressed.truth.set;
    t["noise_draw"] = cases[k].draw;
    t["handed_out_sha256"] = sha256_of_case(here);
    const std::string salt = derived(secret, "salt of " + id);
    sealed["cases"].push_back({{"salt", salt}, {"truth", t}});
    open["cases"][id] = commitment(salt, t);
  }
  write_file(folder + "/sealed/truth.json", sealed.dump(1) + "\n");
  write_file(folder + "/handed_out/commitment.json", open.dump(1) + "\n");
  fmt::print("sealed: {0} cases of {1} truths, {2}/handed_out\nNext: copy handed_out away from "
             "sealed, then sealed answer COPY -o ANSWERS\n",
             cases.size(), std::count_if(truths.begin(), truths.end(), usable), folder);
}

void hand_out(const std::string &folder, const std::string &id, const Round &round,
              const Truth &truth, const std::vector<PressedSamples> &shown, std::uint64_t seed) {
  MeasuredSpecimens s;
  s.id = id;
  s.recipe_file = round.bank.recipe_file;
  s.pressures = round.bank.pressures;
  s.packings = truth.samples;
  s.area = truth.samples * area_of(round, truth);
  s.repeats = round.repeats;
  s.disc_for_each_pressure = round.disc_for_each_pressure;
  s.noise = round.noise;
  s.understated = truth.understated;
  s.press.pressure = truth.pressure_error;
  for (const std::string &name : truth.hidden) {
    const PressErrors &h = find_hidden(name)->press;
    s.press.displacement_factor *= h.displacement_factor;
    s.press.pressure_offset_MPa += h.pressure_offset_MPa;
    s.press.release_shift_um += h.release_shift_um;
    s.press.drift_um += h.drift_um;
  }
  write_measured(folder, s, shown, seed);
}

std::string calendem_beside() {
  return (fs::path(this_program()).parent_path() / "calendem").string();
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
  const FolderLock lock(o.folder);
  fs::create_directories(o.folder + "/sealed");
  fs::permissions(o.folder + "/sealed", fs::perms::owner_all);
  const std::string secret = secret_of(o);
  const std::vector<Truth> truths = truths_of_sets(round, secret, o.sets);
  const std::vector<Truth> all = with_pairs(round, truths);
  const TruthRuns runs = truth_runs(round, all);
  fmt::print("sealed: {} truths, with what is run beside them {}; {} runs, {} for each pressure\n",
             truths.size(), all.size(), runs.study.runs.size(),
             runs.study.runs.size() / round.bank.pressures.size());
  StudyOptions options;
  options.folder = o.folder + "/sealed/study";
  options.calendem = calendem_beside();
  options.liggghts = o.liggghts;
  options.jobs = o.jobs;
  const std::vector<std::string> made = make_what_runs(runs.study, options, "Truths");
  std::vector<std::string> folders;
  for (const std::size_t k : runs.of_truths)
    folders.push_back(made[k]);
  const auto shown = shown_runs(folders, round, all);
  std::vector<PressedTruth> pressed;
  auto pair = shown.begin() + std::ptrdiff_t(truths.size());
  for (std::size_t k = 0; k < truths.size(); ++k) {
    pressed.push_back({truths[k], shown[k], {}});
    if (companion(round, truths[k]))
      pressed.back().without_cause = *pair++;
  }
  seal_round(o.folder, round, pressed, secret);
}

} // namespace calendem
