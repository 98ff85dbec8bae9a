// SPDX-License-Identifier: Apache-2.0
/// Parts of clips, and the dense synthetic ones, that several benchmarks share.
#pragma once

#include <string>

#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// `pixel`: 1 px Gaussian. `densepose`: 1 px, UV noise 0.02 of a chart, 8-bit UV, 5 % outliers, each part missing 5 %
/// of the time. Throws std::invalid_argument for other names.
DenseFaultOptions DenseFaults(const std::string& noise);

/// All frames when `frames` is 0 or more than there are.
Motion FirstFrames(Motion motion, int frames);
KeypointSequence FirstFrames(KeypointSequence keypoints, int frames);

/// Toes and heels get confidence 0: what most detectors show.
void LeaveOutFeet(KeypointSequence* keypoints);

/// First part of the file's name.
std::string MotionName(const std::string& path);

}  // namespace bodyloom
