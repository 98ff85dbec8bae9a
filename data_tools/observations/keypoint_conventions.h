// SPDX-License-Identifier: Apache-2.0
/// Landmark orders of detectors, in one vocabulary.
///
/// Landmarks of bodies (COCO's 17, toes and heels) have the body's names in all conventions; others (neck, mid_hip,
/// head_top, …) have their own names and constrain nothing unless a body has them. Left and right are the person's.
/// Sources: OpenPose doc/02_output.md and poseParameters.cpp (BODY_25, BODY_25B, COCO-18), COCO and COCO-WholeBody,
/// Halpe-FullBody, MediaPipe pose_landmark, VideoPose3D common/h36m_dataset.py.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bodyloom {

struct KeypointConvention {
  std::string name;                ///< "coco17", "body25", …
  std::vector<std::string> names;  ///< landmark names in the detector's order
};

/// COCO's 17 (CocoNames()).
const KeypointConvention& Coco17();
/// OpenPose's 25: neck and mid-hip, eyes, ears, three foot points per side.
const KeypointConvention& Body25();
/// OpenPose's experimental 25B: COCO's 17, upper_neck, head_top, three foot points per side.
const KeypointConvention& Body25B();
/// OpenPose's 18: COCO with a neck, right side first.
const KeypointConvention& OpenPoseCoco18();
/// COCO-WholeBody's first 23 of 133: COCO's 17 and three foot points per side (face and hands: hand_and_face_points.h).
const KeypointConvention& CocoWholeBody23();
/// Halpe's 26 (also the first 26 of its 136): COCO's 17, head_top, neck, mid_hip, three foot points per side.
const KeypointConvention& Halpe26();
/// BlazePose's 33. Its "foot index" is the tip of the foot and is used as the big toe (about 2 cm away).
const KeypointConvention& MediaPipe33();

/// Human3.6M's 17 as in VideoPose3D: pelvis, legs (right side first), spine, neck, head, arms (left side first). Its
/// ninth, between chin and nose, is "head_front" and constrains nothing.
const KeypointConvention& Human36m17();

/// The conventions above.
const std::vector<const KeypointConvention*>& KnownConventions();

/// The convention of COCO's family with that many landmarks: 17, 23 or 133 (whole body), 26 or 136 (Halpe), of which
/// the first ones are those named; nullptr for another number.
const KeypointConvention* ConventionOfCount(size_t num_points);

/// Sets `convention`, null before the first person of a file, to ConventionOfCount(). Throws std::runtime_error naming
/// `place` when there is none, or another than that of the people before.
void RequireConventionOfCount(size_t num_points, const std::string& place, const KeypointConvention** convention);

// Landmarks by the names that people and detectors give them.

/// Returns a landmark's name in lower case with underscores, the side in front: "LEFT_FOOT_INDEX" → "left_big_toe",
/// "left_big toe" → "left_big_toe", "LShoulder", "shoulder_l" and "leftShoulder" → "left_shoulder", "hip", "hips" and
/// "pelvis" without a side → "mid_hip", "thorax" → "neck". Other names come back in that spelling.
std::string LandmarkNameFrom(std::string_view text);

/// Returns the convention that has these names (as LandmarkNameFrom() gives them) in this order, for 133 and 136 names
/// the one that has the first of them (ConventionOfCount()), else one called "custom".
KeypointConvention ConventionOfNames(const std::vector<std::string>& names);

/// Returns true if a name is one of COCO's, a toe, a heel, or the neck, mid-hip or top of the head: a person's.
bool IsPersonLandmark(const std::string& name);

}  // namespace bodyloom
