// SPDX-License-Identifier: GPL-2.0-or-later
// gap.html: the page made from gap.json and nothing else.
#ifndef CALENDEM_DIAGNOSE_PAGE_H
#define CALENDEM_DIAGNOSE_PAGE_H

#include "report/page.h"
#include <nlohmann/json.hpp>
#include <string>

namespace calendem {

/// Self-contained; draws "shrink" (how far) where gap.json has it.
std::string diagnosis_page(const nlohmann::ordered_json &gap);

/// Parts of the page, as its template wants them.
nlohmann::json ranking_part(const nlohmann::json &gap);
/// What was measured beside base model and best hypothesis: numbers as strips, curves as charts.
nlohmann::json predictions_part(const nlohmann::json &gap);
std::vector<report::Chart> prediction_charts(const nlohmann::json &gap);
/// How probable each effect is and what limits it; what of a base parameter may be a hidden effect.
nlohmann::json effects_part(const nlohmann::json &gap);
/// What every observable's uncertainty is made of.
nlohmann::json budget_part(const nlohmann::json &gap);
nlohmann::json conflict_part(const nlohmann::json &gap);
/// Base parameters from one stage at a time.
nlohmann::json drift_part(const nlohmann::json &gap);
nlohmann::json confounding_part(const nlohmann::json &gap);
/// Gap before and after the effect is in, rerun in the simulation; null without "shrink".
nlohmann::json shrink_part(const nlohmann::json &gap);
/// Held-out curves, a chart for each condition; none without "shrink".
std::vector<report::Chart> rerun_charts(const nlohmann::json &gap);

} // namespace calendem

#endif
