// SPDX-License-Identifier: Apache-2.0
/// Frame indices and timestamps from the numbers that detectors put into file names and image ids.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

/// The last run of digits in a file name without folder, extension and OpenPose's "_keypoints" ending
/// ("walk_000000000012_keypoints.json" → 12, "cam01.0037.json" → 37); −1 if there is none or it exceeds 10¹⁵.
int64_t FrameNumberFromName(const std::string& file_name);

/// The frame numbers of the names of one clip, in which FrameNumberFromName()'s number may be the same everywhere
/// ("take2_60fps_12_1080p.json"): then the last of their numbers that differs between names, if all have as many; −1
/// where there is none. Names may repeat.
std::vector<int64_t> FrameNumbersFromNames(const std::vector<std::string>& names);

/// FrameNumbersFromNames(), or the order of the names if one has no number.
std::vector<int64_t> NumbersOrOrder(const std::vector<std::string>& names);

/// Frames on a regular grid.
struct FrameGrid {
  std::vector<int> index;          ///< frame of each input number
  std::vector<double> timestamps;  ///< T seconds: number / fps, which preserves the start of a clip at frame 100
};

/// Lays numbers (any order, no duplicates) on a grid: frame 0 is the smallest, the step is the greatest common divisor
/// of their differences (every fifth frame of a video is not a gap of four), and missing numbers in between are frames
/// without detections. Throws std::runtime_error beginning with `where` for duplicates and for a grid of more than a
/// million frames, std::invalid_argument for a frame rate that is not positive.
FrameGrid MakeFrameGrid(const std::vector<int64_t>& numbers, double fps, const std::string& where);

// A range of a clip's observations.

/// Frames [first, last], both included, with their original timestamps. Throws std::invalid_argument for frames out of
/// range.
KeypointSequence CutFrames(KeypointSequence keypoints, int first, int last);
HandsAndFaceSequence CutFrames(HandsAndFaceSequence hands_and_face, int first, int last);
DenseSequence CutFrames(DenseSequence dense, int first, int last);
PartLabelSequence CutFrames(PartLabelSequence labels, int first, int last);

}  // namespace bodyloom
