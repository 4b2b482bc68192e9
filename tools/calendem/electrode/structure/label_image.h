// SPDX-License-Identifier: GPL-2.0-or-later
// Label images (segmented tomograms): 0 or another number is background, every other number one
// particle. Read and written by VTK's classes, TIFF by libtiff.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_LABEL_IMAGE_H
#define CALENDEM_ELECTRODE_STRUCTURE_LABEL_IMAGE_H

#include "base/image_series.h"
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace calendem {

struct LabelImage {
  std::array<int, 3> n = {0, 0, 0};
  Eigen::Vector3d voxel = Eigen::Vector3d::Ones(); ///< sides of a voxel [um]
  std::vector<std::int32_t> label;                 ///< x runs fastest

  size_t index(int i, int j, int k) const { return (size_t(k) * n[1] + j) * n[0] + i; }
  std::int32_t at(int i, int j, int k) const { return label[index(i, j, k)]; }
};

/// Formats by the file's ending: .vti, .mhd .mha, .nrrd .nhdr, .tif .tiff (one file of many pages,
/// or a numbered series given as a pattern such as slice_%04d.tif).
/// `voxel_um` > 0 replaces the voxel size of the file; it is needed for TIFF and for files whose
/// header states none. Throws Failure(2) with what is wrong: no file, a format that is not
/// read, a file that is cut, labels that are not whole numbers, an implausible voxel size.
LabelImage read_label_image(const std::string &file, double voxel_um = 0.0);

/// Writes .mhd (with a .zraw beside it), .mha or .vti. Throws Failure(2) where it cannot, as on a
/// full disk; what was there before is kept.
void write_label_image(const LabelImage &image, const std::string &file);

/// Endings that can be read, for messages.
std::string readable_images();
bool is_readable_image(const std::string &file);

/// Hash of the image's files: a pattern's slices, a header and the data it names.
std::string hash_of_image(const std::string &file);

/// Name of the data file that a MetaImage or NRRD header names, with its folder; empty if the data
/// follow the header. Throws Failure(2) if that file does not exist or the data are in several.
std::string data_file_of(const std::string &header);

} // namespace calendem

#endif
