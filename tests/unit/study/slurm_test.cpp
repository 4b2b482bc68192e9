// SPDX-License-Identifier: GPL-2.0-or-later
#include "simulate/making.h"
#include <gtest/gtest.h>

namespace calendem {
namespace {

TEST(Slurm, RangesAreThoseOfSbatch) {
  EXPECT_EQ(ranges_of({}), "");
  EXPECT_EQ(ranges_of({4}), "4");
  EXPECT_EQ(ranges_of({1, 2, 3, 7, 9, 10}), "1-3,7,9-10");
}

TEST(Slurm, ScriptHoldsAllThatSbatchNeeds) {
  SlurmArray a;
  a.name = "calendem-0-runs";
  a.file = "runs";
  a.purpose = "A task makes a run.";
  a.command = {"/opt/a program", "study", "it's.toml", "--only"};
  a.tasks = {1, 2, 5};
  a.at_once = 2;
  a.ranks = 4;
  a.options = "--partition=x --time=04:00:00";
  const std::string script = array_script(a);
  for (const char *line :
       {"#SBATCH --ntasks=4\n", "#SBATCH --partition=x --time=04:00:00\n",
        "#SBATCH --job-name=calendem-0-runs\n", "#SBATCH --array=1-2,5%2\n",
        "#SBATCH --output=runs.%a.log\n",
        "exec '/opt/a program' 'study' 'it'\\''s.toml' '--only' \"${SLURM_ARRAY_TASK_ID:-$1}\"\n"})
    EXPECT_NE(script.find(line), std::string::npos) << line << "in\n" << script;
  EXPECT_LT(script.find("--partition"), script.find("--job-name")) << "the later one counts";
  a.at_once = 0;
  EXPECT_NE(array_script(a).find("#SBATCH --array=1-2,5\n"), std::string::npos);
}

TEST(Slurm, TasksThatWaitRunOrEndAreStillLive) {
  for (const char *state : {"PENDING", "RUNNING", "COMPLETING", "REQUEUED", "SUSPENDED"})
    EXPECT_TRUE((SlurmTask{1, state, ""}).live()) << state;
  for (const char *state : {"COMPLETED", "FAILED", "TIMEOUT", "CANCELLED", "UNKNOWN"})
    EXPECT_FALSE((SlurmTask{1, state, ""}).live()) << state;
}

} // namespace
} // namespace calendem
