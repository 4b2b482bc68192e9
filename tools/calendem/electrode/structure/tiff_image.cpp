// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/image_header.h"
#include <algorithm>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <tiffio.h>
#include <vector>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

namespace calendem {
namespace {

constexpr double kPacked = 10000.0; // voxels that the best packing has put into a byte

thread_local std::string said; // libtiff's last error; its handler carries nothing else

void note_error(const char *, const char *format, va_list values) {
  char text[300];
  std::vsnprintf(text, sizeof text, format, values);
  said = text;
}

struct Page {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT;

  /// VTK's, of a voxel; VTK_VOID where it is none of a label.
  int type() const {
    const bool sign = format == SAMPLEFORMAT_INT;
    if (samples != 1 || (format == SAMPLEFORMAT_IEEEFP && bits != 32))
      return VTK_VOID;
    if (format == SAMPLEFORMAT_IEEEFP)
      return VTK_FLOAT;
    return bits == 8    ? (sign ? VTK_SIGNED_CHAR : VTK_UNSIGNED_CHAR)
           : bits == 16 ? (sign ? VTK_SHORT : VTK_UNSIGNED_SHORT)
           : bits == 32 ? (sign ? VTK_INT : VTK_UNSIGNED_INT)
                        : VTK_VOID;
  }
};

// While it lives, libtiff's errors are noted and its warnings dropped.
class Handlers {
public:
  Handlers() { said.clear(); }
  ~Handlers() {
    TIFFSetWarningHandler(warnings_);
    TIFFSetErrorHandler(errors_);
  }
  Handlers(const Handlers &) = delete;
  Handlers &operator=(const Handlers &) = delete;

private:
  TIFFErrorHandler warnings_ = TIFFSetWarningHandler(nullptr);
  TIFFErrorHandler errors_ = TIFFSetErrorHandler(note_error);
};

class Tiff {
public:
  explicit Tiff(const std::string &file) : file_(file), tiff_(TIFFOpen(file.c_str(), "r")) {
    if (!tiff_)
      refuse_page(1);
  }

  vtkSmartPointer<vtkImageData> read() {
    const Page first = page();
    const long pages = count_pages(first), row = long(first.width) * first.bits / 8;
    check_axes(file_, {long(first.width), long(first.height), pages}, file_size(), kPacked);
    const auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(int(first.width), int(first.height), int(pages));
    image->AllocateScalars(first.type(), 1);
    char *to = static_cast<char *>(image->GetScalarPointer());
    for (long k = 0; k < pages; ++k, to += row * first.height)
      if (!(k == 0 ? TIFFSetDirectory(tiff_.get(), 0) : TIFFReadDirectory(tiff_.get())) ||
          TIFFScanlineSize(tiff_.get()) != row ||
          !(TIFFIsTiled(tiff_.get()) ? read_tiles(first, row, to) : read_rows(first, row, to)))
        refuse_page(k + 1);
    return image;
  }

private:
  struct Close {
    void operator()(TIFF *tiff) const { TIFFClose(tiff); }
  };
  Handlers handlers_;
  std::string file_;
  std::unique_ptr<TIFF, Close> tiff_;

  [[noreturn]] void refuse_page(long number) const {
    refuse_image(file_, fmt::format("page {} cannot be read: {}. The file is cut, damaged or not a "
                                    "TIFF file. Copy it again.",
                                    number, said.empty() ? "it contradicts itself" : said));
  }
  long file_size() const { return long(std::filesystem::file_size(file_)); }

  Page page() const {
    Page p;
    TIFFGetField(tiff_.get(), TIFFTAG_IMAGEWIDTH, &p.width);
    TIFFGetField(tiff_.get(), TIFFTAG_IMAGELENGTH, &p.height);
    TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_BITSPERSAMPLE, &p.bits);
    TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLESPERPIXEL, &p.samples);
    TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLEFORMAT, &p.format);
    return p;
  }

  long count_pages(const Page &first) {
    long number = 0;
    do {
      const Page p = page();
      ++number;
      if (p.type() == VTK_VOID)
        refuse_image(file_, fmt::format("page {} has {} numbers of {} bits per voxel; a label "
                                        "image has one of 8, 16 or 32. Export the labels, not a "
                                        "rendering.",
                                        number, p.samples, p.bits));
      if (p.width != first.width || p.height != first.height || p.type() != first.type())
        refuse_image(file_, fmt::format("page {} has {} x {} voxels of {} bits, the first {} x {} "
                                        "of {}. All pages must be of one size.",
                                        number, p.width, p.height, p.bits, first.width,
                                        first.height, first.bits));
    } while (TIFFReadDirectory(tiff_.get()));
    if (!said.empty() || !TIFFLastDirectory(tiff_.get()))
      refuse_page(number + 1);
    return number;
  }

  bool read_rows(const Page &p, long row, char *to) const {
    for (std::uint32_t j = 0; j < p.height; ++j, to += row)
      if (TIFFReadScanline(tiff_.get(), to, j) < 0)
        return false;
    return true;
  }

  bool read_tiles(const Page &p, long row, char *to) const {
    std::uint32_t width = 0, height = 0;
    TIFFGetField(tiff_.get(), TIFFTAG_TILEWIDTH, &width);
    TIFFGetField(tiff_.get(), TIFFTAG_TILELENGTH, &height);
    check_axes(file_, {long(width), long(height), 1}, file_size(), kPacked);
    const long of_tile = TIFFTileRowSize(tiff_.get()), voxel = p.bits / 8;
    std::vector<char> tile(std::size_t(TIFFTileSize(tiff_.get())));
    for (std::uint32_t y = 0; y < p.height; y += height)
      for (std::uint32_t x = 0; x < p.width; x += width) {
        if (TIFFReadTile(tiff_.get(), tile.data(), x, y, 0, 0) < 0)
          return false;
        for (std::uint32_t j = 0; j < std::min(height, p.height - y); ++j)
          std::memcpy(to + (y + j) * row + x * voxel, tile.data() + j * of_tile,
                      std::size_t(std::min(width, p.width - x) * voxel));
      }
    return true;
  }
};

} // namespace

vtkSmartPointer<vtkImageData> read_tiff(const std::string &file) { return Tiff(file).read(); }

} // namespace calendem
