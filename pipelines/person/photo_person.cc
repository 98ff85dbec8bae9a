// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/photo_person.h"

#include "bodyloom/geometry/bake_shape.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/cloth/cloth_wearer.h"

namespace bodyloom {

LooseGarment CutGarment(const BodyModel& clothed, LooseGarmentOptions* cut) {
  constexpr uint64_t kSeed = 1;  // of how it is crumpled
  LooseGarment garment = ClothWearer(clothed, Eigen::VectorXd(), {}).Cut(*cut, kSeed);
  cut->columns = garment.columns;
  return garment;
}

Track MovedByPerson(const PhotoPerson& person, const Track& track, PersonPlacing placed) {
  BODYLOOM_CHECK(!track.HasMovingCamera(), "its camera moves; expected one that stands still");
  return OfBakedBody(WithShape(*person.bare, track, person.betas, placed));
}

}  // namespace bodyloom
