// SPDX-License-Identifier: GPL-2.0-or-later
// A whole round on a bank of formulas: sealed, handed out, answered, scored, tampered with.
#include "base/messages.h"
#include "base/random.h"
#include "diagnose/bank/bank_table.h"
#include "diagnose/diagnose.h"
#include "sealed/answer.h"
#include "sealed/make.h"
#include "sealed/score.h"
#include "sealed/sealing.h"
#include "support/test_folder.h"
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>

namespace {

using namespace calendem;
using calendem_test::test_folder;
namespace fs = std::filesystem;

/// Stiffer particles: thicker; friction: another shape of the curve. Each packing has its own
/// thickness.
SimulatedRun run_by_formula(double stiffness, double friction, int packing, double target) {
  SimulatedRun r;
  const double own = 0.02 * std::sin(7.0 * packing);
  r.control = "pressure";
  r.target = r.max_pressure = target;
  r.solid_column = 9.15;
  r.thickness_at_max = 13.0 + 0.6 * stiffness - 0.01 * target + own;
  r.thickness_after = r.thickness_at_max + 1.0 + 0.4 * stiffness;
  r.porosity_at_max = 1.0 - r.solid_column / r.thickness_at_max;
  r.porosity_initial = 0.48;
  r.porosity_after = 1.0 - r.solid_column / r.thickness_after;
  r.cracked_fraction = 0.2;
  for (double p = 0.25; p <= 1.2 * target; p += 0.25) {
    r.pressure.push_back(p);
    r.displacement.push_back((4.0 - stiffness) * std::log(1.0 + p / 5.0) / 2.0 -
                             2.0 * friction * std::exp(-p / 10.0) + own);
  }
  return r;
}

const char *const kBank =
    "[bank]\nrecipe = \"electrode.toml\"\ncase = \"case.toml\"\npressures_MPa = [30, 50]\n"
    "packings = 4\nbase_points = 16\neffect_points = 8\neffects = [\"friction\", "
    "\"thickness_zero\"]\n[[parameter]]\nname = \"E\"\nkeys = "
    "[\"case.material.cbd.youngs_modulus_GPa\"]\nlow = 1\nhigh = 2\n";

/// Bank, round, and what was handed out of four truths.
class SealedRound : public testing::Test {
protected:
  fs::path at_ = test_folder();
  std::string round_ = (at_ / "round").string(), given_ = (at_ / "given/handed_out").string(),
              answers_ = (at_ / "answers").string();

  virtual int samples() const { return 1; }
  virtual std::string kinds() const {
    return "faults = [\"friction\", \"thickness_zero\"]\nopen = [\"displacement_scale\"]\n";
  }

  void SetUp() override {
    std::ofstream(at_ / "electrode.toml")
        << "[coating]\nloading_mg_cm2 = 4\n[cell]\nx_um = 6\ny_um = 6\n"; // 9.15 um of solid
    std::ofstream(at_ / "case.toml") << "electrode = \"any\"\n";
    std::ofstream(at_ / "bank.toml") << kBank;
    std::ofstream(at_ / "round.toml")
        << "[round]\nbank = \"bank.toml\"\nnull_packings = 1\nnull_draws = 2\namplitudes = 0\n"
        << kinds() << fmt::format("samples = {}\n", samples());
    const Round round = read_round((at_ / "round.toml").string());
    write_table(round.bank);
    std::vector<PressedTruth> pressed;
    for (const Truth &t : draw_truths(round, "secret")) {
      pressed.push_back({t, {}, {}});
      for (const double target : {30.0, 50.0}) {
        pressed.back().shown.push_back(samples_of(t, target));
        if (has_cause(t) || companion(round, t))
          pressed.back().without_cause.push_back(samples_of(without_cause(t), target));
      }
    }
    fs::create_directories(round_ + "/sealed");
    seal_round(round_, round, pressed, "secret");
    fs::create_directories(at_ / "given");
    fs::copy(round_ + "/handed_out", given_, fs::copy_options::recursive);
  }

  PressedSamples samples_of(const Truth &t, double target) const {
    PressedSamples out(std::size_t(samples()), shown_of(t, target));
    for (std::size_t k = 0; k < out.size() && samples() > 1 && has_cause(t); ++k) {
      const double chance = k % 2 == 0 ? 0.3 : -0.3;
      out[k].thickness_at_max += chance;
      out[k].thickness_after += chance;
    }
    return out;
  }

