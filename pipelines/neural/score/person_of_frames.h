// SPDX-License-Identifier: Apache-2.0
/// Makes a person from a dataset's images, treated as photos with known fits (render/photo_avatar).
#pragma once

#include <optional>
#include <span>

#include "pipelines/neural/photo/people_data.h"
#include "render/garment/fit_clothes.h"
#include "render/photo_avatar/draw_person.h"
#include "render/photo_avatar/photo_person.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Makes person `person` of `people`; `photos` are its images `frames`. Empty when no photo shows enough of the person.
std::optional<PhotoPerson> PersonOfFrames(const PeopleData& people, int person, std::span<const int> frames,
                                          std::span<const PhotoFrame> photos, int texture_size,
                                          const FitClothesOptions& clothes);

/// Pose in frame `frame` with clothes at rest; empty where the frame's body is unknown.
std::optional<PersonPose> PoseOfFrame(const PhotoPerson& person, const PeopleData& people, int number, int frame);

}  // namespace bodyloom
