// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "commands/commands.h"
#include "physics/pi.h"
#include "press/press_curve.h"
#include "report/study_page.h"
#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace calendem {
namespace fs = std::filesystem;
namespace {

constexpr const char *kHeadOfCurve = "# [press] # made by calendem press\n";

struct PressOptions {
  std::vector<std::string> exports;
  std::string curve, blank, decimal = "auto", specimen, machine;
  PressFormat format;
  double diameter_mm = 0.0, foil_um = 0.0, contact_MPa = 0.2;
};

/// The head of a curve: TOML behind '#'.
std::string head_of(const PressOptions &o, const std::string &file) {
  std::string out = kHeadOfCurve;
  const auto text = [&](const char *key, const std::string &value) {
    if (!value.empty())
      out += fmt::format("# {} = {}\n", key, nlohmann::json(value).dump());
  };
  const auto number = [&](const char *key, double value) {
    if (value > 0.0)
      out += fmt::format("# {} = {:.6g}\n", key, value);
  };
  text("export", fs::path(file).filename().string());
  text("export_hash", hash_of_file(file));
  text("specimen", o.specimen);
  text("machine", o.machine);
  number("diameter_mm", o.diameter_mm);
  number("area_mm2", o.format.area_mm2);
  number("foil_um", o.foil_um);
  number("contact_MPa", o.contact_MPa);
  text("blank", o.blank);
  return out;
}

/// CURVE.csv; of repeats CURVE_1.csv and so on.
std::string name_of(const PressOptions &o, std::size_t k, const char *ending) {
  const fs::path curve = o.curve;
  const std::string number = o.exports.size() > 1 ? fmt::format("_{}", k + 1) : "";
  return (curve.parent_path() / (curve.stem().string() + number + ending)).string();
}

/// By how much specimens of one coating differ, at shares of the pressure that all reach.
void print_scatter(const std::vector<PressCurve> &curves) {
  double lowest = HUGE_VAL;
  for (const PressCurve &c : curves)
    lowest = std::min(lowest, c.highest());
  for (const double share : {0.25, 0.5, 0.95}) {
    std::vector<double> d;
    for (const PressCurve &c : curves)
      d.push_back(c.displacement_at(share * lowest));
    const MeanAndSd s = mean_and_sd(d);
    fmt::print("press: displacement at {:.4g} MPa {:.2f} um, standard deviation of {} specimens "
               "{:.2f}\n",
               share * lowest, s.mean, s.n, s.sd);
  }
}

void press(PressOptions o) {
  if (o.diameter_mm > 0.0)
    o.format.area_mm2 = 0.25 * kPi * o.diameter_mm * o.diameter_mm;
  o.format.decimal = o.decimal == "comma" ? ',' : o.decimal == "point" ? '.' : '\0';
  PressCurve blank;
  if (!o.blank.empty())
    blank = make_press_curve(o.blank, read_press_export(o.blank, o.format), o.contact_MPa);
  std::vector<PressCurve> curves;
  for (std::size_t k = 0; k < o.exports.size(); ++k) {
    const std::string &file = o.exports[k], table = name_of(o, k, ".csv");
    std::error_code none;
    if (fs::equivalent(file, table, none))
      throw Failure(kBadInput,
                    "{}: -o names the export itself, which would be replaced. Give another name.",
                    file);
    require_own_file(table, kHeadOfCurve);
    const PressExport from = read_press_export(file, o.format);
    curves.push_back(make_press_curve(file, from, o.contact_MPa));
    PressCurve &curve = curves.back();
    if (!o.blank.empty())
      subtract_machine(curve, blank);
    fmt::print("press: {}: {}\n", file, fmt::join(from.said, "; "));
    for (const std::string &text : curve.said)
      fmt::print("press: {}\n", text);
    write_file(table, curve_table(curve, head_of(o, file)));
    write_file(name_of(o, k, ".html"), press_page(file, from, curve));
    fmt::print("press: {}, and what was done in {}\n", table, name_of(o, k, ".html"));
  }
  if (curves.size() > 1)
    print_scatter(curves);
}

} // namespace

void add_press_verb(CLI::App &app) {
  const auto o = std::make_shared<PressOptions>();
  CLI::App *verb = app.add_subcommand(
      "press", "Make the curve of an experiment from the file that a press exported");
  verb->add_option("RAW", o->exports, "exports (CSV or the like), one for each specimen")
      ->required();
  verb->add_option("-o,--output", o->curve, "curve to write; a page of the same name shows it")
      ->required()
      ->type_name("CURVE.csv");
  const CLI::Validator positive = finite_range(1e-6, 1e6);
  auto *diameter =
      verb->add_option("--diameter-mm", o->diameter_mm, "diameter of the disc")->check(positive);
  verb->add_option("--area-mm2", o->format.area_mm2, "its area instead")
      ->check(positive)
      ->excludes(diameter);
  for (const char *quantity : {"force", "displacement", "pressure", "time", "stage"})
    verb->add_option_function<std::string>(
            fmt::format("--{}", quantity),
            [o, quantity](const std::string &text) { o->format.columns[quantity] = text; },
            "column: its name or number, and its unit where the name has none (2:kN)")
        ->type_name("COLUMN[:UNIT]");
  verb->add_option("--decimal", o->decimal, "decimal sign, if the file leaves it open")
      ->check(CLI::IsMember({"auto", "point", "comma"}))
      ->capture_default_str();
  verb->add_option("--contact-MPa", o->contact_MPa, "pressure at which contact begins")
      ->check(positive)
      ->capture_default_str();
  verb->add_option("--blank", o->blank,
                   "export of a run without film, for the compliance of the press")
      ->type_name("RAW.csv");
  verb->add_option("--specimen", o->specimen, "name of the specimen, for the curve's head");
  verb->add_option("--machine", o->machine, "name of the press, for the curve's head");
  verb->add_option("--foil-um", o->foil_um, "thickness of the foil, for the curve's head")
      ->check(positive);
  verb->footer("Columns are known by English, German and French names with N, kN, mN, um, mm, s, "
               "MPa, kPa, bar ...");
  verb->callback([o] { press(*o); });
}

} // namespace calendem
