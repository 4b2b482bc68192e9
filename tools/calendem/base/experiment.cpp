// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/experiment.h"
#include "base/csv_table.h"
#include "base/provenance.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace calendem {

double sample_area_cm2(const Experiment &e) {
  return kPi / 400.0 * e.sample_diameter_mm * e.sample_diameter_mm;
}

double foil_mg_cm2(const Experiment &e) {
  return 0.1 * e.foil_thickness_um * e.foil_density_g_cm3; // um g/cm3 -> mg/cm2
}

double coating_thickness_um(const Experiment &e, const Measured &thickness) {
  return thickness.value - (thickness.includes_foil ? e.foil_thickness_um : 0.0);
}

double coating_loading_mg_cm2(const Experiment &e, const Measured &mass) {
  return mass.value / sample_area_cm2(e) - (mass.includes_foil ? foil_mg_cm2(e) : 0.0);
}

double solid_thickness_um(const Experiment &e, double loading_mg_cm2) {
  return 10.0 * loading_mg_cm2 *
         (e.recipe.am_weight / e.recipe.am_density +
          (1.0 - e.recipe.am_weight) / e.recipe.cbd_solid_density);
}

const std::vector<Key> &head_keys() {
  static const std::vector<Key> keys = {
      {"name", "", "", 0, 0, "", "name for reports", "", true},
      {"electrode", "", "", 0, 0, "", "recipe of the electrode before calendering", "", true},
      {"sample_diameter_mm", "", "-", 1e-3, 1000, "mm", "diameter of the punched disc"},
      {"foil_thickness_um", "", "-", 1, 100, "um", "thickness of the current collector"},
      {"foil_density_g_cm3", "", "-", 0.5, 20, "g/cm3",
       "density of the current collector; aluminium 2.70, copper 8.96"},
      {"labels_pore", "", "0", -1e9, 1e9, "", "label of pores in the label images", "", false,
       true},
      {"labels_cbd", "", "-", -1e9, 1e9, "",
       "label of CBD in the label images; if not given, all solid is AM", "", false, true},
      {"labels_voxel_um", "", "-", 1e-3, 10, "um",
       "voxel size of the label images, if it differs from that in the files"},
      {"measured_on", "", "press", 0, 0, "",
       "simulation: the data come from a run like those of the bank, so that its numerics are no "
       "error and specimens do not differ",
       "press|simulation"},
      {"specimen_porosity_points", "", "0.5", 0, 10, "%",
       "standard deviation between specimens of the porosity before pressing, and again under "
       "pressure"},
      {"specimen_thickness_percent", "", "1", 0, 20, "%",
       "standard deviation of the thickness between specimens, where compared in um"},
      {"material", "", "-", 0, 0, "",
       "name of the powder and binder, for calibrate: films of one material share its parameters, "
       "those of others have similar ones. Default: 'unnamed', the same for all films that name "
       "none",
       "", true},
  };
  return keys;
}

const std::vector<Key> &condition_keys() {
  static const std::vector<Key> keys = {
      {"id", "", "", 0, 0, "", "name of the condition, as used in split", "", true},
      {"control", "", "", 0, 0, "", "what the press or calender was set to",
       "pressure|displacement|thickness|roll_gap"},
      {"curve", "", "-", 0, 0, "",
       "CSV: displacement_um,pressure_MPa[,stage]; stage: loading, dwell, unloading", "", true},
      {"labels_before", "", "-", 0, 0, "",
       "label image before calendering, z from the collector up", "", true},
      {"labels_after", "", "-", 0, 0, "", "label image after calendering", "", true},
      {"dwell_s", "", "0", 0, 1e6, "s", "time at the target"},
      {"curve_sd_um", "", "0", 0, 100, "um",
       "standard deviation of the curve's displacements, independent from row to row"},
      {"curve_drift_um", "", "0", 0, 100, "um",
       "standard deviation of the drift of displacement at the end of the curve"},
      {"curve_zero_um", "", "0", 0, 100, "um",
       "standard deviation of the position of first touch, where the displacement is 0"},
      {"specimen", "", "-", 0, 0, "",
       "name of the piece that was pressed, if conditions share one; default: each has its own", "",
       true},
      {"pressing", "", "-", 0, 0, "",
       "how it was pressed, if not in the usual way; diagnose and calibrate leave such a condition "
       "out",
       "", true},
  };
  return keys;
}

