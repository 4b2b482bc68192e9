// SPDX-License-Identifier: GPL-2.0-or-later
// The command line `calendem`.
#include "base/messages.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "commands/program.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <string>
#include <unistd.h>

namespace {

struct Verb {
  void (*add)(CLI::App &);
  const char *group; ///< heading in the help; empty: not shown
};
const Verb kVerbs[] = {
    {calendem::add_pack_verb, "Electrodes"},     {calendem::add_dry_verb, "Electrodes"},
    {calendem::add_tomogram_verb, "Electrodes"}, {calendem::add_run_verb, "Runs"},
    {calendem::add_collect_verb, "Runs"},        {calendem::add_measure_verb, "Runs"},
    {calendem::add_report_verb, "Runs"},         {calendem::add_export_verb, "Runs"},
    {calendem::add_study_verb, "Many runs"},     {calendem::add_sample_verb, "Many runs"},
    {calendem::add_press_verb, "Experiments"},   {calendem::add_compare_verb, "Experiments"}};
const Verb kLastVerbs[] = {{calendem::add_effects_verb, "Help"}, {calendem::add_registry_verb, ""}};

void add_verb(CLI::App &app, const Verb &verb) {
  verb.add(app);
  app.get_subcommands([](CLI::App *) { return true; }).back()->group(verb.group);
}

void add_verbs(CLI::App &app) {
  for (const Verb &verb : kVerbs)
    add_verb(app, verb);
  for (const calendem::FilmVerb &verb : calendem::kFilmVerbs)
    app.add_subcommand(verb.name, verb.description)->group(verb.group);
  for (const Verb &verb : kLastVerbs)
    add_verb(app, verb);
}

/// Goes on as the program of that verb; where it was not built, throws Failure(2).
void hand_over(char **argv) {
  const std::string program = calendem::program_beside(calendem::kFilmProgram);
  execv(program.c_str(), argv);
  throw calendem::Failure(calendem::kBadInput,
                          "calendem {}: {} is not there. tools/build makes it, in a few minutes.",
                          argv[1], program);
}

int run(int argc, char **argv) {
  const auto is_asked = [&](const calendem::FilmVerb &verb) {
    return argc > 1 && std::string(argv[1]) == verb.name;
  };
  if (std::any_of(std::begin(calendem::kFilmVerbs), std::end(calendem::kFilmVerbs), is_asked))
    hand_over(argv);
  return calendem::run_program(argc, argv, add_verbs);
}

} // namespace

int main(int argc, char **argv) {
  return calendem::exit_status_of([&] { return run(argc, argv); });
}
