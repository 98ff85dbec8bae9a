// SPDX-License-Identifier: Apache-2.0
/// Chooses the pictures of a person to animate from.
#pragma once

#include <vector>

#include "render/texture/photo_frame.h"

namespace bodyloom {

/// `count` frames (fewer when there are not as many): first the one with most of the face in it, for the method takes
/// its source to be seen from the front; then each time the one that shows most texels of the person that those before
/// do not show. Lower numbers win ties.
std::vector<int> ChoosePhotos(const PhotoSource& people, int person, int count);

}  // namespace bodyloom