const std::vector<Quantity> &quantities() {
  static const std::vector<Quantity> list = {
      {{"roll_gap_um", "", "-", 0, 1000, "um", "gap between the rolls"}, &Condition::roll_gap_um},
      {{"displacement_um", "", "-", 0.01, 1000, "um",
        "displacement of the platen from first touch"},
       &Condition::displacement_um},
      {{"thickness_at_max_um", "", "-", 1, 1000, "um",
        "thickness of the coating at the maximum pressure, without foil"},
       &Condition::thickness_at_max_um},
      {{"max_pressure_MPa", "", "-", 0.1, 2000, "MPa", "maximum pressure"},
       &Condition::max_pressure_MPa},
      {{"loading_mg_cm2", "", "-", 0.5, 100, "mg/cm2", "loading of this sample, without foil"},
       &Condition::loading_mg_cm2},
      {{"porosity_before_percent", "", "-", 1, 90, "%",
        "total porosity of this sample before pressing"},
       &Condition::porosity_before_percent},
      {{"porosity_after_percent", "", "-", 1, 90, "%", "total porosity after calendering"},
       &Condition::porosity_after_percent},
      {{"thickness_after_um", "", "-", 1, 1000, "um", "thickness after calendering"},
       &Condition::thickness_after_um},
      {{"mass_mg", "", "-", 0.01, 1e5, "mg", "mass of the sample"}, &Condition::mass_mg},
      {{"cracked_bodies_fraction", "", "-", 0, 1, "fraction",
        "fraction of secondary particles that are cracked"},
       &Condition::cracked_bodies_fraction},
      {{"cbd_nanoporosity_after_percent", "", "-", 1, 90, "%",
        "nanoporosity of the carbon-binder domain after calendering; calibrate learns from it, the "
        "other verbs do not compare it"},
       &Condition::cbd_nanoporosity_after_percent},
      {{"pressure_left_percent", "", "-", 0, 200, "%",
        "pressure at the end of a dwell at constant gap, of that at its beginning"},
       &Condition::pressure_left_percent},
  };
  return list;
}

const std::vector<Key> &crushed_keys() {
  static const std::vector<Key> keys = {
      {"diameter_um", "", "", 0.5, 100, "um", "diameter of the particles"},
      {"load_mN", "", "", 1e-3, 1e6, "mN",
       "load at which half of them break; a number, { value, sd } or { value, sd_relative }"},
  };
  return keys;
}

std::string list_of_experiment_keys() {
  std::string text = "Keys of an experiment file: name, unit, range, meaning\n";
  const auto rows = [&](const char *table, const std::vector<Key> &keys) {
    text += fmt::format(" {}\n", table);
    for (const Key &k : keys)
      text += fmt::format("  {:<26} {:<8} {:<14} {}\n", k.name, k.unit,
                          k.text || !k.choices.empty() ? "text"
                                                       : fmt::format("{:g}..{:g}", k.low, k.high),
                          k.choices.empty() ? k.meaning : k.choices);
  };
  rows("[experiment]", head_keys());
  text += "  split                                      { train = [ids], test = [ids] }\n";
  rows("[[condition]]", condition_keys());
  std::vector<Key> measured;
  for (const Quantity &q : quantities())
    measured.push_back(q.key);
  rows("[[condition]], a number or { value, sd } or { value, sd_relative }; mass_mg and "
       "thickness_after_um also includes_foil (default: a mass does, a thickness does not)",
       measured);
  rows("[[crushed_particle]]", crushed_keys());
  return text;
}

