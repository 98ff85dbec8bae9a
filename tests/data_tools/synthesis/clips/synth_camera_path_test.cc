// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/clips/synth_camera.h"

#include <gtest/gtest.h>

#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/toy_body.h"

namespace bodyloom::synth_camera_path_test {
namespace {

using Eigen::Vector3d;

Motion ShortWalk() { return DemoMotion(ToyBody(), 40, 10); }

SynthClipOptions Options(SynthCameraMotion motion) {
  SynthClipOptions options;
  options.camera.width = options.camera.height = 256;
  options.camera_path.motion = motion;
  options.dense_per_frame = 50;
  options.detection.noise = 0;
  options.num_threads = 1;
  return options;
}

double LargestTurn(const std::vector<CameraPose>& path) {
  double largest = 0;
  for (const CameraPose& pose : path) {
    largest = std::max(largest, AxisAngleFromRotation(pose.camera_from_world_rotation).norm());
  }
  return largest;
}

TEST(SynthCameraPath, BeginsInTheSceneAndIsTheSameForTheSameSeed) {
  for (const SynthCameraMotion motion :
       {SynthCameraMotion::kHandHeld, SynthCameraMotion::kWalking, SynthCameraMotion::kOrbit}) {
    EXPECT_EQ(SynthCameraMotionFromString(ToString(motion)), motion);
    const auto make = [&](uint64_t seed) {
      return MakeSynthCameraPath(ToyBody(), ShortWalk(), {}, {.motion = motion}, seed);
    };
    const SynthCameraPath path = make(1), again = make(1), other = make(2);
    ASSERT_EQ(path.camera_from_scene.size(), 40U);
    EXPECT_TRUE(path.camera_from_scene[0].camera_from_world_rotation.isIdentity(1e-12));
    EXPECT_LT(path.camera_from_scene[0].camera_from_world_translation.norm(), 1e-12);
    EXPECT_EQ(path.camera_from_scene[17].camera_from_world_rotation,
              again.camera_from_scene[17].camera_from_world_rotation);
    EXPECT_NE(path.camera_from_scene[17].camera_from_world_rotation,
              other.camera_from_scene[17].camera_from_world_rotation);
  }
  EXPECT_TRUE(MakeSynthCameraPath(ToyBody(), ShortWalk(), {}, {}, 1).camera_from_scene.empty());
  EXPECT_THROW(SynthCameraMotionFromString("drone"), std::invalid_argument);
}

TEST(SynthCameraPath, AnOrbitWithoutShakeTurnsByItsAngleAndKeepsItsDistance) {
  const SynthCameraPath path = MakeSynthCameraPath(
      ToyBody(), ShortWalk(), {}, {.motion = SynthCameraMotion::kOrbit, .shake_deg = 0, .shake_m = 0}, 1);
  EXPECT_NEAR(LargestTurn(path.camera_from_scene), M_PI / 2, 1e-9);
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortWalk(), path, Options(SynthCameraMotion::kOrbit));
  const auto distance = [&](int t) {
    return MovedPoint(path.camera_from_scene[size_t(t)], clip.truth.joints[size_t(t)].row(0).transpose()).norm();
  };
  EXPECT_NEAR(distance(39), distance(0), 0.35) << "the pelvis is followed about its mean place of a second";
}

TEST(SynthCameraPath, WhatIsSeenIsTheTruthThroughTheCameraOfItsFrame) {
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortWalk(), Options(SynthCameraMotion::kWalking));
  ASSERT_TRUE(clip.truth.HasMovingCamera());
  int checked = 0;
  for (const int t : {0, 20, 39}) {
    for (int k = 0; k < 17; ++k) {
      const Keypoint& point = clip.keypoints_truth.at(t, k);
      if (point.confidence == 0) continue;
      const Vector3d seen =
          MovedPoint(clip.truth.camera_from_scene[size_t(t)], clip.truth.coco17[size_t(t)].row(k).transpose());
      Eigen::Vector2d px;
      ASSERT_TRUE(clip.truth.camera.Project(seen, &px));
      EXPECT_LT((px - Eigen::Vector2d(point.x, point.y)).norm(), 1e-3);
      ++checked;
    }
  }
  EXPECT_GT(checked, 30);
  // The scene stands still: the same motion seen by a camera at rest is the same up to one rigid motion.
  const Motion still = MotionInCamera(ToyBody(), ShortWalk(), clip.camera_from_world);
  EXPECT_LT((clip.truth.motion.trans - still.trans).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(SynthCameraPath, RefusesWhatHasNoPlaceInAScene) {
  SynthClipOptions options = Options(SynthCameraMotion::kWalking);
  options.camera.model = CameraModel::kWeakPerspective;
  EXPECT_THROW(MakeSynthClip(ToyBody(), ShortWalk(), options), std::invalid_argument);
  options = Options(SynthCameraMotion::kWalking);
  options.initialiser_error_px = 5;
  EXPECT_THROW(MakeSynthClip(ToyBody(), ShortWalk(), options), std::invalid_argument);
  options = Options(SynthCameraMotion::kWalking);
  options.camera_path.shake_deg = -1;
  EXPECT_THROW(MakeSynthClip(ToyBody(), ShortWalk(), options), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::synth_camera_path_test
