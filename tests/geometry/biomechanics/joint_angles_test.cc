// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/joint_angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include "geometry/base/hash_random.h"
#include "geometry/base/units.h"
#include "geometry/biomechanics/landmark_angles.h"
#include "geometry/math/rotation.h"
#include "tests/support/toy_body.h"

namespace bodyloom::joint_angles_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d About(int axis, double degrees) { return RotationFromAxisAngle(degrees * kDegree * Vector3d::Unit(axis)); }
Matrix3d Zxy(double a, double b, double c) { return About(2, a) * About(0, b) * About(1, c); }

MatrixX3d Rest() { return ToyBody().RestJoints(Eigen::VectorXd()); }

Vector3d RestJoint(const std::string& name) { return Rest().row(ToyBody().FindJoint(name)).transpose(); }

/// Columns x, y, z of a limb's anatomical frame at rest, from the joint `near` to the joint `far`.
Matrix3d LimbFrame(const std::string& near, const std::string& far) {
  const Vector3d y = (RestJoint(near) - RestJoint(far)).normalized();
  const Vector3d z = Vector3d::UnitZ().cross(y).normalized();
  Matrix3d frame;
  frame << y.cross(z), y, z;
  return frame;
}

Matrix3d TrunkFrameAtRest() {
  Matrix3d frame;
  frame << Vector3d::UnitZ(), Vector3d::UnitY(), -Vector3d::UnitX();
  return frame;
}

Matrix3d FootFrame(const std::string& side) {
  const Vector3d toe = RestJoint(side + "_foot") - RestJoint(side + "_ankle");
  const Vector3d x = Vector3d(toe.x(), 0, toe.z()).normalized();
  Matrix3d frame;
  frame << x, Vector3d::UnitY(), x.cross(Vector3d::UnitY());
  return frame;
}

BodyPose RestPose() { return {std::vector<Matrix3d>(24, Matrix3d::Identity()), Vector3d(0.1, 1, -2)}; }

using Coordinates = std::map<std::string, double>;

/// The pose that has these coordinates, and 0 (pro_sup: 90) for the others: an inverse of the angles, written
/// independently.
BodyPose PoseWith(const Coordinates& coordinates) {
  BodyPose pose = RestPose();
  const auto value = [&](const std::string& name) {
    const auto found = coordinates.find(name);
    return found != coordinates.end() ? found->second : name.starts_with("pro_sup") ? 90.0 : 0.0;
  };
  const auto set = [&](const std::string& joint, const Matrix3d& parent, const Matrix3d& between, const Matrix3d& own) {
    pose.rotations[size_t(ToyBody().FindJoint(joint))] = parent * between * own.transpose();
  };
  const Matrix3d trunk = TrunkFrameAtRest();
  pose.rotations[0] = trunk * About(1, value("pelvis_rotation")) * About(0, value("pelvis_list")) *
                      About(2, value("pelvis_tilt")) * trunk.transpose();
  set("spine3", trunk, Zxy(value("lumbar_extension"), value("lumbar_bending"), value("lumbar_rotation")), trunk);
  for (const std::string side : {"r", "l"}) {
    const double sign = side == "r" ? 1 : -1;
    const std::string end = "_" + side, j = side + "_";
    const Matrix3d thigh = LimbFrame(j + "hip", j + "knee"), shank = LimbFrame(j + "knee", j + "ankle"),
                   arm = LimbFrame(j + "shoulder", j + "elbow"), forearm = LimbFrame(j + "elbow", j + "wrist");
    set(j + "hip", trunk,
        Zxy(value("hip_flexion" + end), sign * value("hip_adduction" + end), sign * value("hip_rotation" + end)),
        thigh);
    set(j + "knee", thigh, Zxy(-value("knee_angle" + end), 0, 0), shank);
    set(j + "ankle", shank, Zxy(value("ankle_angle" + end), sign * value("subtalar_angle" + end), 0), FootFrame(side));
    set(j + "shoulder", trunk,
        Zxy(value("arm_flex" + end), sign * value("arm_add" + end), sign * value("arm_rot" + end)), arm);
    set(j + "elbow", arm, Zxy(value("elbow_flex" + end), 0, sign * (value("pro_sup" + end) - 90)), forearm);
  }
  return pose;
}

