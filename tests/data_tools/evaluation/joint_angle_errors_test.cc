// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/joint_angle_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "data_tools/evaluation/truth_evaluation.h"
#include "geometry/base/units.h"
#include "geometry/biomechanics/landmark_angles.h"
#include "geometry/biomechanics/track_angles.h"
#include "geometry/math/rotation.h"
#include "tests/support/short_track.h"

namespace bodyloom::joint_angle_errors_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double Breakdown(const Evaluation& evaluation, const std::string& name, const std::string& label) {
  for (const EvaluationBreakdown& breakdown : evaluation.breakdowns) {
    if (breakdown.name != name) continue;
    for (size_t i = 0; i < breakdown.labels.size(); ++i) {
      if (breakdown.labels[i] == label) return breakdown.values[i];
    }
  }
  ADD_FAILURE() << name << " has no " << label;
  return kNaN;
}

TEST(JointAngleErrors, DifferencesAreWrappedAndUnknownOnesLeftOut) {
  RowMatrixXd track(3, 2), truth(3, 2);
  track << 179, 10, -175, 20, 5, kNaN;
  truth << -179, 12, 175, kNaN, 0, 1;
  const AngleErrors errors = CompareAngles(track, truth);
  EXPECT_NEAR(errors.mean_abs_deg[0], (2 + 10 + 5) / 3.0, 1e-12);
  EXPECT_NEAR(errors.bias_deg[0], (-2 + 10 + 5) / 3.0, 1e-12);
  EXPECT_NEAR(errors.mean_abs_deg[1], 2, 1e-12);
  EXPECT_NEAR(errors.bias_deg[1], -2, 1e-12);
  EXPECT_TRUE(std::isnan(CompareAngles(RowMatrixXd::Constant(3, 1, kNaN), truth.leftCols(1)).bias_deg[0]));
  EXPECT_THROW(CompareAngles(track, truth.leftCols(1)), std::invalid_argument);
}

TEST(JointAngleErrors, TwoTriplesOfOneRotationAreNoError) {
  const int flex = FindCoordinate("arm_flex_l"), hip = FindCoordinate("hip_flexion_r");
  RowMatrixXd truth = RowMatrixXd::Zero(2, kNumCoordinates), track = truth;
  truth.row(0).segment<3>(flex) << 20, -140, 30;
  track.row(0).segment<3>(flex) << 200 - 360, 320 - 360, 210;
  truth.row(1).segment<3>(flex) << 20, -80, 30;
  track.row(1).segment<3>(flex) << 90, -80, -40;
  track(1, hip) = 7;
  const RowMatrixXd nearest = NearestTriples(track, truth);
  const AngleErrors errors = CompareAngles(nearest, truth);
  EXPECT_NEAR(errors.mean_abs_deg[flex], 0, 1e-9) << "near 90° of adduction it is not determined";
  EXPECT_NEAR(errors.mean_abs_deg[flex + 1], 0, 1e-9);
  EXPECT_TRUE(std::isnan(nearest(1, flex)) && std::isnan(nearest(1, flex + 2)));
  EXPECT_NEAR(errors.mean_abs_deg[hip], 3.5, 1e-9);
}

