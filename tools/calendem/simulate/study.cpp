// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/study.h"
#include "base/child.h"
#include "base/job_pool.h"
#include "base/liggghts_job.h"
#include "base/output_folder.h"
#include "base/provenance.h"
#include "simulate/by_slurm.h"
#include "simulate/making.h"
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <nlohmann/json.hpp>

namespace calendem {
namespace fs = std::filesystem;
namespace {

void stop_if_failed(const Making &making) {
  if (stop_requested())
    throw Failure(kSimulationFailed, "study: stopped on request. What was computed is kept; the "
                                     "same command goes on.");
  if (const std::string failures = making.failures(); !failures.empty())
    throw Failure(making.count("failed") > 0 ? kSimulationFailed : kCheckFailed,
                  "study: some runs are not usable:" + failures);
}

} // namespace

std::vector<std::string> finished_runs(const Study &study, StudyOptions o) {
  o.folder = fs::absolute(o.folder).lexically_normal().string();
  o.liggghts = fs::absolute(o.liggghts).lexically_normal().string();
  return Making(study, o).finished();
}

void make_study(const Study &study, StudyOptions o) {
  o.folder = fs::absolute(o.folder).lexically_normal().string();
  o.liggghts = fs::absolute(o.liggghts).lexically_normal().string();
  o.slurm.on = o.slurm.on || o.slurm.dry_run;
  const int n = static_cast<int>(study.runs.size());
  if (o.only > n)
    throw Failure(kBadInput, fmt::format("--only {}: the study has {} runs.", o.only, n));
  if (const std::string wrong = wrong_program(o.liggghts); !wrong.empty())
    throw Failure(kBadInput, wrong);
  make_output_folder(o.folder);
  fs::create_directories(o.folder + "/packings");
  fs::create_directories(o.folder + "/runs");
  Making making(study, o);
  write_file(o.folder + "/study.json", making.description().dump(2) + "\n");
  fmt::print("study: {} runs, {} of them there -> {}\n", n, n - making.runs_to_make().size(),
             o.folder);
  std::cout << std::flush;
  if (o.slurm.on)
    make_by_slurm(making, study, o);
  else if (o.only > 0)
    in_parallel(1, 1, [&](int) { making.make(o.only - 1); });
  else if (!o.table)
    in_parallel(n, std::max(1, o.jobs), [&](int k) { making.make(k); });
  if (o.step == StudyStep::Packing || o.slurm.dry_run)
    return stop_if_failed(making);
  making.write_table();
  fmt::print("study: {} of {} runs done, {}/study.csv\n", making.count("done"), n, o.folder);
  stop_if_failed(making);
}

} // namespace calendem
