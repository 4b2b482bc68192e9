// SPDX-License-Identifier: GPL-2.0-or-later
#include "withheld/handed_out.h"
#include "base/messages.h"
#include "base/pi.h"
#include "base/provenance.h"
#include "base/random.h"
#include "withheld/hidden_changes.h"
#include "withheld/sealing.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace calendem {
namespace {

constexpr int kRows = 40; // of a curve's branch, even in pressure
constexpr std::uint64_t kPurpose = 0x401;

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
  Press(const Round &round, const Truth &truth, std::uint64_t seed)
      : noise_(round.noise), factor_(truth.understated), error_(1.0 + truth.pressure_error),
        random_(seed, kPurpose) {
    for (const std::string &name : truth.hidden)
      scale_ *= find_hidden(name)->displacement_factor;
  }

  double with_noise(double value, double sd) { return value + factor_ * sd * random_.normal(); }

  std::string curve(const PressedSamples &samples, double target) {
    std::string out = "displacement_um,pressure_MPa,stage\n";
    for (int k = 1; k <= kRows; ++k)
      add(target * k / kRows, "compression", out, [&](double p) {
        return mean(samples, [&](const SimulatedRun &s) {
          return displacement_at(s.pressure, s.displacement, p);
        });
      });
    for (int k = kRows - 1; k > 0; --k)
      add(target * k / kRows, "relaxation", out, [&](double p) {
        return mean(samples, [&](const SimulatedRun &s) {
          return displacement_at(s.release_pressure, s.release_displacement, p);
        });
      });
    return out;
  }

private:
  const MeasurementNoise &noise_;
  double factor_, error_, scale_ = 1.0;
  Random random_;

  template <class Displacement>
  void add(double shown_pressure, const char *stage, std::string &out, const Displacement &at) {
    const double d = at(shown_pressure * error_);
    const double measured = with_noise(scale_ * d, noise_.displacement_um);
    if (std::isfinite(d))
      out += fmt::format("{:.4f},{:.6g},{}\n", measured, shown_pressure, stage);
  }
};

std::string condition(const Round &round, const PressedSamples &samples, double target,
                      const std::string &curve, Press &press) {
  const MeasurementNoise &n = round.noise;
  const auto shown = [&](double SimulatedRun::*what) {
    return mean(samples, [&](const SimulatedRun &s) { return s.*what; });
  };
  const double cracked =
      press.with_noise(shown(&SimulatedRun::cracked_fraction), n.cracked_fraction);
  std::string out =
      fmt::format("\n[[condition]]\nid = \"p{:g}\"\ncontrol = \"pressure\"\n", target);
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
  return out + fmt::format("curve = \"{}\"\ncurve_sd_um = {:g}\n", curve, n.displacement_um);
}

/// Area of the truth's own cell [um2].
double area_of(const Round &round, const Truth &truth) {
  double area = read_recipe(round.bank.recipe_file).area();
  for (const std::string &name : truth.hidden)
    for (const ChangedKey &c : find_hidden(name)->keys)
      if (c.key == "recipe.cell.x_um" || c.key == "recipe.cell.y_um")
        area *= c.factor;
  return area;
}

} // namespace

void hand_out(const std::string &folder, const std::string &id, const Round &round,
              const Truth &truth, const std::vector<PressedSamples> &shown, std::uint64_t seed) {
  std::filesystem::create_directories(folder);
  Press press(round, truth, seed);
  const double area = round.samples * area_of(round, truth); // um2
  const double diameter = 2.0 * std::sqrt(area / kPi);
  std::string text =
      fmt::format("# means of {} samples, each as large as a simulated cell; the "
                  "diameter is that of all together\n[experiment]\nname = \"case "
                  "{}\"\nelectrode = \"electrode.toml\"\nsample_diameter_mm = {:.6g}\n",
                  round.samples, id, 1e-3 * diameter);
  if (const auto &p = round.bank.pressures; p.size() > 1)
    text += fmt::format("split = {{ train = [\"p{:g}\"], test = [\"p{:g}\"] }}\n",
                        fmt::join(p.begin(), p.end() - 1, "\", \"p"), p.back());
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const double target = round.bank.pressures[k];
    const std::string curve = fmt::format("p{:g}.csv", target);
    text += condition(round, shown[k], target, curve, press);
    write_file(folder + "/" + curve, press.curve(shown[k], target));
  }
  write_file(folder + "/experiment.toml", text);
  write_file(folder + "/electrode.toml", bytes_of(round.bank.recipe_file));
}

} // namespace calendem
