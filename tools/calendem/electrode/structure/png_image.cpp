// SPDX-License-Identifier: GPL-2.0-or-later
// Slices as PNG, by libpng: VTK's reader ends the program on a file that is cut.
#include "electrode/structure/image_header.h"
#include <csetjmp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <png.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

namespace calendem {

namespace {

void leave(png_structp png, png_const_charp what) {
  std::snprintf(static_cast<char *>(png_get_error_ptr(png)), 100, "%s", what);
  png_longjmp(png, 1);
}

void drop(png_structp, png_const_charp) {}

// libpng comes back by longjmp where the file is wrong: nothing here has a destructor.
bool read_rows(png_structp png, png_infop info, std::FILE *in, char *to, long row, long rows) {
  if (setjmp(png_jmpbuf(png))) // NOLINT(cert-err52-cpp)
    return false;
  png_init_io(png, in);
  png_read_info(png, info);
  png_set_swap(png); // of 16 bits the low byte first
  const int passes = png_set_interlace_handling(png);
  png_read_update_info(png, info);
  if (long(png_get_rowbytes(png, info)) != row)
    return false;
  for (int pass = 0; pass < passes; ++pass)
    for (long j = 0; j < rows; ++j)
      png_read_row(png, reinterpret_cast<png_bytep>(to + j * row), nullptr);
  png_read_end(png, nullptr);
  return true;
}

} // namespace

vtkSmartPointer<vtkImageData> read_png(const std::string &file) {
  // https://www.w3.org/TR/png: signature, then the chunk IHDR
  constexpr int kAtSize = 16, kAtDepth = 24, kAtColour = 25, kHead = 33;
  unsigned char head[kHead] = {};
  std::ifstream(file, std::ios::binary).read(reinterpret_cast<char *>(head), kHead);
  if (std::string(head + 12, head + 16) != "IHDR")
    refuse_image(file, "this is not a PNG file, or it is cut. Copy it again.");
  const int bits = head[kAtDepth];
  if ((bits != 8 && bits != 16) || head[kAtColour] != PNG_COLOR_TYPE_GRAY)
    refuse_image(file,
                 "its pixels are colours, or of fewer than 8 bits; a label image has a number "
                 "of 8 or 16 bits for each. Export the labels, not a rendering.");
  const auto side = [&](int at) {
    return ((long(head[at]) << 8 | head[at + 1]) << 8 | head[at + 2]) << 8 | head[at + 3];
  };
  const long width = side(kAtSize), height = side(kAtSize + 4);
  check_axes(file, {width, height, 1}, long(std::filesystem::file_size(file)), kDeflate * 8 / bits);
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(int(width), int(height), 1);
  image->AllocateScalars(bits == 8 ? VTK_UNSIGNED_CHAR : VTK_UNSIGNED_SHORT, 1);
  char said[100] = "it contradicts itself";
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, said, leave, drop);
  png_infop info = png_create_info_struct(png);
  const std::unique_ptr<std::FILE, int (*)(std::FILE *)> in(std::fopen(file.c_str(), "rb"),
                                                            std::fclose);
  const bool whole =
      in && read_rows(png, info, in.get(), static_cast<char *>(image->GetScalarPointer()),
                      width * bits / 8, height);
  png_destroy_read_struct(&png, &info, nullptr);
  if (!whole)
    refuse_image(file, "libpng cannot read it: {}. The file is cut or damaged. Copy it again.",
                 said);
  return image;
}

} // namespace calendem
