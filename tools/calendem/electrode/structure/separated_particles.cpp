// SPDX-License-Identifier: GPL-2.0-or-later
#include "electrode/structure/separated_particles.h"
#include "base/messages.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#ifdef __clang__ // ITK 5.2 of Debian refuses compilers other than the one that it was made with
#define ITK_COMPILER_DETECTION_H
#define ITK_NOEXCEPT noexcept
#endif
#include <itkGrayscaleFillholeImageFilter.h>
#include <itkImage.h>
#include <itkMorphologicalWatershedImageFilter.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>

namespace calendem {
namespace {

using Mask = itk::Image<unsigned char, 3>;
using Numbers = itk::Image<float, 3>;
using Basins = itk::Image<std::uint32_t, 3>;

Mask::Pointer mask_of(const LabelImage &image, std::int32_t label) {
  const auto mask = Mask::New();
  Mask::SizeType size;
  for (unsigned axis = 0; axis < 3; ++axis)
    size[axis] = Mask::SizeValueType(image.n[axis]);
  mask->SetRegions(size);
  mask->SetSpacing(image.voxel.data());
  mask->Allocate();
  std::transform(image.label.begin(), image.label.end(), mask->GetBufferPointer(),
                 [&](std::int32_t l) { return static_cast<unsigned char>(l == label); });
  return mask;
}

// -ln(d/v + 1) inside, 0 outside. Pores that the label encloses are inside: a particle is not cut at
// them. Maurer's distance is 0 in the outermost voxels: their centres are
// half a voxel from the surface.
Numbers::Pointer depth_of(const LabelImage &image, std::int32_t label) {
  const auto filled = itk::GrayscaleFillholeImageFilter<Mask, Mask>::New();
  filled->SetInput(mask_of(image, label));
  filled->Update();
  const auto distance = itk::SignedMaurerDistanceMapImageFilter<Mask, Numbers>::New();
  distance->SetInput(filled->GetOutput());
  distance->SetUseImageSpacing(true);
  distance->SetSquaredDistance(false);
  distance->SetInsideIsPositive(true);
  distance->Update();
  const Numbers::Pointer depth = distance->GetOutput();
  const auto v = float(std::cbrt(image.voxel.prod()));
  const unsigned char *inside = filled->GetOutput()->GetBufferPointer();
  float *d = depth->GetBufferPointer();
  for (size_t p = 0; p < image.label.size(); ++p)
    d[p] = inside[p] ? -std::log(std::max(0.0F, d[p]) / v + 1.5F) : 0.0F;
  return depth;
}

} // namespace

void check_phases(const LabelImage &image, const PhaseLabels &phases) {
  std::map<std::int32_t, size_t> count;
  for (const std::int32_t label : image.label)
    ++count[label];
  std::string others;
  for (const auto &[label, voxels] : count)
    if (label != phases.pore && label != phases.am && label != phases.cbd && others.size() < 100)
      others += fmt::format("{}{} ({:.2g} %)", others.empty() ? "" : ", ", label,
                            100.0 * double(voxels) / double(image.label.size()));
  Mistakes mistakes(image.file);
  if (!others.empty())
    mistakes.add(0,
                 "the labels {} are none of shapes.phases (pore {}, am {}, cbd {}). Name every "
                 "phase; leave shapes.phases out if the labels are particles.",
                 others, phases.pore, phases.am, phases.cbd);
  for (const auto &[name, label] :
       {std::pair("pore", phases.pore), std::pair("am", phases.am), std::pair("cbd", phases.cbd)})
    if (count.count(label) == 0)
      mistakes.add(0,
                   "no voxel has the label {} of shapes.phases.{}. Give the label of that phase{}.",
                   label, name, label == phases.cbd ? ", or leave cbd out if there is none" : "");
  mistakes.stop_if_any();
}

namespace {

void say_how_long(const LabelImage &image) {
  constexpr double kShort = 5.0, kSecondsEach = 1.0; // of a million voxels
  const double millions = 1e-6 * double(image.label.size());
  if (millions * kSecondsEach > kShort)
    fmt::print(stderr,
               "note: {}: {:.1f} million voxels are separated into particles, in about {:.0f} s.\n",
               image.file, millions, kSecondsEach * millions);
}

} // namespace

LabelImage separate_particles(const LabelImage &image, const PhaseLabels &phases, double neck) {
  check_phases(image, phases);
  say_how_long(image);
  const auto watershed = itk::MorphologicalWatershedImageFilter<Numbers, Basins>::New();
  watershed->SetInput(depth_of(image, phases.am));
  watershed->SetLevel(float(-std::log(neck)));
  watershed->SetMarkWatershedLine(false);
  watershed->SetFullyConnected(true);
  watershed->Update();
  const std::uint32_t *basin = watershed->GetOutput()->GetBufferPointer();
  LabelImage out = image;
  std::map<std::uint32_t, std::int32_t> number;
  for (size_t p = 0; p < out.label.size(); ++p)
    out.label[p] = image.label[p] == phases.am
                       ? number.emplace(basin[p], std::int32_t(number.size()) + 1).first->second
                       : 0;
  return out;
}

} // namespace calendem
