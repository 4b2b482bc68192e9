// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/label_image.h"
#include "support.h"
#include <fmt/format.h>
#include <minizip/zip.h>
#include <regex>
#include <tiffio.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>

namespace {
using namespace calendem;
using namespace calendem_test;
namespace fs = std::filesystem;

// What the files in data/ show.
int expected(int i, int j, int k) {
  if (i >= 1 && i <= 2 && j >= 1 && j <= 3 && k >= 1 && k <= 2)
    return 7;
  return i == 4 && j >= 2 && j <= 3 && k == 2 ? 300 : 0;
}

LabelImage sample() {
  LabelImage image = empty_image(12, 5, 4, 0.3);
  image.voxel.z() = 0.5;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 12; ++i)
        image.label[image.index(i, j, k)] = expected(i, j, k);
  return image;
}

void expect_sample(const LabelImage &image) {
  EXPECT_EQ(image.n, sample().n);
  EXPECT_EQ(image.label, sample().label);
}

// Pages first..last of the sample as TIFF.
void write_tiff(const std::string &file, int first, int last, int width = 12) {
  const LabelImage image = sample();
  TIFF *out = TIFFOpen(file.c_str(), "w");
  for (int k = first; k <= last; ++k) {
    TIFFSetField(out, TIFFTAG_IMAGEWIDTH, width);
    TIFFSetField(out, TIFFTAG_IMAGELENGTH, 5);
    TIFFSetField(out, TIFFTAG_BITSPERSAMPLE, 16);
    TIFFSetField(out, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    for (int j = 0; j < 5; ++j) {
      std::array<std::uint16_t, 12> row{};
      for (int i = 0; i < width; ++i)
        row[i] = static_cast<std::uint16_t>(image.at(i, j, k));
      TIFFWriteScanline(out, row.data(), std::uint32_t(j));
    }
    TIFFWriteDirectory(out);
  }
  TIFFClose(out);
}

void cut(const fs::path &file, double share) {
  fs::resize_file(file, std::uintmax_t(share * double(fs::file_size(file))));
}

TEST(LabelImage, WrittenFilesKeepLabelsAndVoxelSize) {
  const fs::path folder = test_folder();
  for (const char *name : {"a.vti", "a.mhd", "a.mha", "a.tif"}) {
    const std::string file = (folder / name).string();
    write_label_image(sample(), file);
    const LabelImage image = read_label_image(file);
    expect_sample(image);
    EXPECT_NEAR((image.voxel - sample().voxel).norm(), 0.0, 1e-6) << name;
    EXPECT_EQ(read_label_image(file, 0.041).voxel, Eigen::Vector3d::Constant(0.041)) << name;
  }
}

// Fiji opens unsigned numbers best, and 8 bits need least room.
TEST(LabelImage, TiffFilesHaveTheSmallestTypeThatHoldsTheirLabels) {
  const std::string file = (test_folder() / "a.tif").string();
  const auto bits_of = [&](std::int32_t first, std::int32_t last) {
    LabelImage image = empty_image(12, 5, 4, 0.3);
    image.label.front() = first;
    image.label.back() = last;
    write_label_image(image, file);
    EXPECT_EQ(read_label_image(file).label, image.label);
    std::uint16_t bits = 0, format = 0;
    TIFF *tiff = TIFFOpen(file.c_str(), "r");
    TIFFGetField(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetField(tiff, TIFFTAG_SAMPLEFORMAT, &format);
    TIFFClose(tiff);
    return std::string(format == SAMPLEFORMAT_INT ? "int" : "uint") + std::to_string(bits);
  };
  EXPECT_EQ(bits_of(0, 255), "uint8");
  EXPECT_EQ(bits_of(0, 256), "uint16");
  EXPECT_EQ(bits_of(0, 65536), "int32");
  EXPECT_EQ(bits_of(-1, 32767), "int16");
  EXPECT_EQ(bits_of(-1, 32768), "int32");
}

TEST(LabelImage, NrrdFilesOfTeemAreRead) {
  for (const char *name : {"unu_gzip.nrrd", "unu_raw.nhdr"}) {
    const LabelImage image = read_label_image(kData + name);
    expect_sample(image);
    EXPECT_NEAR((image.voxel - sample().voxel).norm(), 0.0, 1e-6) << name;
  }
}

// VTK 9.1 reads other numbers than are in the file.
TEST(LabelImage, NrrdAsTextIsRefused) {
  expect_parts(refusal([] { read_label_image(kData + "unu_text.nrrd"); }),
               {"ASCII", "raw and gzip"});
}

TEST(LabelImage, TiffStacksAreReadFromOneFileOrANumberedSeries) {
  const fs::path folder = test_folder();
  const std::string stack = (folder / "stack.tif").string();
  write_tiff(stack, 0, 3);
  expect_sample(read_label_image(stack, 0.3));
  for (int k = 0; k < 4; ++k)
    write_tiff((folder / fmt::format("slice_{:03}.tif", k + 9)).string(), k, k);
  const std::string series = (folder / "slice_%03d.tif").string();
  expect_sample(read_label_image(series, 0.3));
  EXPECT_EQ(read_label_image(series, 0.3).voxel, Eigen::Vector3d::Constant(0.3));
}

TEST(LabelImage, ASeriesWithAGapOrAnotherSizeIsRefused) {
  const fs::path folder = test_folder();
  const std::string series = (folder / "s_%d.tif").string();
  expect_parts(refusal([&] { read_label_image(series, 0.3); }), {"no file", "slice_%04d"});
  write_tiff((folder / "s_1.tif").string(), 0, 0);
  write_tiff((folder / "s_3.tif").string(), 1, 1);
  expect_parts(refusal([&] { read_label_image(series, 0.3); }), {"slice 2 is missing", "1 to 3"});
  write_tiff((folder / "s_2.tif").string(), 1, 1, 4);
  expect_parts(refusal([&] { read_label_image(series, 0.3); }), {"4 x 5", "12 x 5", "one size"});
}

TEST(LabelImage, FilesThatAreCutAreRefused) {
  const fs::path folder = test_folder();
  for (const char *name : {"a.vti", "a.mha", "a.mhd"})
    write_label_image(sample(), (folder / name).string());
  cut(folder / "a.vti", 0.7);
  cut(folder / "a.mha", 0.8);
  cut(folder / "a.zraw", 0.5);
  write_tiff((folder / "a.tif").string(), 0, 3);
  cut(folder / "a.tif", 0.4);
  for (const char *name : {"unu_gzip.nrrd", "unu_raw.nhdr", "unu_raw.raw"})
    fs::copy(kData + name, folder / name);
  cut(folder / "unu_gzip.nrrd", 0.9);
  cut(folder / "unu_raw.raw", 0.9);
  for (const char *name : {"a.vti", "a.mha", "a.mhd", "a.tif", "unu_gzip.nrrd", "unu_raw.nhdr"})
    expect_parts(refusal([&] { read_label_image((folder / name).string(), 0.3); }), {name});
}

TEST(LabelImage, WhatIsNoLabelImageIsRefusedWithTheRemedy) {
  const fs::path folder = test_folder();
  const std::string bad = (folder / "a.mhd").string();
  expect_parts(refusal([&] { read_label_image(bad); }), {"no such file"});
  expect_parts(refusal([&] { read_label_image((folder / "a.jpg").string()); }),
               {"'.jpg'", ".mhd", ".tif"});
  std::ofstream(bad) << "not an image\n";
  expect_parts(refusal([&] { read_label_image(bad); }), {"a.mhd", "format"});
  const std::string grey = (folder / "grey.mha").string();
  std::ofstream(grey, std::ios::binary)
      << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
         "ElementSpacing = 0.3 0.3 0.3\nDimSize = 1 1 2\nElementType = MET_FLOAT\n"
         "ElementDataFile = LOCAL\n"
      << std::string("\0\0\x80\x3f\0\0\0\x3f", 8); // 1 and 0.5
  expect_parts(refusal([&] { read_label_image(grey); }), {"(0, 0, 1) is 0.5", "whole number"});
}

// A spacing of 1 is one, unless the header has none.
TEST(LabelImage, VoxelsOfOneMicrometreAreStatedOrNot) {
  const fs::path folder = test_folder();
  LabelImage image = sample();
  image.voxel.setOnes();
  for (const char *name : {"a.vti", "a.mhd", "a.mha"}) {
    const std::string file = (folder / name).string();
    write_label_image(image, file);
    EXPECT_EQ(read_label_image(file).voxel, Eigen::Vector3d::Ones()) << name;
    std::string text = bytes_of(file);
    const std::string field =
        name == std::string("a.vti") ? " Spacing=\"1 1 1\"" : "ElementSpacing = 1 1 1\n";
    const size_t at = text.find(field);
    ASSERT_NE(at, std::string::npos) << text.substr(0, 600);
    std::ofstream(file, std::ios::binary) << text.erase(at, field.size());
    expect_parts(refusal([&] { read_label_image(file); }),
                 {name, "voxel size", "shapes.voxel_size_um"});
    EXPECT_EQ(read_label_image(file, 1.0).voxel.x(), 1.0);
  }
  std::string nrrd = bytes_of(kData + "unu_gzip.nrrd");
  const std::regex spacings("(spacings|space directions): [^\n]*\n");
  ASSERT_TRUE(std::regex_search(nrrd, spacings));
  const std::string file = (folder / "a.nrrd").string();
  std::ofstream(file, std::ios::binary) << std::regex_replace(nrrd, spacings, "spacings: 1 1 1\n");
  EXPECT_EQ(read_label_image(file).voxel, Eigen::Vector3d::Ones());
  std::ofstream(file, std::ios::binary) << std::regex_replace(nrrd, spacings, "");
  expect_parts(refusal([&] { read_label_image(file); }), {"voxel size"});
}

TEST(LabelImage, VoxelSizeMustBeKnownAndPlausible) {
  const fs::path folder = test_folder();
  const std::string file = (folder / "a.mha").string();
  LabelImage image = sample();
  image.voxel.setConstant(0.3e-3); // in mm
  write_label_image(image, file);
  expect_parts(refusal([&] { read_label_image(file); }), {"0.0003", "0.001 to 10 um", "mm"});
  write_tiff((folder / "a.tif").string(), 0, 3);
  expect_parts(refusal([&] { read_label_image((folder / "a.tif").string()); }), {"voxel size"});
}

// The sample's voxels as a file of 16 bits has them.
std::string voxels(bool big = false) {
  std::string out;
  for (const std::int32_t label : sample().label) {
    const char low = char(label & 255), high = char(label >> 8);
    out += big ? std::string{high, low} : std::string{low, high};
  }
  return out;
}

// All pages behind one directory, as ImageJ and tifffile write large stacks.
std::string write_one_directory(const fs::path &file, const std::string &description,
                                const char *mode = "w", double pixels_per_unit = 0.0) {
  TIFF *out = TIFFOpen(file.c_str(), mode);
  TIFFSetField(out, TIFFTAG_IMAGEWIDTH, 12);
  TIFFSetField(out, TIFFTAG_IMAGELENGTH, 5);
  TIFFSetField(out, TIFFTAG_BITSPERSAMPLE, 16);
  TIFFSetField(out, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(out, TIFFTAG_ROWSPERSTRIP, 5);
  TIFFSetField(out, TIFFTAG_IMAGEDESCRIPTION, description.c_str());
  if (pixels_per_unit > 0.0) {
    TIFFSetField(out, TIFFTAG_XRESOLUTION, pixels_per_unit);
    TIFFSetField(out, TIFFTAG_YRESOLUTION, pixels_per_unit);
  }
  std::string all = voxels(std::string(mode) == "wb");
  TIFFWriteRawStrip(out, 0, all.data(), tmsize_t(all.size()));
  TIFFWriteDirectory(out);
  TIFFClose(out);
  return file.string();
}

// Read as one page it would be a film of pores.
TEST(LabelImage, StacksWithOneDirectoryAreReadWhole) {
  const fs::path folder = test_folder();
  for (const char *mode : {"wl", "wb"})
    for (const char *description : {"ImageJ=1.53t\nimages=4\nslices=4\n", "{\"shape\": [4, 5, 12]}",
                                    "<OME><Pixels SizeX=\"12\" SizeZ=\"4\" SizeC=\"1\"/></OME>"})
      expect_sample(
          read_label_image(write_one_directory(folder / "a.tif", description, mode), 0.3));
}

TEST(LabelImage, StacksThatAnnounceMoreThanIsThereAreRefused) {
  const fs::path folder = test_folder();
  const auto said = [&](const char *description) {
    return refusal(
        [&] { read_label_image(write_one_directory(folder / "a.tif", description), 0.3); });
  };
  expect_parts(said("ImageJ=1.53t\nimages=40\n"), {"announces 40 pages, 1 can be read"});
  expect_parts(said("{\"shape\": [40, 5, 12]}"), {"announces 40 pages"});
  expect_parts(said("ImageJ=1.53t\nimages=4\nchannels=2\nslices=2\n"), {"2 channels or moments"});
  write_tiff((folder / "b.tif").string(), 0, 1);
  TIFF *file = TIFFOpen((folder / "b.tif").c_str(), "r+");
  TIFFSetField(file, TIFFTAG_IMAGEDESCRIPTION, "ImageJ=1.53t\nimages=4\n");
  TIFFRewriteDirectory(file);
  TIFFClose(file);
  expect_parts(refusal([&] { read_label_image((folder / "b.tif").string(), 0.3); }),
               {"announces 4 pages, 2 can be read"});
}

TEST(LabelImage, VoxelSizeOfFijiIsRead) {
  const fs::path folder = test_folder();
  double pixels_per_um = 2.5;
  const auto read = [&](const std::string &lines, double voxel_um = 0.0) {
    return read_label_image(write_one_directory(folder / "a.tif",
                                                "ImageJ=1.53t\nimages=4\n" + lines, "w",
                                                pixels_per_um),
                            voxel_um)
        .voxel;
  };
  const Eigen::Vector3d flat(0.4, 0.4, 0.5);
  EXPECT_NEAR((read("unit=micron\nspacing=0.5\n") - flat).norm(), 0.0, 1e-6);
  EXPECT_NEAR((read("unit=\\u00B5m\nspacing=0.5\n") - flat).norm(), 0.0, 1e-6);
  EXPECT_NEAR((read("unit=mm\nspacing=0.5\n", 0.3) - Eigen::Vector3d::Constant(0.3)).norm(), 0.0,
              0.0);
  expect_parts(refusal([&] { read("unit=mm\nspacing=0.5\n"); }), {"400 x 400 x 500 um"});
  expect_parts(refusal([&] { read("unit=micron\n"); }), {"no voxel size along z. Give"});
  expect_parts(refusal([&] { read("unit=pixel\nspacing=0.5\n"); }), {"states no voxel size"});
  pixels_per_um = 0.0;
  expect_parts(refusal([&] { read("unit=micron\nspacing=0.5\n"); }),
               {"no voxel size along x, y. Give"});
  const std::string ome = "<OME><Pixels SizeZ=\"4\" PhysicalSizeX=\"400\" PhysicalSizeXUnit=\"nm\" "
                          "PhysicalSizeY=\"0.4\" PhysicalSizeZ=\"0.5\"/></OME>";
  EXPECT_NEAR((read_label_image(write_one_directory(folder / "o.tif", ome)).voxel - flat).norm(),
              0.0, 1e-6);
}

TEST(LabelImage, NegativeLabelsWithoutAMeaningAreRefused) {
  LabelImage image = sample();
  image.file = "a.tif";
  image.label[image.index(3, 2, 1)] = -5;
  expect_parts(refusal([&] { refuse_negative_labels(image, {0}); }),
               {"a.tif", "(3, 2, 1)", "-5", "unsigned"});
  refuse_negative_labels(image, {0, -5});
}

TEST(LabelImage, SeriesOfPngAreReadAsTiffIs) {
  const fs::path folder = test_folder();
  for (int k = 0; k < 4; ++k) {
    vtkNew<vtkImageData> slice;
    slice->SetDimensions(12, 5, 1);
    slice->AllocateScalars(VTK_UNSIGNED_SHORT, 1);
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 12; ++i) // VTK's first row is the last of the picture
        slice->SetScalarComponentFromDouble(i, 4 - j, 0, 0, expected(i, j, k));
    vtkNew<vtkPNGWriter> writer;
    writer->SetFileName((folder / fmt::format("s_{}.png", k)).c_str());
    writer->SetInputData(slice);
    writer->Write();
  }
  const std::string series = (folder / "s_%d.png").string();
  expect_sample(read_label_image(series, 0.3));
  expect_parts(refusal([&] { read_label_image(series); }), {"states no voxel size"});
  cut(folder / "s_2.png", 0.6);
  expect_parts(refusal([&] { read_label_image(series, 0.3); }), {"s_2.png"});
  std::string colours = bytes_of(folder / "s_1.png");
  colours[25] = 2;
  std::ofstream(folder / "s_2.png", std::ios::binary) << colours;
  expect_parts(refusal([&] { read_label_image(series, 0.3); }), {"colours"});
}

std::string npy(const std::string &type, const std::string &shape, const std::string &data,
                const char *fortran = "False") {
  std::string head =
      fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': ({}), }}", type, fortran, shape);
  head.resize(117, ' ');
  return std::string("\x93NUMPY\1\0\x76\0", 10) + head + "\n" + data;
}

std::string write_npz(const fs::path &file, const std::vector<std::string> &arrays) {
  zipFile out = zipOpen64(file.c_str(), 0);
  for (size_t k = 0; k < arrays.size(); ++k) {
    const std::string name = fmt::format("arr_{}.npy", k);
    zipOpenNewFileInZip(out, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 6);
    zipWriteInFileInZip(out, arrays[k].data(), unsigned(arrays[k].size()));
    zipCloseFileInZip(out);
  }
  zipClose(out, nullptr);
  return file.string();
}

TEST(LabelImage, ArraysOfNumPyAreRead) {
  const fs::path folder = test_folder();
  const std::string file = (folder / "a.npy").string();
  const auto read = [&](const std::string &bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return read_label_image(file, 0.3);
  };
  expect_sample(read(npy("<u2", "4, 5, 12", voxels())));
  expect_sample(read(npy(">i2", "4, 5, 12", voxels(true))));
  std::string turned; // z runs fastest
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 4; ++k)
        turned += std::string{char(expected(i, j, k) & 255), char(expected(i, j, k) >> 8)};
  expect_sample(read(npy("<u2", "4, 5, 12", turned, "True")));
  const std::string whole = npy("<u2", "4, 5, 12", voxels());
  expect_sample(read_label_image(write_npz(folder / "a.npz", {whole}), 0.3));
  const auto said = [&](const std::string &bytes) { return refusal([&] { read(bytes); }); };
  expect_parts(said(npy("<u2", "5, 12", voxels())), {"(5, 12)", "three axes"});
  expect_parts(said(npy("<c8", "4, 5, 12", voxels())), {"'<c8'", "astype"});
  expect_parts(said(npy("<u2", "4, 5, 13", voxels())), {"520 bytes", "480 are there"});
  expect_parts(said("\x93NUMPY"), {"numpy.save"});
  expect_parts(refusal([&] {
                 read_label_image(write_npz(folder / "b.npz", {whole, whole}), 0.3);
               }),
               {"2 arrays"});
  cut(folder / "a.npz", 0.7);
  expect_parts(refusal([&] { read_label_image((folder / "a.npz").string(), 0.3); }), {"a.npz"});
  expect_parts(refusal([&] { read_label_image(file); }), {"numpy.save"});
}

} // namespace
