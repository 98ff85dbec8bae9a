// SPDX-License-Identifier: Apache-2.0
/// A person made of a dataset's pictures as if they were photos that are fitted already (render/photo_avatar).
#pragma once

#include <optional>
#include <span>

#include "pipelines/neural/photo/people_data.h"
#include "render/garment/fit_clothes.h"
#include "render/photo_avatar/draw_person.h"
#include "render/photo_avatar/photo_person.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Person `person` of `people`; `photos` are its pictures `frames`. None when no photo shows enough of the person.
std::optional<PhotoPerson> PersonOfFrames(const PeopleData& people, int person, std::span<const int> frames,
                                          std::span<const PhotoFrame> photos, int texture_size,
                                          const FitClothesOptions& clothes);

/// Of frame `frame`, its clothes hanging still; none where the frame's body is not known.
std::optional<PersonPose> PoseOfFrame(const PhotoPerson& person, const PeopleData& people, int number, int frame);

}  // namespace bodyloom
