// SPDX-License-Identifier: Apache-2.0
/// The motion that a verb was given by name: any motion file, or the one made by code.
#pragma once

#include <string>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

struct MotionInput {
  std::string motion;                   ///< any motion file; "demo": the motion that is made by code
  double fps = 0;                       ///< resampled to; 0: as the file has it (demo: 30)
  int first_frame = 0, num_frames = 0;  ///< of the motion, after resampling; 0 frames: all
  /// Played so many times as fast; first_frame and num_frames count frames at speed 1, so that they name the same poses
  /// at any speed. Other than 1 needs fps.
  double speed = 1;
};

/// Text for --help of the option that names the motion.
extern const char* const kMotionInputHelp;

/// Reads or makes it and cuts it; its clock begins at zero. Throws std::runtime_error naming the file, and
/// std::invalid_argument for a speed that is not positive or has no fps.
Motion LoadMotionInput(const MotionInput& input, const BodyModel& body);

}  // namespace bodyloom
