// SPDX-License-Identifier: Apache-2.0
/// Input features of the lifter: detections as viewing rays, normalised in direction and scale.
///
/// The generator of training windows and the tracker both call this, so that training and inference cannot differ.
///
/// Each frame has a virtual camera of its own: the real one, turned by the smallest rotation that puts the middle of
/// the body (mean direction of the seen shoulders and hips; of all seen points when fewer than two of those are seen;
/// interpolated in time when nothing is) on the optical axis. All lengths below are in that camera's image plane Z = 1.
///   S_t = |mid-shoulder − mid-hip| + mean over the seen legs of (thigh + shin)
///   S   = 85th percentile of S_t over the frames within ±(kLifterScaleFrames − 1)/2: the size of the upright person,
///         independent of the pose in this frame.
/// A frame that shows only the torso, only legs or only a part of a leg gives S_t by that part's share in the mean
/// body. One that shows none of these gives a rougher guess (longest limb, shoulder width or head by their shares),
/// which is used for S only where no better S_t lies within the window, and counts as unknown in the features.
///
/// Features of a frame (kLifterInputs floats):
///   for each of the kLifterPoints points x/S, y/S in [−4, 4] (0 where missing) and its confidence;
///   log S + 1.3 (0 when the focal length is unknown); focal_known (0 or 1); S_t/S − 0.9 (0 where S_t is unknown);
///   the motion of the centre ray since the frame before, in units of S, along x and y of the virtual camera, in
///   [−2, 2] (0 at the first frame and where this frame or the one before shows nothing);
///   for each of the kLifterBones bones its extent in depth as implied by foreshortening, √(max(0, m² − l²)), and its
///   full length m, where l is its length in this frame and m the 90th percentile of the lengths of the bone and its
///   mirror image over the same window, both divided by S and at most 4 (0 where an end is missing). These need maxima
///   over seconds, which a network learns slowly by itself.
///
/// A point counts as seen when its coordinates are finite, its confidence is positive and its ray lies within 84° of
/// the body's middle. Everything is finite for every input; a clip in which nothing is seen gives zero coordinates.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace bodyloom {

inline constexpr int kLifterPoints = 21;
inline constexpr int kLifterBones = 11;
inline constexpr int kLifterInputs = 3 * kLifterPoints + 5 + 2 * kLifterBones;
inline constexpr double kLifterRate = 20;      ///< frames a second the network works at
inline constexpr int kLifterScaleFrames = 81;  ///< window of the scale percentile

/// Indices of the points used by name in the code; right = left + 1.
enum LifterPoint : int {
  kLifterNose = 0,
  kLifterLeftEye = 1,
  kLifterLeftEar = 3,
  kLifterLeftShoulder = 5,
  kLifterLeftElbow = 7,
  kLifterLeftWrist = 9,
  kLifterLeftHip = 11,
  kLifterLeftKnee = 13,
  kLifterLeftAnkle = 15,
  kLifterLeftBigToe = 17,
  kLifterLeftHeel = 19,
};

/// CocoNames(), then left_big_toe, right_big_toe, left_heel, right_heel.
const std::vector<std::string>& LifterPointNames();

/// Detections of a stretch of frames (at about kLifterRate) as viewing rays.
struct LifterFrames {
  int num_frames = 0;
  std::vector<float> x, y;        ///< T·21 frame-major, ray (X/Z, Y/Z) after undistortion
  std::vector<float> confidence;  ///< T·21, 0 = missing; above 1 counts as 1, NaN as 0
  bool focal_known = false;       ///< false: the rays were made with a guessed focal length
};

struct LifterInput {
  std::vector<float> features;                       ///< T·kLifterInputs
  std::vector<Eigen::Matrix3f> camera_from_virtual;  ///< T rotations
  std::vector<float> scale;                          ///< T: S, positive
  std::vector<char> seen;                            ///< T: at least one usable point
};

/// Throws std::invalid_argument when the arrays do not have num_frames · kLifterPoints entries.
LifterInput MakeLifterInput(const LifterFrames& frames);

/// Index of the mirror image of a bone of the features: left and right exchanged.
int MirroredLifterBone(int bone);

/// camera_from_virtual of MakeLifterInput(frames) alone.
std::vector<Eigen::Matrix3f> LifterVirtualCameras(const LifterFrames& frames);

/// The lifter's unit of length: |mid-shoulder − mid-hip| + mean over the legs of thigh + shin, of 3·kLifterPoints
/// coordinates (in their unit). For the rest pose it is the Lref of the lifter's targets.
float LifterReferenceLength(std::span<const float> points);

}  // namespace bodyloom
