// SPDX-License-Identifier: GPL-2.0-or-later
// Label images (segmented tomograms): 0 or another number is background, every other number one
// particle. Read and written by VTK's classes, TIFF by libtiff, NumPy's arrays here.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_LABEL_IMAGE_H
#define CALENDEM_ELECTRODE_STRUCTURE_LABEL_IMAGE_H

#include "base/image_series.h"
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace calendem {

struct LabelImage {
  std::array<int, 3> n = {0, 0, 0};
  Eigen::Vector3d voxel = Eigen::Vector3d::Ones(); ///< sides of a voxel [um]
  std::vector<std::int32_t> label;                 ///< x runs fastest
  std::string file;                                ///< that it was read from

  size_t index(int i, int j, int k) const { return (size_t(k) * n[1] + j) * n[0] + i; }
  std::int32_t at(int i, int j, int k) const { return label[index(i, j, k)]; }
};

/// Formats by the file's ending: .vti, .mhd .mha, .nrrd .nhdr, .tif .tiff, .png, .npy .npz (TIFF: one
/// file of many pages; TIFF and PNG: a numbered series given as a pattern such as slice_%04d.tif).
/// `voxel_um` > 0 replaces the voxel size of the file; it is needed where the file states none.
/// Prints what the file states, and the shares of few labels. Throws Failure(2) with what is wrong:
/// no file, a format that is not read, a file that is cut, labels that are not whole numbers, an
/// implausible voxel size.
LabelImage read_label_image(const std::string &file, double voxel_um = 0.0);

/// The image turned, not mirrored, until its axis `upwards` ("z", "x", "-y" ...) is z. Places along x and
/// y are then those along the axes that follow it in the order x, y, z, x; with -, those of y backwards.
LabelImage turned(const LabelImage &image, const std::string &upwards);

/// Throws Failure(2) where a label below 0 is none of those that mean something.
void refuse_negative_labels(const LabelImage &image,
                            const std::vector<std::optional<std::int32_t>> &known);

/// Writes .mhd (with a .zraw beside it), .mha, .vti or .tif. Throws Failure(2) where it cannot, as on a
/// full disk; what was there before is kept.
void write_label_image(const LabelImage &image, const std::string &file);

/// A page for each slice, the smallest type that holds all labels, packed (deflate), sides of a voxel
/// as ImageJ states them. False where it cannot be written.
bool write_tiff(const LabelImage &image, const std::string &file);

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
