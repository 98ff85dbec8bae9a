// SPDX-License-Identifier: Apache-2.0
/// Fast evaluation of the lifter's 21 landmarks of a posed body: each is reduced once to a few bones, without pose
/// correctives (they move joint landmarks by millimetres), in single precision.
///
///   x = Σ_i R_i (s_i ∘ l_i(β) + w_i o) + w_i p_i     l_i(β) = q_i(β) − w_i J_i(β), Σ w_i = 1
///   (tracking/problem/body_points.h)
/// with s_i the stretch of bone i along its own axes (all bones share the body's axes in T-pose; the joints below bone
/// i move by s_i too) and o the landmark's own offset.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "data_tools/synthesis/lifter/lifter_window_options.h"
#include "geometry/base/hash_random.h"
#include "geometry/body/body_model.h"
#include "tracking/lifter/lifter_input.h"

namespace bodyloom {

/// A person: data that are constant over a window.
struct LifterPerson {
  Eigen::Vector3f pelvis;                               ///< of the rest pose
  std::array<Eigen::Vector3f, kPoseJoints> offset;      ///< from the parent joint
  std::vector<Eigen::Vector3f> local;                   ///< one for each landmark and bone
  std::array<Eigen::Vector3f, kLifterPoints> detector;  ///< the detector's own place for the landmark, in its bone
  float reference_length = 0;                           ///< Lref, metres
  float size = 1;                                       ///< Lref over that of the mean body
};

struct PosedPerson {
  std::array<Eigen::Matrix3f, kPoseJoints> rotation;  ///< world from joint
  std::array<Eigen::Vector3f, kPoseJoints> joint;
  std::array<Eigen::Vector3f, kLifterPoints> point;
};

/// Deviations of a window's person from the mean body; spreads as in LifterWindowOptions.
struct LifterPersonSpread {
  double shape_sd = 0, bone_noise = 0, landmark_sd_m = 0, biased_detector = 0, detector_bias_sd_m = 0;
};

class LifterBody {
 public:
  /// Throws std::invalid_argument when the body lacks SMPL's first 24 joints or one of LifterPointNames().
  explicit LifterBody(const BodyModel& body);

  /// `betas` may be shorter or longer than the body's (missing ones are zero, further ones are ignored).
  [[nodiscard]] LifterPerson Person(const Eigen::VectorXd& betas) const;
  [[nodiscard]] LifterPerson RandomPerson(const LifterPersonSpread& spread, HashRandom random) const;

  /// `rotations`: 24, `trans` as SMPL's: the pelvis is at person.pelvis + trans.
  void Pose(const LifterPerson& person, const Eigen::Quaternionf* rotations, const Eigen::Vector3f& trans,
            PosedPerson* posed) const;

  /// Position of landmark k as defined by a biased detector.
  [[nodiscard]] Eigen::Vector3f DetectedPoint(const LifterPerson& person, const PosedPerson& posed, int k) const {
    return posed.point[k] + posed.rotation[main_bone_[k]] * person.detector[k];
  }

  /// Height of the lowest point of landmarks, trunk and head, modelled as balls that fill the body.
  [[nodiscard]] float Lowest(const LifterPerson& person, const PosedPerson& posed) const;
  /// Lowest points of the balls, to determine contact with the floor: kNumBalls of (x, height, z).
  static constexpr int kNumBalls = 22;
  void BallBottoms(const LifterPerson& person, const PosedPerson& posed,
                   std::array<Eigen::Vector3f, kNumBalls>* bottoms) const;
  /// Height of toes and heels above the sole in the rest pose, metres of the mean body (toe, heel).
  [[nodiscard]] std::array<float, 2> foot_radius() const { return {toe_radius_, heel_radius_}; }

 private:
  struct Bone {
    int joint;
    float weight;
    int column;  ///< first of the three rows in local_shape_
  };
  LifterPerson Build(const Eigen::VectorXf& betas, const std::array<Eigen::Vector3f, kPoseJoints>& stretch,
                     const std::array<Eigen::Vector3f, kLifterPoints>& offsets) const;

  int num_betas_ = 0;
  std::array<int, kPoseJoints> parent_{};
  Eigen::VectorXf rest_joint_, local_;         ///< 72, 3·(landmark, bone)
  Eigen::MatrixXf joint_shape_, local_shape_;  ///< their change by shape
  std::array<std::vector<Bone>, kLifterPoints> bones_;
  std::array<int, kLifterPoints> main_bone_{};
  float mean_length_ = 1, toe_radius_ = 0, heel_radius_ = 0;
};

}  // namespace bodyloom
