// SPDX-License-Identifier: Apache-2.0
/// Planar images (channel, row, column) of the networks as pictures to look at.
#pragma once

#include <cstdint>
#include <span>

#include "render/image/image.h"

namespace bodyloom {

/// Planar RGB in [0, 1] to a picture; values beyond are cut off.
Image PictureOf(std::span<const float> planar, int width, int height);

/// Normals of the camera frame as colours: red right, green up, blue towards the viewer; black where there are none.
Image NormalPicture(std::span<const float> planar, int width, int height);

/// Classes of a single-person dataset (data_tools/datasets/single_person_dataset.h), a colour each; the background is
/// black.
Image LabelsPicture(std::span<const uint8_t> labels, int width, int height);

}  // namespace bodyloom
