// SPDX-License-Identifier: Apache-2.0
/// Options of the lifter's random training windows. Probabilities are of a window unless stated otherwise.
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
  double min_elevation_deg = -10, max_elevation_deg = 40;  ///< positive: the camera looks down on the person
  double any_elevation = 0.12;  ///< from -35 to 75 degrees in place of the above: from the floor, from a balcony
  double roll_sd_deg = 4;
  double min_distance = 2.6, max_distance = 9;  ///< logarithmically uniform
  double off_axis = 0.35;                       ///< sideways, of the distance; half of it up and down
  double moving_camera = 0.15;                  ///< the camera turns after the person, and shakes
  double focal_known = 0.6;
  double focal_guess_sd = 0.3;  ///< of the logarithm of guessed over true focal length, where it is not known

  // Motion.
  double min_speed = 0.58, max_speed = 1.73;  ///< logarithmically uniform
  double mirror = 0.5;
  double as_recorded = 0.35;  ///< nothing of what follows is done, but for a quarter of the perturbation
  double arm_exchange = 0.35, leg_exchange = 0.15;  ///< for each arm and leg: moves as in another clip
  double spine_exchange = 0.2;
  double perturbation = 1.2;                ///< smooth random turns of the joints: the level is uniform up to this
  double squat = 0.35, lunge_share = 0.35;  ///< of the squats, this share has legs of their own
  double leg_raise = 0.18, kick = 0.08, arm_raise = 0.25, bend = 0.1, lean = 0.2;
  double reach = 0.2;         ///< an arm, or both, stretched out to the front
  double spin = 0.08;         ///< all of the body turns about the vertical, up to twice around
  double tumble = 0.05;       ///< it turns over, about a horizontal axis: flips, handstands, turns on the hands
  double floor_poses = 0.22;  ///< lying, sitting, kneeling, crawling, rolling, upside down

  // Bodies.
  double shape_sd = 1.2;              ///< standard deviation of each shape component
  double bone_noise = 1;              ///< multiplies the spread of bone lengths: 0.02 each + 0.06 … 0.10 by group
  double landmark_sd_m = 0.008;       ///< a landmark's place in the body
  double biased_detector = 0.5;       ///< the detector means places of its own, the same on both sides
  double detector_bias_sd_m = 0.012;  ///< how far off these are
  // Detections (data_tools/synthesis/clips/detection_noise.h).
  double noise = 1;                     ///< multiplies it; 0: exact positions
  double noise_spread = 0.3;            ///< sd of the logarithm of a window's own factor
  bool model_confidence = true;         ///< false: 1 for every landmark that is there
  double dropout = 0.01;                ///< of a point and frame
  double pair_swap = 0.06;              ///< of a window and pair (elbows, wrists, knees, ankles): few frames
  double body_swap = 0.03;              ///< all left and right points, for a stretch
  double no_feet = 0.6, no_face = 0.1;  ///< points that the detector does not have
  double missing_limb = 0.1, missing_lower_half = 0.08, nothing = 0.06;  ///< for a stretch
  double image_border = 0.15;                                            ///< the image ends across the body
  double cut_off = 0.25;             ///< points below a confidence of 0.1 … 0.4 are not reported
  double constant_confidence = 0.1;  ///< the confidence is 1 for all it reports
  double confidence_spread = 0.35;   ///< sd of the logarithm of the exponent that detectors' confidences differ by

  [[nodiscard]] bool IsValid(std::string* why) const;

  /// Motion as it was recorded, before the same cameras and detectors: for validation and tests.
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

// Poses of a stretch of frames in the form that windows are made in: unit quaternions of SMPL's 24 joints.

/// The same turn seen in a mirror at x = 0.
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

/// The turn by |w| radians about w. Series in the half angle's square: within 2e-7 up to 3 rad, libm's beyond.
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

/// From a (part 0) to b (part 1) by the short way, at nearly constant speed.
inline Eigen::Quaternionf Between(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b, float part) {
  const float sign = a.dot(b) < 0 ? -part : part;
  return Eigen::Quaternionf((1 - part) * a.coeffs() + sign * b.coeffs()).normalized();
}

}  // namespace bodyloom
