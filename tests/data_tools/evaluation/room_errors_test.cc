// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/room_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/math/rotation.h"

namespace bodyloom::room_errors_test {
namespace {

using Eigen::Vector3d;
constexpr int kFrames = 200;
constexpr double kDegree = std::numbers::pi / 180;

/// COCO's landmarks of a puppet whose mid-hip is at (x, hip_m, z): legs of 0.4 and 0.4 m with both knees bent forwards
/// by `flexion`, ankles under the hips.
MatrixX3d Puppet(double x, double z, double flexion = 0, double lean = 0) {
  MatrixX3d p(17, 3);
  const double half = flexion / 2, hip = 0.08 + 0.8 * std::cos(half);
  const auto up_trunk = [&](double along, double side) {
    return Vector3d(x + side, hip + along * std::cos(lean), z + along * std::sin(lean));
  };
  for (int k = 0; k < 5; ++k) p.row(k) = up_trunk(0.65 + 0.02 * k, 0.03 * (k - 2)).transpose();
  for (const int s : {0, 1}) {
    const double side = s == 0 ? 0.2 : -0.2;
    p.row(5 + s) = up_trunk(0.5, side).transpose();
    p.row(7 + s) = up_trunk(0.2, 1.2 * side).transpose();
    p.row(9 + s) = up_trunk(-0.05, 1.2 * side).transpose();
    p.row(11 + s) = Vector3d(x + side / 2, hip, z).transpose();
    p.row(13 + s) = Vector3d(x + side / 2, 0.08 + 0.4 * std::cos(half), z + 0.4 * std::sin(half)).transpose();
    p.row(15 + s) = Vector3d(x + side / 2, 0.08, z).transpose();
  }
  return p;
}

/// Walks a circle without lifting a foot for the first half, then stands.
std::vector<MatrixX3d> Walk(double flexion = 0, double lean = 0) {
  std::vector<MatrixX3d> frames;
  for (int t = 0; t < kFrames; ++t) {
    const double angle = 0.03 * std::min(t, kFrames / 2);
    frames.push_back(Puppet(2 * std::cos(angle), 2 * std::sin(angle), flexion, lean));
  }
  return frames;
}

std::vector<double> Times() {
  std::vector<double> times;
  for (int t = 0; t < kFrames; ++t) times.push_back(t / 30.0);
  return times;
}

std::vector<MatrixX3d> Moved(const std::vector<MatrixX3d>& frames, const Eigen::Matrix3d& rotation, const Vector3d& by,
                             double scale = 1) {
  std::vector<MatrixX3d> moved;
  for (const MatrixX3d& points : frames) {
    moved.emplace_back((scale * points * rotation.transpose()).rowwise() + by.transpose());
  }
  return moved;
}

TEST(RoomErrors, HeadingPlaceAndSizeAreNoErrors) {
  const auto yaw = RotationFromAxisAngle(Vector3d(0, 1.1, 0));
  const RoomErrors e = MeasureRoomErrors(Moved(Walk(), yaw, Vector3d(3, 0, -2), 1.2), Walk(), Times());
  EXPECT_EQ(e.frames, kFrames);
  for (const double error : {e.g_mpjpe_m, e.w_mpjpe_m, e.wa_mpjpe_m, e.w_mpjpe_100_m, e.wa_mpjpe_100_m, e.rte,
                             e.knee_err_deg, e.knee_bias_deg, e.trunk_lean_bias_deg}) {
    EXPECT_NEAR(error, 0, 1e-5);
  }
  EXPECT_NEAR(e.trunk_err_deg, 0, 1e-4) << "near 0 the angle of two vectors has the root of rounding";
  // Both stand with ankles 8 cm high, the truth's floor is its ankles' own.
  EXPECT_NEAR(e.ankle_height_err_m, 0, 1e-9);
  EXPECT_NEAR(e.foot_slide_mps, 0, 1e-9);
  for (const double ratio : e.bone_ratio) EXPECT_NEAR(ratio, 1, 1e-9);
}

TEST(RoomErrors, ALeanCountsThoughASimilarityHidesIt) {
  const double tilt = 10 * kDegree;
  const RoomErrors e =
      MeasureRoomErrors(Moved(Walk(), RotationFromAxisAngle(Vector3d(tilt, 0, 0)), Vector3d::Zero()), Walk(), Times());
  EXPECT_NEAR(e.trunk_err_deg, 10, 1e-4);
  EXPECT_NEAR(e.trunk_lean_bias_deg, 10, 1e-4) << "the truth stands upright";
  double expected = 0;
  const MatrixX3d from_hip = Puppet(0, 0).rowwise() - Eigen::RowVector3d(0, 0.88, 0);
  // Every point moves on a circle about the x axis through the middle of the hips.
  for (int k = 0; k < 17; ++k) expected += 2 * std::sin(tilt / 2) * from_hip.row(k).tail<2>().norm() / 17;
  EXPECT_NEAR(e.g_mpjpe_m, expected, 1e-3) << "but for the yaw, which gains what it can";
  EXPECT_LT(e.wa_mpjpe_100_m, 1e-6);
  EXPECT_GT(e.wa_mpjpe_m, 0.05);
}

TEST(RoomErrors, HoveringIsTheAnklesHeight) {
  const RoomErrors e =
      MeasureRoomErrors(Moved(Walk(), Eigen::Matrix3d::Identity(), Vector3d(0, 0.05, 0)), Walk(), Times());
  EXPECT_NEAR(e.ankle_height_err_m, 0.05, 1e-9);
  EXPECT_NEAR(e.ankle_height_bias_m, 0.05, 1e-9);
  EXPECT_NEAR(e.wa_mpjpe_m, 0, 1e-6) << "windows are placed";
}

TEST(RoomErrors, KneesBentTooMuch) {
  const RoomErrors e = MeasureRoomErrors(Walk(30 * kDegree), Walk(20 * kDegree), Times());
  EXPECT_NEAR(e.knee_err_deg, 10, 1e-6);
  EXPECT_NEAR(e.knee_bias_deg, 10, 1e-6);
  EXPECT_NEAR(MeasureRoomErrors(Walk(10 * kDegree), Walk(20 * kDegree), Times()).knee_bias_deg, -10, 1e-6);
}

TEST(RoomErrors, ALongShankShowsInTheRatios) {
  std::vector<MatrixX3d> longer = Walk();
  for (MatrixX3d& points : longer) {
    for (const int ankle : {15, 16}) points(ankle, 1) -= 0.04;
  }
  const RoomErrors e = MeasureRoomErrors(longer, Walk(), Times());
  const double total = 2 * (Puppet(0, 0).row(5) - Puppet(0, 0).row(7)).norm() +
                       2 * (Puppet(0, 0).row(7) - Puppet(0, 0).row(9)).norm() + 4 * 0.4;
  const double scale = total / (total + 0.08);
  ASSERT_EQ(e.bones[6], "left shank");
  EXPECT_NEAR(e.bone_ratio[6], 1.1 * scale, 1e-9);
  EXPECT_NEAR(e.bone_ratio[4], scale, 1e-9);
}

TEST(RoomErrors, FeetThatStandAreSeenToSlide) {
  std::vector<MatrixX3d> sliding = Walk();
  for (int t = 0; t < kFrames; ++t) sliding[t].col(2).array() += 0.3 * t / 30.0;
  EXPECT_NEAR(MeasureRoomErrors(sliding, Walk(), Times()).foot_slide_mps, 0.3, 1e-9);
}

TEST(RoomErrors, DriftIsAShareOfThePath) {
  std::vector<MatrixX3d> truth, track;
  for (int t = 0; t < kFrames; ++t) {
    truth.push_back(Puppet(0.01 * t, 0));
    track.push_back(Puppet(0.012 * t, 0));
  }
  // Along a line of length L the track is too long by a fifth: after the rigid motion it is off by |s − L/2| / 5.
  double expected = 0;
  for (int t = 0; t < kFrames; ++t)
    expected += 0.002 * std::abs(t - (kFrames - 1) / 2.0) / kFrames / (0.01 * (kFrames - 1));
  const RoomErrors e = MeasureRoomErrors(track, truth, Times());
  EXPECT_NEAR(e.rte, expected, 1e-9);
  EXPECT_GT(e.w_mpjpe_m, e.wa_mpjpe_m);
}

TEST(RoomErrors, FramesThatNobodyKnowsAreLeftOut) {
  std::vector<MatrixX3d> track = Walk(), truth = Walk();
  track[3].setConstant(std::nan(""));
  truth[7].resize(0, 3);
  EXPECT_EQ(MeasureRoomErrors(track, truth, Times()).frames, kFrames - 2);
  EXPECT_TRUE(std::isnan(MeasureRoomErrors({track[3]}, {truth[3]}, {0}).g_mpjpe_m));
  EXPECT_THROW(MeasureRoomErrors(track, {}, {}), std::invalid_argument);
}

TEST(RoomErrors, AnEarThatIsNeverSeenIsLeftOut) {
  std::vector<MatrixX3d> track = Walk(), truth = Walk();
  for (MatrixX3d& points : track) points.row(3).array() += 1;  // would be an error of 1.7 m in one of 17
  for (MatrixX3d& points : truth) points.row(3).setConstant(std::nan(""));
  const RoomErrors e = MeasureRoomErrors(track, truth, Times());
  EXPECT_EQ(e.frames, kFrames);
  EXPECT_NEAR(e.g_mpjpe_m, 0, 1e-9);
  EXPECT_NEAR(e.wa_mpjpe_100_m, 0, 1e-9);
  for (MatrixX3d& points : truth) points.row(9).setConstant(std::nan(""));
  EXPECT_EQ(MeasureRoomErrors(track, truth, Times()).frames, 0) << "without a wrist there is no person";
}

TEST(RoomErrors, AnklesAreMeasuredFromTheLevelOfTheFrame) {
  // The second half is on a box of 0.4 m, which the track has 3 cm too high, with its person on it.
  std::vector<MatrixX3d> truth = Walk(), track = Walk();
  std::vector<double> levels(kFrames, 0);
  for (size_t t = kFrames / 2; t < size_t{kFrames}; ++t) {
    truth[t].col(1).array() += 0.4;
    track[t].col(1).array() += levels[t] = 0.43;
  }
  EXPECT_NEAR(MeasureRoomErrors(track, truth, Times()).ankle_height_err_m, 0.03 / 2, 1e-9);
  EXPECT_NEAR(MeasureRoomErrors(track, truth, Times(), levels).ankle_height_err_m, 0, 1e-9);
  for (size_t t = kFrames / 2; t < size_t{kFrames}; ++t) track[t].col(1).array() += 0.05;
  EXPECT_NEAR(MeasureRoomErrors(track, truth, Times(), levels).ankle_height_err_m, 0.05 / 2, 1e-9);
  levels.pop_back();
  EXPECT_THROW(MeasureRoomErrors(track, truth, Times(), levels), std::invalid_argument);
}

TEST(RoomErrors, OfATrackAreInItsOwnWorld) {
  Track track;
  track.camera = MakePinhole(1280, 720, 1000);
  std::vector<MatrixX3d> in_camera;
  // The camera looks along −z of the world from 1.4 m above the ground, its image's y down.
  const WorldFrame world = WorldOverGround(Vector3d(0, -1, 0), 1.4);
  for (const MatrixX3d& points : Walk()) {
    in_camera.emplace_back((points.rowwise() - world.translation.transpose()) * world.rotation);
    track.coco17.push_back(in_camera.back());
  }
  Evaluation none;
  AddRoomErrors(track, in_camera, Vector3d(0, -1, 0), Times(), &none);
  EXPECT_TRUE(none.values.empty()) << "a track without a world";
  const double tilt = 5 * kDegree;
  track.world = WorldOverGround(Vector3d(0, -std::cos(tilt), std::sin(tilt)), 1.4);
  Evaluation e;
  AddRoomErrors(track, in_camera, Vector3d(0, -1, 0), Times(), &e);
  EXPECT_NEAR(e.Value("tilt_deg"), 5, 1e-6);
  EXPECT_NEAR(e.Value("trunk_err_deg"), 5, 1e-3);
  EXPECT_EQ(e.breakdowns.back().labels.size(), 11U);
  track.level_m = Eigen::VectorXd::Constant(kFrames, 0.2);
  Evaluation on_level;
  AddRoomErrors(track, in_camera, Vector3d(0, -1, 0), Times(), &on_level);
  EXPECT_NEAR(on_level.Value("ankle_height_bias_mm"), e.Value("ankle_height_bias_mm") - 200, 1e-6);
}

}  // namespace
}  // namespace bodyloom::room_errors_test
