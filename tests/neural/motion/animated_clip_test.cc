// SPDX-License-Identifier: Apache-2.0
// Another person's motion, shown by the person that the motion-dependent renderer learned.
#include "bodyloom/pipelines/neural/motion/animated_clip.h"

#include <gmock/gmock.h>

#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom {
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

}  // namespace
}  // namespace bodyloom