namespace {

const Key &range_of(std::optional<Measured> Condition::*field) {
  return std::find_if(quantities().begin(), quantities().end(),
                      [&](const Quantity &q) { return q.field == field; })
      ->key;
}

/// A mass is bound as the loading that it stands for is.
void check_mass(double loading, const Measured &mass, const std::string &who, int line,
                Mistakes &mistakes) {
  const Key &allowed = range_of(&Condition::loading_mg_cm2);
  if (loading < allowed.low || loading > allowed.high)
    mistakes.add(line,
                 "{}: mass_mg = {:g} is a loading of {:.3g} mg/cm2; allowed is {:g} to {:g}. Is "
                 "the mass in mg, and sample_diameter_mm that of the disc that was weighed?",
                 who, mass.value, loading, allowed.low, allowed.high);
}

} // namespace

std::optional<Measured> loading_of(const Experiment &e, const Condition &c) {
  if (c.mass_mg)
    return Measured{coating_loading_mg_cm2(e, *c.mass_mg), c.mass_mg->sd / sample_area_cm2(e)};
  return c.loading_mg_cm2;
}

void check_thickness(const Experiment &e, const Condition &c, const std::string &who, int line,
                     Mistakes &mistakes) {
  constexpr double kFar = 3.0;  // standard deviations
  constexpr double kZero = 6.0; // um: as far off as the zero of a gauge that a diagnosis names
  const double most = range_of(&Condition::porosity_before_percent).high;
  const Key &allowed = range_of(&Condition::loading_mg_cm2);
  const Measured loading = loading_of(e, c).value_or(Measured{e.recipe.loading});
  const double solid = solid_thickness_um(e, loading.value),
               solid_sd = solid_thickness_um(e, loading.sd);
  for (const auto field : {&Condition::thickness_at_max_um, &Condition::thickness_after_um}) {
    const double coating = c.*field ? coating_thickness_um(e, *(c.*field)) : 0.0;
    if (e.recipe.file.empty() || coating <= 0.0 || loading.value < allowed.low ||
        loading.value > allowed.high) // mistakes of their own
      continue;
    const double off = kZero + kFar * std::hypot((c.*field)->sd, solid_sd,
                                                 0.01 * e.specimen_thickness_percent * coating);
    std::string wrong;
    if (coating + off < solid)
      wrong = fmt::format("its solid alone fills {:.2f}", solid);
    else if (coating - off > solid / (1.0 - 0.01 * most))
      wrong =
          fmt::format("of which the solid fills {:.2f}: {:.1f} % would be pores, allowed are at "
                      "most {:g} %{}",
                      solid, 100.0 * (1.0 - solid / coating), most,
                      field == &Condition::thickness_after_um && !(c.*field)->includes_foil
                          ? " (was the foil measured too? then say includes_foil = true)"
                          : "");
    if (!wrong.empty())
      mistakes.add(line,
                   "{}: {} is {:g} um of coating, {}, at a loading of {:.4g} mg/cm2. Correct the "
                   "thickness, the loading or the recipe.",
                   who, range_of(field).name, coating, wrong, loading.value);
  }
}

void check_foil(const Experiment &e, const Condition &c, const std::string &who, int line,
                Mistakes &mistakes) {
  const bool on_thickness = c.thickness_after_um && c.thickness_after_um->includes_foil;
  const bool on_mass = c.mass_mg && c.mass_mg->includes_foil;
  std::vector<std::string> missing;
  if (c.mass_mg && e.sample_diameter_mm == 0.0)
    missing.push_back("sample_diameter_mm");
  if ((on_thickness || on_mass) && e.foil_thickness_um == 0.0)
    missing.push_back("foil_thickness_um");
  if (on_mass && e.foil_density_g_cm3 == 0.0)
    missing.push_back("foil_density_g_cm3");
  if (!missing.empty()) {
    mistakes.add(line, "{} gives a mass, or a thickness with foil: [experiment] must have {}.", who,
                 fmt::join(missing, ", "));
    return;
  }
  if (on_thickness && coating_thickness_um(e, *c.thickness_after_um) <= 0.0)
    mistakes.add(
        line,
        "{}: thickness_after_um = {} includes a foil of {} um: nothing is left for the coating.",
        who, c.thickness_after_um->value, e.foil_thickness_um);
  if (on_mass && coating_loading_mg_cm2(e, *c.mass_mg) <= 0.0)
    mistakes.add(line, "{}: mass_mg = {} is less than that of the foil ({:.2f} mg).", who,
                 c.mass_mg->value, foil_mg_cm2(e) * sample_area_cm2(e));
  else if (c.mass_mg)
    check_mass(coating_loading_mg_cm2(e, *c.mass_mg), *c.mass_mg, who, line, mistakes);
}

