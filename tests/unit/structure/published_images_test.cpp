// SPDX-License-Identifier: GPL-2.0-or-later
// Measured on an image whose values another program gives: TauFactor's test electrode
// (doi:10.21105/joss.05358), where CALENDEM_IMAGES names the folder with it.
#include "electrode/structure/separated_particles.h"
#include "measure/diffusion.h"
#include "measure_support.h"
#include <cstdlib>

namespace {
using namespace calendem;
using namespace calendem_test;

PhaseImage published() {
  const char *images = std::getenv("CALENDEM_IMAGES");
  if (!images)
    return {};
  return phases_of(read_label_image(std::string(images) + "/taufactor_electrode.tiff", 1.0), 0,
                   170);
}
constexpr const char *kWhy = "CALENDEM_IMAGES names no folder with taufactor_electrode.tiff";

TEST(PublishedElectrode, PhasesAreToTheLastDigit) {
  const PhaseImage image = published();
  if (image.label.empty())
    GTEST_SKIP() << kWhy;
  const PhaseFractions f = phase_fractions(image);
  EXPECT_NEAR(f.pore, 0.44992, 5e-6);
  EXPECT_NEAR(f.am, 0.40047, 5e-6);
  EXPECT_NEAR(f.cbd, 0.14962, 5e-6);
}

// On the voxels as they are, without the step to finer ones: TauFactor solves the same equations, to a
// change of 1e-3 of the flux.
TEST(PublishedElectrode, TortuosityOnItsVoxelsIsTauFactors) {
  const PhaseImage image = published();
  if (image.label.empty())
    GTEST_SKIP() << kWhy;
  const Diffusion d = diffusion(pore_space(image), 2);
  EXPECT_NEAR(d.open / d.effective, 2.0776, 0.003);
}

} // namespace