TEST(JointAngleErrors, OfAKneeThatIsBentMoreAreThatKnees) {
  const Track truth = ShortTrack();
  Track track = truth;
  const int knee = BuiltinBody().FindJoint("l_knee"), spine = BuiltinBody().FindJoint("spine3");
  for (int t = 0; t < track.num_frames(); ++t) {
    auto by = track.motion.poses.row(t).segment<3>(Eigen::Index(3) * knee);
    by = AxisAngleFromRotation(RotationFromAxisAngle(Eigen::Vector3d(8 * kDegree, 0, 0)) *
                               RotationFromAxisAngle(by.transpose()))
             .transpose();
  }
  Evaluation evaluation = EvaluateAgainstTruth(track, truth, BuiltinBody());
  // The knee's axis at rest is the body's up to a degree.
  EXPECT_NEAR(Breakdown(evaluation, "coordinate_err_deg", "knee_angle_l"), 8, 0.1);
  EXPECT_NEAR(Breakdown(evaluation, "coordinate_bias_deg", "knee_angle_l"), 8, 0.1);
  EXPECT_NEAR(Breakdown(evaluation, "coordinate_err_deg", "knee_angle_r"), 0, 1e-9);
  EXPECT_NEAR(Breakdown(evaluation, "coordinate_group_err_deg", "knees"), 4, 0.1);
  EXPECT_NEAR(Breakdown(evaluation, "coordinate_group_err_deg", "hips"), 0, 1e-9);
  EXPECT_NEAR(evaluation.Value("gait_angle_err_deg"), 8.0 / 16, 0.01);
  EXPECT_NEAR(evaluation.Value("arm_angle_err_deg"), 0, 1e-9);

  // A trunk that turns by 6° takes the arms with it.
  track = truth;
  for (int t = 0; t < track.num_frames(); ++t) {
    auto by = track.motion.poses.row(t).segment<3>(Eigen::Index(3) * spine);
    by = AxisAngleFromRotation(RotationFromAxisAngle(by.transpose()) *
                               RotationFromAxisAngle(Eigen::Vector3d(0, 6 * kDegree, 0)))
             .transpose();
  }
  evaluation = EvaluateAgainstTruth(track, truth, BuiltinBody());
  EXPECT_NEAR(Breakdown(evaluation, "coordinate_bias_deg", "lumbar_rotation"), 6, 1e-6);
  EXPECT_NEAR(evaluation.Value("arm_angle_err_deg"), 0, 1e-9);
}

TEST(JointAngleErrors, AWorldThatLeansIsAnErrorOfThePelvis) {
  Track truth = ShortTrack();
  truth.world = WorldFrame();
  Track track = truth;
  track.world->rotation = RotationFromAxisAngle(Eigen::Vector3d(0, 0, 5 * kDegree)) * truth.world->rotation;
  const Evaluation evaluation = EvaluateAgainstTruth(track, truth, BuiltinBody());
  const double tilt = Breakdown(evaluation, "coordinate_err_deg", "pelvis_tilt"),
               list = Breakdown(evaluation, "coordinate_err_deg", "pelvis_list");
  EXPECT_GT(tilt + list, 5 - 1e-6);
  EXPECT_NEAR(Breakdown(evaluation, "coordinate_err_deg", "hip_flexion_r"), 0, 1e-9);
}

TEST(JointAngleErrors, LandmarksAreComparedInAnyFrame) {
  const Track truth = ShortTrack();
  std::vector<MatrixX3d> turned, bent = truth.coco17;
  for (const MatrixX3d& points : truth.coco17) {
    turned.emplace_back(2 * points * RotationFromAxisAngle(Eigen::Vector3d(0.3, 1, -0.5)).transpose());
  }
  Evaluation evaluation;
  AddLandmarkAngleErrors(turned, truth.coco17, &evaluation);
  EXPECT_NEAR(evaluation.Value("landmark_angle_err_deg"), 0, 1e-9);
  const double straight = FlexionDeg(bent[0].row(11), bent[0].row(13), bent[0].row(15));
  bent.resize(1);
  bent[0].row(15) = bent[0].row(13) + (bent[0].row(13) - bent[0].row(11));  // in line
  evaluation = {};
  AddLandmarkAngleErrors(bent, {truth.coco17[0]}, &evaluation);
  EXPECT_NEAR(Breakdown(evaluation, "landmark_angle_bias_deg", "knee_angle_l"), -straight, 1e-5);
  EXPECT_NEAR(Breakdown(evaluation, "landmark_angle_err_deg", "knee_angle_r"), 0, 1e-9);
}

}  // namespace
}  // namespace bodyloom::joint_angle_errors_test
