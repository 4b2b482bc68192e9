// SPDX-License-Identifier: GPL-2.0-or-later
// A rehearsal of the diagnosis on runs of a bank: rehearsal BANK FOLDER [EVERY]. Every packing is left out in turn; its
// runs, with a laboratory's errors, are films that are diagnosed with what the other packings teach. The user's model is
// the run's own (nothing to see), or lacks an effect of it, or two, or has one that does not act. Prints a line for each
// answer, and scores.
#include "base/provenance.h"
#include "diagnose/diagnosis.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <map>

namespace {

using namespace calendem;
using inference::Verdict;

constexpr double kPressures[] = {50.0, 150.0}; // about these the film is pressed
constexpr double kPorosityPoints = 0.3, kCrackedShare = 0.03, kCurveUm = 0.05, kTouchUm = 1.0;

/// A run as a laboratory reports it, in a folder.
class Laboratory {
public:
  Laboratory(const FilmBank &bank, std::string folder) : bank_(bank), folder_(std::move(folder)) {}

  Experiment measure(const bank::Run &run, std::uint64_t seed) const {
    std::filesystem::create_directories(folder_);
    write_file(folder_ + "/film.toml", recipe_of(run));
    Random random(seed, 1);
    const double diameter = 1e-3 * std::sqrt(4.0 * bank_.recipe().area() / kPi);
    std::string text = fmt::format("[experiment]\nname = \"run {}\"\nelectrode = \"film.toml\"\n"
                                   "measured_on = \"simulation\"\nsample_diameter_mm = {:.6f}\n",
                                   run.point.number, diameter);
    for (const double wanted : kPressures) {
      const bank::PressedFilm &press =
          *std::min_element(run.presses.begin(), run.presses.end(),
                            [&](const bank::PressedFilm &a, const bank::PressedFilm &b) {
                              return std::fabs(std::log(a.pressure / wanted)) <
                                     std::fabs(std::log(b.pressure / wanted));
                            });
      text += condition_of(run, press, random);
    }
    write_file(folder_ + "/experiment.toml", text);
    return read_experiment(folder_ + "/experiment.toml");
  }

private:
  const FilmBank &bank_;
  std::string folder_;

  /// The bank's recipe with the values of the point.
  std::string recipe_of(const bank::Run &run) const {
    std::map<std::string, std::string> tables; // of keys by table
    for (std::size_t k = 0; k < bank_.spec().design.inputs.size(); ++k)
      if (const bank::Input &input = bank_.spec().design.inputs[k]; input.is_film())
        for (const std::string &key : input.keys) {
          const std::string name = key.substr(std::string("recipe.").size());
          const std::size_t dot = name.find('.');
          tables[name.substr(0, dot)] +=
              fmt::format("{} = {:.6g}\n", name.substr(dot + 1), run.point.values[k]);
        }
    tables["coating"] += "loading_mg_cm2 = 6\n";
    std::string out = "name = \"film\"\nmaterial = \"nmc111\"\n";
    for (const auto &[table, keys] : tables)
      out += fmt::format("[{}]\n{}", table, keys);
    return out;
  }

