// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/rig_track_evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <set>

#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"
#include "tracking/initialise/ground_plane.h"

namespace bodyloom::rig_track_evaluation_test {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kFrames = 120, kLeftElbow = 18;
constexpr double kFps = 60, kSpeed = 0.5;  // metres a second
constexpr double kSkinnedPx = 1e-3;        // vertices are skinned in float

/// Somebody who glides aside and bends an elbow, both at constant speed, at a moment of the first camera's clock.
void SetPose(double time_s, Eigen::Index row, Motion* motion) {
  Eigen::VectorXd pose = RandomAxisAngle(ToyBody(), 1, 0.6);
  pose.segment<3>(Eigen::Index{3} * kLeftElbow) << 0.1 + 0.3 * time_s, 0, 0;
  motion->poses.row(row) = pose.transpose();
  motion->trans.row(row) << kSpeed * (time_s - 1), 0.1, 4;
}

Track TrackOfTimes(const std::vector<double>& times_s) {
  Track track;
  track.camera = MakePinhole(1920, 1080, 1300);
  track.motion.body = "smpl";
  track.motion.up = Motion::Up::kCamera;
  track.motion.betas = Eigen::VectorXd::Zero(6);
  track.motion.poses.resize(Eigen::Index(times_s.size()), 72);
  track.motion.trans.resize(Eigen::Index(times_s.size()), 3);
  track.motion.timestamps = times_s;
  track.frame_status.assign(times_s.size(), FrameStatus::kTracked);
  for (size_t t = 0; t < times_s.size(); ++t) SetPose(times_s[t], Eigen::Index(t), &track.motion);
  return track;
}

std::vector<double> Times(int frames = kFrames) {
  std::vector<double> times;
  for (int t = 0; t < frames; ++t) times.push_back(t / kFps);
  return times;
}

/// Two cameras, 4 m from the person, at right angles.
std::vector<RigCamera> TwoCameras() {
  std::vector<RigCamera> rig(2);
  rig[0].name = "front";
  rig[0].camera = MakePinhole(1920, 1080, 1300);
  rig[1].name = "side";
  rig[1].camera = MakePinhole(1280, 720, 900);
  rig[1].camera_from_rig.camera_from_world_rotation << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  rig[1].camera_from_rig.camera_from_world_translation = Vector3d(-4, 0, 4);
  return rig;
}

Track InCamera(Track track, const RigCamera& camera) {
  track.motion = MovedMotion(ToyBody(), track.motion, {&camera.camera_from_rig, 1});
  track.camera = camera.camera;
  if (track.world) {
    track.world->rotation = track.world->rotation * camera.camera_from_rig.camera_from_world_rotation.transpose();
  }
  return track;
}

MatrixX3d VerticesOf(const Track& track, int t) {
  return PoseVertices(
      ToyBody(), track.motion.betas,
      PoseFromAxisAngle(ToyBody(), track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose()));
}

double OfView(const Evaluation& evaluation, const std::string& breakdown, const std::string& view) {
  for (const EvaluationBreakdown& one : evaluation.breakdowns) {
    for (size_t i = 0; one.name == breakdown && i < one.labels.size(); ++i) {
      if (one.labels[i] == view) return one.values[i];
    }
  }
  ADD_FAILURE() << breakdown << " has no " << view;
  return 0;
}

Evaluation Evaluate(const Track& track, const Track& truth, const std::vector<RigCamera>& rig,
                    const std::string& view = "", bool equal_clocks = false) {
  RigTrackOptions options;
  options.equal_clocks = equal_clocks;
  return EvaluateAgainstRig(track, truth, rig, view, ToyBody(), options);
}

TEST(RigTrackEvaluation, TheTruthHasNoError) {
  Track truth = TrackOfTimes(Times());
  truth.world = WorldOverGround(Vector3d(0, -1, 0.1), 1.2);
  truth.world->source = WorldSource::kGround;
  const Evaluation e = Evaluate(truth, truth, TwoCameras());
  EXPECT_EQ(e.protocol, "rig-track");
  EXPECT_EQ(e.frames, kFrames);
  EXPECT_EQ(e.Value("frames_without_truth"), 0);
  for (const char* name :
       {"projection_mean_px", "pve_mm", "joint_angle_err_deg", "limb_angle_err_deg", "own_view_mean_px",
        "own_view_median_px", "own_view_p95_px", "own_view_height_percent", "other_views_mean_px",
        "other_views_height_percent", "joint_err_mm", "landmark_pa_mpjpe_mm"}) {
    EXPECT_NEAR(e.Value(name), 0, 1e-6) << name;
  }
  for (const char* name : {"w_mpjpe_mm", "wa_mpjpe_mm", "room_g_mpjpe_mm", "room_w_mpjpe_mm", "room_wa_mpjpe_mm"}) {
    EXPECT_NEAR(e.Value(name), 0, 1e-6) << name;
  }
  EXPECT_NEAR(e.Value("tilt_deg"), 0, 1e-5);
  EXPECT_EQ(OfView(e, "joint_angle_group_err_deg", "elbows"), 0);
  std::set<std::string> names;
  for (const EvaluationValue& value : e.values) EXPECT_TRUE(names.insert(value.name).second) << value.name;
}

/// A track that is too far away by 20 cm: no pixel at the principal ray of its own view, f d / z across in the other.
TEST(RigTrackEvaluation, AnErrorInDepthShowsInTheOtherView) {
  constexpr double kDepth = 0.2;
  const Track truth = TrackOfTimes(Times());
  Track track = truth;
  track.motion.trans.col(2).array() += kDepth;
  const std::vector<RigCamera> rig = TwoCameras();
  const Evaluation e = Evaluate(track, truth, rig);
  double own = 0, side = 0, own_percent = 0;
  for (int t = 0; t < kFrames; ++t) {
    const MatrixX3d x = VerticesOf(truth, t);
    const Eigen::ArrayXd z = x.col(2).array(), side_z = 4 - x.col(0).array();
    const Eigen::ArrayXd from_axis = x.leftCols<2>().rowwise().norm();
    const double frame = (1300 * from_axis * (1 / z - 1 / (z + kDepth))).mean();
    const Eigen::ArrayXd u = 1300 * x.col(0).array() / z, v = 1300 * x.col(1).array() / z;
    own += frame / kFrames;
    own_percent += 100 * frame / std::max(u.maxCoeff() - u.minCoeff(), v.maxCoeff() - v.minCoeff()) / kFrames;
    side += (900 * kDepth / side_z).mean() / kFrames;
  }
  EXPECT_GT(side, 2 * own);
  EXPECT_NEAR(e.Value("own_view_mean_px"), own, kSkinnedPx);
  EXPECT_NEAR(e.Value("own_view_height_percent"), own_percent, kSkinnedPx);
  EXPECT_NEAR(e.Value("other_views_mean_px"), side, kSkinnedPx);
  EXPECT_NEAR(OfView(e, "view_mean_px", "front"), own, kSkinnedPx);
  EXPECT_NEAR(OfView(e, "view_mean_px", "side"), side, kSkinnedPx);
  EXPECT_NEAR(e.Value("joint_err_mm"), 1000 * kDepth, 1e-6);
  EXPECT_NEAR(e.Value("root_depth_err_mm"), 1000 * kDepth, 1e-6);
  EXPECT_NEAR(e.Value("wa_mpjpe_mm"), 0, 1e-6);
  EXPECT_NEAR(e.Value("landmark_pa_mpjpe_mm"), 0, 1e-6);
  EXPECT_NEAR(e.Value("other_views_placed_mean_px"), 0, kSkinnedPx);
}

/// The track of the second camera, in its frame and with its clock, which starts elsewhere and runs too fast.
TEST(RigTrackEvaluation, ATrackOfAnotherViewIsCarriedThere) {
  std::vector<RigCamera> rig = TwoCameras();
  rig[1].offset_s = -3.7;
  rig[1].rate = 1e-3;
  rig[1].middle_s = 1;
  Track truth = TrackOfTimes(Times());
  truth.world = WorldOverGround(Vector3d(0.2, -1, 0.1), 1.2);
  truth.world->source = WorldSource::kVertical;
  Track track = InCamera(truth, rig[1]);
  for (double& time : track.motion.timestamps) time = rig[1].TimeAt(time);
  const Evaluation e = Evaluate(track, truth, rig, "side");
  EXPECT_EQ(e.frames, kFrames);
  EXPECT_NEAR(e.Value("own_view_mean_px"), 0, kSkinnedPx);
  EXPECT_NEAR(e.Value("other_views_mean_px"), 0, kSkinnedPx);
  EXPECT_NEAR(e.Value("joint_err_mm"), 0, 1e-5);
  EXPECT_NEAR(e.Value("root_rotation_err_deg"), 0, 1e-5);
  EXPECT_NEAR(e.Value("tilt_deg"), 0, 1e-5);

  // Too far away by 20 cm for the second camera is aside for the first.
  Track farther = track;
  farther.motion.trans.col(2).array() += 0.2;
  double front = 0;
  for (int t = 0; t < kFrames; ++t) front += (1300 * 0.2 / VerticesOf(truth, t).col(2).array()).mean() / kFrames;
  EXPECT_NEAR(Evaluate(farther, truth, rig, "side").Value("other_views_mean_px"), front, kSkinnedPx);

  // A vertical of its own that is 3 degrees off.
  const Vector3d level = track.world->up_in_camera().unitOrthogonal();
  track.world->rotation = track.world->rotation * RotationFromAxisAngle(3 * kDegree * level);
  EXPECT_NEAR(Evaluate(track, truth, rig, "side").Value("tilt_deg"), 3, 1e-5);
  // An assumed vertical is no truth.
  truth.world->source = WorldSource::kLevelCamera;
  const Evaluation assumed = Evaluate(track, truth, rig, "side");
  EXPECT_THROW((void)assumed.Value("tilt_deg"), std::invalid_argument);
}

TEST(RigTrackEvaluation, AClockThatIsHalfAFrameOff) {
  std::vector<RigCamera> rig = TwoCameras();
  rig[1].offset_s = 0.5 / kFps;
  std::vector<double> between = Times();
  for (double& time : between) time -= 0.5 / kFps;
  const Track truth = TrackOfTimes(Times());
  Track track = InCamera(TrackOfTimes(between), rig[1]);
  track.motion.timestamps = Times();
  const Evaluation e = Evaluate(track, truth, rig, "side");
  EXPECT_EQ(e.frames, kFrames - 1);
  EXPECT_EQ(e.Value("frames_without_truth"), 1);  // the first, half a frame before the truth begins
  EXPECT_NEAR(e.Value("joint_err_mm"), 0, 1e-5);
  EXPECT_NEAR(e.Value("joint_angle_err_deg"), 0, 1e-5);

  rig[1].offset_s = 0;
  const Evaluation off = Evaluate(track, truth, rig, "side");
  EXPECT_EQ(off.Value("frames_without_truth"), 0);
  EXPECT_NEAR(off.Value("root_err_mm"), 1000 * kSpeed * 0.5 / kFps, 1e-5);
  EXPECT_GT(off.Value("landmark_pa_mpjpe_mm"), 1e-3);
  EXPECT_NEAR(OfView(off, "joint_angle_err_deg", "l_elbow"), 0.3 * 0.5 / kFps / kDegree, 1e-5);
  EXPECT_NEAR(OfView(off, "joint_angle_group_err_deg", "elbows"), 0.5 * 0.3 * 0.5 / kFps / kDegree, 1e-5);
}

TEST(RigTrackEvaluation, FramesWithoutTruthAreLeftOutAndLostOnesAreScored) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Track truth = TrackOfTimes(Times(100));
  truth.motion.trans.row(10).setConstant(kNaN);
  truth.frame_status[20] = FrameStatus::kInterpolated;
  Track track = TrackOfTimes(Times());
  track.motion.poses.row(50).setConstant(kNaN);
  const Evaluation e = Evaluate(track, truth, TwoCameras());
  EXPECT_EQ(e.Value("frames_without_truth"), kFrames - 100 + 2);
  EXPECT_EQ(e.frames, 98);
  EXPECT_EQ(e.frames_without_result, 1);
  EXPECT_NEAR(e.Value("joint_err_mm") * e.frames, 1000 * kSpeed / kFps, 0.5);  // by the frame before, and the elbow

