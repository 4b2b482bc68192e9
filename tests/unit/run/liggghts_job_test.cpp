// SPDX-License-Identifier: GPL-2.0-or-later
// How LIGGGHTS is started, with a stand-in for mpirun.
#include "base/liggghts_job.h"
#include "base/messages.h"
#include "base/provenance.h"
#include "support/test_folder.h"
#include <cstdlib>
#include <gtest/gtest.h>
#include <optional>
#include <thread>
#include <unistd.h>

namespace {

using namespace calendem;
namespace fs = std::filesystem;

/// Sets a variable of this program's environment for its life; nullptr: removes it.
class Variable {
public:
  Variable(const char *name, const char *value) : name_(name) {
    if (const char *is = std::getenv(name))
      before_ = is;
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable &) = delete;
  Variable &operator=(const Variable &) = delete;

private:
  const char *name_;
  std::optional<std::string> before_;

  void set(const char *value) { value ? setenv(name_, value, 1) : unsetenv(name_); }
};

/// What a stand-in for mpirun, a shell script, prints when a job with so many ranks is run.
/// `temporary`: where this program is told to put temporary files.
std::string said_by_mpirun(const std::string &script, int ranks, const std::string &temporary) {
  const fs::path folder = calendem_test::test_folder(); // in another TMPDIR it would be another
  const Variable tmpdir("TMPDIR", temporary.c_str());
  write_file((folder / "mpirun").string(), "#!/bin/sh\n" + script + "\n");
  write_file((folder / "liggghts").string(), "#!/bin/sh\n");
  for (const char *program : {"mpirun", "liggghts"})
    fs::permissions(folder / program, fs::perms::owner_all);
  const Variable path("PATH", (folder.string() + ":" + std::getenv("PATH")).c_str());
  LiggghtsJob job;
  job.program = (folder / "liggghts").string();
  job.ranks = ranks;
  job.script = "in.script";
  job.log = (folder / "log.liggghts").string();
  job.screen = (folder / "screen").string();
  try {
    run_liggghts(job, [] {});
  } catch (const Failure &) {
  }
  return text_of_file(job.screen);
}

std::string asked_of_mpirun(int ranks) {
  return said_by_mpirun("echo \"$*\"", ranks, testing::TempDir());
}

// As many ranks as cores keep one each; fewer may move; what the user asks OpenMPI for holds.
TEST(Ranks, KeepTheirCoresWhereTheyHaveThemAll) {
  const Variable none("OMPI_MCA_hwloc_base_binding_policy", nullptr);
  const int cores = int(std::thread::hardware_concurrency());
  const bool all = cores == sysconf(_SC_NPROCESSORS_ONLN); // of the machine's are this program's
  EXPECT_NE(asked_of_mpirun(cores).find(all ? "--bind-to core:if-supported" : "--bind-to none"),
            std::string::npos);
  if (cores > 1)
    EXPECT_NE(asked_of_mpirun(cores - 1).find("--bind-to none"), std::string::npos);
  const std::string more = asked_of_mpirun(cores + 1);
  EXPECT_NE(more.find("--oversubscribe"), std::string::npos);
  EXPECT_EQ(more.find("--bind-to"), std::string::npos);
  const Variable users("OMPI_MCA_hwloc_base_binding_policy", "none");
  EXPECT_EQ(asked_of_mpirun(cores).find("--bind-to"), std::string::npos);
}

/// The folder that mpirun has for its temporary files, by a stand-in that leaves some in it.
fs::path used_by_mpirun(const std::string &temporary, const std::string &then) {
  std::string said =
      said_by_mpirun("mkdir \"$TMPDIR/ompi.host\" && touch \"$TMPDIR/ompi.host/file\""
                     " && echo \"$TMPDIR\"\n" +
                         then,
                     1, temporary);
  EXPECT_FALSE(said.empty()) << "mpirun could not write into its folder";
  said.erase(said.find_last_not_of('\n') + 1);
  return said;
}

// Two runs of OpenMPI that share a folder remove it under each other.
TEST(TemporaryFiles, EachRunHasAFolderOfItsOwnWhichIsRemoved) {
  const std::string users = testing::TempDir() + "calendem_temporary_files";
  fs::remove_all(users);
  fs::create_directories(users);
  const fs::path one = used_by_mpirun(users, ""), two = used_by_mpirun(users, "exit 1");
  EXPECT_EQ(one.parent_path(), users);
  EXPECT_EQ(two.parent_path(), users);
  EXPECT_NE(one, two);
  EXPECT_TRUE(fs::is_empty(users)); // after a failure too
}

TEST(TemporaryFiles, WhatTheUserSetsHolds) {
  const Variable base("OMPI_MCA_orte_tmpdir_base", "/place/of/the/user");
  const std::string asked = "echo \"$OMPI_MCA_orte_tmpdir_base $TMPDIR\"";
  EXPECT_EQ(said_by_mpirun(asked, 1, "/no/such/folder"), // none can be made there
            "/place/of/the/user /no/such/folder\n");
}

} // namespace
