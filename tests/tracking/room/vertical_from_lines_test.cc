// SPDX-License-Identifier: Apache-2.0
// The tracker with a vertical from the lines of the picture, on synthetic clips with known truth.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "tests/support/clip_input.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/room/picture_vertical.h"

namespace bodyloom::vertical_from_lines_test {
namespace {

constexpr double kDegree = M_PI / 180;

SynthClip Clip(SynthCameraMotion motion = SynthCameraMotion::kStill) {
  SynthClipOptions options;
  options.camera_path = {.motion = motion, .shake_deg = 3, .shake_m = 0};
  options.dense_per_frame = 0;
  options.camera.elevation_deg = 20;
  return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 40, 20), options);
}

/// Lines that say `up` for the camera, to 1°.
PictureVertical LinesOf(const Eigen::Vector3d& up, const Camera& camera) {
  PictureVertical lines;
  lines.found = true;
  lines.why = "made";
  lines.up = up;
  lines.focal_px = camera.fx;
  lines.covariance = kDegree * kDegree * (Eigen::Matrix3d::Identity() - up * up.transpose());
  return lines;
}

GroundSummary GroundOf(const SynthClip& clip, const PictureVertical* lines, const KnownGround* ground = nullptr,
                       std::vector<PlanEntry>* plan = nullptr) {
  TrackSequenceInput input = KnownCameraInput(clip);
  if (clip.truth.HasMovingCamera()) input.camera_from_scene = &clip.truth.camera_from_scene;
  input.picture_vertical = lines;
  input.ground = ground;
  TrackSequenceOptions options;
  options.num_threads = 2;
  const TrackSequenceResult result = FitClip(input, options);
  if (plan != nullptr) *plan = result.summary.plan;
  return result.summary.ground;
}

double AngleDeg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.dot(b))) / kDegree;
}

const PlanEntry* Find(const std::vector<PlanEntry>& plan, const std::string& what) {
  const auto it = std::find_if(plan.begin(), plan.end(), [&](const PlanEntry& entry) { return entry.what == what; });
  return it == plan.end() ? nullptr : &*it;
}

TEST(VerticalFromLines, DrawsTheTrackersVerticalToIt) {
  const SynthClip clip = Clip();
  const GroundSummary alone = GroundOf(clip, nullptr);
  ASSERT_TRUE(alone.has_up);
  // Lines that are 8° to the side of the truth: the answer goes most of the way, and says that it is sure of it.
  const Eigen::Vector3d side = Eigen::AngleAxisd(8 * kDegree, Eigen::Vector3d::UnitZ()) * clip.up_in_camera;
  const PictureVertical lines = LinesOf(side, clip.truth.camera);
  std::vector<PlanEntry> plan;
  const GroundSummary with = GroundOf(clip, &lines, nullptr, &plan);
  EXPECT_GT(AngleDeg(alone.up, side), 4);
  EXPECT_LT(AngleDeg(with.up, side), 3);
  EXPECT_LT(with.up_sigma_deg, 0.8 * alone.up_sigma_deg);
  ASSERT_NE(Find(plan, "vertical from lines"), nullptr);
  EXPECT_TRUE(Find(plan, "vertical from lines")->runs);
  EXPECT_EQ(Find(plan, "vertical from lines in the fit"), nullptr);
  // True lines make it right.
  const PictureVertical right = LinesOf(clip.up_in_camera, clip.truth.camera);
  EXPECT_LT(AngleDeg(GroundOf(clip, &right).up, clip.up_in_camera), 2);
}

TEST(VerticalFromLines, BehindACameraThatTurnsItIsOfTheScene) {
  const SynthClip clip = Clip(SynthCameraMotion::kHandHeld);
  ASSERT_TRUE(clip.truth.HasMovingCamera());
  const Eigen::Vector3d side = Eigen::AngleAxisd(8 * kDegree, Eigen::Vector3d::UnitZ()) * clip.up_in_camera;
  const PictureVertical lines = LinesOf(side, clip.truth.camera);
  const GroundSummary alone = GroundOf(clip, nullptr), with = GroundOf(clip, &lines);
  EXPECT_GT(AngleDeg(alone.up, side), 3.5);
  EXPECT_LT(AngleDeg(with.up, side), 3);
  EXPECT_LT(with.up_sigma_deg, 0.8 * alone.up_sigma_deg);
}