  // Nothing is interpolated over a fifth of a second.
  std::vector<double> times = Times();
  times.erase(times.begin() + 30, times.begin() + 41);
  const Track gap = TrackAtTimes(ToyBody(), TrackOfTimes(times), Times());
  EXPECT_TRUE(gap.HasResult(29));
  EXPECT_FALSE(gap.HasResult(30));
  EXPECT_FALSE(gap.HasResult(40));
  EXPECT_TRUE(gap.HasResult(41));
}

TEST(RigTrackEvaluation, StatesTheTruthsOwnUncertainty) {
  Track truth = TrackOfTimes(Times());
  truth.joint_sigma.setConstant(kFrames, 24, 0.01);
  truth.root_sigma.setConstant(kFrames, 0.02);
  std::vector<RigCamera> rig = TwoCameras();
  rig[1].rotation_sigma_rad = 0.5 * kDegree;
  rig[1].translation_sigma_m = 0.03;
  const Evaluation e = Evaluate(InCamera(truth, rig[1]), truth, rig, "side");
  EXPECT_NEAR(e.Value("truth_joint_sigma_mm"), 10, 1e-9);
  EXPECT_NEAR(e.Value("truth_joint_err_mm"), 15.957691, 1e-6);
  EXPECT_NEAR(e.Value("truth_root_sigma_mm"), 20, 1e-9);
  EXPECT_NEAR(e.Value("view_rotation_sigma_deg"), 0.5, 1e-9);
  EXPECT_NEAR(e.Value("view_translation_sigma_mm"), 30, 1e-9);
  EXPECT_TRUE(std::isnan(Evaluate(truth, TrackOfTimes(Times()), rig).Value("truth_joint_sigma_mm")));
}

