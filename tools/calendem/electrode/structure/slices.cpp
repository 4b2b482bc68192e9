// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/slices.h"
#include "base/provenance.h"
#include "electrode/structure/measured_shape.h"
#include <algorithm>
#include <cmath>
#include <set>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

namespace calendem {
namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kPore{255, 255, 255}, kAm{200, 200, 200}, kCbd{90, 90, 90}, kWhole{200, 30, 30},
    kCut{30, 90, 200};

// The middle slice across an axis; its rows go up along the higher of the two others.
class Slice {
public:
  Slice(const LabelImage &image, int axis)
      : n_(image.n), axis_(axis), u_(axis == 0 ? 1 : 0), v_(axis == 2 ? 1 : 2) {}
  int width() const { return n_[u_]; }
  int height() const { return n_[v_]; }
  std::int32_t at(const LabelImage &image, int x, int y) const {
    std::array<int, 3> p{};
    p[axis_] = n_[axis_] / 2;
    p[u_] = std::clamp(x, 0, n_[u_] - 1);
    p[v_] = n_[v_] - 1 - std::clamp(y, 0, n_[v_] - 1);
    return image.at(p[0], p[1], p[2]);
  }

private:
  std::array<int, 3> n_;
  int axis_, u_, v_;
};

// Pixels of `scale` for each voxel, as wide as all slices beside each other.
class Sheet {
public:
  Sheet(int width, int height, int scale)
      : scale_(scale), width_(width * scale), height_(height * scale),
        pixels_(size_t(width_) * height_ * 3, 255) {}

  template <class ColourAt> void fill(int left, const Slice &slice, const ColourAt &colour_at) {
    for (int y = 0; y < slice.height() * scale_; ++y)
      for (int x = 0; x < slice.width() * scale_; ++x) {
        const Colour c = colour_at(x, y);
        std::copy(c.begin(), c.end(), pixels_.begin() + (long(y) * width_ + left * scale_ + x) * 3);
      }
  }
  std::string png() const { return png_bytes(pixels_, width_, height_); }

private:
  int scale_, width_, height_;
  std::vector<std::uint8_t> pixels_;
};

} // namespace

void draw_particles(const LabelImage &image, const PhaseLabels &phases, const LabelImage &particles,
                    const std::string &file) {
  constexpr int kGap = 4, kWidth = 2000; // voxels, pixels
  std::set<std::int32_t> cut;
  for (const Region &r : find_regions(particles, 0))
    if (r.cut)
      cut.insert(r.label);
  const Slice slices[] = {{image, 2}, {image, 1}, {image, 0}};
  int width = -kGap, height = 0;
  for (const Slice &s : slices) {
    width += s.width() + kGap;
    height = std::max(height, s.height());
  }
  const int scale = std::clamp(kWidth / width, 1, 8);
  Sheet sheet(width, height, scale);
  int left = 0;
  for (const Slice &s : slices) {
    sheet.fill(left, s, [&](int x, int y) {
      const auto particle = [&](int dx, int dy) {
        return s.at(particles, int(std::floor(double(x + dx) / scale)),
                    int(std::floor(double(y + dy) / scale)));
      };
      const std::int32_t own = particle(0, 0);
      if (own != 0 && (particle(1, 0) != own || particle(0, 1) != own || particle(-1, 0) != own ||
                       particle(0, -1) != own))
        return cut.count(own) > 0 ? kCut : kWhole;
      const std::int32_t label = s.at(image, x / scale, y / scale);
      return label == phases.am ? kAm : label == phases.pore ? kPore : kCbd;
    });
    left += s.width() + kGap;
  }
  write_file(file, sheet.png());
}

std::string png_bytes(const std::vector<std::uint8_t> &pixels, int width, int height) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(width, height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto *data = static_cast<unsigned char *>(image->GetScalarPointer());
  const size_t row = size_t(width) * 3;
  for (int y = 0; y < height; ++y) // VTK's rows begin at the bottom
    std::copy_n(pixels.data() + y * row, row, data + (height - 1 - y) * row);
  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn();
  writer->SetInputData(image);
  writer->Write();
  const auto *bytes = reinterpret_cast<const char *>(writer->GetResult()->GetPointer(0));
  return {bytes, bytes + writer->GetResult()->GetNumberOfTuples()};
}

} // namespace calendem
