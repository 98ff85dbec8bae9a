// SPDX-License-Identifier: Apache-2.0
/// Approximate labels and normals of a person, for recordings without them: from the person's outline and the tracked
/// body.
///
/// The outline is as accurate as the mask. Within it a pixel has the clothing class of its body part, or of the body
/// part of the nearest pixel of the body (photo_segmentation.h): skirts are trousers, coats end at the waist, hair is
/// face. Normals are those of the bare body, beyond its outline those of its nearest pixel, without folds and loose
/// cloth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

/// Body surface at the pixels of an image; background 0.
struct BodySurface {
  int width = 0, height = 0;
  std::vector<uint8_t> parts;  ///< DensePose's, 1 to 24: height × width
  std::vector<float> normals;  ///< unit, outwards, camera frame: 3 × height × width
};

struct BodyTruth {
  std::vector<uint8_t> labels;  ///< PersonLabel: height × width
  Image normals;                ///< by NormalCode (single_person_dataset.h), 0 on the background
};

/// `person`: non-zero where the person is. `parts`: DensePose's parts from another source, which take precedence over
/// the body's (0 and above 24: unknown); empty: the body's alone. If no pixel shows the body, all is background. Throws
/// std::invalid_argument when sizes differ.
BodyTruth BodyTruthOf(const BodySurface& body, std::span<const uint8_t> person, std::span<const uint8_t> parts = {});

}  // namespace bodyloom
