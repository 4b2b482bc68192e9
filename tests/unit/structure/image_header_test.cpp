// SPDX-License-Identifier: GPL-2.0-or-later
// Headers on which VTK's readers crash, hang, take gigabytes or read other numbers than are there:
// they are refused before VTK sees the file. Most were found by tests/reliability/fuzz.
#include "electrode/structure/label_image.h"
#include "support.h"
#include <map>
#include <tiffio.h>

namespace {
using namespace calendem;
using namespace calendem_test;

std::string said_of(const std::string &ending, const std::string &bytes) {
  const std::string file = (test_folder() / ("a" + ending)).string();
  std::ofstream(file, std::ios::binary) << bytes;
  return refusal([&] { read_label_image(file, 0.3); });
}
// What write_label_image() makes of an image of 12 x 5 x 4 voxels.
std::string written(const std::string &ending) {
  LabelImage image = empty_image(12, 5, 4, 0.3);
  image.label[7] = 3;
  const std::string file = (test_folder() / ("a" + ending)).string();
  write_label_image(image, file);
  EXPECT_EQ(read_label_image(file).label[7], 3);
  return bytes_of(file);
}

TEST(NrrdHeader, ThatDoesNotEndOrSaysItAnotherWayIsRefused) {
  const std::string good = bytes_of(kData + "unu_gzip.nrrd"),
                    head = good.substr(0, good.find("\n\n"));
  expect_parts(said_of(".nrrd", head), {"header does not end"}); // VTK waits for a line
  expect_parts(said_of(".nrrd", replaced(good, "# Complete", std::string("#\0", 2))),
               {"header does not end"});
  expect_parts(said_of(".nrrd", replaced(good, "12 5 4", "99999 99999 99999")), {"2147483647"});
  expect_parts(said_of(".nrrd", replaced(good, "12 5 4", "12 5 4444444")),
               {"bytes of data can hold"});
  expect_parts(said_of(".nrrd", replaced(good, "12 5 4", "6 10 4")),
               {"first axis has 6", "colours"});
  expect_parts(said_of(".nrrd", replaced(good, "sizes: 12 5 4", "sizes: 12 20")), {"0 x 0 x 0"});
  expect_parts(said_of(".nrrd", replaced(good, "dimension: 3", "Dimension: 3")),
               {"no 'dimension'"});
  expect_parts(said_of(".nrrd", replaced(good, "dimension: 3", "sizes: 12 5 4")), {"occurs twice"});
  expect_parts(said_of(".nrrd", replaced(good, "unsigned short", "block")), {"'type' is 'block'"});
  const std::string spread =
      replaced(bytes_of(kData + "unu_raw.nhdr"), "./unu_raw.raw", "s%n.raw 1 3 0");
  expect_parts(said_of(".nhdr", spread), {"over several files"}); // VTK hands it to printf
}

// numpy's labels are 64 bits long; VTK reads them from NRRD, and writes past its memory from
// MetaImage.
TEST(NrrdHeader, LabelsOf64BitsAreRead) {
  const std::string head = "NRRD0004\ntype: int64\ndimension: 3\nsizes: 12 1 1\nspace: "
                           "left-posterior-superior\nspace directions: (0.3,0,0) (0,0.3,0) "
                           "(0,0,0.5)\nendian: little\nencoding: raw\nkey:=a: b\n\n";
  const std::string file = (test_folder() / "a.nrrd").string();
  std::string voxels(96, '\0');
  voxels[16] = 7;
  std::ofstream(file, std::ios::binary) << head << voxels;
  const LabelImage image = read_label_image(file);
  EXPECT_EQ(image.n, (std::array<int, 3>{12, 1, 1}));
  EXPECT_EQ(image.label[2], 7);
  EXPECT_NEAR(image.voxel.z(), 0.5, 1e-12);
  for (const char *type : {"MET_LONG", "MET_ULONG", "MET_LONG_LONG", "MET_ULONG_LONG"})
    expect_parts(said_of(".mha", replaced(written(".mha"), "MET_INT", type)),
                 {std::string("'ElementType' is '") + type, "1, 2 or 4 bytes"});
}

TEST(MetaImageHeader, ThatAsksForTheImpossibleIsRefused) {
  const std::string good = written(".mha");
  expect_parts(said_of(".mha", replaced(good, "DimSize = 12 5 4", "DimSize = 12 5 4000000")),
               {"bytes of data can hold"});
  expect_parts(said_of(".mha", replaced(good, "DimSize = 12 5 4", "DimSize = -12 5 4")),
               {"-12 x 5 x 4"});
  expect_parts(said_of(".mha", replaced(good, "DimSize = 12 5 4", "DimSize = 12 5 3")),
               {"do not unpack to the 720 bytes"});
  expect_parts(said_of(".mha", replaced(good, "NDims = 3", "NDims = 9")), {"'NDims' is '9'"});
  expect_parts(said_of(".mha", replaced(good, "Offset = 0 0 0", "Offset = 0 0")),
               {"'Offset'", "3 numbers"});
  expect_parts(said_of(".mha", replaced(good, "= LOCAL", "= LIST")), {"over several files"});
  expect_parts(said_of(".mha", replaced(good, "= LOCAL", "= s%d.raw 1 4 1")),
               {"over several files"});
  expect_parts(said_of(".mha", replaced(good, "NDims = 3", "NDims 3")), {"line 2 of the header"});
  std::string damaged = good; // VTK waits for the end of a stream like this
  for (size_t k = good.size() - 20; k < good.size(); ++k)
    damaged[k] = char(~damaged[k]);
  expect_parts(said_of(".mha", damaged), {"do not unpack", "cut or damaged"});
}

TEST(VtiHeader, OfAnotherSizeOrInPiecesIsRefused) {
  const std::string good = written(".vti"), extent = "WholeExtent=\"0 11 0 4 0 3\"";
  expect_parts(said_of(".vti", replaced(good, extent, "WholeExtent=\"0 11 0 4 0 99999999\"")),
               {"12 x 5 x 100000000", "2147483647"});
  expect_parts(said_of(".vti", replaced(good, extent, "WholeExtent=\"0 11 0 4 0 999999\"")),
               {"can hold"});
  expect_parts(said_of(".vti", replaced(good, extent, "WholeExtent=\"0 11 0 4 0 9\"")),
               {"in pieces"});
  expect_parts(said_of(".vti", replaced(good, extent, "WholeExtent=\"5 1 0 4 0 3\"")),
               {"-3 x 5 x 4"});
  expect_parts(said_of(".vti", replaced(good, extent, "")), {"WholeExtent"});
  const size_t data = good.find('_', good.find("<AppendedData")) +
                      1; // base64 of blocks, bytes of a block, ...: AQAAAACAAAD...
  EXPECT_EQ(good.substr(data, 8), "AQAAAACA");
  std::string blocks = good; // VTK makes room for 2^32 - 1 of them
  expect_parts(said_of(".vti", blocks.replace(data, 6, "/////w")), {"4294967295 blocks"});
  blocks = good;
  expect_parts(said_of(".vti", blocks.replace(data + 6, 5, "////5")), {"1 blocks of 42781"});
  expect_parts(said_of(".vti", replaced(good, "<Piece Extent", "<Piece Extent=\"0 1\" X")),
               {"Extent="});
  expect_parts(said_of(".vti", replaced(good, "Name=\"label\"", "NumberOfComponents=\"9\"")),
               {"has 9 numbers"});
}

// A page of 12 x 5 voxels of 8 bits, not packed; of each tag its place in the file.
struct Tiff {
  std::string bytes = std::string("II\x2a\0\x08\0\0\0", 8);
  std::map<int, size_t> tag;
  void number(std::uint32_t v, int size) {
    for (int k = 0; k < size; ++k)
      bytes += char(v >> 8 * k & 255);
  }
  void page(std::uint32_t height, std::uint32_t next) {
    const std::uint32_t tags[][2] = {{256, 12},          {257, height}, {258, 8}, {259, 1},
                                     {262, 1},           {273, 0},      {277, 1}, {278, height},
                                     {279, 12 * height}, {284, 1}};
    number(10, 2);
    const std::uint32_t data = std::uint32_t(bytes.size()) + 124;
    for (const auto &[name, value] : tags) {
      tag[int(name)] = bytes.size();
      number(name, 2);
      number(4, 2);
      number(1, 4);
      number(name == 273 ? data : value, 4);
    }
    number(next, 4);
    bytes += std::string(12 * height, '\1');
  }
  std::string with(int name, std::uint32_t value, std::uint32_t count = 1) const {
    Tiff t = *this;
    const std::string tail = t.bytes.substr(tag.at(name) + 12);
    t.bytes.resize(tag.at(name) + 4);
    t.number(count, 4);
    t.number(value, 4);
    return t.bytes + tail;
  }
};

TEST(TiffHeader, ThatContradictsTheFileIsRefused) {
  Tiff good;
  good.page(5, 0);
  const std::string file = (test_folder() / "good.tif").string();
  std::ofstream(file, std::ios::binary) << good.bytes;
  EXPECT_EQ(read_label_image(file, 0.3).label, std::vector<std::int32_t>(60, 1));
  for (const auto &[tag, value] : {std::pair(259, 0), std::pair(278, 2), std::pair(273, 999)})
    expect_parts(said_of(".tif", good.with(tag, std::uint32_t(value))),
                 {"page 1 cannot be read", "cut, damaged"});
  expect_parts(said_of(".tif", good.with(256, 4000000000)), {"4000000000 x 5 x 1 voxels"});
  expect_parts(said_of(".tif", good.with(256, 1000000)), {"more than"});
  expect_parts(said_of(".tif", good.with(258, 1)), {"of 1 bits"});
  expect_parts(said_of(".tif", good.with(277, 3)), {"3 numbers"});
  expect_parts(said_of(".tif", "GIF89a and more"), {"page 1 cannot be read", "Not a TIFF"});
}

// What other programs write: packed, in tiles, with the other byte order, with colours to show.
TEST(TiffImage, IsReadAsItsNumbersHoweverTheyAreStored) {
  const std::string file = (test_folder() / "a.tif").string();
  for (const char *mode : {"w", "wb", "w8"})
    for (const int packing : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE})
      for (const bool tiles : {false, true}) {
        TIFF *out = TIFFOpen(file.c_str(), mode);
        for (int page = 0; page < 2; ++page) {
          std::uint16_t values[32 * 16] = {};
          for (int k = 0; k < 20 * 16; ++k)
            values[k / 20 * (tiles ? 32 : 20) + k % 20] = std::uint16_t(1000 * page + k);
          TIFFSetField(out, TIFFTAG_IMAGEWIDTH, 20);
          TIFFSetField(out, TIFFTAG_IMAGELENGTH, 16);
          TIFFSetField(out, TIFFTAG_BITSPERSAMPLE, 16);
          TIFFSetField(out, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISWHITE);
          TIFFSetField(out, TIFFTAG_COMPRESSION, packing);
          TIFFSetField(out, tiles ? TIFFTAG_TILEWIDTH : TIFFTAG_ROWSPERSTRIP, tiles ? 32 : 16);
          if (tiles)
            TIFFSetField(out, TIFFTAG_TILELENGTH, 16);
          if (tiles)
            TIFFWriteEncodedTile(out, 0, values, sizeof values);
          else
            TIFFWriteEncodedStrip(out, 0, values, 2 * 20 * 16);
          TIFFWriteDirectory(out);
        }
        TIFFClose(out);
        const LabelImage image = read_label_image(file, 0.3);
        ASSERT_EQ(image.n, (std::array<int, 3>{20, 16, 2})) << mode << packing << tiles;
        for (int k = 0; k < 20 * 16; ++k) {
          EXPECT_EQ(image.label[k], k) << mode << packing << tiles;
          EXPECT_EQ(image.label[320 + k], 1000 + k) << mode << packing << tiles;
        }
      }
}

TEST(TiffHeader, PagesMustBeOfOneSizeAndComeToAnEnd) {
  Tiff two;
  two.page(5, 8 + 126 + 60);
  two.page(9, 0);
  expect_parts(said_of(".tif", two.bytes), {"page 2 has 12 x 9", "the first 12 x 5"});
  Tiff loop;
  loop.page(5, 8);
  expect_parts(said_of(".tif", loop.bytes), {"page 2 cannot be read"});
}

} // namespace
