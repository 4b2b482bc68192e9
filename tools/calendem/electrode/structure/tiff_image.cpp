// SPDX-License-Identifier: GPL-2.0-or-later
// Label images as TIFF, read and written, with the voxel size where Fiji and Python's programs have it.
#include "electrode/structure/image_header.h"
#include "electrode/structure/label_image.h"
#include "electrode/structure/particle_data.h"
#include <algorithm>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
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

double um_of(const std::string &unit) {
  static const std::map<std::string, double> known = {
      {"nm", 1e-3},       {"nanometer", 1e-3}, {"um", 1.0},       {"micron", 1.0},
      {"microns", 1.0},   {"micrometer", 1.0}, {"\\u00B5m", 1.0}, {"\xC2\xB5m", 1.0},
      {"\xCE\xBCm", 1.0}, {"\xB5m", 1.0},      {"mm", 1e3},       {"millimeter", 1e3},
      {"cm", 1e4},        {"m", 1e6},          {"inch", 25400.0}};
  const auto at = known.find(unit);
  return at == known.end() ? 0.0 : at->second;
}

// What the program that wrote the file says of the stack, in the description of its first page:
// ImageJ (Fiji) by lines name=value, tifffile by {"shape": [...]}, OME by XML.
class Description {
public:
  explicit Description(std::string text) : text_(std::move(text)) {
    is_imagej_ = text_.rfind("ImageJ=", 0) == 0;
  }

  /// Pages of one image; 0: not stated.
  double pages(double voxels_of_page) const {
    if (is_imagej_)
      return std::max(1.0, number("images"));
    if (const auto j = nlohmann::json::parse(text_, nullptr, false);
        j.is_object() && j.contains("shape") && j["shape"].is_array()) {
      double all = 1.0;
      for (const auto &n : j["shape"])
        all *= n.is_number() ? n.get<double>() : 1.0;
      return all / voxels_of_page;
    }
    return number("SizeZ") * times();
  }
  /// Channels and moments: a label image has one of each.
  double times() const {
    double all = 1.0;
    for (const char *name : {"channels", "frames", "SizeC", "SizeT"})
      all *= std::max(1.0, number(name));
    return all;
  }
  /// Sides [um] of a voxel whose page has so many pixels per unit (0: not stated); 0: not stated.
  std::array<double, 3> voxel(double x_per_unit, double y_per_unit) const {
    std::array<double, 3> v = {number("PhysicalSizeX"), number("PhysicalSizeY"),
                               number("PhysicalSizeZ")};
    if (is_imagej_) {
      const double um = um_of(word("unit"));
      v = {x_per_unit > 0.0 ? um / x_per_unit : 0.0, y_per_unit > 0.0 ? um / y_per_unit : 0.0,
           um * std::fabs(number("spacing"))};
      if (v[2] == 0.0 && x_per_unit == 1.0) // ImageJ leaves out a spacing of 1
        v[2] = um;
    } else
      for (int k = 0; k < 3; ++k) // XML; micrometres unless it says otherwise
        if (const std::string unit = word(std::string("PhysicalSize") + "XYZ"[k] + "Unit");
            !unit.empty())
          v[k] *= um_of(unit);
    for (double &side : v)
      side = std::isfinite(side) ? std::max(0.0, side) : 0.0;
    return v;
  }

private:
  std::string text_;
  bool is_imagej_;

  std::string word(const std::string &name) const {
    const std::string before = is_imagej_ ? "\n" + name + "=" : " " + name + "=\"";
    const size_t at = text_.find(before);
    if (at == std::string::npos)
      return "";
    const size_t from = at + before.size(),
                 to = text_.find_first_of(is_imagej_ ? "\r\n" : "\"", from);
    return text_.substr(from, to - from);
  }
  double number(const std::string &name) const {
    const double v = number_in(word(name)).value_or(0.0);
    return std::isfinite(v) ? v : 0.0;
  }
};

class Tiff {
public:
  explicit Tiff(const std::string &file) : file_(file), tiff_(TIFFOpen(file.c_str(), "r")) {
    if (!tiff_)
      refuse_page(1);
  }