TEST(RigTrackEvaluation, ContradictionsAreRefused) {
  const Track truth = TrackOfTimes(Times());
  const auto expect_refused = [&](const Track& track, const Track& other, const std::vector<RigCamera>& rig,
                                  const std::string& view, const std::string& why) {
    EXPECT_THAT([&] { Evaluate(track, other, rig, view); }, ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  expect_refused(truth, truth, {}, "", "no cameras");
  expect_refused(truth, truth, TwoCameras(), "top", "no camera 'top', expected one of front, side");
  std::vector<RigCamera> rig = TwoCameras();
  rig[1].camera_from_rig.camera_from_world_rotation(0, 0) = std::nan("");
  expect_refused(truth, truth, rig, "front", "'side': expected a pose");
  rig = TwoCameras();
  rig[1].rate = -1;
  expect_refused(truth, truth, rig, "side", "'side': expected a clock");
  rig = TwoCameras();
  rig[0].camera.fx *= 1.1;
  expect_refused(truth, truth, rig, "", "the rig that was written with the truth");
  rig = TwoCameras();
  rig[1].offset_s = std::nan("");
  expect_refused(truth, truth, rig, "side", "the clock of the rig's camera 'side' is not known");
  EXPECT_EQ(Evaluate(InCamera(truth, rig[1]), truth, rig, "side", true).frames, kFrames);
  rig = TwoCameras();

  Track later = truth;
  for (double& time : later.motion.timestamps) time += 10;
  expect_refused(later, truth, rig, "", "none of the track's frames");
  Track other = truth;
  other.motion.body = "smplx";
  expect_refused(other, truth, rig, "", "of the body 'smplx'");
  other = truth;
  other.camera.model = CameraModel::kWeakPerspective;
  expect_refused(other, truth, rig, "", "the track is of weak perspective");
  other = truth;
  other.camera_from_scene.resize(kFrames);
  expect_refused(truth, other, rig, "", "the truth is of a moving camera");
  other = truth;
  other.motion.timestamps[5] = other.motion.timestamps[4];
  expect_refused(truth, other, rig, "", "timestamp 5");
}

}  // namespace
}  // namespace bodyloom::rig_track_evaluation_test
