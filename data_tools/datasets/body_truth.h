// SPDX-License-Identifier: Apache-2.0
/// Labels and normals of a person of whom no dataset knows them: from the person's outline and the tracked body.
///
/// The outline is as good as the mask it comes from. Within it a pixel has the clothing class of the part of the body
/// that it shows, or that the nearest pixel of the body shows (photo_segmentation.h): skirts are trousers, coats end at
/// the waist, hair is face. Normals are the bare body's, beyond its outline those of its nearest pixel; folds and
/// whatever hangs free are not in them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

/// What the pixels of a picture show of a body, background 0.
struct BodySurface {
  int width = 0, height = 0;
  std::vector<uint8_t> parts;  ///< DensePose's, 1 to 24: height × width
  std::vector<float> normals;  ///< unit, outwards, camera frame: 3 × height × width
};

struct BodyTruth {
  std::vector<uint8_t> labels;  ///< PersonLabel: height × width
  Image normals;                ///< by NormalCode (single_person_dataset.h), 0 on the background
};

/// `person`: where the person is, not 0. `parts`: DensePose's parts as somebody else found them, which count before the
/// body's (0 and above 24: not known); empty: the body's alone. Without anything of the body all is background. Throws
/// std::invalid_argument when sizes differ.
BodyTruth BodyTruthOf(const BodySurface& body, std::span<const uint8_t> person, std::span<const uint8_t> parts = {});

}  // namespace bodyloom
