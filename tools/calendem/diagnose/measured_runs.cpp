// SPDX-License-Identifier: GPL-2.0-or-later
#include "diagnose/measured_runs.h"
#include "base/provenance.h"
#include "base/random.h"
#include "physics/pi.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {

namespace {

constexpr int kRows = 40; // of a curve's branch, even in pressure
constexpr std::uint64_t kPressStream = 0x401;

/// Mean over the samples; NaN where one of them does not have it.
template <class Of> double mean(const PressedSamples &samples, const Of &of) {
  double sum = 0.0;
  for (const SimulatedRun &s : samples)
    sum += of(s);
  return sum / double(samples.size());
}

/// Displacements of the samples as their press shows them.
class Press {
public:
  Press(const MeasuredSpecimens &s, std::uint64_t seed)
      : noise_(s.noise), factor_(s.understated), errors_(s.press), random_(seed, kPressStream) {}

  double with_noise(double value, double sd) { return value + factor_ * sd * random_.normal(); }

  std::string curve(const PressedSamples &samples, double target) {
    std::string out = "displacement_um,pressure_MPa,stage\n";
    for (int k = 1; k <= kRows; ++k)
      add(target * k / kRows, "compression", k, out, [&](double p) {
        return mean(samples, [&](const SimulatedRun &s) {
          return displacement_at(s.pressure, s.displacement, p);
        });
      });
    for (int k = kRows - 1; k > 0; --k)
      add(target * k / kRows, "relaxation", 2 * kRows - k, out, [&](double p) {
        return errors_.release_shift_um + mean(samples, [&](const SimulatedRun &s) {
                 return displacement_at(s.release_pressure, s.release_displacement, p);
               });
      });
    return out;
  }

private:
  const MeasurementNoise &noise_;
  double factor_;
  PressErrors errors_;
  Random random_;

  template <class Displacement>
  void add(double shown_pressure, const char *stage, int row, std::string &out,
           const Displacement &at) {
    const double true_pressure =
        shown_pressure * (1.0 + errors_.pressure) - errors_.pressure_offset_MPa;
    const double d = at(true_pressure) + errors_.drift_um * row / (2 * kRows);
    const double measured = with_noise(errors_.displacement_factor * d, noise_.displacement_um);
    if (std::isfinite(d))
      out += fmt::format("{:.4f},{:.6g},{}\n", measured, shown_pressure, stage);
  }
};

/// Name of the k-th specimen at each pressure, from 0.
std::string id_of(double pressure, std::size_t k) {
  return k == 0 ? fmt::format("p{:g}", pressure) : fmt::format("p{:g}_{}", pressure, k + 1);
}

/// Repeats are specimens by name: the diagnosis compares means of specimens pressed alike.
std::string specimen_of(const MeasuredSpecimens &s, const std::string &id, std::size_t k) {
  if (s.repeats == 1)
    return s.disc_for_each_pressure ? "" : "specimen = \"one\"\n";
  return fmt::format("specimen = \"{}\"\n",
                     s.disc_for_each_pressure ? id : fmt::format("number {}", k + 1));
}

std::string condition(const MeasuredSpecimens &specimens, const PressedSamples &samples,
                      double target, std::size_t repeat, Press &press) {
  const MeasurementNoise &n = specimens.noise;
  const auto shown = [&](double SimulatedRun::*what) {
    return mean(samples, [&](const SimulatedRun &s) { return s.*what; });
  };
  const double cracked =
      press.with_noise(shown(&SimulatedRun::cracked_fraction), n.cracked_fraction);
  const std::string id = id_of(target, repeat);
  std::string out = fmt::format("\n[[condition]]\nid = \"{}\"\n{}control = \"pressure\"\n", id,
                                specimen_of(specimens, id, repeat));
  out += fmt::format("max_pressure_MPa = {{ value = {:g}, sd_relative = {:g} }}\n", target,
                     0.01 * n.pressure_percent);
  const auto add = [&](const char *key, double value, double sd) {
    out += fmt::format("{} = {{ value = {:.5f}, sd = {:g} }}\n", key, value, sd);
  };
  add("porosity_before_percent",
      press.with_noise(100.0 * shown(&SimulatedRun::porosity_initial), n.porosity_percent),
      n.porosity_percent);
  add("porosity_after_percent",
      press.with_noise(100.0 * shown(&SimulatedRun::porosity_after), n.porosity_percent),
      n.porosity_percent);
  add("thickness_at_max_um",
      press.with_noise(shown(&SimulatedRun::thickness_at_max), n.thickness_um), n.thickness_um);
  add("thickness_after_um", press.with_noise(shown(&SimulatedRun::thickness_after), n.thickness_um),
      n.thickness_um);
  add("cracked_bodies_fraction", std::clamp(cracked, 0.0, 1.0), n.cracked_fraction);
  return out + fmt::format("curve = \"{}.csv\"\ncurve_sd_um = {:g}\n", id, n.displacement_um);
}

} // namespace

void write_measured(const std::string &folder, const MeasuredSpecimens &s,
                    const std::vector<PressedSamples> &shown, std::uint64_t seed) {
  std::filesystem::create_directories(folder);
  Press press(s, seed);
  const double diameter = 2.0 * std::sqrt(s.area / kPi);
  std::string text =
      fmt::format("# means of {} samples, each as large as a simulated cell; the "
                  "diameter is that of all together\n[experiment]\nname = \"case "
                  "{}\"\nelectrode = \"electrode.toml\"\nmeasured_on = \"simulation\"\n"
                  "sample_diameter_mm = {:.6g}\n",
                  s.packings, s.id, 1e-3 * diameter);
  const auto &pressures = s.pressures;
  std::vector<std::string> train, test;
  for (std::size_t k = 0; k < shown.size(); ++k)
    (k % pressures.size() + 1 == pressures.size() ? test : train)
        .push_back(id_of(pressures[k % pressures.size()], k / pressures.size()));
  if (pressures.size() > 1)
    text += fmt::format("split = {{ train = [\"{}\"], test = [\"{}\"] }}\n",
                        fmt::join(train, "\", \""), fmt::join(test, "\", \""));
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const double target = pressures[k % pressures.size()];
    const std::size_t repeat = k / pressures.size();
    text += condition(s, shown[k], target, repeat, press);
    write_file(folder + "/" + id_of(target, repeat) + ".csv", press.curve(shown[k], target));
  }
  write_file(folder + "/experiment.toml", text);
  write_file(folder + "/electrode.toml", text_of_file(s.recipe_file));
}

} // namespace calendem
