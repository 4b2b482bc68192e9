// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/output_folder.h"
#include "base/messages.h"
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

namespace calendem {
namespace fs = std::filesystem;

std::uintmax_t room_on_disk(const std::string &folder) {
  std::error_code error;
  const auto space = fs::space(folder, error);
  return error ? UINTMAX_MAX : space.available;
}

void make_output_folder(const std::string &folder, std::uintmax_t room) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && access(folder.c_str(), W_OK) != 0)
    error = std::error_code(errno, std::generic_category());
  if (error)
    throw Failure(kBadInput, fmt::format("cannot write into the folder '{}': {}. Give a folder "
                                         "that you may write to with -o.",
                                         folder, error.message()));
  if (room_on_disk(folder) < room)
    throw Failure(kBadInput, fmt::format("the disk of '{}' has {:.1f} MB left; this run needs at "
                                         "least {:.1f} MB. Make room or give another folder with "
                                         "-o.",
                                         folder, 1e-6 * room_on_disk(folder), 1e-6 * room));
}

} // namespace calendem