  static SimulatedRun shown_of(const Truth &t, double target) {
    double friction = 0.0;
    for (const auto &[name, value] : t.effects)
      friction += name == "friction" ? value : 0.0;
    SimulatedRun run = run_by_formula(t.base[0] - 1.0, friction, 9, target);
    for (const auto &[name, value] : t.effects)
      if (find_effect(name).instrument)
        run = shown_with(find_effect(name), value, run);
    run.release_pressure = run.pressure;
    run.release_displacement = run.displacement;
    return run;
  }

  void write_table(const BankSpec &spec) const {
    BankTable table = {spec, {}};
    for (const BankPoint &p : bank_points(spec))
      for (const double target : spec.pressures)
        table.rows.push_back({p, run_by_formula(p.base[0] - 1.0, p.effect.empty() ? 0.0 : p.value,
                                                p.packing, target)});
    std::ofstream(at_ / "bank.csv") << write_bank_table(table);
  }

  void answer() const {
    AnswerOptions o;
    o.handed_out = given_;
    o.folder = answers_;
    o.bank = (at_ / "bank.toml").string();
    o.table = (at_ / "bank.csv").string();
    answer_round(o);
  }

  int status_of_opening() const {
    try {
      open_round(round_, answers_);
      return kDone;
    } catch (const Failure &e) {
      return e.exit_status();
    }
  }

  std::string pair_of_one() const {
    return fs::directory_iterator(round_ + "/sealed/without_cause")->path().string();
  }

