// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/liggghts_job.h"
#include "base/provenance.h"
#include "support/test_folder.h"
#include <cstdlib>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>

namespace {

using namespace calendem;

/// What mpirun is asked for with so many ranks: the stand-in prints its arguments.
std::string asked_of_mpirun(int ranks) {
  const auto folder = calendem_test::test_folder();
  write_file((folder / "mpirun").string(), "#!/bin/sh\necho \"$*\"\n");
  write_file((folder / "liggghts").string(), "#!/bin/sh\n");
  for (const char *program : {"mpirun", "liggghts"})
    std::filesystem::permissions(folder / program, std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  setenv("PATH", (folder.string() + ":" + path).c_str(), 1);
  LiggghtsJob job;
  job.program = (folder / "liggghts").string();
  job.ranks = ranks;
  job.script = "in.script";
  job.log = (folder / "log.liggghts").string();
  job.screen = (folder / "screen").string();
  run_liggghts(job, [] {});
  setenv("PATH", path.c_str(), 1);
  return text_of_file(job.screen);
}

// As many ranks as cores keep one each; fewer may move; what the user asks OpenMPI for holds.
TEST(Ranks, KeepTheirCoresWhereTheyHaveThemAll) {
  unsetenv("OMPI_MCA_hwloc_base_binding_policy");
  const int cores = int(std::thread::hardware_concurrency());
  const bool all = cores == sysconf(_SC_NPROCESSORS_ONLN); // of the machine's are this program's
  EXPECT_NE(asked_of_mpirun(cores).find(all ? "--bind-to core:if-supported" : "--bind-to none"),
            std::string::npos);
  if (cores > 1)
    EXPECT_NE(asked_of_mpirun(cores - 1).find("--bind-to none"), std::string::npos);
  const std::string more = asked_of_mpirun(cores + 1);
  EXPECT_NE(more.find("--oversubscribe"), std::string::npos);
  EXPECT_EQ(more.find("--bind-to"), std::string::npos);
  setenv("OMPI_MCA_hwloc_base_binding_policy", "none", 1);
  EXPECT_EQ(asked_of_mpirun(cores).find("--bind-to"), std::string::npos);
}

} // namespace
