// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/truth_evaluation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::evaluation_truth_test {
namespace {

constexpr int kFrames = 12;

Track TrueTrack() {
  Track track;
  track.camera = MakePinhole(1920, 1080, 1300);
  track.motion.body = "smpl";
  track.motion.up = Motion::Up::kCamera;
  track.motion.betas = Eigen::VectorXd::Zero(6);
  track.motion.poses.resize(kFrames, 72);
  track.motion.trans.resize(kFrames, 3);
  const Eigen::VectorXd a = RandomAxisAngle(ToyBody(), 1, 0.6), b = RandomAxisAngle(ToyBody(), 2, 0.6);
  for (int t = 0; t < kFrames; ++t) {
    track.motion.poses.row(t) = (a + (b - a) * t / kFrames).transpose();
    track.motion.poses.row(t).head<3>() = a.head<3>().transpose();
    track.motion.trans.row(t) << 0.02 * t, 0, 4;
    track.motion.timestamps.push_back(t / 60.0);
    track.frame_status.push_back(FrameStatus::kTracked);
  }
  return track;
}

TEST(EvaluationTruthTest, ThePerfectTrackHasNoError) {
  const Track truth = TrueTrack();
  const Evaluation e = EvaluateAgainstTruth(truth, truth, ToyBody());
  EXPECT_EQ(e.protocol, "known-truth");
  EXPECT_EQ(e.frames, kFrames);
  EXPECT_EQ(e.frames_without_result, 0);
  for (const char* name :
       {"projection_mean_px", "projection_std_px", "projection_rms_px", "pve_mm", "mpjpe_mm", "accel_err_ms2",
        "joint_angle_err_deg", "root_err_mm", "shape_err_mm", "focal_err_percent"}) {
    EXPECT_EQ(e.Value(name), 0) << name;
  }
  EXPECT_NEAR(e.Value("pa_mpjpe_mm"), 0, 1e-9);
  EXPECT_NEAR(e.Value("clip_scale"), 1, 1e-12);
  EXPECT_GT(e.Value("gt_accel_ms2"), 0);
}

/// Errors by vertex are those that the figures are means of.
TEST(EvaluationTruthTest, ErrorsOfAFrameAverageToTheFigures) {
  const Track truth = TrueTrack();
  Track track = truth;
  track.motion.poses.array() += 0.05;
  track.motion.trans.col(0).array() += 0.1;
  track.motion.betas = Eigen::VectorXd::Constant(2, 0.5);
  track.camera.fx *= 1.05;
  const Evaluation e = EvaluateAgainstTruth(track, truth, ToyBody());
  double mm = 0, px = 0;
  for (int t = 0; t < kFrames; ++t) {
    const auto of = [&](VertexErrorUnit unit) { return VertexErrorsOfFrame(track, truth, t, ToyBody(), unit); };
    ASSERT_EQ(of(VertexErrorUnit::kMillimetres).size(), ToyBody().num_vertices());
    mm += of(VertexErrorUnit::kMillimetres).mean() / kFrames;
    px += of(VertexErrorUnit::kPixels).mean() / kFrames;
  }
  EXPECT_GT(mm, 5);
  EXPECT_NEAR(mm, e.Value("pve_mm"), 1e-3);  // the figures are skinned in float
  EXPECT_NEAR(px, e.Value("projection_mean_px"), 1e-3);
  track.motion.poses(3, 7) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(VertexErrorsOfFrame(track, truth, 3, ToyBody(), VertexErrorUnit::kPixels).size(), 0);
  EXPECT_EQ(VertexErrorsOfFrame(truth, track, 3, ToyBody(), VertexErrorUnit::kMillimetres).size(), 0);
  EXPECT_THROW(VertexErrorsOfFrame(track, truth, kFrames, ToyBody(), VertexErrorUnit::kPixels), std::invalid_argument);
}

TEST(EvaluationTruthTest, KneesAreMeasuredInDegrees) {
  Track truth = TrueTrack();
  truth.motion.poses.middleCols<6>(12).setZero();
  Track track = truth;
  for (int t = 0; t < kFrames; ++t) {
    track.motion.poses(t, 12) = 0.1 * t;  // the left knee; the right one stays straight
    track.motion.poses(t, 13) = 2;        // a twist is no flexion
    truth.motion.poses(t, 12) = truth.motion.poses(t, 15) = 0.5;
  }
  track.motion.poses.row(kFrames - 1).setConstant(NAN);
  const Evaluation e = EvaluateAgainstTruth(track, truth, ToyBody());
  EXPECT_NEAR(e.Value("gt_knee_flexion_deg"), 0.5 * 180 / M_PI, 1e-12);
  EXPECT_EQ(e.Value("knee_flexion_deg"), 0);  // of 22 numbers 12 are zero
  for (int t = 0; t < kFrames; ++t) track.motion.poses(t, 15) = 0.25;
  const Evaluation alone = EvaluateAlone(track);
  EXPECT_EQ(alone.protocol, "track-alone");
  EXPECT_EQ(alone.frames, kFrames);
  EXPECT_EQ(alone.frames_without_result, 1);
  EXPECT_NEAR(alone.Value("knee_flexion_deg"), 0.25 * 180 / M_PI, 1e-12);
  track.motion.poses.setConstant(NAN);
  EXPECT_TRUE(std::isnan(EvaluateAlone(track).Value("knee_flexion_deg")));
}

TEST(EvaluationTruthTest, AShiftedRootMovesTheImageAndNothingElse) {
  const Track truth = TrueTrack();
  Track track = truth;
  track.motion.trans.rowwise() += Eigen::RowVector3d(0.03, 0.04, 0);
  const Evaluation e = EvaluateAgainstTruth(track, truth, ToyBody());
  EXPECT_NEAR(e.Value("root_err_mm"), 50, 1e-9);
  EXPECT_NEAR(e.Value("root_lateral_err_mm"), 50, 1e-9);
  EXPECT_NEAR(e.Value("root_depth_err_mm"), 0, 1e-9);
  EXPECT_NEAR(e.Value("mpjpe_mm"), 0, 1e-9);
  EXPECT_NEAR(e.Value("pve_mm"), 0, 1e-3);
  EXPECT_NEAR(e.Value("joint_angle_err_deg"), 0, 1e-9);
  // 50 mm at about 4 m through 1300 px, in an image whose longer side is 512.
  double sum = 0;
  int count = 0;
  for (int t = 0; t < kFrames; ++t) {
    const BodyPose pose =
        PoseFromAxisAngle(ToyBody(), truth.motion.poses.row(t).transpose(), truth.motion.trans.row(t).transpose());
    const MatrixX3d vertices = PoseVertices(ToyBody(), truth.motion.betas, pose);
    for (Eigen::Index v = 0; v < vertices.rows(); ++v, ++count) sum += 0.05 * 1300 / vertices(v, 2) * 512 / 1920;
  }
  EXPECT_NEAR(e.Value("projection_mean_px"), sum / count, 1e-5);  // vertices are skinned in float
  VertexErrorOptions options;
  options.num_threads = 2;
  EXPECT_EQ(EvaluateAgainstTruth(track, truth, ToyBody(), options).Value("pve_mm"), e.Value("pve_mm"));
  options.image_side_px = 1920;
  options.vertex_step = 3;
  EXPECT_NEAR(EvaluateAgainstTruth(track, truth, ToyBody(), options).Value("projection_mean_px"),
              sum / count * 1920 / 512, 0.05);
}

TEST(EvaluationTruthTest, AKnownTurnOfOneJoint) {
  const Track truth = TrueTrack();
  Track track = truth;
  const int elbow = ToyBody().FindJoint("l_elbow");
  ASSERT_GE(elbow, 0);
  for (int t = 0; t < kFrames; ++t) {
    const Eigen::Matrix3d R = RotationFromAxisAngle(truth.motion.poses.row(t).segment<3>(3 * elbow).transpose());
    track.motion.poses.row(t).segment<3>(3 * elbow) =
        AxisAngleFromRotation(R * RotationFromAxisAngle({0, 0, 0.1})).transpose();
  }
  const Evaluation e = EvaluateAgainstTruth(track, truth, ToyBody());
  EXPECT_NEAR(e.Value("joint_angle_err_deg"), 0.1 * 180 / M_PI / 23, 1e-9);
  EXPECT_EQ(e.Value("root_rotation_err_deg"), 0);
  EXPECT_GT(e.Value("mpjpe_mm"), 0.5);
  ASSERT_EQ(e.breakdowns.size(), 5u);
  EXPECT_NEAR(e.breakdowns[1].values[elbow], 0.1 * 180 / M_PI, 1e-9);
  EXPECT_NEAR(e.breakdowns[0].values[ToyBody().FindJoint("l_knee")], 0, 1e-9);
  EXPECT_GT(e.breakdowns[0].values[ToyBody().FindJoint("l_wrist")], 10);
}

TEST(EvaluationTruthTest, ShapeAndFocalLength) {
  const Track truth = TrueTrack();
  Track track = truth;
  track.camera.fx = track.camera.fy = 1.1 * 1300;
  track.motion.betas[0] = 1;  // stature: 4.5 % larger about the pelvis
  const Evaluation e = EvaluateAgainstTruth(track, truth, ToyBody());
  EXPECT_NEAR(e.Value("focal_err_percent"), 10, 1e-9);
  EXPECT_NEAR(e.Value("clip_scale"), 1 / 1.045, 1e-6);
  EXPECT_NEAR(e.Value("mpjpe_scaled_mm"), 0, 1e-4);
  MatrixX3d vertices = ToyBody().data().v_template;
  vertices.rowwise() -= Eigen::RowVector3d(ToyBody().joint_template().row(0));
  const double size_mm = vertices.rowwise().norm().mean() * 1e3;
  EXPECT_NEAR(e.Value("shape_err_mm"), 0.045 * size_mm, 0.01);
  EXPECT_NEAR(e.Value("pve_mm"), 0.045 * size_mm, 0.1 * 0.045 * size_mm);  // the posed body is a little smaller
}

TEST(EvaluationTruthTest, FramesWithoutAResultCost) {
  const Track truth = TrueTrack();
  Track track = truth;
  track.motion.poses.row(5).setConstant(NAN);
  track.motion.trans(6, 2) = NAN;
  track.frame_status[5] = track.frame_status[6] = FrameStatus::kLost;
  const Evaluation e = EvaluateAgainstTruth(track, truth, ToyBody());
  EXPECT_EQ(e.frames_without_result, 2);
  EXPECT_EQ(e.frames, kFrames);
  // Both neighbours are one frame away and 20 mm of travel: 2 · 20 / 12.
  EXPECT_NEAR(e.Value("root_err_mm"), 2 * 20.0 / kFrames, 1e-6);
  EXPECT_GT(e.Value("projection_mean_px"), 0.1);

  track.motion.trans.setConstant(NAN);
  const Evaluation none = EvaluateAgainstTruth(track, truth, ToyBody());
  EXPECT_EQ(none.frames_without_result, kFrames);
  EXPECT_TRUE(none.values.empty());
}

TEST(EvaluationTruthTest, WeakPerspectiveHasNoDepthToJudge) {
  const Track truth = TrueTrack();
  Track track = truth;
  track.camera = WeakCamera(1920, 1080, 1);
  track.weak_camera = MatrixX3d::Zero(kFrames, 3);
  for (int t = 0; t < kFrames; ++t) track.weak_camera.row(t) << 1300 / 4.0, 0, 0;
  const Evaluation e = EvaluateAgainstTruth(track, truth, ToyBody());
  EXPECT_TRUE(std::isnan(e.Value("root_err_mm")));
  EXPECT_TRUE(std::isnan(e.Value("focal_err_percent")));
  EXPECT_LT(e.Value("projection_mean_px"), 20);
  EXPECT_GT(e.Value("projection_mean_px"), 0);
}

TEST(EvaluationTruthTest, BrokenContractsThrow) {
  const Track truth = TrueTrack();
  Track shorter = truth;
  shorter.motion.poses.conservativeResize(kFrames - 1, 72);
  EXPECT_THROW(EvaluateAgainstTruth(shorter, truth, ToyBody()), std::invalid_argument);
  EXPECT_THROW(EvaluateAgainstTruth({}, {}, ToyBody()), std::invalid_argument);
  VertexErrorOptions options;
  options.vertex_step = 0;
  EXPECT_THROW(EvaluateAgainstTruth(truth, truth, ToyBody(), options), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(EvaluateAgainstTruth(truth, truth, ToyBody()).Value("nonsense")),
               std::invalid_argument);
}

TEST(EvaluationTruthTest, TableAndJsonHoldEveryValue) {
  const Track truth = TrueTrack();
  Track track = truth;
  track.motion.trans.rowwise() += Eigen::RowVector3d(0.03, 0.04, 0);
  Evaluation e = EvaluateAgainstTruth(track, truth, ToyBody());
  e.subject = {{"clip", "a \"quoted\" \xff name"}};
  e.Add("nothing_mm", NAN, "never measured");
  const std::string table = EvaluationTable(e);
  const nlohmann::json json = nlohmann::json::parse(EvaluationJson(e));
  EXPECT_EQ(json["protocol"], "known-truth");
  EXPECT_EQ(json["frames"], kFrames);
  EXPECT_EQ(json["values"].size(), e.values.size());
  for (const EvaluationValue& entry : e.values) {
    EXPECT_NE(table.find("  " + entry.name + " "), std::string::npos) << entry.name;
    EXPECT_NE(table.find(entry.meaning), std::string::npos) << entry.meaning;
    if (std::isfinite(entry.value)) {
      EXPECT_EQ(json["values"][entry.name].get<double>(), entry.value);
    } else {
      EXPECT_TRUE(json["values"][entry.name].is_null());
    }
    EXPECT_EQ(json["meanings"][entry.name], entry.meaning);
  }
  EXPECT_NE(table.find("50.000"), std::string::npos);
  EXPECT_EQ(json["breakdowns"]["mpjpe_mm"].size(), 24u);
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
}

}  // namespace
}  // namespace bodyloom::evaluation_truth_test
