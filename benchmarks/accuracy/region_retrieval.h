// SPDX-License-Identifier: Apache-2.0
/// Retrieval by a part of the body (motion_retrieval.h): hand, torso or leg, as Yoon et al. (CVPR 2022, Fig. 4)
/// retrieve patches. A camera's descriptor of a part says nothing while the body hides the part; the 3D descriptor
/// knows no view.
#pragma once

#include <vector>

#include "benchmarks/accuracy/motion_retrieval.h"
#include "data_tools/descriptors/person_frames.h"
#include "geometry/body/body_model.h"

namespace bodyloom {

enum class RetrievedRegion { kHand, kTorso, kLeg };
/// "hand", "torso", "leg".
const char* RegionName(RetrievedRegion region);

/// Of the person's right side, by DensePose's charts: hand and lower arm; both charts of the torso; the leg without the
/// foot. By COCO's landmarks: wrist and elbow; shoulders and hips; knee and ankle.
struct RegionOfBody {
  std::vector<int> landmarks;  ///< indices into CocoNames()
  int side = 0;                ///< texels of the atlas' sides
  std::vector<bool> texels;    ///< side × side, row-major: whether one belongs to the region
};

/// Throws std::invalid_argument when the body has no 24 parts or no UV coordinates, or side is out of range.
RegionOfBody MakeRegion(const BodyModel& body, RetrievedRegion region, int side);

/// Columns of KeypointTrajectories() that are of the region: its landmarks, still relative to the mean of all 17.
DescriptorRows KeypointsOfRegion(const DescriptorRows& whole, const RegionOfBody& region);
/// DenseCoordinates() with all pixels 0 that do not see the region.
DescriptorRows DenseCoordinatesOfRegion(const PersonFrames& frames, const RegionOfBody& region, int past);
/// Columns of MotionDescriptors() that are the region's texels. Throws std::invalid_argument when its atlas is of
/// another size.
DescriptorRows MotionOfRegion(const DescriptorRows& whole, const RegionOfBody& region);

/// Frames in which the camera sees at least a quarter of the pixels of the region that it sees in the median frame, and
/// did in each of the past − 1 frames before.
std::vector<bool> RegionSeen(const PersonFrames& frames, const RegionOfBody& region, int past);

}  // namespace bodyloom
