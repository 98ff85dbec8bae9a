// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/photo_person.h"

#include "bodyloom/data_tools/motion/shape_track.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

Track MovedByPerson(const PhotoPerson& person, const Track& track) {
  BODYLOOM_CHECK(!track.HasMovingCamera(), "its camera moves; expected one that stands still");
  Track moved = WithShape(*person.bare, track, person.betas);
  moved.motion.betas.setZero();
  moved.joints.clear();  // the bare body's
  return moved;
}

}  // namespace bodyloom
