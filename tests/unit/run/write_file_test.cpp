// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/messages.h"
#include "base/provenance.h"
#include "support/test_folder.h"
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using namespace calendem;

constexpr int kWriters = 4, kTimes = 300;
const std::string kContent(20000, 'x');

/// Writes the file again and again in a process of its own; exit status 0 unless one write failed.
pid_t begin_writer(const std::string &file) {
  const pid_t child = fork();
  if (child != 0)
    return child;
  int failed = 0;
  for (int k = 0; k < kTimes; ++k)
    try {
      write_file(file, kContent);
    } catch (const Failure &) {
      failed = 1;
    }
  _exit(failed);
}

// Requirement: tasks of a cluster that write the same file at the same time do not hinder each
// other; whoever reads it finds it whole; nothing else is left.
TEST(WriteFile, ProcessesMayWriteTheSameFileAtOnce) {
  const auto folder = calendem_test::test_folder();
  const std::string file = (folder / "study.json").string();
  pid_t writers[kWriters];
  for (pid_t &w : writers)
    w = begin_writer(file);
  for (const pid_t w : writers) {
    int status = 0;
    ASSERT_EQ(waitpid(w, &status, 0), w);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    EXPECT_EQ(text_of_file(file), kContent);
  }
  int files = 0;
  for ([[maybe_unused]] const auto &entry : std::filesystem::directory_iterator(folder))
    ++files;
  EXPECT_EQ(files, 1);
}

TEST(WriteFile, AFolderThatIsNotThereIsNamed) {
  const std::string folder = (calendem_test::test_folder() / "none").string();
  try {
    write_file(folder + "/a.txt", kContent);
    FAIL() << "written";
  } catch (const Failure &f) {
    EXPECT_NE(std::string(f.what()).find("there is no folder '" + folder + "'"), std::string::npos)
        << f.what();
  }
}

TEST(WriteFile, WhatCannotBeWrittenLeavesNothing) {
  const auto folder = calendem_test::test_folder();
  std::filesystem::create_directory(folder / "taken"); // a folder of that name: no file can be it
  std::filesystem::create_directory(folder / "taken" / "full");
  EXPECT_THROW(write_file((folder / "taken").string(), kContent), Failure);
  int files = 0;
  for ([[maybe_unused]] const auto &entry : std::filesystem::directory_iterator(folder))
    ++files;
  EXPECT_EQ(files, 1);
}

} // namespace