  std::string condition_of(const bank::Run &run, const bank::PressedFilm &press,
                           Random &random) const {
    const std::string id = fmt::format("p{:.0f}", press.pressure);
    const double touch = kTouchUm * random.normal(),
                 largest = run.thickness_before - press.thickness_at_max;
    std::string curve = "stage,pressure_MPa,displacement_um\n";
    const auto add = [&](const char *stage, double pressure, double displacement) {
      if (std::isfinite(displacement))
        curve += fmt::format("{},{:.5g},{:.4f}\n", stage, pressure,
                             displacement + touch + kCurveUm * random.normal());
    };
    for (std::size_t k = 0; k < run.loading.size(); ++k)
      if (bank::curve_pressures()[k] < 0.98 * press.pressure)
        add("compression", bank::curve_pressures()[k], run.loading[k]);
    add("compression", press.pressure, largest);
    for (std::size_t k = press.release.size(); k-- > 0;)
      add("relaxation", bank::kReleasedTo[k] * press.pressure, press.release[k]);
    write_file(folder_ + "/" + id + ".csv", curve);
    return fmt::format(
        "[[condition]]\nid = \"{0}\"\nspecimen = \"one\"\ncontrol = \"pressure\"\ncurve = "
        "\"{0}.csv\"\n"
        "curve_sd_um = {1}\ncurve_zero_um = {2}\nloading_mg_cm2 = {{ value = 6, sd = 0.03 }}\n"
        "max_pressure_MPa = {{ value = {3:.5g}, sd_relative = 0.01 }}\n"
        "porosity_after_percent = {{ value = {4:.4f}, sd = {5} }}\n"
        "cracked_bodies_fraction = {{ value = {6:.4f}, sd = {7} }}\n",
        id, kCurveUm, kTouchUm, press.pressure,
        100.0 * press.porosity_after + kPorosityPoints * random.normal(), kPorosityPoints,
        std::clamp(press.cracked + kCrackedShare * random.normal(), 0.0, 1.0), kCrackedShare);
  }
};

/// A film, and the user's model of it.
struct Truth {
  std::string kind;                 ///< "none", "single", "absent", "pair"
  std::vector<std::string> acting;  ///< in the model
  std::vector<std::string> changes; ///< as names of changes
};

std::vector<std::string> acting_of(const bank::Bank &spec, const bank::Run &run, bool acts) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < spec.design.inputs.size(); ++k)
    if (spec.design.inputs[k].is_effect() && std::isnan(run.point.values[k]) != acts)
      out.push_back(spec.design.inputs[k].name);
  return out;
}

/// Kinds take turns, effects by chance.
Truth truth_of(const bank::Bank &spec, const bank::Run &run, int turn) {
  Truth out;
  out.acting = acting_of(spec, run, true);
  const std::vector<std::string> off = acting_of(spec, run, false);
  Random random(std::uint64_t(run.point.number), 2);
  const auto take = [&] {
    const auto at =
        out.acting.begin() + std::ptrdiff_t(random.uniform() * double(out.acting.size()));
    out.changes.push_back(*at);
    out.acting.erase(at);
  };
  const char *const kinds[] = {"none", "single", "single", "absent", "pair"};
  out.kind = kinds[turn % 5];
  if (out.kind == "single" && !out.acting.empty())
    take();
  else if (out.kind == "pair" && out.acting.size() > 1)
    take(), take();
  else if (out.kind == "absent" && !off.empty()) {
    const std::string &extra = off[std::size_t(random.uniform() * double(off.size()))];
    out.acting.push_back(extra);
    out.changes.push_back("no " + extra);
  } else
    out.kind = "none";
  return out;
}

/// Length of the gap in the errors, beyond what noise leaves.
double signal_of(const Diagnosis &d) {
  const auto at = first_datum(d);
  const auto n = Eigen::Index(d.readings.size());
  const inference::Vector r = d.model.residual.segment(at, n);
  const double square = r.dot(inference::Cholesky(d.model.expected.block(at, at, n, n)).solve(r));
  return std::sqrt(std::max(0.0, square - double(n)));
}

struct Scores {
  std::map<std::string, int> count, right, wrong, in_list, nothing;
  int strong = 0, strong_first = 0;
  double hits[10] = {}, sums[10] = {}, all[10] = {}; ///< of probabilities by tenths

