// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the program on a case's in-script in a fresh folder and reads what it wrote.
// CALENDEM_LIGGGHTS (environment) names another program than the build's.
#ifndef CALENDEM_TESTS_RUN_CASE_H
#define CALENDEM_TESTS_RUN_CASE_H

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace calendem {

using Settings = std::map<std::string, std::string>;
using Files = std::map<std::string, std::string>;
using Row = std::map<std::string, double>;

inline std::string number(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

class CaseRun {
public:
  /// `script` relative to tests/verification; `settings` become `-var NAME VALUE`; `files` are
  /// written into the run's folder beforehand.
  CaseRun(const std::string &script, const Settings &settings, int ranks = 1,
          const Files &files = {}) {
    namespace fs = std::filesystem;
    static std::map<std::string, int> runs; // of each test
    const auto *test = ::testing::UnitTest::GetInstance()->current_test_info();
    const std::string name = std::string(test->test_suite_name()) + "." + test->name();
    if (ranks > 1 && name.find("Ranks") == std::string::npos)
      ADD_FAILURE() << "a test on several ranks has Ranks in its name, by which ctest knows it";
    const int run = ++runs[name];
    if (run == 1)
      fs::remove_all(fs::path(CALENDEM_SCRATCH) / name);
    folder_ = fs::path(CALENDEM_SCRATCH) / name / std::to_string(run);
    fs::create_directories(folder_);
    for (const auto &f : files)
      std::ofstream(folder_ / f.first) << f.second;
    const char *other = std::getenv("CALENDEM_LIGGGHTS");
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    // OpenMPI's files of a run: shared, one that ends removes the folder of another that starts
    setenv("OMPI_MCA_orte_tmpdir_base", folder_.c_str(), 1);
    const std::string start = // one rank needs no launcher
        ranks == 1 ? "OMPI_MCA_ess_singleton_isolated=1 OMPI_MCA_pml=ob1 OMPI_MCA_btl=self "
                   : "mpirun --oversubscribe -np " + std::to_string(ranks) + " ";
    std::string
        command = // no `-screen none`: the host's meshes write to a screen that is not there
        "cd '" + folder_.string() + "' && " + start + "'" + (other ? other : CALENDEM_PROGRAM) +
        "' -screen /dev/null -in '" CALENDEM_CASES "/" + script + "'";
    if (script.find("input_scripts/") == std::string::npos) // these know their variables
      command += " -var cases '" CALENDEM_CASES "'";
    for (const auto &s : settings)
      command += " -var " + s.first + " " + s.second;
    status_ = std::system((command + " > output.txt 2>&1").c_str());
  }

  bool finished() const { return status_ == 0; }
  const std::filesystem::path &folder() const { return folder_; }

  std::string text(const std::string &file) const {
    std::ifstream in(folder_ / file);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  }

  /// Rows of a CSV file by the names of its columns; cells that are no numbers are left out.
  std::vector<Row> rows(const std::string &file) const {
    std::istringstream in(text(file));
    std::vector<std::string> names;
    std::vector<Row> rows;
    for (std::string line; std::getline(in, line);) {
      std::vector<std::string> cells;
      std::istringstream cut(line);
      for (std::string cell; std::getline(cut, cell, ',');)
        cells.push_back(cell);
      if (names.empty()) {
        names = cells;
        continue;
      }
      Row row;
      for (size_t c = 0; c < cells.size() && c < names.size(); ++c) {
        char *end = nullptr;
        const double value = std::strtod(cells[c].c_str(), &end);
        if (end != cells[c].c_str())
          row[names[c]] = value;
      }
      rows.push_back(row);
    }
    return rows;
  }

  /// Frames of spheres.dump: for each sphere in the order of tags its columns by name.
  std::vector<std::vector<Row>> frames() const {
    std::istringstream in(text("spheres.dump"));
    std::vector<std::vector<Row>> all;
    std::vector<std::string> names;
    for (std::string line; std::getline(in, line);) {
      if (line.rfind("ITEM: ATOMS", 0) == 0) {
        std::istringstream words(line.substr(11));
        names.assign(std::istream_iterator<std::string>(words), {});
        all.emplace_back();
      } else if (line.rfind("ITEM:", 0) == 0) {
        names.clear();
      } else if (!names.empty()) {
        std::istringstream cells(line);
        Row row;
        for (const std::string &n : names)
          cells >> row[n];
        all.back().push_back(row);
      }
    }
    return all;
  }

  /// What the run says about itself, for a failure's message.
  std::string why() const { return text("output.txt") + text("log.liggghts"); }

private:
  std::filesystem::path folder_;
  int status_ = -1;
};

} // namespace calendem

#endif
