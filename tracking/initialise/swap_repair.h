// SPDX-License-Identifier: Apache-2.0
/// Repairs detections whose left and right were exchanged for some frames, and finds cuts.
#pragma once

#include <vector>

#include "bodyloom/geometry/observations.h"

namespace bodyloom {

/// Exchanges each left–right pair back in the frames where it was swapped: a two-state trellis over the clip, in which
/// a jump costs its squared length in body sizes (saturated) and a swapped frame costs a little, so that a pair is only
/// exchanged where both its points jump to each other's place and back. Pairs are found by name (left_x, right_x);
/// shoulders with hips, and eyes with ears, are not tied together. Returns the number of exchanged pairs × frames.
int RepairSwaps(KeypointSequence* keypoints);

inline constexpr double kMaxGap_s = 1;  ///< between frames of one shot

/// True where frame t does not continue frame t−1: a gap of more than kMaxGap_s, or the whole body jumping by more than
/// half its size within a tenth of a second. The first frame is never a cut.
std::vector<char> FindCuts(const KeypointSequence& keypoints);

/// Whether a detector is sure enough of a landmark to judge motion by it (confidence 0.2).
bool IsSeen(const Keypoint& point);

/// Diagonal of the box around the seen landmarks of frame t: the person's size in the image, pixels; 0 with fewer
/// than 4.
double SeenBodySize(const KeypointSequence& keypoints, int t);

}  // namespace bodyloom
