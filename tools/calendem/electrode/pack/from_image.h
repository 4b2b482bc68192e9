// SPDX-License-Identifier: GPL-2.0-or-later
// A crop of a tomogram as a film: its particles and its carbon-binder where the image has them.
#ifndef CALENDEM_ELECTRODE_PACK_FROM_IMAGE_H
#define CALENDEM_ELECTRODE_PACK_FROM_IMAGE_H

#include "electrode/pack/body.h"
#include "electrode/pack/packing_state.h"
#include "electrode/structure/existing_structure.h"
#include "electrode/structure/measured_shape.h"
#include "electrode/structure/phase_image.h"
#include <nlohmann/json_fwd.hpp>

namespace calendem {

/// Lengths um. A particle of the image is in the film as a whole or not at all, also where the
/// crop's sides cut it: what sticks out of one side comes in at the opposite one, and makes itself
/// room when the film is packed. Those are taken whose places are free, as many as give the crop's
/// volume of active material. The crop's bottom and top cut: a plate lies there.
struct FilmOfImage {
  ExistingStructure structure; ///< id k: a sphere of the volume of shapes[k - 1]; then CBD
  std::vector<MeasuredShape> shapes;
  PhaseImage phases;         ///< the crop
  std::array<int, 3> corner; ///< of the crop in the image, in voxels
  long whole = 0;            ///< particles that lie in the crop
  long across = 0;           ///< particles across its sides
  long left_out = 0;         ///< other particles across its sides
  long cut = 0;              ///< particles that the crop's top and bottom or the image's border cut
  double overlap = 0.0;      ///< share of the active material that lies in other, across the sides
  long small = 0;            ///< labels of less than half a primary
  double small_volume = 0.0; ///< their share of the active material
  bool cbd_of_image = false; ///< else the recipe's, at random places in the pores
};

/// Throws Failure(2) with what is wrong with image, phases or crop.
FilmOfImage read_film_of_image(const Recipe &recipe);

/// The particle's shape as it lies in the image, filled with `count` primaries.
Body make_body(const Recipe &recipe, const FilmOfImage &film, const ExistingSphere &sphere,
               int count, Random &random);

/// "image" of electrode.json: the crop, its porosity beside the film's, how much of the active
/// material is where it was.
nlohmann::json describe_image(const Recipe &recipe, const FilmOfImage &film,
                              const std::vector<Particle> &particles);

} // namespace calendem

#endif