TEST(VerticalFromLines, TheLifterReadsTheJointsWithoutTheCamerasTurns) {
  const SynthClip still = Clip();
  const Camera& camera = still.truth.camera;
  KeypointSequence turned = still.keypoints;
  std::vector<CameraPose> path;
  const size_t joints = turned.names.size();
  for (int t = 0; t < turned.num_frames(); ++t) {
    const double angle = 5 * kDegree * std::sin(2 * M_PI * 3 * t / turned.num_frames());
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d(1, -2, 1).normalized()).toRotationMatrix();
    path.push_back({R, Eigen::Vector3d::Zero()});
    for (size_t k = 0; k < joints; ++k) {
      Keypoint& point = turned.points[t * joints + k];
      Eigen::Vector2d pixel;
      ASSERT_TRUE(camera.Project(R * camera.Unproject({point.x, point.y}).homogeneous(), &pixel));
      point.x = float(pixel.x()), point.y = float(pixel.y());
    }
  }
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.lifter = &BuiltinLifter();
  const FrameLayout layout = FrameLayout::Make(BuiltinBody(), CameraKnowledge::kKnown, camera, {0}, 0);
  LiftedStart expected;
  input.keypoints = &still.keypoints;
  FindInitialStates(input, &still.keypoints, layout, {}, &expected);
  ASSERT_EQ(expected.frames.size(), path.size());
  input.keypoints = &turned;
  input.camera_from_scene = &path;
  LiftedStart lifted;
  FindInitialStates(input, &turned, layout, {}, &lifted);
  ASSERT_EQ(lifted.frames.size(), path.size());
  for (size_t t = 0; t < path.size(); ++t) {
    const Eigen::Matrix3d& R = path[t].camera_from_world_rotation;
    EXPECT_LT((lifted.frames[t].points * R - expected.frames[t].points).cwiseAbs().maxCoeff(), 0.01) << t;
    EXPECT_LT((R.transpose() * lifted.frames[t].up - expected.frames[t].up).norm(), 0.01) << t;
  }
}

TEST(VerticalFromLines, FarFromTheLiftersItIsLeftOut) {
  const SynthClip clip = Clip();
  const Eigen::Vector3d far = Eigen::AngleAxisd(40 * kDegree, Eigen::Vector3d::UnitZ()) * clip.up_in_camera;
  const PictureVertical lines = LinesOf(far, clip.truth.camera);
  std::vector<PlanEntry> plan;
  const GroundSummary with = GroundOf(clip, &lines, nullptr, &plan), alone = GroundOf(clip, nullptr);
  EXPECT_EQ(with.up, alone.up);
  ASSERT_NE(Find(plan, "vertical from lines in the fit"), nullptr);
  EXPECT_FALSE(Find(plan, "vertical from lines in the fit")->runs);
}

TEST(VerticalFromLines, AGivenVerticalComesFirst) {
  const SynthClip clip = Clip();
  KnownGround known;
  known.up = clip.up_in_camera;
  const Eigen::Vector3d side = Eigen::AngleAxisd(8 * kDegree, Eigen::Vector3d::UnitZ()) * clip.up_in_camera;
  const PictureVertical lines = LinesOf(side, clip.truth.camera);
  std::vector<PlanEntry> plan;
  EXPECT_EQ(GroundOf(clip, &lines, &known, &plan).up, GroundOf(clip, nullptr, &known).up);
  ASSERT_NE(Find(plan, "vertical from lines"), nullptr);
  EXPECT_FALSE(Find(plan, "vertical from lines")->runs);
}

}  // namespace
}  // namespace bodyloom::vertical_from_lines_test
