// SPDX-License-Identifier: GPL-2.0-or-later
// The verbs of the command line: each adds its options to the program and does its work when it is
// parsed; what goes wrong is thrown as Failure (base/messages.h) with the exit status. And the files
// made from the rows of the registry: parts of the input scripts, so that plain LIGGGHTS can run
// them, and pages of docs/reference.
#ifndef CALENDEM_COMMANDS_COMMANDS_H
#define CALENDEM_COMMANDS_COMMANDS_H

#include <string>
#include <vector>

namespace CLI {
class App;
class Validator;
} // namespace CLI

namespace calendem {

struct StudyOptions;

void add_pack_verb(CLI::App &app);     ///< pack SPEC.toml -o DIR [--seed N] [--ranks N] [--force]
void add_dry_verb(CLI::App &app);      ///< dry SPEC.toml -o DIR
void add_tomogram_verb(CLI::App &app); ///< tomogram SPEC.toml -o FILE.mhd
void add_run_verb(CLI::App &app);      ///< run CASE.toml -o DIR [--ranks N] [--resume]
void add_collect_verb(CLI::App &app);  ///< collect DIR: of what plain input scripts left there
void add_study_verb(CLI::App &app);    ///< study STUDY.toml -o DIR [--jobs N] [--slurm] ...
void add_measure_verb(CLI::App &app);  ///< measure DIR|IMAGE -o OUT
void add_sample_verb(CLI::App &app);   ///< sample DIR... --one gap|pressure -o DIR
void add_press_verb(CLI::App &app);    ///< press RAW.csv... -o CURVE.csv --diameter-mm D
void add_report_verb(CLI::App &app);   ///< report DIR... [-o FILE.html]
void add_export_verb(CLI::App &app);   ///< export RUN [--bpx FILE] [--lammps FILE] [--phases FILE]
void add_compare_verb(CLI::App &app);  ///< compare EXPERIMENT.toml DIR... -o DIR
void add_effects_verb(CLI::App &app);  ///< effects [NAME] [--json]
void add_registry_verb(CLI::App &app); ///< registry DIR [--check]

/// A finite number from `low` to `high`; CLI11's own check of a range lets NaN through.
CLI::Validator finite_range(double low, double high, const std::string &unit = "");

/// The options of all verbs that make a study. `options` must outlive `verb`.
void add_study_options(CLI::App &verb, StudyOptions &options);

struct GeneratedFile {
  std::string path; ///< from the repository's top
  std::string text;
};

/// `top`: of the repository, whose pages have text that is written by hand around what is made.
std::vector<GeneratedFile> generated_files(const std::string &top);
std::vector<GeneratedFile> reference_pages(const std::string &top);

} // namespace calendem

#endif
