// SPDX-License-Identifier: GPL-2.0-or-later
// What the header of an image announces, and whether the file can hold it; TIFF read whole. VTK's
// readers take what they find: they fill up what is missing without an error, allocate what a wrong
// number asks for, divide by zero, wait for lines that never come. So the header is checked before
// VTK sees the file.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_IMAGE_HEADER_H
#define CALENDEM_ELECTRODE_STRUCTURE_IMAGE_HEADER_H

#include "base/messages.h"
#include <array>
#include <limits>
#include <map>
#include <string>
#include <vector>

class vtkImageData;
template <class T> class vtkSmartPointer;

namespace calendem {

/// A label takes four bytes in memory.
constexpr long kMostVoxels = 2147483647;

/// Failure(2) with the name of the file; values are put into the text as by fmt::format.
[[noreturn]] void refuse_image(const std::string &file, const std::string &what);
template <class First, class... Others>
[[noreturn]] void refuse_image(const std::string &file, fmt::format_string<First, Others...> what,
                               First &&first, Others &&...others) {
  refuse_image(file,
               fmt::format(what, std::forward<First>(first), std::forward<Others>(others)...));
}

/// Each throws Failure(2) unless the file has three axes and one number per voxel, is as long as it
/// announces and says nothing that VTK takes otherwise than the format's description.
void check_meta_image(const std::string &file);
void check_nrrd(const std::string &file);
void check_vti(const std::string &file); ///< as far as its first MB says

/// The header of a file that passed its check gives the spacing; VTK takes 1 where it does not.
bool states_voxel_size(const std::string &file);
bool states_voxel_size_of_vti(const std::string &file);

/// The lines "name = value" (MetaImage, separator "=") or "name: value" (NRRD, ": ") up to the
/// data.
class ImageHeader {
public:
  /// Throws Failure(2) where a line is none, is longer than VTK's buffers or there twice, or where
  /// the header does not end.
  ImageHeader(const std::string &file, const std::string &separator);

  bool has(const std::string &name) const { return fields_.count(name) > 0; }
  std::string text(const std::string &name) const;
  long bytes() const { return bytes_; } ///< up to where data may begin

  /// Three whole numbers; 0 where they are none.
  std::array<long, 3> axes(const std::string &name) const;
  /// Bytes of a voxel whose type is one of `types`.
  struct Type {
    const char *names; ///< a pattern
    long bytes;
  };
  long type_size(const std::string &name, const std::vector<Type> &types) const;
  /// Throw Failure(2) where the field is there and is not `wanted` finite numbers, one of
  /// `allowed`.
  void check_numbers(const std::string &name, size_t wanted) const;
  void check_is(const std::string &name, const std::vector<std::string> &allowed) const;
  /// Throws Failure(2) where the field is not there.
  void need(const std::string &name) const;

private:
  std::string file_, separator_;
  std::map<std::string, std::string> fields_;
  long bytes_ = 0;

  bool take(int number, const std::string &line);
};

/// Throws Failure(2) if the axes are not of 1 voxel and more, have more voxels than can be read, or
/// more than `bytes` of data can hold at `most_per_byte` voxels per byte.
constexpr double kAnyNumber = std::numeric_limits<double>::infinity();
void check_axes(const std::string &file, const std::array<long, 3> &n, long bytes,
                double most_per_byte = kAnyNumber);
/// Throws Failure(2) if there are fewer bytes than announced.
void check_length(const std::string &file, double announced, long there);

/// zlib packs at most 1032 bytes into one.
constexpr double kDeflate = 1032.0;

// Whether packed voxels (zlib or gzip) are whole. MetaIO waits forever on a stream that is not.

/// Bytes that the stream at `offset` of `file`, at most `length` long, unpacks to; stops above
/// `most`. -1: the stream is cut or damaged.
long unpacked_bytes(const std::string &file, long offset, long length, long most);

// Label images in TIFF files, by libtiff: VTK's reader changes the numbers of files that show 0 as
// white, cannot read tiles in a stack and turns a single page upside down, but not a stack.

/// All pages, also those that a description announces behind the only one, the first at the bottom, with rows and numbers as the file stores them, whatever
/// colours and orientation it gives them. Throws Failure(2) unless the file is whole and its pages
/// have one size and one number per voxel.
vtkSmartPointer<vtkImageData> read_tiff(const std::string &file);
/// Sides of a voxel [um] as ImageJ (Fiji) or OME state them; 0 where they do not.
std::array<double, 3> voxel_size_of_tiff(const std::string &file);

// Arrays of NumPy and slices as PNG.

/// Axes (z, y, x) of whole numbers, in a .npy file or alone in a .npz file. Throws Failure(2) unless
/// the file is whole.
vtkSmartPointer<vtkImageData> read_numpy(const std::string &file);
/// Grey values of 8 or 16 bits, the rows as the file stores them. Throws Failure(2) for colours.
vtkSmartPointer<vtkImageData> read_png(const std::string &file);

} // namespace calendem

#endif
