// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/score/person_of_frames.h"

#include <string>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/scene/observations.h"
#include "render/photo_avatar/photo_person.h"
#include "render/photo_avatar/photo_person_builder.h"
#include "render/texture/planar_image.h"

namespace bodyloom {
namespace {

/// The frame as a photo that was fitted.
FittedPhoto FittedPhotoOf(const PhotoFrame& frame, const std::string& name, Track body) {
  FittedPhoto photo;
  photo.name = name;
  photo.image = ImageFromPlanes(frame.image, frame.size, frame.size);
  photo.track = std::move(body);
  photo.mask.width = photo.mask.height = frame.size;
  photo.mask.labels = photo.labels = frame.labels;
  return photo;
}

}  // namespace

std::optional<PhotoPerson> PersonOfFrames(const PeopleData& people, int person, std::span<const int> frames,
                                          std::span<const PhotoFrame> photos, int texture_size,
                                          const FitClothesOptions& clothes) {
  PhotoPersonBuilder builder(people.body(), texture_size, nullptr, clothes);
  int used = 0;
  for (size_t k = 0; k < photos.size(); ++k) {
    Track body = people.BodyOf(person, frames[k]);
    if (!body.HasResult(0)) continue;
    const std::string name = Concatenate("person ", person, ", image ", frames[k]);
    try {
      builder.Add(FittedPhotoOf(photos[k], name, std::move(body)));
      ++used;
    } catch (const NoPersonFound&) {  // shows too little: the others may do
    }
  }
  if (used == 0) return std::nullopt;
  return builder.Finish();
}

std::optional<PersonPose> PoseOfFrame(const PhotoPerson& person, const PeopleData& people, int number, int frame) {
  const Track body = people.BodyOf(number, frame);
  if (!body.HasResult(0)) return std::nullopt;
  const Track moved = MovedByPerson(person, body);
  return PersonPose{StillVertices(person, moved), moved.CameraAt(0)};
}

}  // namespace bodyloom