  static void change(const std::string &file) {
    std::string text = bytes_of(file);
    text.replace(text.find_last_of("0123456789"), 1, "_");
    std::ofstream(file) << text;
  }
};

TEST_F(SealedRound, EffectsAreFoundAndAllHashesHold) {
  answer();
  for (const ScoredCase &c : open_round(round_, answers_)) {
    if (c.block == "fault") {
      EXPECT_EQ(c.claim, c.truth);
    }
    EXPECT_EQ(c.baselines.at("always none"), "none");
  }
  const fs::path gap = answers_ + "/001/gap.json";
  const auto before = fs::last_write_time(gap);
  answer(); // what was answered is not answered again
  EXPECT_EQ(fs::last_write_time(gap), before);
}

// Far beyond noise, the places that the diagnosis reports are the true ones: those of what
// recalibration leaves, here of a thickness zero in the curve too, since stiffness takes up a part.
TEST_F(SealedRound, TheKeepersPairsShowHowLargeAGapIsAndWhere) {
  answer();
  std::vector<ScoredCase> cases = open_round(round_, answers_);
  const std::string bank = (at_ / "bank.toml").string(), table = (at_ / "bank.csv").string();
  add_true_gaps(round_, answers_, bank, table, cases);
  int strong = 0;
  for (const ScoredCase &c : cases) {
    EXPECT_EQ(c.paired, c.block != "null");
    if (c.block != "fault")
      continue;
    ++strong;
    EXPECT_GT(c.signal_to_noise, kStrongEnough);
    EXPECT_EQ(c.true_places, c.places) << c.truth;
    EXPECT_TRUE(c.true_places.count("p50|compression|displacement"));
    EXPECT_EQ(c.true_places.count("p50|compression|thickness"), c.truth == "thickness_zero");
  }
  EXPECT_EQ(strong, 2);
  std::ofstream(table, std::ios::app) << "\n";
  EXPECT_THROW(add_true_gaps(round_, answers_, bank, table, cases), Failure);
}

// Differences of runs that a cause did not make: 8 features, sd 1 each. Their length is about 2.8
// whatever the cause; its expected square is the number of features too large.
TEST(TrueGap, ChanceBetweenTwoRunsIsNoSignal) {
  constexpr int kFeatures = 8, kDraws = 4000;
  for (const double signal : {0.0, 3.0})
    for (const int samples : {2, 4}) {
      double square = 0.0;
      int visible = 0, other = 0;
      for (int d = 0; d < kDraws; ++d) {
        Random random(std::uint64_t(d), 77);
        inference::Matrix each(kFeatures, samples);
        for (double &v : each.reshaped())
          v = random.normal();
        each.row(0).array() += signal;
        double common = 0.0;
        for (int i = 0; i < samples; ++i)
          for (int j = 0; j < i; ++j)
            common += each.col(i).dot(each.col(j)) / (0.5 * samples * (samples - 1));
        const double length = common_length(each);
        square += common / kDraws;
        visible += length >= kVisible;
        other += std::fabs(length * length - std::max(0.0, common)) > 1e-9;
      }
      EXPECT_EQ(other, 0) << samples;
      // variance of d_1 . d_2 about s^2: n + 2 s^2; more samples lessen it
      const double sd = std::sqrt((kFeatures + 2.0 * signal * signal) / kDraws);
      EXPECT_NEAR(square, signal * signal, 3.0 * sd) << samples;
      if (signal == 0.0) {
        EXPECT_LT(visible, 0.02 * kDraws) << samples;
      }
    }
  EXPECT_DOUBLE_EQ(common_length(inference::Matrix::Constant(1, 1, -5.0)), 5.0);
}

/// Every truth of two samples, which chance makes 0.3 um thicker or thinner where a cause is on.
class SealedInTwo : public SealedRound {
protected:
  int samples() const override { return 2; }
};

TEST_F(SealedInTwo, TheSignalIsWhatTheSamplesHaveInCommon) {
  answer();
  std::vector<ScoredCase> cases = open_round(round_, answers_);
  add_true_gaps(round_, answers_, (at_ / "bank.toml").string(), (at_ / "bank.csv").string(), cases);
  std::vector<ScoredCase> by_mean = cases;
  fs::rename(round_ + "/sealed/samples", round_ + "/samples");
  add_true_gaps(round_, answers_, (at_ / "bank.toml").string(), (at_ / "bank.csv").string(),
                by_mean);
  fs::rename(round_ + "/samples", round_ + "/sealed/samples");
  for (std::size_t k = 0; k < cases.size(); ++k)
    if (cases[k].block == "fault") { // s + c and s - c have less in common than their mean, s
      EXPECT_GT(cases[k].signal_to_noise, kStrongEnough);
      EXPECT_LT(cases[k].signal_to_noise, by_mean[k].signal_to_noise);
      EXPECT_EQ(cases[k].true_places, by_mean[k].true_places);
    }
  const std::string sample = fs::directory_iterator(round_ + "/sealed/samples")->path().string();
  change(sample + "/1_without/experiment.toml");
  EXPECT_EQ(status_of_opening(), kCheckFailed);
}

/// Beside two samples without a cause experiments before and after a change, or none.
class SealedChanges : public SealedRound {
protected:
  std::string kinds() const override {
    return "interventions = [\"friction\", \"nothing\", \"thickness_zero\"]\n";
  }

