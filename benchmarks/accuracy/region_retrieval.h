// SPDX-License-Identifier: Apache-2.0
/// Retrieves motion by a part of the body (motion_retrieval.h): hand, torso or leg, as Yoon et al. (CVPR 2022, Fig. 4)
/// retrieve patches. An image-space descriptor of a part is undefined while the body occludes the part; the 3D
/// descriptor does not depend on the view.
#pragma once

#include <vector>

#include "benchmarks/accuracy/motion_retrieval.h"
#include "data_tools/descriptors/person_frames.h"
#include "geometry/body/body_model.h"

namespace bodyloom {

enum class RetrievedRegion { kHand, kTorso, kLeg };
/// "hand", "torso", "leg".
const char* RegionName(RetrievedRegion region);

/// A region of the person's right side. DensePose charts: hand and lower arm; both charts of the torso; the leg without
/// the foot. COCO landmarks: wrist and elbow; shoulders and hips; knee and ankle.
struct RegionOfBody {
  std::vector<int> landmarks;  ///< indices into CocoNames()
  int side = 0;                ///< side length of the atlas, texels
  std::vector<bool> texels;    ///< side × side, row-major: true if in the region
};

/// Throws std::invalid_argument when the body has no 24 parts or no UV coordinates, or side is out of range.
RegionOfBody MakeRegion(const BodyModel& body, RetrievedRegion region, int side);

/// Columns of KeypointTrajectories() of the region's landmarks, still relative to the mean of all 17.
DescriptorRows KeypointsOfRegion(const DescriptorRows& whole, const RegionOfBody& region);
/// DenseCoordinates() with all pixels outside the region set to 0.
DescriptorRows DenseCoordinatesOfRegion(const PersonFrames& frames, const RegionOfBody& region, int past);
/// Columns of MotionDescriptors() of the region's texels. Throws std::invalid_argument when its atlas has another size.
DescriptorRows MotionOfRegion(const DescriptorRows& whole, const RegionOfBody& region);

/// True for frames in which at least a quarter of the region's pixels in the median frame is visible, as in each of the
/// past − 1 frames before.
std::vector<bool> RegionSeen(const PersonFrames& frames, const RegionOfBody& region, int past);

}  // namespace bodyloom
