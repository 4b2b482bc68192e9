// SPDX-License-Identifier: GPL-2.0-or-later
// Label images as TIFF, with the voxel size where Fiji and Python's programs look for it.
#include "electrode/structure/image_header.h"
#include "electrode/structure/label_image.h"
#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <tiffio.h>

namespace calendem {
namespace {

struct Quiet { // libtiff writes to the terminal
  TIFFErrorHandler before = TIFFSetErrorHandler(nullptr);
  Quiet() = default;
  ~Quiet() { TIFFSetErrorHandler(before); }
  Quiet(const Quiet &) = delete;
  Quiet &operator=(const Quiet &) = delete;
};

void set_fields(TIFF *tiff, const LabelImage &image, int bits, bool sign) {
  const std::string description = fmt::format(
      "ImageJ=1.53t\nimages={0}\nslices={0}\nunit=micron\nspacing={1:.9g}\nloop=false\n",
      image.n[2], image.voxel[2]);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, std::uint32_t(image.n[0]));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, std::uint32_t(image.n[1]));
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, std::uint32_t(image.n[1]));
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, sign ? SAMPLEFORMAT_INT : SAMPLEFORMAT_UINT);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, description.c_str());
  TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
  TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 1.0 / image.voxel[0]);
  TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 1.0 / image.voxel[1]);
}

template <class Voxel> bool write_pages(TIFF *tiff, const LabelImage &image, bool sign) {
  const size_t page = size_t(image.n[0]) * image.n[1];
  std::vector<Voxel> voxels(page);
  for (int k = 0; k < image.n[2]; ++k) {
    set_fields(tiff, image, 8 * int(sizeof(Voxel)), sign);
    std::transform(image.label.begin() + long(k * page), image.label.begin() + long((k + 1) * page),
                   voxels.begin(), [](std::int32_t label) { return Voxel(label); });
    if (TIFFWriteEncodedStrip(tiff, 0, voxels.data(), tmsize_t(page * sizeof(Voxel))) < 0 ||
        !TIFFWriteDirectory(tiff))
      return false;
  }
  return true;
}

} // namespace

bool write_tiff(const LabelImage &image, const std::string &file) {
  constexpr double kClassic = 4e9; // bytes; larger files need another kind of TIFF
  const Quiet quiet;
  const auto [low, high] = std::minmax_element(image.label.begin(), image.label.end());
  const bool large = 4.0 * double(image.label.size()) > kClassic;
  const std::unique_ptr<TIFF, void (*)(TIFF *)> tiff(TIFFOpen(file.c_str(), large ? "w8" : "w"),
                                                     TIFFClose);
  if (!tiff)
    return false;
  if (*low >= 0 && *high <= UINT8_MAX)
    return write_pages<std::uint8_t>(tiff.get(), image, false);
  if (*low >= 0 && *high <= UINT16_MAX)
    return write_pages<std::uint16_t>(tiff.get(), image, false);
  if (*low >= INT16_MIN && *high <= INT16_MAX)
    return write_pages<std::int16_t>(tiff.get(), image, true);
  return write_pages<std::int32_t>(tiff.get(), image, true);
}

} // namespace calendem