namespace {

/// The curve of a condition, as its file has it.
class CurveCheck {
public:
  CurveCheck(const std::string &path, int line, Mistakes &mistakes)
      : path_(path), line_(line), mistakes_(mistakes), table_(CsvTable::parse(text_of_file(path))) {
  }

  void check(const Experiment &e, const Condition &c) {
    if (!check_columns())
      return;
    if (const std::string guess = table_.guess(); !guess.empty())
      fmt::print(stderr, "note: {}: read with {}.\n", path_, guess);
    check_order();
    check_stages();
    check_units(e, c);
  }

private:
  const std::string &path_;
  int line_;
  Mistakes &mistakes_;
  CsvTable table_;

  template <class... Values> void refuse(fmt::format_string<Values...> what, Values &&...values) {
    mistakes_.add(line_, "'{}'{}", path_, fmt::format(what, std::forward<Values>(values)...));
  }

  /// Columns and numbers; false if the rest cannot be checked.
  bool check_columns() {
    const int before = mistakes_.count();
    const std::string first = fmt::format("{}", fmt::join(table_.header(), ","));
    if (const std::string wrong = table_.ambiguous({"displacement_um", "pressure_MPa", "stage"});
        !wrong.empty())
      refuse(" {}", wrong);
    if (table_.header().empty())
      return false;
    for (const char *column : {"displacement_um", "pressure_MPa"}) {
      if (!table_.has(column)) {
        refuse(" has no column '{}' in its first line: {}. calendem press makes a curve of a "
               "press's own export: columns of other names and units.",
               column, first);
        continue;
      }
      const std::vector<double> values = table_.numbers(column);
      const auto wrong =
          std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
      if (wrong != values.end())
        refuse(": {} of row {} is not a finite number. Correct or remove the row.", column,
               wrong - values.begin() + 1);
    }
    if (!table_.bad_lines().empty())
      refuse(": line {} has another number of columns than the first line. Correct the line, or "
             "copy the file again if it is cut. Numbers with decimal commas need other separators: "
             "semicolons.",
             table_.bad_lines().front());
    if (table_.rows() < 2)
      refuse(" has {} rows below its first line; a curve has at least 2.", table_.rows());
    return mistakes_.count() == before;
  }

  /// Rows that a noisy reading moved to the release would be lost without a word.
  void check_loading(const std::vector<std::string> &stages) {
    constexpr double kReached = 0.9; // of the highest pressure; a dwell may add the rest
    const std::vector<double> p = table_.numbers("pressure_MPa");
    double loaded = 0.0, highest = 0.0;
    for (std::size_t k = 0; k < p.size(); ++k) {
      highest = std::max(highest, p[k]);
      if (stages[k] == "loading" || stages[k] == "compression")
        loaded = std::max(loaded, p[k]);
    }
    if (loaded < kReached * highest)
      refuse(": rows of the stage loading reach {:g} MPa, the curve {:g}. Rows up to the highest "
             "pressure are loading, those after it unloading.",
             loaded, highest);
  }

