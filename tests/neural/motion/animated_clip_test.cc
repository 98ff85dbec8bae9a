// SPDX-License-Identifier: Apache-2.0
// Another person's motion applied to the person of a trained motion-dependent renderer.
#include "pipelines/neural/motion/animated_clip.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/track_io.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom::animated_clip_test {
namespace {

using ::testing::HasSubstr;

class AnimatedClips : public ::testing::Test {
 protected:
  AnimatedClips() {
    run_.config.profile = MotionProfileNamed("tiny");
    run_.pixels_per_metre = 60;
    run_.fps = 6;
    run_.betas = Eigen::VectorXd::Zero(BuiltinBody().num_betas());
    (*run_.betas)[0] = 2;
    driver_ = ShortTrack();
    driver_.motion.betas = Eigen::Vector2d(-1.5, 1);
  }
  AnimatedClipRequest Request() {
    WriteTrack(scratch_ / "driver.npz", driver_);
    AnimatedClipRequest request;
    request.track = scratch_ / "driver.npz";
    return request;
  }
  MotionRun run_;
  Track driver_;
  ScratchFolder scratch_;
};

TEST_F(AnimatedClips, ThePersonOfTheRunIsPosedInTheDriversMotion) {
  const AnimatedClip clip(Request(), run_);
  EXPECT_EQ(clip.track().motion.betas, *run_.betas);
  EXPECT_EQ(clip.track().motion.poses, driver_.motion.poses);
  EXPECT_THAT(clip.notes(), HasSubstr("carried over to the run's person"));
}

TEST_F(AnimatedClips, OrTheDriversOwnShape) {
  AnimatedClipRequest request = Request();
  request.shape_of_track = true;
  const AnimatedClip clip(request, run_);
  EXPECT_EQ(clip.track().motion.betas, driver_.motion.betas);
  EXPECT_EQ(clip.notes(), "");
}

TEST_F(AnimatedClips, ARunWithoutAShapePosesTheDriversAndSaysSo) {
  run_.betas.reset();
  const AnimatedClip clip(Request(), run_);
  EXPECT_EQ(clip.track().motion.betas, driver_.motion.betas);
  EXPECT_THAT(clip.notes(), HasSubstr("does not hold its person's shape"));
}

TEST_F(AnimatedClips, AShapeOfAnotherBodyIsRefused) {
  run_.betas = Eigen::VectorXd::Zero(BuiltinBody().num_betas() + 1);
  EXPECT_THROW(AnimatedClip(Request(), run_), std::runtime_error);
}

TEST_F(AnimatedClips, MotionIsDescribedAsInTraining) {
  const AnimatedClip camera(Request(), run_);
  run_.motion.frame = SurfaceFrame::kBody;
  SetVelocity("central", &run_.motion);
  const AnimatedClip body(Request(), run_);
  EXPECT_EQ(body.frames().options().motion.frame, SurfaceFrame::kBody);
  const size_t values = size_t(body.frames().channels()) * 64 * 64;
  std::vector<float> in_camera(values), in_body(values);
  camera.frames().MotionMaps(5, in_camera);
  body.frames().MotionMaps(5, in_body);
  EXPECT_NE(in_camera, in_body);
}

/// Ten past maps span the time that they spanned in training.
TEST_F(AnimatedClips, AFasterTrackIsShownAtTheRunsRate) {
  run_.betas = driver_.motion.betas;
  const AnimatedClip slow(Request(), run_);
  const Track at_rate = driver_;
  driver_ = ShortTrack(12);
  driver_.motion.betas = at_rate.motion.betas;
  const AnimatedClip fast(Request(), run_);
  EXPECT_EQ(slow.notes(), "");
  EXPECT_THAT(fast.notes(), HasSubstr("12 frames a second, is shown at the run's 6"));
  ASSERT_EQ(fast.frames().num_frames(), 12);
  ASSERT_LT((fast.track().motion.poses - at_rate.motion.poses).norm(), 1e-9) << "another walk: nothing to compare";
  const size_t values = size_t(fast.frames().channels()) * 64 * 64;
  std::vector<float> expected(values), found(values);
  slow.frames().MotionMaps(11, expected);
  fast.frames().MotionMaps(11, found);
  float largest = 0, moves = 0;
  for (size_t i = 0; i < values; ++i) {
    largest = std::max(largest, std::abs(found[i] - expected[i]));
    if (i >= values - 3 * 64 * 64) moves = std::max(moves, std::abs(expected[i]));
  }
  EXPECT_LT(largest, 0.02);
  EXPECT_GT(moves, 0.2) << "the last of the ten maps is empty";
}

}  // namespace
}  // namespace bodyloom::animated_clip_test
