// SPDX-License-Identifier: Apache-2.0
// Two people before one camera whose focal length nobody says.
#include "bodyloom/tracking/people/track_people.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/learned/lifter_weights_io.h"
#include "bodyloom/data_tools/learned/pose_prior_io.h"
#include "bodyloom/data_tools/synthesis/clips/demo_motion.h"
#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {
namespace {

SynthClip Clip(uint64_t seed) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  options.seed = seed;
  return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 40, 15), options);
}

TrackSequenceInput InputOf(const SynthClip& clip) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &clip.keypoints;
  input.prior = &BuiltinPosePrior();
  static const LifterWeights lifter = BuiltinLifter();
  input.lifter = &lifter;
  input.camera.width = clip.truth.camera.width;
  input.camera.height = clip.truth.camera.height;
  return input;
}

TrackSequenceOptions Options() {
  TrackSequenceOptions options;
  options.camera_knowledge = CameraKnowledge::kUnknownFocal;
  options.num_threads = 2;
  return options;
}

TEST(TrackPeople, OnePersonIsTrackedAsAlone) {
  const SynthClip clip = Clip(1);
  const TrackSequenceResult alone = TrackSequence(InputOf(clip), Options());
  const TrackPeopleResult together = TrackPeople({InputOf(clip)}, Options());
  ASSERT_EQ(together.people.size(), 1U);
  EXPECT_EQ(together.people[0].track.motion.poses, alone.track.motion.poses);
  EXPECT_EQ(together.people[0].track.motion.trans, alone.track.motion.trans);
  EXPECT_EQ(together.summary.fitted_again[0], 0);
  EXPECT_NEAR(together.summary.scene.focal_px, alone.summary.focal_px, 1e-9 * alone.summary.focal_px);
}

TEST(TrackPeople, HaveOneFocalLengthAndOneVertical) {
  const SynthClip a = Clip(1), b = Clip(2);
  const double truth = a.truth.camera.fx;
  const double f_a = TrackSequence(InputOf(a), Options()).track.camera.fx;
  const double f_b = TrackSequence(InputOf(b), Options()).track.camera.fx;
  ASSERT_NE(f_a, f_b);
  std::vector<double> fractions;
  TrackSequenceOptions options = Options();
  options.progress = [&](const TrackProgress& at) {
    fractions.push_back(at.fraction);
    return true;
  };
  const TrackPeopleResult together = TrackPeople({InputOf(a), InputOf(b)}, options);
  const double f = together.summary.scene.focal_px;
  EXPECT_EQ(together.people[0].track.camera.fx, f);
  EXPECT_EQ(together.people[1].track.camera.fx, f);
  // Not worse than the worse of both, and surer than either.
  const auto error = [&](double focal) { return std::abs(std::log(focal / truth)); };
  EXPECT_LE(error(f), std::max(error(f_a), error(f_b)));
  EXPECT_GT(together.summary.scene.focal_log_sigma, 0);
  EXPECT_LT(together.summary.scene.focal_log_sigma, 0.25);
  ASSERT_TRUE(together.summary.scene.has_up);
  for (const TrackSequenceResult& person : together.people) {
    EXPECT_GT(person.summary.ground.up.dot(together.summary.scene.ground.up), std::cos(2 * M_PI / 180));
  }
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_LE(fractions.back(), 1);
}

TEST(TrackPeople, FocalLengthsWhoseSpreadIsNotKnownAreNotTakenForKnownOnes) {
  const SynthClip a = Clip(1), b = Clip(2);
  TrackSequenceOptions options = Options();
  options.estimate_uncertainty = false;
  const TrackPeopleResult together = TrackPeople({InputOf(a), InputOf(b)}, options);
  EXPECT_EQ(together.summary.scene.focal_px, 0);
  for (const TrackSequenceResult& person : together.people) {
    EXPECT_TRUE(std::isnan(person.summary.focal_log_sigma));
    EXPECT_GT(person.track.camera.fx, 0);
  }
}

TEST(TrackPeople, StopsWhenItIsTold) {
  const SynthClip a = Clip(1), b = Clip(2);
  TrackSequenceOptions options = Options();
  options.progress = [](const TrackProgress&) { return false; };
  const TrackPeopleResult stopped = TrackPeople({InputOf(a), InputOf(b)}, options);
  EXPECT_EQ(stopped.people.size(), 2U);
  EXPECT_EQ(stopped.summary.fitted_again[0] + stopped.summary.fitted_again[1], 0);
}

TEST(TrackPeople, NobodyAndTwoCamerasAreRefused) {
  EXPECT_THROW(TrackPeople({}, Options()), std::invalid_argument);
  const SynthClip clip = Clip(1);
  TrackSequenceInput other = InputOf(clip);
  ++other.camera.width;
  EXPECT_THROW(TrackPeople({InputOf(clip), other}, Options()), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