PosedSkeleton SkeletonOf(const BodyPose& pose, const Matrix3d& world_from_frame = Matrix3d::Identity()) {
  PosedSkeleton skeleton = PoseSkeleton(ToyBody(), Rest(), pose);
  for (Matrix3d& rotation : skeleton.world_rotations) rotation = world_from_frame * rotation;
  skeleton.joints = (skeleton.joints * world_from_frame.transpose()).eval();
  return skeleton;
}

/// The body that faces the world's x axis, which is the zero of pelvis_rotation.
Matrix3d FacingX() { return TrunkFrameAtRest().transpose(); }

CoordinateRow CoordinatesOf(const BodyPose& pose, PelvisOrder order = PelvisOrder::kRotationFirst) {
  return JointAngleReader(ToyBody(), {}, order).Next(SkeletonOf(pose, FacingX()));
}

Vector3d JointOf(const BodyPose& pose, const std::string& name) {
  return SkeletonOf(pose).joints.row(ToyBody().FindJoint(name)).transpose();
}

void ExpectCoordinates(const Coordinates& expected, const CoordinateRow& row) {
  for (int c = 0; c < kNumCoordinates; ++c) {
    if (!IsAngle(c)) continue;
    const std::string& name = CoordinateNames()[size_t(c)];
    const auto found = expected.find(name);
    const double value = found != expected.end() ? found->second : name.starts_with("pro_sup") ? 90.0 : 0.0;
    EXPECT_NEAR(row[c], value, 1e-9) << name;
  }
}

TEST(JointAngles, EachCoordinateIsTheOnlyOneThatItsRotationChanges) {
  ExpectCoordinates({}, CoordinatesOf(PoseWith({})));
  for (int c = 0; c < kNumCoordinates; ++c) {
    if (!IsAngle(c)) continue;
    for (const double degrees : {35.0, -20.0}) {
      const Coordinates one = {{CoordinateNames()[size_t(c)], degrees}};
      SCOPED_TRACE(one.begin()->first);
      ExpectCoordinates(one, CoordinatesOf(PoseWith(one)));
    }
  }
}

TEST(JointAngles, CompositionsComeBack) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    HashRandom random(seed, {7});
    Coordinates all;
    for (int c = 0; c < kNumCoordinates; ++c) {
      if (IsAngle(c)) all[CoordinateNames()[size_t(c)]] = random.Uniform(-70, 70);
    }
    ExpectCoordinates(all, CoordinatesOf(PoseWith(all)));
  }
}

