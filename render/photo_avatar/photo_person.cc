// SPDX-License-Identifier: Apache-2.0
#include "render/photo_avatar/photo_person.h"

#include "geometry/base/check.h"
#include "geometry/cloth/body_with_garment.h"
#include "geometry/scene/track_edits.h"
#include "render/garment/person_cloth.h"
#include "render/view/overlay.h"

namespace bodyloom {

Track MovedByPerson(const PhotoPerson& person, const Track& track, PersonPlacing placed) {
  BODYLOOM_CHECK(!track.HasMovingCamera(), "its camera moves; expected one that stands still");
  return OfBakedBody(WithShape(*person.bare, track, person.betas, placed));
}

MatrixX3d StillVertices(const PhotoPerson& person, const Track& moved) {
  MatrixX3d vertices = TrackVertices(*person.body, moved, 0);
  if (person.garment.empty()) return vertices;
  PersonCloth cloth(*person.clothed, person.garment, moved);
  PlaceGarment(person.garment, cloth.At(0), &vertices);
  return vertices;
}

}  // namespace bodyloom
