// SPDX-License-Identifier: Apache-2.0
// The tracker end to end on a synthetic clip of a moving camera.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/world_drift.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/scene/camera_path.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/live/track_live.h"
#include "tracking/people/track_people.h"

namespace bodyloom::moving_track_test {
namespace {

/// Somebody walks, and a camera goes along.
class MovingTrack : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    SynthClipOptions options;
    options.dense_per_frame = 0;
    options.camera_path.motion = SynthCameraMotion::kWalking;
    clip_ = new SynthClip(MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 75, 15), options));
  }
  static void TearDownTestSuite() {
    delete clip_;
    clip_ = nullptr;
  }
  static TrackSequenceInput Input(const std::vector<CameraPose>* path, double scale_m = 1) {
    TrackSequenceInput input;
    input.body = &BuiltinBody();
    input.keypoints = &clip_->keypoints;
    input.prior = &BuiltinPosePrior();
    input.lifter = &BuiltinLifter();
    input.camera = clip_->truth.camera;
    input.camera_from_scene = path;
    input.camera_scale_m = scale_m;
    return input;
  }
  static TrackSequenceOptions Options() {
    TrackSequenceOptions options;
    options.estimate_uncertainty = false;
    options.num_threads = 2;
    return options;
  }
  static const std::vector<CameraPose>& path() { return clip_->truth.camera_from_scene; }
  static WorldDrift DriftOf(const TrackSequenceResult& result) {
    return MeasureWorldDrift(result.track, clip_->truth, BuiltinBody());
  }

  static const SynthClip* clip_;
};
const SynthClip* MovingTrack::clip_ = nullptr;

TEST_F(MovingTrack, TheWorldIsRightWithThePathAndWrongWithout) {
  const TrackSequenceResult with = FitClip(Input(&path()), Options());
  const TrackSequenceResult without = FitClip(Input(nullptr), Options());
  ASSERT_TRUE(with.summary.IsUsable() && without.summary.IsUsable());
  EXPECT_EQ(with.track.camera_from_scene.size(), path().size());
  EXPECT_TRUE(with.summary.camera_path.moves);
  EXPECT_LT(DriftOf(with).w_mpjpe_m, 0.25);
  EXPECT_GT(DriftOf(without).w_mpjpe_m, 3 * DriftOf(with).w_mpjpe_m);
  EXPECT_GT(without.summary.ground.standing_speed_mps, 2 * with.summary.ground.standing_speed_mps);
  // In the picture both are right.
  EXPECT_LT(1e3 * ProcrustesPositionError(with.track.joints, clip_->truth.joints).mean, 60);
  EXPECT_NEAR(with.summary.reprojection_median_px, without.summary.reprojection_median_px, 2);
}

TEST_F(MovingTrack, ALengthIsFoundFromStandingFeet) {
  const std::vector<CameraPose> unit = ScaledPath(path(), 1 / 4.0);
  const TrackSequenceResult result = FitClip(Input(&unit, 0), Options());
  const CameraPathSummary& found = result.summary.camera_path;
  ASSERT_GT(found.scale_m, 0) << found.why;
  EXPECT_TRUE(found.estimated);
  EXPECT_NEAR(found.scale_m, 4, 0.6);
  EXPECT_GT(found.sigma_m, 0);
  EXPECT_NEAR(result.track.camera_from_scene[40].camera_from_world_translation.norm(),
              found.scale_m * unit[40].camera_from_world_translation.norm(), 1e-9);
  EXPECT_LT(DriftOf(result).w_mpjpe_m, 0.3);
}

TEST_F(MovingTrack, APathThatStandsStillChangesNothing) {
  const std::vector<CameraPose> still(path().size());
  const TrackSequenceResult moving = FitClip(Input(&still), Options());
  const TrackSequenceResult none = FitClip(Input(nullptr), Options());
  // The same problem by other sums: equal but for rounding, which the stages' tolerances stretch.
  EXPECT_LT((moving.track.motion.trans - none.track.motion.trans).cwiseAbs().maxCoeff(), 1e-3);
}

TEST_F(MovingTrack, BothEnginesAgree) {
  TrackSequenceOptions options = Options();
  options.function_tolerance = 1e-9;
  options.max_iterations = options.max_fine_iterations = 200;
  const TrackSequenceResult chain = FitClip(Input(&path()), options);
  options.solver = SequenceSolver::kCeres;
  const TrackSequenceResult ceres = FitClip(Input(&path()), options);
  EXPECT_NEAR(chain.summary.final_cost, ceres.summary.final_cost, 1e-3 * ceres.summary.final_cost);
  EXPECT_LT((chain.track.motion.trans - ceres.track.motion.trans).cwiseAbs().maxCoeff(), 0.02);
}

TEST_F(MovingTrack, RefusesWhatCannotMove) {
  TrackSequenceOptions weak = Options();
  weak.camera_knowledge = CameraKnowledge::kWeak;
  EXPECT_THROW(FitClip(Input(&path()), weak), std::invalid_argument);
  const std::vector<CameraPose> few(path().begin(), path().begin() + 5);
  EXPECT_THROW(FitClip(Input(&few), Options()), std::invalid_argument);
  std::vector<CameraPose> bent = path();
  bent[3].camera_from_world_rotation *= 1.1;
  EXPECT_THROW(FitClip(Input(&bent), Options()), std::invalid_argument);
  EXPECT_THROW(FitClip(Input(&path(), -1), Options()), std::invalid_argument);
  EXPECT_THROW(TrackLive(Input(&path()), {}), std::invalid_argument);
  EXPECT_THROW(TrackPeople({Input(&path()), Input(nullptr)}, Options()), std::invalid_argument);
}

TEST_F(MovingTrack, PeopleShareOneScale) {
  const std::vector<CameraPose> unit = ScaledPath(path(), 1 / 4.0);
  // The same person twice: what matters is that both end in one scene.
  const TrackPeopleResult result = TrackPeople({Input(&unit, 0), Input(&unit, 0)}, Options());
  ASSERT_TRUE(result.people[0].summary.IsUsable() && result.people[1].summary.IsUsable());
  for (size_t t = 0; t < unit.size(); ++t) {
    EXPECT_EQ(result.people[0].track.camera_from_scene[t].camera_from_world_translation,
              result.people[1].track.camera_from_scene[t].camera_from_world_translation);
  }
  EXPECT_THAT(result.summary.scene.size, ::testing::Each(1));
}

}  // namespace
}  // namespace bodyloom::moving_track_test
