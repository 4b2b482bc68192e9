// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"
#include "commands/commands.h"
#include "withheld/answer.h"
#include "withheld/make.h"
#include "withheld/rehearsal.h"
#include "withheld/score.h"
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
  verb->add_option("DIR", a->round, "folder of calendem withheld make")->required();
  verb->add_option("ANSWERS", a->answers, "folder of calendem withheld answer")->required();
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

void add_rehearse(CLI::App &app) {
  auto o = std::make_shared<RehearsalOptions>();
  o->bank = input_scripts() + "/cases/bank/bank.toml";
  CLI::App *verb = app.add_subcommand("rehearse", "How well a bank can diagnose: each packing left "
                                                  "out in turn, its runs taken for samples");
  verb->add_option("-o,--output", o->folder, "folder for rehearsal.csv and the samples")
      ->required();
  verb->add_option("--bank", o->bank, "bank (TOML) that the table was made from");
  verb->add_option("--table", o->table,
                   "the bank's table; default: beside the bank, with its name");
  verb->add_option("--jobs", o->jobs, "packings or draws at a time")->check(CLI::Range(1, 4096));
  CLI::Option *draws =
      verb->add_option("--drawn", o->draws,
                       "leave nothing out: draw so many samples of the base model and of each "
                       "effect from the bank's predictions, as if its stated errors were exact")
          ->check(CLI::Range(1, 100000));
  verb->add_option("--cells", o->cells,
                   "how many of the bank's cells a drawn sample is as large as; default: one")
      ->check(finite_range(1.0, 1e9))
      ->needs(draws);
  verb->callback([o] {
    if (o->table.empty())
      o->table = std::filesystem::path(o->bank).replace_extension("csv").string();
    rehearse(*o);
  });
}

} // namespace

void add_withheld_verb(CLI::App &app) {
  CLI::App *verb =
      app.add_subcommand("withheld", "Test the diagnosis on cases whose truth it cannot see");
  verb->require_subcommand(1);
  verb->footer("make and score are for whoever keeps the truths, answer for whoever does not;\n"
               "rehearse needs neither, it asks a bank about itself.\n"
               "A round says what is drawn: see input_scripts/cases/withheld/round_2.toml.");
  add_make(*verb);
  add_answer(*verb);
  add_score(*verb);
  add_rehearse(*verb);
}

} // namespace calendem
