// SPDX-License-Identifier: Apache-2.0
/// Which picture of a person another one is to be turned into: the pairs that the one-photo renderers learn from.
#pragma once

#include "render/texture/photo_frame.h"

namespace bodyloom {

/// What the target of a pair does not share with its source.
enum class PartnerDiffers {
  kPose,        ///< "the same person (but in different poses)": Sarkar et al., ECCV 2020, Section 3.5
  kPoseAndView  ///< "with different views and 3D poses": Yoon et al., CVPR 2021, Section 3.1.1
};

/// A frame of the person to be the target of `source`: each as likely of those that differ as told, where there are
/// none of those of another pose, where there are none of all others, `source` where there are no others. `uniform` in
/// [0, 1) chooses. Throws std::invalid_argument for a person or frame that is not there, and when people.places do not
/// have the frames of people.num_frames.
int PartnerOf(const PhotoSource& people, int person, int source, PartnerDiffers differs, double uniform);

}  // namespace bodyloom
