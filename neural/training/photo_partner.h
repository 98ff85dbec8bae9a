// SPDX-License-Identifier: Apache-2.0
/// Chooses target images for source images of a person: training pairs of the one-photo renderers.
#pragma once

#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Difference required between the target of a pair and its source.
enum class PartnerDiffers {
  kPose,        ///< "the same person (but in different poses)": Sarkar et al., ECCV 2020, Section 3.5
  kPoseAndView  ///< "with different views and 3D poses": Yoon et al., CVPR 2021, Section 3.1.1
};

/// Chooses a target frame of the person for `source`, uniformly among those that differ as requested; if there are
/// none, among those of another pose; if there are none, among all others; else `source` itself. `uniform` in [0, 1)
/// selects it. Throws std::invalid_argument for a person or frame out of range, and when people.places and
/// people.num_frames differ in size.
int PartnerOf(const PhotoSource& people, int person, int source, PartnerDiffers differs, double uniform);

}  // namespace bodyloom
