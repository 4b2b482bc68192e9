// SPDX-License-Identifier: GPL-2.0-or-later
// The sealed test of the diagnosis as a program: sealed make | answer | score.
#include "base/messages.h"
#include "base/provenance.h"
#include "sealed/answer.h"
#include "sealed/make.h"
#include "sealed/score.h"
#include <CLI/CLI.hpp>
#include <filesystem>

namespace calendem {
namespace {

void add_make(CLI::App &app) {
  auto o = std::make_shared<MakeOptions>();
  o->liggghts = liggghts_program();
  CLI::App *verb = app.add_subcommand("make", "Draw truths, run them, seal them, hand out what a "
                                              "laboratory would measure");
  verb->add_option("ROUND", o->round_file, "round (TOML)")->required();
  verb->add_option("-o,--output", o->folder, "folder for sealed/ and handed_out/")->required();
  verb->add_option("--jobs", o->jobs, "runs at a time")->check(CLI::Range(1, 4096));
  verb->add_option(
          "--sets", o->sets,
          "only so many sets of shared samples, which are in random order: a round that is too "
          "long stays a sample of itself; default: all")
      ->check(CLI::Range(1, 1000));
  verb->add_option("--seed", o->seed,
                   "truths that can be drawn again (for tests, not sealed); default: a secret from "
                   "the system, kept in sealed/");
  verb->add_option("--liggghts", o->liggghts, "program with the plugin");
  verb->callback([o] { make_round(*o); });
}

void add_answer(CLI::App &app) {
  auto o = std::make_shared<AnswerOptions>();
  o->liggghts = liggghts_program();
  o->bank = input_scripts() + "/cases/bank/bank.toml";
  CLI::App *verb = app.add_subcommand("answer", "Diagnose every case that was handed out; cannot "
                                                "read truths");
  verb->add_option("HANDED_OUT", o->handed_out, "a copy of handed_out, away from sealed")
      ->required();
  verb->add_option("-o,--output", o->folder, "folder for the answers")->required();
  verb->add_option("--bank", o->bank, "bank (TOML) that the table was made from");
  verb->add_option("--table", o->table,
                   "the bank's table; default: beside the bank, with its name");
  verb->add_option("--jobs", o->jobs, "cases, then runs at a time")->check(CLI::Range(1, 4096));
  verb->add_option("--rerun", o->rerun_packings,
                   "where an effect is claimed, run base model, effect and a placebo again on so "
                   "many new packings; default: nothing is run again")
      ->check(CLI::Range(2, 1000));
  verb->add_option("--liggghts", o->liggghts, "program with the plugin, for --rerun");
  verb->callback([o] {
    if (o->table.empty())
      o->table = std::filesystem::path(o->bank).replace_extension("csv").string();
    answer_round(*o);
  });
}

void add_score(CLI::App &app) {
  auto a = std::make_shared<ScoreOptions>();
  a->bank = input_scripts() + "/cases/bank/bank.toml";
  CLI::App *verb = app.add_subcommand("score", "Open the truths, check all hashes, judge the "
                                               "answers: every gate, met or missed");
  verb->add_option("DIR", a->round, "folder of sealed make")->required();
  verb->add_option("ANSWERS", a->answers, "folder of sealed answer")->required();
  verb->add_option("-o,--output", a->folder, "folder for scores.json, .md and .html")->required();
  verb->add_option("--bank", a->bank, "bank (TOML) with which it was answered");
  verb->add_option("--table", a->table,
                   "the bank's table; default: beside the bank, with its name");
  verb->callback([a] {
    if (a->table.empty())
      a->table = std::filesystem::path(a->bank).replace_extension("csv").string();
    score_round(*a);
  });
}

} // namespace

} // namespace calendem

int main(int argc, char **argv) {
  return calendem::exit_status_of([&]() -> int {
    CLI::App app{"Test the diagnosis on cases whose truth it cannot see.", "sealed"};
    app.require_subcommand(1);
    app.footer("make and score are for whoever keeps the truths, answer for whoever does not.\n"
               "A round says what is drawn: see tests/validation/sealed/rounds.");
    calendem::add_make(app);
    calendem::add_answer(app);
    calendem::add_score(app);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError &e) { // or what --help asks for
      return app.exit(e) == 0 ? calendem::kDone : calendem::kUsage;
    }
    return calendem::kDone;
  });
}