  std::string one_of_them() const {
    for (const auto &entry : fs::directory_iterator(round_ + "/handed_out"))
      if (is_intervention(entry.path().string()))
        return entry.path().filename().string();
    return "";
  }
};

TEST_F(SealedChanges, WhatChangedBetweenTwoExperimentsIsFound) {
  answer();
  const std::vector<ScoredCase> cases = open_round(round_, answers_);
  int changes = 0;
  for (const ScoredCase &c : cases) {
    if (c.block != kIntervention)
      continue;
    ++changes;
    EXPECT_EQ(c.claim, c.truth) << c.id;
    EXPECT_EQ(c.covered_amplitude.empty(), c.truth == "none");
    EXPECT_EQ(nlohmann::json::parse(bytes_of(answers_ + "/" + c.id + "/gap.json"))["change_from"],
              "case " + c.id + ", before");
  }
  EXPECT_EQ(changes, 3);
  for (const Metric &m : metrics_of(cases))
    if (m.name == "intervention: claimed right where something changed") {
      EXPECT_EQ(m.cases, 2);
      EXPECT_EQ(m.value, 1.0);
    }
}

TEST_F(SealedChanges, BothExperimentsAreSealed) {
  answer();
  EXPECT_EQ(status_of_opening(), kDone);
  const std::string of_round = round_ + "/handed_out/" + one_of_them();
  for (const char *file : {"/before/p30.csv", "/after/experiment.toml"}) {
    const std::string good = bytes_of(of_round + file);
    change(of_round + file);
    EXPECT_EQ(status_of_opening(), kCheckFailed) << file;
    std::ofstream(of_round + file) << good;
  }
  std::ofstream(given_ + "/" + one_of_them() + "/more.toml") << "a = 1\n";
  EXPECT_THROW(answer(), Failure);
}

// Learning takes most of the time of a diagnosis; it depends on no measured value.
TEST_F(SealedRound, CasesOfOneLayoutShareWhatIsLearnt) {
  const BankTable table =
      read_bank_table(read_bank_spec((at_ / "bank.toml").string()), (at_ / "bank.csv").string());
  SharedModels models;
  const auto model_of = [&](const std::string &id, const BankTable &bank) {
    const Experiment e = read_experiment(given_ + "/" + id + "/experiment.toml");
    return models.of(data_of(e, bank, {}), {});
  };
  EXPECT_EQ(model_of("001", table), model_of("002", table));
  EXPECT_NE(model_of("001", table), model_of("001", without_effects(table, {"friction"})));
}

TEST_F(SealedRound, ChangedTruthsAndAnswersAreNotScored) {
  answer();
  EXPECT_EQ(status_of_opening(), kDone);
  for (const std::string &file :
       {answers_ + "/002/gap.json", answers_ + "/002/baselines.json",
        round_ + "/handed_out/003/p30.csv", round_ + "/handed_out/commitment.json",
        pair_of_one() + "/p30.csv"}) {
    const std::string good = bytes_of(file);
    change(file);
    EXPECT_EQ(status_of_opening(), kCheckFailed) << file;
    std::ofstream(file) << good;
  }
  const std::string file = round_ + "/sealed/truth.json";
  nlohmann::json sealed = nlohmann::json::parse(bytes_of(file));
  sealed["cases"][1]["truth"]["answer"] = "none of this";
  std::ofstream(file) << sealed.dump();
  EXPECT_EQ(status_of_opening(), kCheckFailed);
}

TEST_F(SealedRound, WhatIsHandedOutRevealsNoTruth) {
  const nlohmann::json sealed = nlohmann::json::parse(bytes_of(round_ + "/sealed/truth.json"));
  std::vector<std::string> secrets = {"secret", "sealed", "null", "open", "fault", "unknown"};
  for (const Effect &e : effects())
    secrets.push_back(e.name);
  for (const auto &one : sealed.at("cases")) {
    secrets.push_back(one.at("salt"));
    for (const auto &seed : one.at("truth").at("packing_seeds"))
      secrets.push_back(seed.dump());
    secrets.push_back(one.at("truth").at("handed_out_sha256"));
    for (const auto &name : one.at("truth").at("hidden"))
      secrets.push_back(name);
  }
  int files = 0;
  for (const auto &entry : fs::recursive_directory_iterator(given_)) {
    if (!entry.is_regular_file())
      continue;
    const std::string text =
        entry.path().string().substr(given_.size()) + "\n" + bytes_of(entry.path().string());
    for (const std::string &word : secrets)
      EXPECT_EQ(text.find(word), std::string::npos) << word << " in " << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 1 + 5 * 4); // commitment; experiment, recipe, two curves of each case
}

TEST_F(SealedRound, TruthsWithinReachAreRefused) {
  EXPECT_NO_THROW(check_handed_out(given_));
  EXPECT_THROW(check_handed_out(round_ + "/handed_out"), Failure); // sealed lies beside it
  EXPECT_THROW(check_handed_out(round_), Failure);
  std::ofstream(given_ + "/001/truth.json") << "{}";
  EXPECT_THROW(check_handed_out(given_), Failure);
  fs::remove(given_ + "/001/truth.json");
  fs::create_symlink(round_, given_ + "/more");
  EXPECT_THROW(check_handed_out(given_), Failure);
}

TEST_F(SealedRound, AnExperimentThatLeadsElsewhereIsRefused) {
  std::ofstream(given_ + "/001/experiment.toml")
      << "[experiment]\nname = \"x\"\nelectrode = \"../../../electrode.toml\"\n[[condition]]\nid = "
         "\"a\"\ncontrol = \"pressure\"\nmax_pressure_MPa = 30\n";
  try {
    answer();
    FAIL();
  } catch (const Failure &e) {
    EXPECT_NE(std::string(e.what()).find("not in its folder"), std::string::npos) << e.what();
  }
}

} // namespace
