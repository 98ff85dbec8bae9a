// SPDX-License-Identifier: Apache-2.0
/// A motion given by name: any motion file, or the one made by code; its rate, its frames and its speed.
#pragma once

#include <string>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct MotionSource {
  std::string name;                     ///< any motion file; "demo": the motion that is made by code
  double fps = 0;                       ///< resampled to; 0: as the file has it (demo: 30)
  int first_frame = 0, num_frames = 0;  ///< of the motion, after resampling; 0 frames: all
  /// Played so many times as fast; first_frame and num_frames count frames at speed 1, so that they name the same poses
  /// at any speed. Other than 1 needs fps.
  double speed = 1;
};

/// Reads or makes it and cuts it; its clock begins at zero. Throws std::runtime_error naming the file, and
/// std::invalid_argument for a speed that is not positive or has no fps.
Motion LoadMotionSource(const MotionSource& source, const BodyModel& body);

}  // namespace bodyloom
