// SPDX-License-Identifier: GPL-2.0-or-later
#include "write_restart_whole.h"
#include "comm.h"
#include "error.h"
#include "write_restart.h"
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <unistd.h>
#include <vector>

using namespace LAMMPS_NS;

namespace {

// A disk that takes more now took all that was written before.
bool takes_more(const std::string &file) {
  FILE *fp = fopen(file.c_str(), "ab");
  if (!fp)
    return false;
  const long size = fseek(fp, 0, SEEK_END) == 0 ? ftell(fp) : -1;
  const std::vector<char> more(1 << 16);
  const bool wrote = size > 0 && fwrite(more.data(), 1, more.size(), fp) == more.size() &&
                     fflush(fp) == 0 && fsync(fileno(fp)) == 0 &&
                     ftruncate(fileno(fp), size) == 0 && fsync(fileno(fp)) == 0;
  return fclose(fp) == 0 && wrote;
}

bool replace(const std::string &part, const char *file, const char *old) {
  if (!takes_more(part)) {
    remove(part.c_str());
    return false;
  }
  if (rename(file, old) != 0 && errno != ENOENT)
    return false;
  return rename(part.c_str(), file) == 0;
}

} // namespace

void WriteRestartWhole::command(int narg, char **arg) {
  if (narg != 3 || strcmp(arg[1], "keep"))
    error->all(FLERR, "write_restart/whole takes 'FILE keep OLD'");
  const std::string part = std::string(arg[0]) + ".part";
  std::vector<char> name(part.begin(), part.end());
  name.push_back('\0');
  char *words[] = {name.data()};
  WriteRestart(lmp).command(1, words);
  if (comm->me == 0 && !replace(part, arg[0], arg[2]))
    error->warning(FLERR, "the restart file could not be written whole (is the disk full?); the "
                          "one before it is kept");
  MPI_Barrier(world);
}
