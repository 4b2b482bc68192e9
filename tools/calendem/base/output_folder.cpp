// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/output_folder.h"
#include "base/messages.h"
#include "base/provenance.h"
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
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
    throw Failure(
        kBadInput,
        "cannot write into the folder '{}': {}. Give a folder that you may write to with -o.",
        folder, error.message());
  if (room_on_disk(folder) < room)
    throw Failure(kBadInput,
                  "the disk of '{}' has {:.1f} MB left; this run needs at least {:.1f} MB. Make "
                  "room or give another folder with -o.",
                  folder, 1e-6 * room_on_disk(folder), 1e-6 * room);
}

void require_own_file(const std::string &file, const std::string &head) {
  if (fs::exists(file) && text_of_file(file).rfind(head, 0) != 0)
    throw Failure(kBadInput,
                  "'{}' was not written by this command (its first line does not begin with '{}') "
                  "and would be replaced. Give another folder with -o.",
                  file, head);
}

void must_not_be(const std::string &folder, const std::string &input, const std::string &what) {
  std::error_code none;
  if (fs::equivalent(folder, input, none))
    throw Failure(
        kBadInput,
        "-o is '{}', the folder of {}, whose files would be replaced. Give another folder with -o.",
        folder, what);
}

// The descriptor of a folder is left open for LIGGGHTS on purpose: should this program be killed, the
// lock lasts until LIGGGHTS has ended too.
FolderLock::FolderLock(const std::string &file, const std::string &folder)
    : file_(open(file.c_str(), O_RDWR | O_CREAT | (folder.empty() ? O_CLOEXEC : 0), 0644)) {
  if (file_ >= 0 && flock(file_, folder.empty() ? LOCK_EX : LOCK_EX | LOCK_NB) != 0 &&
      !folder.empty())
    throw Failure(kBadInput,
                  "another run is writing into '{}'. Wait for its end, or give another folder with "
                  "-o.",
                  folder);
}

FolderLock::~FolderLock() {
  if (file_ >= 0)
    close(file_);
}

} // namespace calendem