  void add(const Truth &truth, const Diagnosis &d) {
    const auto is_true = [&](int k) {
      const std::string name = name_of(d, k);
      return std::find(truth.changes.begin(), truth.changes.end(), name) != truth.changes.end();
    };
    const std::vector<int> &named = d.verdict.changes;
    const bool hit = std::any_of(named.begin(), named.end(), is_true),
               explained = d.verdict.kind == Verdict::explained;
    ++count[truth.kind];
    right[truth.kind] += explained && std::all_of(named.begin(), named.end(), is_true);
    wrong[truth.kind] += explained && !hit;
    in_list[truth.kind] += d.verdict.kind == Verdict::one_of && hit;
    nothing[truth.kind] += d.verdict.kind == Verdict::nothing_seen;
    int first = 0;
    for (int k = 0; k < int(d.changes.all.size()); ++k) {
      const double p = d.changes.all[std::size_t(k)].probability;
      if (d.changes.all[std::size_t(k)].effect < 0)
        continue;
      const int tenth = std::min(9, int(10.0 * p));
      all[tenth] += 1.0;
      sums[tenth] += p;
      hits[tenth] += is_true(k);
      if (p > d.changes.all[std::size_t(first)].probability)
        first = k;
    }
    if (truth.kind == "single" && signal_of(d) >= 6.0) {
      ++strong;
      strong_first += is_true(first);
    }
  }

  void print() {
    fmt::print("{:<8} {:>5} {:>6} {:>6} {:>8} {:>8}\n", "kind", "all", "right", "wrong", "in list",
               "nothing");
    for (const auto &[kind, n] : count)
      fmt::print("{:<8} {:>5} {:>6} {:>6} {:>8} {:>8}\n", kind, n, right[kind], wrong[kind],
                 in_list[kind], nothing[kind]);
    fmt::print("single effects with a signal of 6 or more: {} of {} first\n", strong_first, strong);
    double off = 0.0, n = 0.0;
    for (int k = 0; k < 10; ++k) {
      if (all[k] > 0.0)
        fmt::print("probability {:.2f}: true in {:.2f} of {:.0f}\n", sums[k] / all[k],
                   hits[k] / all[k], all[k]);
      off += std::fabs(sums[k] - hits[k]);
      n += all[k];
    }
    fmt::print("calibration error {:.3f}\n", off / n);
  }
};

/// The bank without a packing, its fit kept.
FilmBank without(const bank::Runs &all, int packing, const inference::Hyperparameters &fit) {
  bank::Runs rest = all;
  rest.runs.erase(std::remove_if(rest.runs.begin(), rest.runs.end(),
                                 [&](const bank::Run &r) { return r.point.packing == packing; }),
                  rest.runs.end());
  return FilmBank(rest, inference::Emulator(bank::training_of(rest), fit));
}

void rehearse(const std::string &bank_file, const std::string &folder, int every) {
  const bank::Bank spec = bank::read_bank(bank_file);
  const std::string table = bank::table_of(spec);
  const bank::Runs all = bank::read_runs(spec, table);
  const inference::Hyperparameters fit = bank::emulator_of(all, table).hyperparameters();
  Scores scores;
  int place = 0, turn = 0;
  for (int packing = 1; packing <= spec.design.packings; ++packing) {
    const FilmBank bank = without(all, packing, fit);
    const Laboratory laboratory(bank, folder);
    for (const bank::Run &run : all.runs) {
      if (run.point.packing != packing || !run.failed.empty() || run.point.larger ||
          run.presses.size() < 5 || place++ % every != 0)
        continue;
      const Truth truth = truth_of(spec, run, turn++);
      DiagnosisOptions options;
      options.acting = truth.acting;
      const Diagnosis d =
          diagnosed(laboratory.measure(run, std::uint64_t(run.point.number)), bank, options);
      scores.add(truth, d);
      std::string named;
      for (const int k : d.verdict.changes)
        named +=
            fmt::format(" {} ({:.2f})", name_of(d, k), d.changes.all[std::size_t(k)].probability);
      fmt::print("point {} {} [{}] signal {:.1f}: {}{}\n", run.point.number, truth.kind,
                 fmt::join(truth.changes, ", "), signal_of(d), int(d.verdict.kind), named);
      std::fflush(stdout);
    }
  }
  scores.print();
}

} // namespace

int main(int argc, char **argv) {
  return exit_status_of([&] {
    if (argc < 3)
      throw Failure(kBadInput, "rehearsal BANK FOLDER [EVERY]");
    rehearse(argv[1], argv[2], argc > 3 ? std::max(1, std::atoi(argv[3])) : 1);
    return 0;
  });
}