/// Directions in the body's axes: x left, y up, z front.
TEST(JointAngles, SignsAreOpenSims) {
  const auto moved = [](const Coordinates& by, const std::string& joint, const Coordinates& from = {}) {
    Coordinates both = from;
    both.insert(by.begin(), by.end());
    return Vector3d(JointOf(PoseWith(both), joint) - JointOf(PoseWith(from), joint));
  };
  EXPECT_GT(moved({{"hip_flexion_r", 20}}, "r_knee").z(), 0.05);
  EXPECT_GT(moved({{"hip_flexion_l", 20}}, "l_knee").z(), 0.05);
  EXPECT_GT(moved({{"hip_adduction_r", 20}}, "r_knee").x(), 0.05) << "towards the middle";
  EXPECT_LT(moved({{"hip_adduction_l", 20}}, "l_knee").x(), -0.05);
  EXPECT_LT(moved({{"knee_angle_r", 40}}, "r_ankle").z(), -0.05) << "the heel goes back";
  EXPECT_LT(moved({{"hip_rotation_r", 20}}, "r_ankle", {{"knee_angle_r", 90}}).x(), -0.05) << "inwards: foot outwards";
  EXPECT_GT(moved({{"hip_rotation_l", 20}}, "l_ankle", {{"knee_angle_l", 90}}).x(), 0.05);
  EXPECT_GT(moved({{"ankle_angle_l", 20}}, "l_foot").y(), 0.02) << "dorsiflexion lifts the ball of the foot";
  EXPECT_LT(moved({{"lumbar_extension", 20}}, "neck").z(), -0.01);
  EXPECT_LT(moved({{"lumbar_bending", 20}}, "neck").x(), -0.01) << "to the right";
  EXPECT_GT(moved({{"lumbar_rotation", 20}}, "r_shoulder").z(), 0.02) << "to the left";
  EXPECT_LT(moved({{"pelvis_tilt", 20}}, "neck").z(), -0.05) << "backwards";
  EXPECT_LT(moved({{"pelvis_list", 20}}, "r_hip").y() - moved({{"pelvis_list", 20}}, "l_hip").y(), -0.02);
  EXPECT_GT(moved({{"pelvis_rotation", 20}}, "r_hip").z() - moved({{"pelvis_rotation", 20}}, "l_hip").z(), 0.02);
  for (const std::string side : {"r", "l"}) {
    const double out = side == "r" ? -1 : 1;
    EXPECT_GT(moved({{"arm_flex_" + side, 20}}, side + "_elbow").z(), 0.05);
    EXPECT_GT(out * moved({{"arm_add_" + side, -20}}, side + "_elbow").x(), 0.05) << "abduction is below 0";
    EXPECT_GT(moved({{"elbow_flex_" + side, 40}}, side + "_wrist").z(), 0.05);
    EXPECT_LT(out * moved({{"arm_rot_" + side, 30}}, side + "_wrist", {{"elbow_flex_" + side, 90}}).x(), -0.05)
        << "inwards";
  }
}

TEST(JointAngles, TheRestPoseHasItsArmsUpAndItsPalmsDown) {
  const CoordinateRow row = CoordinatesOf(RestPose());
  for (const std::string side : {"r", "l"}) {
    EXPECT_NEAR(row[FindCoordinate("arm_add_" + side)], -90, 1e-6);
    EXPECT_NEAR(row[FindCoordinate("pro_sup_" + side)], 90, 1e-6);
    const double legs = std::atan2(std::abs(RestJoint("l_knee").x() - RestJoint("l_hip").x()),
                                   RestJoint("l_hip").y() - RestJoint("l_knee").y());
    EXPECT_NEAR(row[FindCoordinate("hip_adduction_" + side)], -legs / kDegree, 0.05) << "legs stand apart";
  }
  BodyPose palms_forward = RestPose();
  palms_forward.rotations[size_t(ToyBody().FindJoint("l_elbow"))] = About(0, -45);
  palms_forward.rotations[size_t(ToyBody().FindJoint("l_wrist"))] = About(0, -45);
  palms_forward.rotations[size_t(ToyBody().FindJoint("r_wrist"))] = About(0, -90);
  const CoordinateRow forward = CoordinatesOf(palms_forward);
  EXPECT_NEAR(forward[FindCoordinate("pro_sup_l")], 0, 1e-6) << "the elbow and the wrist share the twist";
  EXPECT_NEAR(forward[FindCoordinate("pro_sup_r")], 0, 1e-6);
}

TEST(JointAngles, KneesAndElbowsAreTheAnglesOfTheirPositions) {
  const BodyPose pose =
      PoseWith({{"knee_angle_r", 63}, {"knee_angle_l", 5}, {"elbow_flex_l", 110}, {"hip_flexion_r", 30}});
  const auto flexion = [&](const char* near, const char* joint, const char* far) {
    return FlexionDeg(JointOf(pose, near), JointOf(pose, joint), JointOf(pose, far));
  };
  EXPECT_NEAR(flexion("r_hip", "r_knee", "r_ankle"), 63, 1e-9);
  EXPECT_NEAR(flexion("l_hip", "l_knee", "l_ankle"), 5, 1e-9);
  EXPECT_NEAR(flexion("l_shoulder", "l_elbow", "l_wrist"), 110, 1e-9);
  EXPECT_NEAR(flexion("r_shoulder", "r_elbow", "r_wrist"), 0, 1e-5);
}

