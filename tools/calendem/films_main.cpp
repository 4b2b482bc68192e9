// SPDX-License-Identifier: GPL-2.0-or-later
// The program `calendem-films`, as which `calendem` goes on for the verbs that learn from a bank of films.
#include "commands/program.h"
#include "film_commands/film_commands.h"
#include <CLI/CLI.hpp>
#include <map>

namespace {

void add_verbs(CLI::App &app) {
  static const std::map<std::string, void (*)(CLI::App &)> kSetUp = {
      {"bank", calendem::set_up_bank},           {"diagnose", calendem::set_up_diagnose},
      {"calibrate", calendem::set_up_calibrate}, {"predict", calendem::set_up_predict},
      {"design", calendem::set_up_design},       {"validate", calendem::set_up_validate}};
  for (const calendem::FilmVerb &verb : calendem::kFilmVerbs)
    kSetUp.at(verb.name)(*app.add_subcommand(verb.name, verb.description)->group(verb.group));
}

} // namespace

int main(int argc, char **argv) { return calendem::run_program(argc, argv, add_verbs); }
