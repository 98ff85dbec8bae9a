// SPDX-License-Identifier: Apache-2.0
// Landmarks of a lifter that leans, turned to a vertical that is known.
#include "tracking/clip/turn_to_vertical.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/observations.h"
#include "tracking/lifter/lifter_reading.h"
#include "tracking/problem/track_options.h"
#include "tracking/room/picture_vertical.h"

namespace bodyloom::turn_to_vertical_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

/// Two shots of five frames of somebody upright, seen as leaning by these angles together with the vertical.
struct Clip {
  LiftedStart lifted;
  std::vector<FrameState> states;
  std::vector<char> cut_before = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0};
  std::vector<Matrix3d> lean;

  Clip(double first_deg, double second_deg) {
    for (int t = 0; t < 10; ++t) {
      lean.push_back(RotationFromAxisAngle(Vector3d((t < 5 ? first_deg : second_deg) * kDegree, 0, 0)));
      LiftedFrame& frame = lifted.frames.emplace_back();
      frame.seen = true;
      frame.up = lean[t] * Vector3d(0, -1, 0);
      frame.up_sigma = 0.1;
      frame.points.resize(2, 3);
      frame.points << Upright(t).transpose(), -0.3 * Upright(t).transpose();
      LiftedLimb limb;
      limb.points.fill(Upright(t));
      limb.sigma.fill(Eigen::Vector2d::Ones());
      frame.limbs[1] = {limb};
      FrameState& state = states.emplace_back();
      state.rotations.assign(2, Matrix3d::Identity());
      state.rotations[0] = lean[t];
    }
  }
  [[nodiscard]] Vector3d Upright(int t) const { return lean[t] * Vector3d(0, -0.5, 0); }
};

TEST(TurnToVertical, LandmarksAndStartsStandUprightUnderAGivenVertical) {
  Clip clip(8, -5);
  KnownGround ground;
  TrackSequenceInput input;
  input.ground = &ground;
  EXPECT_NEAR(TurnToVertical(input, {}, clip.cut_before, &clip.lifted, &clip.states), 8 * kDegree, 1e-9);
  for (int t = 0; t < 10; ++t) {
    const LiftedFrame& frame = clip.lifted.frames[t];
    EXPECT_LT((frame.points.row(0).transpose() - Vector3d(0, -0.5, 0)).norm(), 1e-9) << t;
    EXPECT_LT((frame.points.row(1).transpose() - Vector3d(0, 0.15, 0)).norm(), 1e-9) << t;
    EXPECT_LT((frame.limbs[1][0].points[3] - Vector3d(0, -0.5, 0)).norm(), 1e-9) << t;
    EXPECT_LT((clip.states[t].rotations[0] - Matrix3d::Identity()).norm(), 1e-9) << t;
    EXPECT_LT((clip.states[t].rotations[1] - Matrix3d::Identity()).norm(), 1e-9) << t;
    EXPECT_LT((frame.up - clip.lean[t] * Vector3d(0, -1, 0)).norm(), 1e-12) << "the lifter's own stays";
  }
}

TEST(TurnToVertical, LinesTurnByTheirShareOfTheInformation) {
  Clip clip(8, 8);
  PictureVertical lines;
  lines.found = true;
  lines.focal_px = 1000;
  const Vector3d up(0, -1, 0);
  lines.covariance = kDegree * kDegree * (Matrix3d::Identity() - up * up.transpose());
  TrackSequenceInput input;
  input.picture_vertical = &lines;
  const double turn = TurnToVertical(input, {1000, 0}, clip.cut_before, &clip.lifted, &clip.states) / kDegree;
  EXPECT_GT(turn, 6.5);  // σ 1° against some 3°
  EXPECT_LT(turn, 8);
  EXPECT_NEAR(std::atan2(clip.lifted.frames[2].points(0, 2), -clip.lifted.frames[2].points(0, 1)) / kDegree, turn - 8,
              1e-6);
}

