// SPDX-License-Identifier: GPL-2.0-or-later
// Whether packed voxels (zlib or gzip) are whole. MetaIO waits forever on a stream that is not.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_PACKED_DATA_H
#define CALENDEM_ELECTRODE_STRUCTURE_PACKED_DATA_H

#include <string>

namespace calendem {

/// Bytes that the stream at `offset` of `file`, at most `length` long, unpacks to; stops above
/// `most`. -1: the stream is cut or damaged.
long unpacked_bytes(const std::string &file, long offset, long length, long most);

} // namespace calendem

#endif
