// SPDX-License-Identifier: Apache-2.0
/// Clinical joint angles of a posed body, under the names and with the signs of OpenSim's full-body gait models.
///
/// Each segment has an anatomical frame: x forward, y up along the segment, z to the person's right. In the rest pose
/// (the T-pose; body axes x left, y up, z front) its axes are
///   pelvis, trunk   the body's
///   thigh           y from knee to hip            shank     y from ankle to knee
///   upper arm       y from elbow to shoulder      forearm   y from wrist to elbow
///   foot            y up; x from ankle to ball of the foot, made horizontal
/// where, but for the foot, x is the body's forward axis made perpendicular to y, and z = x × y. So the zero of all
/// angles is not the T-pose: it is the posture in which thighs, shanks and upper arms hang straight down along the
/// trunk, knees and elbows are straight, soles are flat. From it the T-pose differs by arms lifted sideways in the
/// trunk's plane (arm_add about −90°) and by what the body's own rest joints say: its legs stand some degrees apart and
/// its knees are not quite in line.
///
/// With S the segments' orientations (world from segment) and R = S_parentᵀ S_child = Rz(a) Rx(b) Ry(c):
///   hip_flexion = a, hip_adduction = ±b, hip_rotation = ±c      thigh in pelvis
///   knee_angle = −a                                             shank in thigh; flexion is above 0
///   ankle_angle = a, subtalar_angle = ±b                        foot in shank; dorsiflexion, inversion
///   lumbar_extension = a, lumbar_bending = b, lumbar_rotation = c   trunk (the chest, spine3) in pelvis
///   arm_flex = a, arm_add = ±b, arm_rot = ±c                    upper arm in trunk, the shoulder girdle included
///   elbow_flex = a, pro_sup = 90° ± (c + d)                     forearm in upper arm
/// with + for the right side and − for the left. d is the twist of the hand about the forearm's y, of the first factor
/// in Ry(d) Rx Rz, because a forearm carries the hand in pronation; 90° is the T-pose's, palms down, which with hanging
/// arms is thumbs forward, and 0 palms forward. Second and third angle of the knee are left out: a video hardly
/// determines them, and OpenSim's models make them functions of its flexion. The subtalar joint has the foot's x axis,
/// not the oblique one of OpenSim's models. Bending to the right and rotation to the left are above 0.
///
/// The pelvis in the world (y up; zero when it faces the world's x axis, z to its right):
///   PelvisOrder::kRotationFirst   S = Ry(pelvis_rotation) Rx(pelvis_list) Rz(pelvis_tilt)
///   PelvisOrder::kTiltFirst       S = Rz(pelvis_tilt) Rx(pelvis_list) Ry(pelvis_rotation)
/// A tilt above 0 leans backwards, a list above 0 drops the right side. pelvis_tx, _ty, _tz is the origin that
/// OpenSim's models have between the front spines of the hips: (0.0563, 0.0785, 0) m from the middle of the hip joints
/// in the pelvis' axes, scaled by the distance of the hip joints / 0.1545 m.
///
/// Sources: Wu et al., J. Biomechanics 35 (2002) and 38 (2005) (ISB: frames, order of the angles); Baker, J.
/// Biomechanics 34 (2001) (the pelvis' order); Rajagopal et al., IEEE TBME 63 (2016) and the model LaiUhlrich2022
/// (names, axes, signs, the pelvis' origin).
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"

