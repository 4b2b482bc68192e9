// SPDX-License-Identifier: GPL-2.0-or-later
// The folder of -o: made, with room on its disk, for one writer at a time; what others left in it is
// not replaced.
#ifndef CALENDEM_BASE_OUTPUT_FOLDER_H
#define CALENDEM_BASE_OUTPUT_FOLDER_H

#include <cstdint>
#include <string>

namespace calendem {

/// Bytes left on the disk of `folder`; the largest number if that cannot be found out.
std::uintmax_t room_on_disk(const std::string &folder);

/// Makes the folder of -o. Throws Failure(2) if it cannot be written or its disk has less than
/// `room` bytes left.
void make_output_folder(const std::string &folder, std::uintmax_t room = 0);

/// Throws Failure(2) if `file` exists and does not begin with `head`: somebody else's file of that
/// name, which would be replaced.
void require_own_file(const std::string &file, const std::string &head);

/// Throws Failure(2) if `folder` is `input`, a folder that is read.
void must_not_be(const std::string &folder, const std::string &input, const std::string &what);

/// Keeps others out of a folder as long as this program, and the LIGGGHTS that it started, is alive;
/// where the file system knows locks.
class FolderLock {
public:
  /// Throws Failure(2) if another has it.
  explicit FolderLock(const std::string &folder) : FolderLock(folder + "/.lock", folder) {}
  ~FolderLock();
  FolderLock(const FolderLock &) = delete;
  FolderLock &operator=(const FolderLock &) = delete;

protected:
  /// Without a folder it waits for the others.
  FolderLock(const std::string &file, const std::string &folder);

private:
  int file_;
};

/// Waits until others leave the file, and keeps them out as long as it lives.
struct WaitingLock : FolderLock {
  explicit WaitingLock(const std::string &file) : FolderLock(file, "") {}
};

} // namespace calendem

#endif
