// SPDX-License-Identifier: Apache-2.0
/// Options of the lifter's random training windows. Probabilities are per window unless stated otherwise.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "data_tools/synthesis/pose_joints.h"
#include "tracking/lifter/lifter_input.h"

namespace bodyloom {

struct LifterWindowOptions {
  int num_frames = 81;
  double rate = kLifterRate;  ///< frames a second

  // Camera. Distances are in units of the body: metres for a person of the mean body's size.
  double min_elevation_deg = -20, max_elevation_deg = 40;  ///< positive: the camera looks down on the person
  double any_elevation = 0.15;                             ///< from -35 to 75 degrees instead of the above
  double roll_sd_deg = 4;
  double min_distance = 2.6, max_distance = 9;  ///< logarithmically uniform
  double off_axis = 0.35;                       ///< sideways, of the distance; half of it up and down
  double moving_camera = 0.15;                  ///< the camera follows the person by rotation, with shake
  double focal_known = 0.6;
  double focal_guess_sd = 0.3;  ///< of the logarithm of guessed over true focal length, where unknown

  // Motion.
  double min_speed = 0.58, max_speed = 1.73;  ///< logarithmically uniform
  double mirror = 0.5;
  double as_recorded = 0.35;                        ///< none of the following but a quarter of the perturbation
  double arm_exchange = 0.35, leg_exchange = 0.15;  ///< for each arm and leg: takes the motion of another clip
  double spine_exchange = 0.2;
  double perturbation = 1.2;                ///< smooth random rotations of the joints: the level is uniform up to this
  double squat = 0.35, lunge_share = 0.35;  ///< lunge_share: share of the squats with different legs
  double leg_raise = 0.18, kick = 0.08, arm_raise = 0.25, bend = 0.1, lean = 0.2;
  double reach = 0.2;         ///< one or both arms stretched out to the front
  double spin = 0.08;         ///< the whole body rotates about the vertical, by up to two turns
  double tumble = 0.05;       ///< it rotates about a horizontal axis: flips, handstands, cartwheels
  double floor_poses = 0.22;  ///< lying, sitting, kneeling, crawling, rolling, upside down

  // Bodies.
  double shape_sd = 1.2;              ///< standard deviation of each shape component
  double bone_noise = 1;              ///< multiplies the spread of bone lengths: 0.02 each + 0.06 … 0.10 by group
  double landmark_sd_m = 0.008;       ///< spread of a landmark's place in the body
  double biased_detector = 0.5;       ///< the detector has its own landmark definitions, the same on both sides
  double detector_bias_sd_m = 0.012;  ///< spread of these definitions
  // Detections (data_tools/synthesis/clips/detection_noise.h).
  double noise = 1;                     ///< multiplies it; 0: exact positions
  double noise_spread = 0.3;            ///< sd of the logarithm of a window's own factor
  bool model_confidence = true;         ///< false: 1 for every landmark that is present
  double dropout = 0.01;                ///< per point and frame
  double pair_swap = 0.06;              ///< per window and pair (elbows, wrists, knees, ankles), for a few frames
  double body_swap = 0.03;              ///< all left and right points, for a while
  double no_feet = 0.6, no_face = 0.1;  ///< points that the detector does not have
  double missing_limb = 0.1, missing_lower_half = 0.08, nothing = 0.06;  ///< for a while
  double image_border = 0.15;                                            ///< the image border cuts the body
  double cut_off = 0.25;             ///< points below a confidence of 0.1 … 0.4 are not reported
  double constant_confidence = 0.1;  ///< the confidence is 1 for all it reports
  double confidence_spread = 0.35;   ///< sd of the logarithm of the exponent of detectors' confidences

  [[nodiscard]] bool IsValid(std::string* why) const;

  /// Recorded motion with the same cameras and detectors, for validation and tests.
  static LifterWindowOptions AsRecorded() {
    LifterWindowOptions options;
    options.min_speed = options.max_speed = 1;
    options.arm_exchange = options.leg_exchange = options.spine_exchange = options.perturbation = 0;
    options.squat = options.leg_raise = options.kick = options.arm_raise = options.reach = options.bend = options.lean =
        0;
    options.floor_poses = options.spin = options.tumble = options.any_elevation = 0;
    return options;
  }
};

// Poses of a sequence of frames as unit quaternions of SMPL's 24 joints.

/// The rotation mirrored at x = 0.
inline Eigen::Quaternionf MirrorRotation(const Eigen::Quaternionf& q) { return {q.w(), q.x(), -q.y(), -q.z()}; }

/// World: y up.
struct PoseSequence {
  int num_frames = 0;
  bool has_floor = false;
  std::vector<Eigen::Quaternionf> rotations;  ///< T·24, relative to the parent
  std::vector<Eigen::Vector3f> trans;         ///< T, of the pelvis, metres of the mean body
  std::vector<float> clearance;               ///< T: lowest point above the floor, metres of the mean body
  Eigen::Quaternionf& at(int t, int joint) { return rotations[static_cast<size_t>(t) * kPoseJoints + joint]; }
  [[nodiscard]] const Eigen::Quaternionf& at(int t, int joint) const {
    return rotations[static_cast<size_t>(t) * kPoseJoints + joint];
  }
};

/// The rotation by |w| radians about w. Series in the half angle's square: within 2e-7 up to 3 rad, libm's beyond.
inline Eigen::Quaternionf TurnBy(const Eigen::Vector3f& w) {
  const float h = 0.25F * w.squaredNorm();
  if (h > 2.25F) {
    const float half = std::sqrt(h), s = 0.5F * std::sin(half) / half;
    return {std::cos(half), s * w.x(), s * w.y(), s * w.z()};
  }
  const float c =
      1 - h * (1.F / 2 - h * (1.F / 24 - h * (1.F / 720 - h * (1.F / 40320 - h * (1.F / 3628800 - h / 479001600)))));
  const float s = 0.5F - h * (1.F / 12 - h * (1.F / 240 - h * (1.F / 10080 - h * (1.F / 725760 - h / 79833600))));
  return {c, s * w.x(), s * w.y(), s * w.z()};
}

/// Its inverse; angles in [0, π].
inline Eigen::Vector3f AxisAngleOf(const Eigen::Quaternionf& q) {
  const Eigen::Vector3f v = q.w() < 0 ? Eigen::Vector3f(-q.vec()) : Eigen::Vector3f(q.vec());
  const float s = v.norm();
  return s < 1e-6F ? Eigen::Vector3f(2 * v) : Eigen::Vector3f(2 * std::atan2(s, std::abs(q.w())) / s * v);
}

/// Interpolates from a (part 0) to b (part 1) along the shorter arc, at nearly constant speed.
inline Eigen::Quaternionf Between(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b, float part) {
  const float sign = a.dot(b) < 0 ? -part : part;
  return Eigen::Quaternionf((1 - part) * a.coeffs() + sign * b.coeffs()).normalized();
}

}  // namespace bodyloom