BodyPose RandomPose(uint64_t seed) {
  HashRandom random(seed, {3});
  BodyPose pose = RestPose();
  for (Matrix3d& rotation : pose.rotations) {
    Vector3d by;
    for (int k = 0; k < 3; ++k) by[k] = random.Uniform(-0.5, 0.5);
    rotation = RotationFromAxisAngle(by);
  }
  return pose;
}

TEST(JointAngles, TurningAboutTheVerticalChangesPelvisRotationAlone) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const BodyPose pose = RandomPose(seed);
    const Matrix3d turn = About(1, 70);
    const CoordinateRow one = JointAngleReader(ToyBody(), {}).Next(SkeletonOf(pose, FacingX()));
    const CoordinateRow other = JointAngleReader(ToyBody(), {}).Next(SkeletonOf(pose, turn * FacingX()));
    for (int c = 0; c < kNumCoordinates; ++c) {
      if (!IsAngle(c)) continue;
      const double expected = CoordinateNames()[size_t(c)] == "pelvis_rotation" ? 70 : 0;
      EXPECT_NEAR(other[c] - one[c], expected, 1e-9) << CoordinateNames()[size_t(c)];
    }
    EXPECT_TRUE(Vector3d(other.segment<3>(3).transpose()).isApprox(turn * one.segment<3>(3).transpose(), 1e-12));
  }
}

TEST(JointAngles, TheMirroredPoseSwapsTheSides) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const BodyPose pose = RandomPose(seed);
    const Matrix3d mirror = Vector3d(-1, 1, 1).asDiagonal();
    BodyPose mirrored = pose;
    for (int j = 0; j < 24; ++j) {
      std::string name = SmplJointNames()[size_t(j)];
      if (name.starts_with("l_") || name.starts_with("r_")) name[0] = name[0] == 'l' ? 'r' : 'l';
      mirrored.rotations[size_t(ToyBody().FindJoint(name))] = mirror * pose.rotations[size_t(j)] * mirror;
    }
    const CoordinateRow one = CoordinatesOf(pose), other = CoordinatesOf(mirrored);
    for (int c = 0; c < kNumCoordinates; ++c) {
      if (!IsAngle(c)) continue;
      std::string name = CoordinateNames()[size_t(c)];
      double sign = 1;
      if (name.ends_with("_r") || name.ends_with("_l")) {
        name.back() = name.back() == 'r' ? 'l' : 'r';
      } else if (name != "pelvis_tilt" && name != "lumbar_extension") {
        sign = -1;
      }
      EXPECT_NEAR(other[FindCoordinate(name)], sign * one[c], 1e-9) << name;
    }
  }
}

TEST(JointAngles, TheTiltFirstOrderIsThatOfOpenSimsModels) {
  const BodyPose pose = PoseWith({{"pelvis_rotation", 80}, {"pelvis_list", 5}, {"pelvis_tilt", -15}});
  const CoordinateRow row = CoordinatesOf(pose, PelvisOrder::kTiltFirst);
  const Matrix3d pelvis = FacingX() * pose.rotations[0] * TrunkFrameAtRest();
  EXPECT_TRUE(Zxy(row[0], row[1], row[2]).isApprox(pelvis, 1e-12));
  EXPECT_LT(std::abs(row[0]), 10) << "a lean to the side of the world's z axis is no tilt about it";
}

TEST(JointAngles, ThePelvisOriginIsAheadOfAndAboveTheHips) {
  const BodyPose pose = PoseWith({});
  const CoordinateRow row = CoordinatesOf(pose);
  const Vector3d hips = FacingX() * 0.5 * (JointOf(pose, "l_hip") + JointOf(pose, "r_hip"));
  const double scale = (RestJoint("l_hip") - RestJoint("r_hip")).norm() / 0.15452;
  EXPECT_TRUE(Vector3d(row.segment<3>(3).transpose() - hips).isApprox(scale * Vector3d(0.056276, 0.07849, 0), 1e-9));
}

