// SPDX-License-Identifier: Apache-2.0
/// Converts planar images (channel, row, column) of the networks to images for viewing.
#pragma once

#include <cstdint>
#include <span>

#include "render/image/image.h"

namespace bodyloom {

/// Planar RGB in [0, 1]; values outside are clamped.
Image ImageFromPlanes(std::span<const float> planar, int width, int height);

/// Normals of the camera frame as colours: red right, green up, blue towards the viewer; black for zero normals.
Image NormalImage(std::span<const float> planar, int width, int height);

/// Classes of a single-person dataset (data_tools/datasets/single_person_dataset.h), one colour each; the background is
/// black.
Image LabelsImage(std::span<const uint8_t> labels, int width, int height);

}  // namespace bodyloom
