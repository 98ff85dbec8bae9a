// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/track_angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/base/units.h"
#include "geometry/biomechanics/gait.h"
#include "geometry/biomechanics/landmark_angles.h"
#include "geometry/scene/observations.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::track_angles_test {
namespace {

using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Five frames of random poses, the third lost.
Track TrackOfPoses() {
  Track track;
  track.motion.poses.resize(5, 72);
  track.motion.trans = MatrixX3d::Zero(5, 3);
  track.motion.trans.col(2).setConstant(4);
  for (int t = 0; t < 5; ++t) {
    track.motion.poses.row(t) = RandomAxisAngle(ToyBody(), 3 + t, 0.4).transpose();
    track.motion.timestamps.push_back(0.1 * t);
  }
  track.motion.poses.row(2).setConstant(kNaN);
  track.motion.up = Motion::Up::kCamera;
  track.frame_status.assign(5, FrameStatus::kTracked);
  track.joint_sigma = RowMatrixXd::Constant(5, 24, 0.02);
  track.joint_sigma(4, ToyBody().FindJoint("l_knee")) = kNaN;
  return track;
}

TEST(TrackAngles, LostFramesAreNotANumberAndTheOthersAreTheLaws) {
  const Track track = TrackOfPoses();
  const WorldFrame world = WorldOverGround({0.1, -1, -0.2}, 1.2);
  const TrackAngles angles = AnglesOfTrack(ToyBody(), track, world);
  EXPECT_EQ(angles.timestamps, track.motion.timestamps);
  ASSERT_EQ(angles.values.rows(), 5);
  EXPECT_TRUE(angles.values.row(2).array().isNaN().all());
  EXPECT_TRUE(angles.sigma_deg.row(2).array().isNaN().all());
  const MatrixX3d rest = ToyBody().RestJoints({});
  JointAngleReader reader(ToyBody(), {});
  for (const int t : {0, 1, 3, 4}) {
    if (t == 3) reader.Restart();
    const CoordinateRow expected = reader.Next(SkeletonInWorld(ToyBody(), rest, track.motion, t, world));
    EXPECT_EQ(Eigen::RowVectorXd(angles.values.row(t)), Eigen::RowVectorXd(expected)) << t;
  }
  const PosedSkeleton skeleton = SkeletonInWorld(ToyBody(), rest, track.motion, 0, world);
  const BodyPose pose = PoseFromAxisAngle(ToyBody(), track.motion.poses.row(0).transpose(), Vector3d(0, 0, 4));
  const PosedSkeleton in_camera = PoseSkeleton(ToyBody(), rest, pose);
  EXPECT_TRUE(Vector3d(skeleton.joints.row(7).transpose())
                  .isApprox(world.PointFromCamera(in_camera.joints.row(7).transpose()), 1e-12));
  EXPECT_TRUE(skeleton.world_rotations[7].isApprox(world.rotation * in_camera.world_rotations[7], 1e-12));
}

/// Standard deviation of `angle` of points whose coordinates err independently: by central differences.
template <typename Angle>
double SigmaByDifferences(MatrixX3d points, const Eigen::VectorXd& sigma, const Angle& angle) {
  constexpr double kStep = 1e-6;
  double variance = 0;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    for (int c = 0; c < 3; ++c) {
      const double at = points(k, c);
      points(k, c) = at + kStep;
      const double above = angle(points);
      points(k, c) = at - kStep;
      const double slope = (above - angle(points)) / (2 * kStep);
      points(k, c) = at;
      variance += std::pow(slope * sigma[k], 2);
    }
  }
  return std::sqrt(variance);
}

TEST(TrackAngles, SigmasAreThoseOfThePositionsToFirstOrder) {
  Track track = TrackOfPoses();
  for (int j = 0; j < 24; ++j) track.joint_sigma.col(j).array() *= 1 + 0.05 * j;
  const WorldFrame world;
  const TrackAngles angles = AnglesOfTrack(ToyBody(), track, world);
  const MatrixX3d joints = SkeletonInWorld(ToyBody(), ToyBody().RestJoints({}), track.motion, 1, world).joints;
  const Eigen::VectorXd sigma = track.joint_sigma.row(1).transpose();
  const auto joint = [](const char* name) { return ToyBody().FindJoint(name); };
  const auto flexion = [&](const char* near, const char* middle, const char* far) {
    return SigmaByDifferences(joints, sigma, [&](const MatrixX3d& p) {
      return FlexionDeg(p.row(joint(near)), p.row(joint(middle)), p.row(joint(far)));
    });
  };
  EXPECT_NEAR(angles.sigma_deg(1, FindCoordinate("knee_angle_l")), flexion("l_hip", "l_knee", "l_ankle"), 1e-4);
  EXPECT_NEAR(angles.sigma_deg(1, FindCoordinate("elbow_flex_r")), flexion("r_shoulder", "r_elbow", "r_wrist"), 1e-4);
  // Of a thigh against a plane that contains the trunk's axis, whose own error is another's.
  const auto length = [&](const char* a, const char* b) {
    return (joints.row(joint(a)) - joints.row(joint(b))).norm();
  };
  const double thigh = std::hypot(sigma[joint("r_hip")], sigma[joint("r_knee")]) / length("r_hip", "r_knee");
  const Vector3d mid_hip = 0.5 * (joints.row(joint("l_hip")) + joints.row(joint("r_hip"))).transpose();
  const double trunk = sigma[joint("spine3")] / (joints.row(joint("spine3")).transpose() - mid_hip).norm();
  const double swing = std::hypot(thigh, trunk) / kDegree;
  EXPECT_NEAR(angles.sigma_deg(1, FindCoordinate("hip_adduction_r")), swing, 1e-9);
  EXPECT_NEAR(angles.sigma_deg(1, FindCoordinate("hip_flexion_r")),
              swing / std::cos(angles.values(1, FindCoordinate("hip_adduction_r")) * kDegree), 1e-9);
  for (const char* none : {"pelvis_tilt", "hip_rotation_r", "ankle_angle_l", "lumbar_bending", "pro_sup_l"}) {
    EXPECT_TRUE(std::isnan(angles.sigma_deg(1, FindCoordinate(none)))) << none;
  }
  EXPECT_TRUE(std::isnan(angles.sigma_deg(4, FindCoordinate("knee_angle_l")))) << "the knee's sigma is unknown";
  EXPECT_FALSE(std::isnan(angles.sigma_deg(4, FindCoordinate("knee_angle_r"))));
  track.joint_sigma.resize(0, 0);
  EXPECT_TRUE(AnglesOfTrack(ToyBody(), track, world).sigma_deg.array().isNaN().all());
}

