// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/packed_data.h"
#include <algorithm>
#include <fstream>
#include <vector>
#include <vtk_zlib.h>

namespace calendem {

long unpacked_bytes(const std::string &file, long offset, long length, long most) {
  constexpr int kAnyHeader = 47; // zlib's or gzip's, the largest window
  std::vector<char> in(1 << 16), out(1 << 18);
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(offset);
  z_stream z{};
  if (inflateInit2(&z, kAnyHeader) != Z_OK)
    return -1;
  long total = 0;
  int state = Z_OK;
  while (state == Z_OK && total <= most) {
    if (z.avail_in == 0) {
      stream.read(in.data(), std::min(long(in.size()), length));
      length -= long(stream.gcount());
      z.next_in = reinterpret_cast<Bytef *>(in.data());
      z.avail_in = static_cast<uInt>(stream.gcount());
    }
    z.next_out = reinterpret_cast<Bytef *>(out.data());
    z.avail_out = static_cast<uInt>(out.size());
    state = inflate(&z, Z_NO_FLUSH); // Z_BUF_ERROR once there is nothing left to read
    total += long(out.size()) - long(z.avail_out);
  }
  inflateEnd(&z);
  return state == Z_STREAM_END || total > most ? total : -1;
}

} // namespace calendem