  vtkSmartPointer<vtkImageData> read() {
    const Page first = page();
    const Description description = description_of_first();
    if (description.times() > 1.0)
      refuse_image(file_,
                   "it holds {:.0f} channels or moments of the image; a label image has one. Save "
                   "one of them (Fiji: Image > Duplicate).",
                   description.times());
    const double stated = description.pages(double(first.width) * first.height);
    long pages = count_pages(first);
    const long row = long(first.width) * first.bits / 8;
    if (stated > double(pages))
      return read_behind_first(first, pages, stated);
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

  std::array<double, 3> voxel() const {
    float x = 0.0F, y = 0.0F; // pixels per unit
    TIFFGetField(tiff_.get(), TIFFTAG_XRESOLUTION, &x);
    TIFFGetField(tiff_.get(), TIFFTAG_YRESOLUTION, &y);
    return description_of_first().voxel(x, y);
  }

private:
  struct Close {
    void operator()(TIFF *tiff) const { TIFFClose(tiff); }
  };
  Handlers handlers_;
  std::string file_;
  std::unique_ptr<TIFF, Close> tiff_;

  [[noreturn]] void refuse_page(long number) const {
    refuse_image(
        file_,
        "page {} cannot be read: {}. The file is cut, damaged or not a TIFF file. Copy it again.",
        number, said.empty() ? "it contradicts itself" : said);
  }
  Description description_of_first() const { // before a second page is asked for
    const char *text = nullptr;
    TIFFGetField(tiff_.get(), TIFFTAG_IMAGEDESCRIPTION, &text);
    return Description(text ? text : "");
  }

  // ImageJ and tifffile write large stacks with one directory: the other pages lie behind the first.
  vtkSmartPointer<vtkImageData> read_behind_first(const Page &p, long pages, double stated) {
    std::uint16_t compression = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_COMPRESSION, &compression);
    const double page = double(p.width) * p.height * p.bits / 8.0;
    const std::uint32_t last = TIFFNumberOfStrips(tiff_.get()) - 1;
    const auto offset = [&](std::uint32_t strip) {
      return TIFFGetStrileOffset(tiff_.get(), strip);
    };
    const std::uint64_t from = offset(0);
    const bool dense =
        !TIFFIsTiled(tiff_.get()) &&
        (last == 0 || double(offset(last) - from + TIFFRawStripSize64(tiff_.get(), last)) == page);
    if (pages != 1 || compression != COMPRESSION_NONE || stated != std::floor(stated) || !dense ||
        double(from) + stated * page > double(file_size()))
      refuse_image(
          file_,
          "its description announces {:.10g} pages, {} can be read: the file is cut or only a part "
          "of the image. Copy it again, or save it with a page for each slice.",
          stated, pages);
    check_axes(file_, {long(p.width), long(p.height), long(stated)}, file_size(), kPacked);
    const auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(int(p.width), int(p.height), int(stated));
    image->AllocateScalars(p.type(), 1);
    const long voxels = long(p.width) * p.height * long(stated);
    std::ifstream in(file_, std::ios::binary);
    in.seekg(long(from));
    if (!in.read(static_cast<char *>(image->GetScalarPointer()), voxels * p.bits / 8))
      refuse_page(2);
    if (TIFFIsByteSwapped(tiff_.get()) && p.bits == 16)
      TIFFSwabArrayOfShort(static_cast<std::uint16_t *>(image->GetScalarPointer()), voxels);
    if (TIFFIsByteSwapped(tiff_.get()) && p.bits == 32)
      TIFFSwabArrayOfLong(static_cast<std::uint32_t *>(image->GetScalarPointer()), voxels);
    return image;
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
        refuse_image(file_,
                     "page {} has {} numbers of {} bits per voxel; a label image has one of 8, 16 "
                     "or 32. Export the labels, not a rendering.",
                     number, p.samples, p.bits);
      if (p.width != first.width || p.height != first.height || p.type() != first.type())
        refuse_image(file_,
                     "page {} has {} x {} voxels of {} bits, the first {} x {} of {}. All pages "
                     "must be of one size.",
                     number, p.width, p.height, p.bits, first.width, first.height, first.bits);
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

std::array<double, 3> voxel_size_of_tiff(const std::string &file) { return Tiff(file).voxel(); }

namespace {

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
  const Handlers handlers;
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
