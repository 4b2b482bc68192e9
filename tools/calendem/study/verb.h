// SPDX-License-Identifier: GPL-2.0-or-later
// calendem study STUDY.toml -o DIR [--jobs N] [--ranks N] [--only N] [--table] [--slurm]
#ifndef CALENDEM_STUDY_VERB_H
#define CALENDEM_STUDY_VERB_H

namespace CLI {
class App;
}

namespace calendem {
struct StudyOptions;
void add_study_verb(CLI::App &app);
/// The options of all verbs that make a study. `options` must outlive `verb`.
void add_study_options(CLI::App &verb, StudyOptions &options);
} // namespace calendem

#endif
