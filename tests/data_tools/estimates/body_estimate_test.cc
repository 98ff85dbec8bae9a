// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/body_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/estimates/estimate_arrays.h"
#include "geometry/body/posed_body.h"
#include "tests/data_tools/estimates/estimate_files.h"

namespace bodyloom::body_estimate_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kWidth = 1280, kHeight = 720;

const BodyModel& Body() {
  static const BodyModel body = BuiltinBody();
  return body;
}
Vector3d Pelvis() { return Body().RestJoints(Eigen::VectorXd()).row(0).transpose(); }

/// A person well beside the middle of the image, in a camera.
PersonEstimate Beside(const Camera& camera, double depth_m) {
  const double x_per_z = 420 / camera.fx;
  return estimate_files::MakePerson("1", {0, 2}, camera, {x_per_z * depth_m, 0.1, depth_m});
}

/// Pixels of COCO's landmarks of frame t.
std::vector<Vector2d> Pixels(const Eigen::Ref<const Eigen::RowVectorXd>& pose, const Vector3d& trans,
                             const Camera& camera) {
  const MatrixX3d points =
      PoseLandmarks(Body(), Eigen::VectorXd(), PoseFromAxisAngle(Body(), pose.transpose(), trans), CocoNames());
  std::vector<Vector2d> pixels;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    EXPECT_TRUE(camera.Project(points.row(k).transpose(), &pixels.emplace_back()));
  }
  return pixels;
}

double MeanDistance(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b) {
  double sum = 0;
  for (size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]).norm() / static_cast<double>(a.size());
  return sum;
}

TEST(BodyEstimate, NothingChangesInItsOwnCamera) {
  const Camera camera = CentredCamera(kWidth, kHeight, 900);
  const PersonEstimate person = Beside(camera, 4);
  const Motion motion = EstimateInCamera(person, camera, 4, Pelvis(), Pelvis());
  ASSERT_EQ(motion.num_frames(), 4);
  EXPECT_EQ(motion.up, Motion::Up::kCamera);
  for (const int t : {0, 2}) {
    EXPECT_LT((motion.poses.row(t) - person.poses.row(t / 2)).norm(), 1e-9);
    EXPECT_LT((motion.trans.row(t) - person.trans.row(t / 2)).norm(), 1e-9);
  }
  EXPECT_FALSE(motion.HasPose(1));
  EXPECT_FALSE(motion.HasPose(3));
  EXPECT_THROW(EstimateInCamera(person, camera, 2, Pelvis(), Pelvis()), std::invalid_argument);
}

TEST(BodyEstimate, AnotherBodyStandsAtTheSamePelvis) {
  const Camera camera = CentredCamera(kWidth, kHeight, 900);
  const PersonEstimate person = Beside(camera, 4);
  const Vector3d theirs = MeanPelvis("smplx"), ours = Pelvis();
  const Motion motion = EstimateInCamera(person, camera, 3, theirs, ours);
  EXPECT_LT((motion.trans.row(0).transpose() + ours - person.trans.row(0).transpose() - theirs).norm(), 1e-9);
}

// From nearly no perspective (PHALP) into a wide lens: the person is where it was in the image, and as large. Without
// the turn against the line of sight the same body is seen from 18 degrees farther round.
TEST(BodyEstimate, LooksTheSameInAnotherCamera) {
  const Camera telephoto = CentredCamera(kWidth, kHeight, 5000.0 / 256 * kWidth);
  const Camera wide = MakePinhole(kWidth, kHeight, 0.9 * kWidth);
  const PersonEstimate person = Beside(telephoto, 140);
  const Motion motion = EstimateInCamera(person, wide, 3, Pelvis(), Pelvis());
  const double metre_px = telephoto.fx / 140;
  EXPECT_NEAR(motion.trans(0, 2) + Pelvis().z(), wide.fx * (140 + Pelvis().z()) / telephoto.fx, 1e-6);
  const std::vector<Vector2d> before = Pixels(person.poses.row(0), person.trans.row(0).transpose(), telephoto);
  const std::vector<Vector2d> after = Pixels(motion.poses.row(0), motion.trans.row(0).transpose(), wide);
  EXPECT_LT(MeanDistance(before, after), 0.03 * metre_px);
  Eigen::RowVectorXd unturned = motion.poses.row(0);
  unturned.head<3>() = person.poses.row(0).head<3>();
  EXPECT_GT(MeanDistance(before, Pixels(unturned, motion.trans.row(0).transpose(), wide)),
            1.5 * MeanDistance(before, after));
}

TEST(BodyEstimate, WeakPerspectiveBecomesADepth) {
  Camera weak = CentredCamera(kWidth, kHeight, 1);
  weak.model = CameraModel::kWeakPerspective;
  weak.scale = 180;
  weak.tx = 1.5;
  weak.ty = -0.2;
  const PersonEstimate person = estimate_files::MakePerson("1", {0}, weak, {0, 0, 0});
  const Camera wide = MakePinhole(kWidth, kHeight, 900);
  const Motion motion = EstimateInCamera(person, wide, 1, Pelvis(), Pelvis());
  const Vector3d pelvis = Pelvis() + motion.trans.row(0).transpose();
  EXPECT_NEAR(pelvis.z(), 900.0 / 180, 1e-9);
  Vector2d pixel;
  ASSERT_TRUE(wide.Project(pelvis, &pixel));
  EXPECT_NEAR(pixel.x(), 0.5 * kWidth + 180 * (Pelvis().x() + 1.5), 1e-6);
  EXPECT_NEAR(pixel.y(), 0.5 * kHeight + 180 * (Pelvis().y() - 0.2), 1e-6);
}

TEST(BodyEstimate, FindsThePersonOfTheLandmarks) {
  const Camera camera = CentredCamera(kWidth, kHeight, 900);
  BodyEstimate estimate;
  estimate.rest_pelvis = MeanPelvis("smpl");
  estimate.people = {estimate_files::MakePerson("1", {0, 1, 2, 3}, camera, {-1, 0, 5}),
                     estimate_files::MakePerson("2", {2, 3}, camera, {1, 0, 5})};
  KeypointSequence keypoints;
  keypoints.names = {"left_hip", "right_hip"};
  keypoints.timestamps = {0, 1, 2, 3};
  const auto see = [&](size_t person) {
    keypoints.points.clear();
    for (int t = 0; t < 4; ++t) {
      const size_t i = person == 1 ? static_cast<size_t>(std::max(0, t - 2)) : static_cast<size_t>(t);
      const Vector2d pixel = PelvisOf(estimate.people[person], i, MeanPelvis("smpl"))->pixel;
      for (const float side : {15.0F, -15.0F}) {
        keypoints.points.push_back({static_cast<float>(pixel.x()) + side, static_cast<float>(pixel.y()) + 8, 0.9F});
      }
    }
  };
  see(0);
  EXPECT_EQ(PersonSeenAs(estimate, keypoints), 0);
  see(1);
  EXPECT_EQ(PersonSeenAs(estimate, keypoints), 1);
  for (Keypoint& point : keypoints.points) point.y += 200;
  EXPECT_EQ(PersonSeenAs(estimate, keypoints), -1);
  see(1);  // the middle of what is seen instead of hips
  keypoints.names = {"nose", "left_eye"};
  EXPECT_EQ(PersonSeenAs(estimate, keypoints), 1);
  for (Keypoint& point : keypoints.points) point.confidence = 0;
  EXPECT_EQ(PersonSeenAs(estimate, keypoints), -1);
}

}  // namespace
}  // namespace bodyloom::body_estimate_test