TEST(TurnToVertical, FurtherViewsTurnByTheirOwnLines) {
  Clip own(8, 8);
  PictureVertical lines;
  lines.found = true;
  lines.focal_px = 1000;
  const Vector3d up(0, -1, 0);
  lines.covariance = kDegree * kDegree * (Matrix3d::Identity() - up * up.transpose());
  std::vector<ViewInput> views(2);
  views[1].picture_vertical = &lines;
  TrackSequenceInput input;
  input.views = &views;
  const Camera camera = MakePinhole(640, 480, 1000);
  FrameLayout layout = FrameLayout::Make(BuiltinBody(), CameraKnowledge::kKnown, camera, {0}, 0);
  for (int v = 0; v < 2; ++v) layout.AddView({CameraKnowledge::kKnown, camera, true, true});
  std::vector<ViewObservations> seen(2);
  for (ViewObservations& view : seen) {
    view.lifted = own.lifted.frames;
    view.keypoints.names = CocoNames();
    view.keypoints.points.resize(view.lifted.size() * view.keypoints.names.size());
    for (size_t t = 0; t < view.lifted.size(); ++t) view.keypoints.timestamps.push_back(0.04 * double(t));
  }
  TurnViewsToVertical(input, layout, &seen);
  EXPECT_EQ(seen[0].lifted[2].points, own.lifted.frames[2].points) << "a view without lines stays";
  input.picture_vertical = &lines;
  TurnToVertical(input, {1000, 0}, std::vector<char>(10, 0), &own.lifted, &own.states);
  EXPECT_LT((seen[1].lifted[2].points - own.lifted.frames[2].points).norm(), 1e-12) << "as the first view would";
}

TEST(TurnToVertical, BehindAMovingCameraLinesAndAGivenGroundTurnInTheScene) {
  PictureVertical lines;
  lines.found = true;
  lines.focal_px = 1000;
  const Vector3d up(0, -1, 0);
  lines.covariance = kDegree * kDegree * (Matrix3d::Identity() - up * up.transpose());
  KnownGround ground;
  ground.up = up;
  for (const bool given : {false, true}) {
    Clip still(8, 8), seen(8, 8);
    std::vector<CameraPose> path(10);
    for (int t = 0; t < 10; ++t) {
      const Matrix3d R = RotationFromAxisAngle(Vector3d(0.02 * t, -0.1 * t, 0.03));
      path[t].camera_from_world_rotation = R;
      LiftedFrame& frame = seen.lifted.frames[t];
      frame.up = R * frame.up;
      frame.points = (frame.points * R.transpose()).eval();
      seen.states[t].rotations[0] = R * seen.states[t].rotations[0];
    }
    TrackSequenceInput input;
    input.picture_vertical = &lines;
    input.ground = given ? &ground : nullptr;
    const double turn = TurnToVertical(input, {1000, 0}, still.cut_before, &still.lifted, &still.states);
    EXPECT_GT(turn, 0);
    input.camera_from_scene = &path;
    EXPECT_NEAR(TurnToVertical(input, {1000, 0}, seen.cut_before, &seen.lifted, &seen.states), turn, 1e-9);
    for (int t = 0; t < 10; ++t) {
      const Matrix3d& R = path[t].camera_from_world_rotation;
      EXPECT_LT((seen.lifted.frames[t].points * R - still.lifted.frames[t].points).norm(), 1e-9) << t;
      EXPECT_LT((R.transpose() * seen.states[t].rotations[0] - still.states[t].rotations[0]).norm(), 1e-9) << t;
    }
  }
}

TEST(TurnToVertical, NothingTurnsWithoutAVertical) {
  TrackSequenceInput input;
  PictureVertical none;
  for (const PictureVertical* lines :
       {static_cast<const PictureVertical*>(nullptr), static_cast<const PictureVertical*>(&none)}) {
    Clip clip(8, 8);
    input.picture_vertical = lines;
    EXPECT_EQ(TurnToVertical(input, {}, clip.cut_before, &clip.lifted, &clip.states), 0);
    EXPECT_EQ(clip.states[3].rotations[0], clip.lean[3]);
  }
}

}  // namespace
}  // namespace bodyloom::turn_to_vertical_test
