// SPDX-License-Identifier: GPL-2.0-or-later
// A study under way: which packings and runs it needs, how each stands, and how one is made.
#ifndef CALENDEM_SIMULATE_MAKING_H
#define CALENDEM_SIMULATE_MAKING_H

#include "simulate/study.h"
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>

namespace calendem {

/// Keeps other programs out as long as it lives, where the file system knows locks; waits for them.
class WaitingLock {
public:
  explicit WaitingLock(const std::string &file);
  ~WaitingLock();
  WaitingLock(const WaitingLock &) = delete;
  WaitingLock &operator=(const WaitingLock &) = delete;

private:
  int file_;
};

/// Runs count from 0 here, in the order of the study.
class Making {
public:
  /// Both must outlive it. `options.folder` and `options.liggghts` are absolute paths.
  Making(const Study &study, const StudyOptions &options);

  /// Makes the step of the options of this run, unless it is there already.
  void make(int k);
  /// Looks again how the runs stand that are not done, this one left out.
  void refresh(int but = -1);
  /// A run that other programs were to make and that they did not make, with what is known of it.
  void lost(int k, const std::string &why);
  void write_table();

  std::vector<int> runs_to_make() const;
  /// Of each packing that is not there and that a run needs, its first run.
  std::vector<int> packings_to_make() const;
  int count(const std::string &status) const;
  bool packed(int k) const;
  bool ended(int k) const; ///< done, or its checks did not hold
  std::string failures() const;
  std::string log_of(int k) const; ///< of its packing as long as that is not there
  std::vector<std::string> finished() const;
  nlohmann::json description() const;

private:
  /// Where a run's results lie and how it stands.
  struct RunState {
    std::string run, packing;           ///< names of their folders: hashes of what they depend on
    std::string status = "not started"; ///< "done", "checks failed", "failed", ...
    std::string results;                ///< cells of the table
    std::string why;                    ///< what is known of a failure
  };
  const Study &study_;
  const StudyOptions &o_;
  std::vector<RunState> states_;
  std::mutex guard_;
  std::map<std::string, std::string> not_packed_; ///< why, by folder: other runs do not try again

  std::string run_folder(const RunState &s) const;
  std::string packing_folder(const RunState &s) const;
  std::string status_of(const RunState &s) const;
  std::string results(const RunState &s) const;
  void set_status(int k, const std::string &status);
  void report(int k, const std::string &what);
  std::vector<std::string> command(const char *verb, const std::string &spec,
                                   const std::string &folder) const;
  std::string pack(int k);
  std::string run(int k);
  void keep_tables(int k) const;
};

} // namespace calendem

#endif
