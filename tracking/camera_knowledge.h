// SPDX-License-Identifier: Apache-2.0
/// Camera knowledge: how much of the camera a solve takes as known.
#pragma once

namespace bodyloom {

/// What is known about the camera's intrinsics.
enum class CameraKnowledge {
  kKnown,         ///< TrackSequenceInput::camera is used as it is
  kUnknownFocal,  ///< pinhole, square pixels, centred principal point, focal length estimated with the clip
  kWeak,          ///< weak perspective: scale and image offset per frame (the camera of paper A)
};

}  // namespace bodyloom