  /// Rows from the newest to the oldest, or sorted by another column, turn loading into release.
  void check_order() {
    constexpr double kBegun = 0.5;    // of the highest pressure
    constexpr double kMostBack = 0.3; // of the rows up to the highest pressure
    const std::vector<double> p = table_.numbers("pressure_MPa"),
                              d = table_.numbers("displacement_um");
    const auto top = std::max_element(p.begin(), p.end()) - p.begin();
    if (p.front() > kBegun * p[std::size_t(top)]) {
      refuse(
          " begins at {:g} MPa, its highest pressure is {:g}. Rows go in the order of time, from "
          "the first touch on.",
          p.front(), p[std::size_t(top)]);
      return;
    }
    const double noise = 0.05 * *std::max_element(d.begin(), d.end());
    int back = 0;
    for (int k = 1; k <= top; ++k)
      back += d[std::size_t(k)] < d[std::size_t(k - 1)] - noise;
    if (back > kMostBack * double(top))
      refuse(": in {} of {} rows up to the highest pressure the platen goes far back. Rows go in "
             "the order of time.",
             back, top);
  }

  void check_stages() {
    const std::vector<std::string> known = {"loading",   "compression", "dwell",
                                            "unloading", "relaxation",  "hold"};
    const std::vector<std::string> stages = table_.texts("stage");
    const auto wrong = std::find_if(stages.begin(), stages.end(), [&](const std::string &s) {
      return std::find(known.begin(), known.end(), s) == known.end();
    });
    const bool loads = std::any_of(stages.begin(), stages.end(), [](const std::string &s) {
      return s == "loading" || s == "compression";
    });
    if (wrong != stages.end())
      refuse(": stage of row {} is '{}'; allowed are {}. calendem press knows other names.",
             wrong - stages.begin() + 1, *wrong, fmt::join(known, ", "));
    else if (loads && (stages.front() == "unloading" || stages.front() == "relaxation"))
      refuse(": its first row has the stage {}. Rows go in the order of time, from the first touch "
             "on.",
             stages.front());
    else if (!stages.empty() && !loads)
      refuse(": no row has the stage loading; rows up to the highest pressure have it.");
    else if (!stages.empty())
      check_loading(stages);
  }

  /// A curve in another unit is off by a power of ten: far beyond what the rest of the file allows.
  void check_units(const Experiment &e, const Condition &c) {
    constexpr double kLeastPressure = 0.1, kMostPressure = 2000.0; // as of max_pressure_MPa
    constexpr double kOff = 3.0; // factor between the curve's largest pressure and the stated
    constexpr double kLeastWay = 0.005; // of the film's thickness
    constexpr double kMostWay = 10.0; // a press that gives way moves farther than the film is thick
    const auto largest = [&](const char *column) {
      const std::vector<double> v = table_.numbers(column);
      return *std::max_element(v.begin(), v.end());
    };
    const double p = largest("pressure_MPa"), d = largest("displacement_um");
    if (!(p >= kLeastPressure && p <= kMostPressure))
      refuse(": pressure_MPa goes to {:g}; {:g} to {:g} MPa are those of a press. Is the column in "
             "MPa, and compression positive?",
             p, kLeastPressure, kMostPressure);
    if (c.max_pressure_MPa &&
        (p > kOff * c.max_pressure_MPa->value || p * kOff < c.max_pressure_MPa->value))
      refuse(": pressure_MPa goes to {:g}, max_pressure_MPa is {:g}. Is the column in MPa, and the "
             "curve this condition's?",
             p, c.max_pressure_MPa->value);
    if (e.recipe.file.empty()) // it has mistakes of its own
      return;
    const double film = e.recipe.thickness();
    if (d >= kMostWay * film || d < kLeastWay * film)
      refuse(
          ": displacement_um goes to {:g}; the film of the recipe is {:.1f} um thick, allowed is "
          "{:.3g} to {:.4g}. Is the column in um, counted from first touch?",
          d, film, kLeastWay * film, kMostWay * film);
  }
};

} // namespace

void check_curve(const Experiment &e, const Condition &c, int line, Mistakes &mistakes) {
  CurveCheck(c.curve, line, mistakes).check(e, c);
}

} // namespace calendem
