// SPDX-License-Identifier: Apache-2.0
/// Chooses the images of a person to be used as sources.
#pragma once

#include <vector>

#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Chooses `count` frames (fewer if there are fewer): first the one with the largest visible face, since the method
/// expects a frontal source; then greedily the one that adds the most unseen texels. Ties go to lower numbers.
std::vector<int> ChoosePhotos(const PhotoSource& people, int person, int count);

}  // namespace bodyloom
