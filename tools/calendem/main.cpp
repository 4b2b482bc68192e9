// SPDX-License-Identifier: GPL-2.0-or-later
// The command line. Exit status: 0 done, 1 usage, 2 bad input, 3 the simulation failed, 4 a check
// did not hold.
#include "base/messages.h"
#include "base/provenance.h"
#include "base/registry.h"
#include "commands/commands.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fmt/core.h>
#include <string>
#include <vector>

namespace {

struct Verb {
  void (*add)(CLI::App &);
  const char *group; ///< heading in the help; empty: not shown
};
const Verb kVerbs[] = {
    {calendem::add_pack_verb, "Electrodes"},       {calendem::add_dry_verb, "Electrodes"},
    {calendem::add_tomogram_verb, "Electrodes"},   {calendem::add_run_verb, "Runs"},
    {calendem::add_collect_verb, "Runs"},          {calendem::add_measure_verb, "Runs"},
    {calendem::add_report_verb, "Runs"},           {calendem::add_export_verb, "Runs"},
    {calendem::add_study_verb, "Many runs"},       {calendem::add_sample_verb, "Many runs"},
    {calendem::add_bank_verb, "Many runs"},        {calendem::add_press_verb, "Experiments"},
    {calendem::add_compare_verb, "Experiments"},   {calendem::add_diagnose_verb, "Experiments"},
    {calendem::add_calibrate_verb, "Predictions"}, {calendem::add_predict_verb, "Predictions"},
    {calendem::add_design_verb, "Predictions"},    {calendem::add_validate_verb, "Help"},
    {calendem::add_effects_verb, "Help"},          {calendem::add_registry_verb, ""}};

void add_verbs(CLI::App &app) {
  app.require_subcommand(1);
  app.set_version_flag("--version", calendem::version());
  app.footer(
      fmt::format("calendem VERB --help lists the options of a verb, and the keys of its file.\n"
                  "Examples to copy: {}/cases\n"
                  "Exit status: 0 done, 1 usage, 2 bad input, 3 the simulation failed, 4 a "
                  "check failed.",
                  calendem::input_scripts()));
  for (const Verb &verb : kVerbs) {
    verb.add(app);
    app.get_subcommands([](CLI::App *) { return true; }).back()->group(verb.group);
  }
}

/// What is wrong where the first word is no verb and no option; empty: nothing.
std::string wrong_verb(const CLI::App &app, int argc, char **argv) {
  if (argc < 2)
    return app.help();
  const std::string word = argv[1];
  std::vector<std::string> names;
  for (const CLI::App *verb : app.get_subcommands([](const CLI::App *) { return true; }))
    names.push_back(verb->get_name());
  if (word.empty() || word[0] == '-' || std::find(names.begin(), names.end(), word) != names.end())
    return "";
  return fmt::format("there is no verb '{}'. Did you mean '{}'? calendem --help lists the verbs.\n",
                     word, calendem::closest(word, names));
}

/// The work of a verb, and the exit status. What goes wrong in it is thrown.
int run(int argc, char **argv) {
  CLI::App app{"Calendering of battery electrodes: make an electrode, press it, compare it with "
               "measurements, predict others.",
               "calendem"};
  add_verbs(app);
  if (const std::string wrong = wrong_verb(app, argc, argv); !wrong.empty()) {
    fmt::print(stderr, "{}", wrong);
    return calendem::kUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError &e) { // or what --help asks for
    return app.exit(e) == 0 ? calendem::kDone : calendem::kUsage;
  }
  return calendem::kDone;
}

} // namespace

int main(int argc, char **argv) {
  return calendem::exit_status_of([&] { return run(argc, argv); });
}