TEST(TrackAngles, ATrackOfAnotherBodyIsRefused) {
  Track track = TrackOfPoses();
  track.motion.poses.conservativeResize(5, 75);
  EXPECT_THROW(AnglesOfTrack(ToyBody(), track, WorldFrame()), std::invalid_argument);
  EXPECT_THROW(AnalyseGait(ToyBody(), track, WorldFrame()), std::invalid_argument);
}

/// COCO's landmarks of the toy body are its joints, so that both kinds of angles are of the same positions.
TEST(LandmarkAngles, AreTheBodysWhereTheTrunkIsStraight) {
  for (uint32_t seed = 0; seed < 10; ++seed) {
    BodyPose pose = RandomPose(ToyBody(), seed, 0.6, 4);
    for (const char* spine : {"spine1", "spine2", "spine3", "l_collar", "r_collar"}) {
      pose.rotations[size_t(ToyBody().FindJoint(spine))].setIdentity();
    }
    const CoordinateRow body =
        JointAngleReader(ToyBody(), {}).Next(PoseSkeleton(ToyBody(), ToyBody().RestJoints({}), pose));
    const LandmarkAngleRow row = LandmarkAngles(PoseLandmarks(ToyBody(), {}, pose, CocoNames()));
    for (int a = 0; a < kNumLandmarkAngles; ++a) {
      const std::string& name = LandmarkAngleNames()[size_t(a)];
      if (name.starts_with("arm_flex") || name.starts_with("knee") || name.starts_with("elbow")) continue;
      // The line of hips to shoulders leans by up to 2° against the body's axis at rest.
      EXPECT_NEAR(row[a], body[FindCoordinate(name)], 4) << name << " " << seed;
    }
  }
}

TEST(LandmarkAngles, OfAPuppetAreThoseItWasMadeWith) {
  MatrixX3d p = MatrixX3d::Zero(17, 3);  // x left, y up, z front
  const auto set = [&](int k, double x, double y, double z) { p.row(k) << x, y, z; };
  set(5, 0.2, 1.4, 0), set(6, -0.2, 1.4, 0), set(11, 0.1, 0.9, 0), set(12, -0.1, 0.9, 0);
  const double a = 40 * kDegree, b = 65 * kDegree;
  set(13, 0.1, 0.9 - 0.4 * std::cos(a), 0.4 * std::sin(a));  // left thigh 40° forwards, shank straight down
  set(15, 0.1, 0.5 - 0.4 * std::cos(a), 0.4 * std::sin(a));
  set(14, -0.1 - 0.4 * std::sin(a), 0.9 - 0.4 * std::cos(a), 0);  // right leg 40° to the side, straight
  set(16, -0.1 - 0.8 * std::sin(a), 0.9 - 0.8 * std::cos(a), 0);
  set(7, 0.2, 1.1, 0), set(9, 0.2, 1.1, 0.3);                    // left arm down, elbow at right angles
  set(8, -0.2 - 0.3 * std::sin(b), 1.4 - 0.3 * std::cos(b), 0);  // right arm 65° to the side
  set(10, -0.2 - 0.6 * std::sin(b), 1.4 - 0.6 * std::cos(b), 0);
  const LandmarkAngleRow row = LandmarkAngles(p);
  const std::vector<double> expected = {0, -40, 0, 40, 0, 40, 0, kNaN, -65, 0, 0, 0, 90};
  for (size_t k = 0; k < expected.size(); ++k) {
    if (std::isnan(expected[k])) {
      EXPECT_TRUE(std::isnan(row[Eigen::Index(k)])) << LandmarkAngleNames()[k];
    } else {
      EXPECT_NEAR(row[Eigen::Index(k)], expected[k], 1e-5) << LandmarkAngleNames()[k];
    }
  }
  const double turn = 25 * kDegree;  // shoulders to the left
  p.row(5) << 0.2 * std::cos(turn), 1.4, -0.2 * std::sin(turn);
  p.row(6) << -0.2 * std::cos(turn), 1.4, 0.2 * std::sin(turn);
  EXPECT_NEAR(LandmarkAngles(p)[6], 25, 1e-9);
  p(15, 0) = kNaN;
  EXPECT_TRUE(std::isnan(LandmarkAngles(p)[5]));
  EXPECT_FALSE(std::isnan(LandmarkAngles(p)[2]));
  EXPECT_THROW(LandmarkAngles(p.topRows(16)), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::track_angles_test