namespace bodyloom {

inline constexpr int kNumCoordinates = 31;
using CoordinateRow = Eigen::Matrix<double, 1, kNumCoordinates>;

/// "pelvis_tilt", …, in the order that OpenSim's inverse kinematics writes: pelvis, right leg, left leg, lumbar, right
/// arm, left arm.
const std::vector<std::string>& CoordinateNames();
/// Index of a name, −1 when absent.
int FindCoordinate(const std::string& name);
/// False for pelvis_tx, _ty, _tz, which are lengths.
bool IsAngle(int coordinate);

/// Order of the pelvis' three angles.
enum class PelvisOrder {
  kRotationFirst,  ///< a turn about the vertical changes pelvis_rotation alone, whichever way the person faces
  kTiltFirst,      ///< that of OpenSim's models; tilt and list are about the world's axes z and x
};

/// Index of a joint of the body. Throws std::invalid_argument "what: the body … has no joint …".
int RequireJoint(const BodyModel& body, const std::string& name, const char* what);

/// True if the body has the joints, by SMPL's names, that the angles need.
bool HasJointAngles(const BodyModel& body);

/// Coordinates of one frame after the other.
class JointAngleReader {
 public:
  /// Throws std::invalid_argument naming a joint that the body lacks.
  JointAngleReader(const BodyModel& body, const Eigen::VectorXd& betas,
                   PelvisOrder order = PelvisOrder::kRotationFirst);

  /// Of a skeleton of that body and shape in a world with y up: degrees, and metres for pelvis_t*. Angles continue
  /// those of the call before (CardanZxy()).
  CoordinateRow Next(const PosedSkeleton& skeleton_in_world);
  /// Forgets the frames before.
  void Restart() { before_.reset(); }

  /// Pelvis, trunk, and thighs, shanks, feet, upper arms, forearms, the right one of each first.
  static constexpr int kNumSegments = 12;

 private:
  enum Rotation {
    kPelvis,
    kLumbar,
    kHips,
    kKnees = 4,
    kAnkles = 6,
    kArms = 8,
    kElbows = 10,
    kWrists = 12,
    kCount = 14
  };

  /// Orientation of segment s: world from segment.
  [[nodiscard]] Eigen::Matrix3d Orientation(const PosedSkeleton& skeleton, int segment) const {
    return skeleton.world_rotations[size_t(joint_[size_t(segment)])] * rest_frame_[size_t(segment)];
  }

  PelvisOrder order_;
  std::array<int, kNumSegments> joint_{};                 ///< that turns the segment
  std::array<Eigen::Matrix3d, kNumSegments> rest_frame_;  ///< columns x, y, z in the body's axes at rest
  std::array<int, 2> wrist_{}, hip_{};                    ///< right, left
  Eigen::Vector3d origin_from_mid_hip_;                   ///< metres, in the pelvis' axes
  std::optional<std::array<Eigen::Vector3d, kCount>> before_;
};

// Cardan angles of rotations, continuous over time.

/// Choice between the two triples (a, b, c) and (a + π, π − b, c + π) of one rotation.
enum class CardanBranch {
  /// |b| ≤ π/2 always; a and c follow the frame before by whole turns without limit. For a body that turns in a room.
  kTurning,
  /// A joint, which cannot wind up: the triple with |b| ≤ π/2, each angle in (−π, π], if none is above 75°; otherwise
  /// the triple nearest to the frame before, so that an arm that is lifted sideways beyond the horizontal goes on
  /// from −90° of adduction.
  kJoint,
};

/// Angles (a, b, c), radians, with R = Rz(a) Rx(b) Ry(c), each about the axes that the ones before it have turned.
/// `before`: the angles of the frame before; null: there is none, and the triple with |b| ≤ π/2 is taken. At
/// |b| = π/2, where a ± c alone is determined, a is that of the frame before (0 without one). Near there small errors
/// of R become large ones of a and c, but the three angles always give R. R must be a rotation.
Eigen::Vector3d CardanZxy(const Eigen::Matrix3d& R, const Eigen::Vector3d* before = nullptr,
                          CardanBranch branch = CardanBranch::kJoint);

/// The same with R = Ry(a) Rx(b) Rz(c).
Eigen::Vector3d CardanYxz(const Eigen::Matrix3d& R, const Eigen::Vector3d* before = nullptr,
                          CardanBranch branch = CardanBranch::kJoint);

}  // namespace bodyloom
