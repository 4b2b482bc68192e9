// SPDX-License-Identifier: GPL-2.0-or-later
#include "body_map.h"
#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix.h"
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

using namespace LAMMPS_NS;

void BodyMap::read(const std::string &file) {
  of_tag_.assign(atom->tag_max() + 1, 0);
  char problem[512] = "";
  if (comm->me == 0)
    snprintf(problem, sizeof problem, "%s", read_rows(file).c_str());
  MPI_Bcast(problem, sizeof problem, MPI_CHAR, 0, world);
  if (problem[0])
    error->fix_error(FLERR, owner_, problem);
  MPI_Bcast(of_tag_.data(), static_cast<int>(of_tag_.size()), MPI_INT, 0, world);
  measure();
}

// Returns what is wrong with the file, nothing if all is well.
std::string BodyMap::read_rows(const std::string &file) {
  const std::unique_ptr<FILE, int (*)(FILE *)> fp(fopen(file.c_str(), "r"), fclose);
  const std::string name = "the body map '" + file.substr(0, 300) + "'";
  if (!fp)
    return "cannot open " + name + ": " + strerror(errno);
  char line[256];
  int announced = -1, rows = 0;
  for (int row = 1; fgets(line, sizeof line, fp.get()); ++row) {
    sscanf(line, "# tag body, %d rows", &announced);
    if (line[strspn(line, " \t\r\n")] == '\0' || line[strspn(line, " \t")] == '#')
      continue;
    const std::string problem = read_row(line, row, file, &rows);
    if (!problem.empty())
      return problem;
  }
  if (announced >= 0 && rows != announced)
    return name + " announces " + std::to_string(announced) + " rows and holds " +
           std::to_string(rows) + ": it is cut. Make the electrode again";
  return "";
}

std::string BodyMap::read_row(const char *line, int row, const std::string &file, int *rows) {
  const int highest = static_cast<int>(of_tag_.size()) - 1;
  int tag = 0, body = 0;
  char rest = 0;
  const int n = sscanf(line, "%d %d %c", &tag, &body, &rest);
  if (n != 2 || tag < 1 || tag > highest || body < 1 || of_tag_[tag]) {
    const std::string text(line, std::min<size_t>(strcspn(line, "\r\n"), 60));
    return file.substr(0, 200) + ":" + std::to_string(row) + ": '" + text +
           "' is not a row 'tag body' with 1 <= tag <= " + std::to_string(highest) +
           " (each once) and body >= 1";
  }
  of_tag_[tag] = body;
  ++*rows;
  return "";
}

int BodyMap::highest() const {
  return of_tag_.empty() ? 0 : *std::max_element(of_tag_.begin(), of_tag_.end());
}

// Added in the order of tags, so that no bit depends on the number of ranks: of each term all ranks
// but one have 0.
void BodyMap::measure() {
  const int n = static_cast<int>(of_tag_.size());
  std::vector<double> mine(n, 0.0), cube(n);
  for (int i = 0; i < atom->nlocal; ++i)
    mine[atom->tag[i]] = std::pow(2.0 * atom->radius[i], 3);
  MPI_Allreduce(mine.data(), cube.data(), n, MPI_DOUBLE, MPI_SUM, world);
  diameter_.clear();
  for (int tag = 1; tag < n; ++tag)
    diameter_[of_tag_[tag]] += cube[tag];
  for (auto &body : diameter_)
    body.second = std::cbrt(body.second);
}