TEST(JointAngles, AnArmThatIsLiftedSidewaysGoesOnBeyondTheHorizontal) {
  JointAngleReader reader(ToyBody(), {});
  const int add = FindCoordinate("arm_add_r"), flex = FindCoordinate("arm_flex_r");
  for (int degrees = 0; degrees >= -170; degrees -= 5) {
    const CoordinateRow row = reader.Next(SkeletonOf(PoseWith({{"arm_flex_r", 3}, {"arm_add_r", degrees}}), FacingX()));
    EXPECT_NEAR(row[add], degrees, 1e-6);
    EXPECT_NEAR(row[flex], 3, 1e-4) << degrees;
  }
  reader.Restart();
  const CoordinateRow alone = reader.Next(SkeletonOf(PoseWith({{"arm_flex_r", 3}, {"arm_add_r", -170}}), FacingX()));
  EXPECT_NEAR(alone[add], -10, 1e-6) << "the other triple of the same rotation, and nothing before it";
}

TEST(JointAngles, ThePelvisTurnsOn) {
  JointAngleReader reader(ToyBody(), {});
  for (int degrees = 0; degrees <= 900; degrees += 30) {
    const CoordinateRow row = reader.Next(SkeletonOf(PoseWith({}), About(1, degrees) * FacingX()));
    EXPECT_NEAR(row[FindCoordinate("pelvis_rotation")], degrees, 1e-6);
  }
}

TEST(JointAngles, ABodyWithoutTheJointsIsRefused) {
  BodyModelData data = ToyBodyData();
  data.joint_names[9] = "chest";
  const BodyModel other(std::move(data));
  EXPECT_FALSE(HasJointAngles(other));
  EXPECT_TRUE(HasJointAngles(ToyBody()));
  EXPECT_THROW(JointAngleReader(other, {}), std::invalid_argument);
}

TEST(CardanAngles, GiveTheRotationBackNearTheGimbal) {
  for (const double b : {90.0, -90.0, 90 - 1e-7, -90 + 1e-10, 89.9, -89.0}) {
    for (const double a : {0.0, 130.0, -45.0}) {
      for (const Matrix3d& R : {Zxy(a, b, 25), Matrix3d(About(1, a) * About(0, b) * About(2, 25))}) {
        const Vector3d before(0.3, 0.2, -0.4);
        for (const Vector3d* history : {static_cast<const Vector3d*>(nullptr), &before}) {
          const Vector3d zxy = CardanZxy(R, history) / kDegree, yxz = CardanYxz(R, history) / kDegree;
          EXPECT_TRUE(Zxy(zxy.x(), zxy.y(), zxy.z()).isApprox(R, 1e-8)) << a << " " << b;
          EXPECT_TRUE((About(1, yxz.x()) * About(0, yxz.y()) * About(2, yxz.z())).isApprox(R, 1e-8)) << a << " " << b;
        }
      }
    }
  }
  const Vector3d before(0.7, 1.5, 0.1);
  EXPECT_EQ(CardanZxy(Zxy(50, 90, 10), &before).x(), 0.7) << "where it is free, the first angle stays";
}

TEST(CardanAngles, AJointDoesNotWindUp) {
  // Up sideways, down in front: the same posture again, and the same angles.
  Vector3d angles = CardanZxy(Zxy(0, 0, 0));
  for (int degrees = 0; degrees >= -180; degrees -= 5) angles = CardanZxy(Zxy(0, degrees, 0), &angles);
  for (int degrees = 180; degrees >= 0; degrees -= 5) angles = CardanZxy(Zxy(degrees, 0, 180), &angles);
  const Vector3d turned = CardanZxy(Zxy(0, 0, 60), &angles);
  EXPECT_NEAR(turned.x(), 0, 1e-9);
  EXPECT_NEAR(turned.z() / kDegree, 60, 1e-9);
}

}  // namespace
}  // namespace bodyloom::joint_angles_test
