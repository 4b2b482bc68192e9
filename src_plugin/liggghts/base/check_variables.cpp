// SPDX-License-Identifier: GPL-2.0-or-later
#include "check_variables.h"
#include "comm.h"
#include "error.h"
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace LAMMPS_NS;

namespace {

std::vector<std::string> names_on_command_line() {
  std::ifstream in("/proc/self/cmdline");
  std::vector<std::string> out;
  for (std::string word; std::getline(in, word, '\0');)
    if ((word == "-var" || word == "-v") && std::getline(in, word, '\0'))
      out.push_back(word);
  return out;
}

std::set<std::string> names_in(const std::string &file) {
  std::ifstream in(file);
  std::set<std::string> out;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    if (std::string first, name, style;
        words >> first >> name >> style && first == "variable" && style == "index")
      out.insert(name);
  }
  return out;
}

/// Letters that two names do not share, in any order, less those that both begin with.
int distance(std::string a, std::string b) {
  const auto shared = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin();
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  std::string apart;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(apart));
  return int(apart.size()) - int(shared);
}

std::string first_unknown(const std::set<std::string> &known, const std::string &last_file) {
  for (const std::string &name : names_on_command_line()) {
    if (known.count(name))
      continue;
    const auto nearest =
        std::min_element(known.begin(), known.end(), [&](const auto &a, const auto &b) {
          return distance(a, name) < distance(b, name);
        });
    return std::string("-var ")
        .append(name)
        .append(": the scripts declare no such variable. Did you mean '")
        .append(*nearest)
        .append("'? ")
        .append(last_file)
        .append(" lists all");
  }
  return "";
}

} // namespace

void CheckVariables::command(int narg, char **arg) {
  if (narg < 1)
    error->all(FLERR, "check_variables takes FILE...");
  char message[512] = "";
  if (comm->me == 0) {
    std::set<std::string> known;
    for (int k = 0; k < narg; ++k)
      known.merge(names_in(arg[k]));
    if (known.empty())
      snprintf(message, sizeof message, "check_variables: no 'variable NAME index' in %s",
               arg[narg - 1]);
    else
      snprintf(message, sizeof message, "%s", first_unknown(known, arg[narg - 1]).c_str());
  }
  MPI_Bcast(message, sizeof message, MPI_CHAR, 0, world);
  if (message[0] != '\0')
    error->all(FLERR, message);
}
