// SPDX-License-Identifier: GPL-2.0-or-later
// The tables of a report as JSON: headline figures, the comparison with the paper, facts of a run;
// and the published figures a run is shown beside.
#ifndef CALENDEM_REPORT_TABLES_H
#define CALENDEM_REPORT_TABLES_H

#include "measure/run_directory.h"
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace calendem::report {

/// `value` with `decimals` digits behind the point; a dash when it is not finite.
std::string shown(double value, int decimals);

/// Array of {label, value, unit, text, remark, means, exceeded}: `means` is what the label stands
/// for; `exceeded`: a limit of the model's validity is.
nlohmann::json headline_of(const Run &run);

/// Array of {kind, text}, kind good, bad or none: how the run stands beside Table 1 of the paper,
/// and which limits of its headline are exceeded.
nlohmann::json verdict_of(const Run &run, const nlohmann::json &headline,
                          const nlohmann::json &comparison);

/// {"rows": [{quantity, pressure_MPa, paper, paper_sd, cells: [{run, value, difference, text…}]}]}:
/// one cell per run.
nlohmann::json comparison_of(const std::vector<Run> &runs);

/// The rows of a comparison as lines of text, for a terminal; one column per run.
std::string comparison_text(const nlohmann::json &comparison);

/// Every value in `object`, nested ones with joined names: array of {name, value, unit}. Keys that
/// are in `left_out` are not listed.
nlohmann::json facts_of(const nlohmann::json &object, const std::vector<std::string> &left_out);

/// {name, status, rows: [{name, text, unit, source}]}: what the run's material is, and where each
/// value comes from; null for an electrode that names no material.
nlohmann::json material_table(const Run &run);

struct MeasuredPorosity {
  double pressure_MPa;
  double porosity_percent; ///< total, after relaxation
  double sd_percent;
};

struct PublishedBreaks {
  double pressure_MPa;
  double broken_percent; ///< of the initial bonds
};

/// Presses of summary.json; a sample of cells has only the one that its summary is of.
nlohmann::json presses_of(const Run &run);

/// The recipe in electrode.json is the paper's, that of every key's default. One that is not known counts
/// as it.
bool is_of_paper(const nlohmann::json &electrode);
bool is_of_paper(const Run &run);

std::vector<MeasuredPorosity> paper_porosity();
std::vector<PublishedBreaks> paper_breaks();

} // namespace calendem::report

#endif
