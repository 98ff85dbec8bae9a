// SPDX-License-Identifier: Apache-2.0
/// Frame indices and timestamps from the numbers that detectors put into file names and image ids.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/scene/observations.h"

namespace bodyloom {

/// The last run of digits in a file name without folder, extension and OpenPose's "_keypoints" ending
/// ("walk_000000000012_keypoints.json" → 12, "cam01.0037.json" → 37); −1 when there is none or it exceeds 10¹⁵.
int64_t FrameNumberFromName(const std::string& file_name);

/// The numbers of names; when one has none, their order.
std::vector<int64_t> NumbersOrOrder(const std::vector<std::string>& names);

/// Frames on a regular grid.
struct FrameGrid {
  std::vector<int> index;          ///< frame of each input number
  std::vector<double> timestamps;  ///< T seconds: number / fps, so that a clip that starts at frame 100 says so
};

/// Lays numbers (any order, no duplicates) on a grid: frame 0 is the smallest, the step is the greatest common divisor
/// of their differences (every fifth frame of a video is no gap of four), numbers that are absent in between are frames
/// without detections. Throws std::runtime_error beginning with `where` for duplicates and for a grid of more than a
/// million frames, std::invalid_argument for a frame rate that is not positive.
FrameGrid MakeFrameGrid(const std::vector<int64_t>& numbers, double fps, const std::string& where);

// A stretch of a clip's observations.

/// Frames [first, last], both included, with their timestamps as they are. Throws std::invalid_argument for frames that
/// are not there.
KeypointSequence CutFrames(KeypointSequence keypoints, int first, int last);
PartLabelSequence CutFrames(PartLabelSequence labels, int first, int last);

}  // namespace bodyloom
