// SPDX-License-Identifier: Apache-2.0
/// Finds frames in which the detector did not follow the person.
#pragma once

#include "geometry/scene/observations.h"

namespace bodyloom {

/// Makes all landmarks missing in frames that do not show the person of their neighbours. Either the landmarks are
/// degenerate: five or more on one line or at one point (the smaller standard deviation across them is below 1.5 % of a
/// person's size: the larger of the frame's and the clip's median), unless most of the clip is so. Or the body jumps
/// away from the last good frame and, within 0.5 s, a frame continues that one again. A jump without such a return is a
/// cut and is kept. Bodies a and b, dt seconds apart, with sizes s (diagonal of the box around the seen landmarks):
///   jump:      median distance of common landmarks > (0.15 + 4 dt) min(s_a, s_b), or s changes by over 1.8 (1 + 4 dt)
///   continues: median distance < (0.1 + dt) min(s_a, s_b), and s changes by less than 1.5
/// Frames with fewer than four seen landmarks are neither.
///
/// Or the body is upside down between upright frames, as a detector may see it against the light: shoulders half a
/// trunk below the hips in frames [a, b) of at most 2 s, half a trunk above them in a − 1 and b, and from a − 1 to a
/// and from b − 1 to b the trunk would have turned faster than in any somersault (body_rods.h). Handstands, cartwheels
/// and flips are kept: the trunk gets there in steps that a camera sees.
///
/// Linear in the number of frames. Returns the number of frames emptied.
int RemoveOutlierFrames(KeypointSequence* keypoints);

/// Result of CleanKeypoints().
struct CleanedKeypoints {
  int impossible_frames = 0;  ///< emptied by RemoveOutlierFrames()
  int swaps = 0;              ///< left and right exchanged back by RepairSwaps()
};
/// Removes impossible landmarks (DropUnusable()) and outlier frames, and repairs swaps.
CleanedKeypoints CleanKeypoints(KeypointSequence* keypoints);

/// True if frame b of a sequence continues the earlier frame a, as defined above.
bool ContinuesFrame(const KeypointSequence& keypoints, int a, int b);

}  // namespace bodyloom
