// SPDX-License-Identifier: GPL-2.0-or-later
// The reader of label images under libFuzzer, VTK behind it: every input either works or throws
// Failure with exit status 2 and a message. The first byte of an input names the format, the file
// follows.
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <unistd.h>

#include "base/messages.h"
#include "electrode/structure/label_image.h"

namespace {

const char *const kEndings[] = {".vti",  ".mha", ".nrrd", ".tif", ".mhd",
                                ".nhdr", ".png", ".npy",  ".npz"};

void check(const calendem::LabelImage &image) {
  if (image.label.size() != size_t(image.n[0]) * image.n[1] * image.n[2] || image.label.empty())
    std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char *data, std::size_t size) {
  if (size == 0)
    return 0;
  static const std::string stem = std::string(std::getenv("FUZZ_FOLDER")) + "/input";
  const std::string file = stem + kEndings[std::size_t(data[0] + 256 - '0') % std::size(kEndings)];
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char *>(data) + 1, std::streamsize(size) - 1);
  try {
    check(calendem::read_label_image(file, 0.3));
  } catch (const calendem::Failure &f) {
    if (f.exit_status() != calendem::kBadInput || std::strlen(f.what()) < 10)
      std::abort();
  }
  unlink(file.c_str());
  return 0;
}
