// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/provenance.h"
#include "diagnose/compare/gap.h"
#include "diagnose/compare/heat_map.h"
#include "report/embedded.h"
#include "report/page_template.h"
#include <cmath>
#include <fmt/format.h>

namespace calendem {
extern const char *const kGapHtml;
namespace {

nlohmann::json number_or_null(double x) {
  return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json();
}

nlohmann::json table(const nlohmann::json &gap) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto &r : gap["where"])
    rows.push_back({{"condition", r["condition"]},
                    {"observable", r["observable"]},
                    {"stage", r["stage"]},
                    {"unit", r["unit"]},
                    {"measured", shown(r["measured"], "{:.4g}")},
                    {"simulated", shown(r["simulated"], "{:.4g}")},
                    {"packings", r["packings"]},
                    {"residual", shown(r["residual"], "{:+.3g}")},
                    {"sd_measurement", shown(r["sd_measurement"], "{:.2g}")},
                    {"sd_seeds", shown(r["sd_seeds"], "{:.2g}")},
                    {"sd_pressure", shown(r["sd_pressure"], "{:.2g}")},
                    {"z", shown(r["z"], "{:+.1f}")},
                    {"share", shown(100.0 * r["share"].get<double>(), "{:.0f}")},
                    {"verdict", r["significant"] ? "beyond noise" : "within noise"}});
  return rows;
}

} // namespace

nlohmann::json to_json(const Gap &gap) {
  nlohmann::json where = nlohmann::json::array();
  for (const Residual &r : gap.rows)
    where.push_back({{"observable", r.observable},
                     {"stage", r.stage},
                     {"condition", r.condition},
                     {"unit", r.unit},
                     {"measured", r.measured},
                     {"simulated", r.simulated},
                     {"packings", r.packings},
                     {"residual", r.residual},
                     {"sd_measurement", r.sd_measurement},
                     {"sd_seeds", number_or_null(r.sd_seeds)},
                     {"sd_pressure", r.sd_pressure},
                     {"sd", r.sd},
                     {"z", number_or_null(r.z)},
                     {"share", r.share},
                     {"significant", r.significant}});
  return {{"experiment", gap.experiment},
          {"where", where},
          {"threshold_z", gap.threshold},
          {"chi2", number_or_null(gap.chi2)},
          {"p_value", gap.p_value},
          {"seed_degrees_of_freedom", gap.degrees_of_freedom},
          {"said", gap.said},
          {"not_said", gap.not_said},
          {"provenance", {{"calendem", version()}}}};
}

std::string gap_page(const nlohmann::json &gap) {
  nlohmann::json values = gap;
  values["css"] = report::embedded::kPageCss;
  values["table"] = table(gap);
  values["map"] = heat_map(gap["where"], gap["threshold_z"]);
  values["threshold_text"] = shown(gap["threshold_z"], "{:.2f}");
  values["chi2_text"] = shown(gap["chi2"], "{:.1f}");
  values["p_text"] = shown(gap["p_value"], "{:.2g}");
  values["rows_text"] = fmt::format("{}", gap["where"].size());
  values["json"] = report::in_script(gap.dump());
  return report::fill_template(kGapHtml, values);
}

} // namespace calendem
