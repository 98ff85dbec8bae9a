// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/camera_knowledge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "tests/support/clip_input.h"
#include "tests/support/sequence_scene.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/clip/uncertainty.h"

namespace bodyloom::focal_length_test {
namespace {

/// A fit's posterior when its clip measured log f = x with this variance.
FocalFit Posterior(double x, double variance, const FocalPrior& prior) {
  const double prior_information = 1 / (prior.log_sigma * prior.log_sigma), own = prior_information + 1 / variance;
  return {(prior_information * prior.log_mean + x / variance) / own, 1 / std::sqrt(own)};
}

TEST(FocalLength, AFitIsAMeasurementThatErrsByWhatFitsErrBy) {
  const FocalPrior prior{.log_mean = 7, .log_sigma = 0.25};
  for (const double variance : {1e-8, 1e-3, 0.5}) {
    const FocalFit fit = Posterior(6.2, variance, prior), joined = JoinFocalFits({&fit, 1}, prior);
    const double v = variance + kFocalFitLogSigma * kFocalFitLogSigma, s2 = prior.log_sigma * prior.log_sigma;
    EXPECT_NEAR(joined.log_px, (7 / s2 + 6.2 / v) / (1 / s2 + 1 / v), 1e-6) << variance;
    EXPECT_NEAR(joined.log_sigma, 1 / std::sqrt(1 / s2 + 1 / v), 1e-6) << variance;
  }
}

TEST(FocalLength, WithoutAFitItIsThePrior) {
  const FocalPrior prior{.log_mean = 7, .log_sigma = 0.1};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<FocalFit> useless = {
      {6, nan}, {nan, 0.1}, {6, 0}, {6, -1}, {6.5, 0.1}};  // the last is the prior's width
  const FocalFit joined = JoinFocalFits(useless, prior);
  EXPECT_EQ(joined.log_px, 7);
  EXPECT_EQ(joined.log_sigma, 0.1);
}

TEST(FocalLength, OfALensByItsDiagonalAngleOfView) {
  // 50 mm on 36 x 24 mm, and 3000 x 2000 pixels: 50 / 36 of the width.
  EXPECT_NEAR(std::exp(FocalPrior::ForLens(3000, 2000, 50, 0.05).log_mean), 50.0 / 36 * 3000, 1e-9);
  EXPECT_NEAR(std::exp(FocalPrior::ForLens(2000, 3000, 50, 0.05).log_mean), 50.0 / 36 * 3000, 1e-9);
  EXPECT_EQ(FocalPrior::ForLens(3000, 2000, 50, 0.05).log_sigma, 0.05);
}

TEST(FocalLength, ItsSpreadIsThatOfTheWholeCovariance) {
  SequenceSceneOptions options;
  options.frames = 7;
  options.knowledge = CameraKnowledge::kUnknownFocal;
  const auto scene = MakeSequenceScene(options);
  double expected = 0;
  PositionSigmaOf(scene->problem, 1, &expected);
  EXPECT_GT(expected, 0);
  EXPECT_NEAR(FocalLogSigmaOf(scene->problem, 1), expected, 1e-9 * expected);
  options.knowledge = CameraKnowledge::kKnown;
  EXPECT_TRUE(std::isnan(FocalLogSigmaOf(MakeSequenceScene(options)->problem, 1)));
}

SynthClip SeenClip(int frames, double fps) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), frames, fps), options);
}

/// A synthetic clip whose focal length nobody says.
TrackSequenceResult TrackUnknownFocal(const SynthClip& clip, const std::optional<FocalPrior>& prior) {
  TrackSequenceInput input = UnknownFocalInput(clip);
  input.focal_prior = prior;
  return FitClip(input, UnknownFocalOptions());
}

TEST(FocalLength, ATrackHasWhatItsDetectionsAndThePriorSayTogether) {
  const SynthClip clip = SeenClip(60, 20);
  const Camera& camera = clip.truth.camera;
  const TrackSequenceResult free = TrackUnknownFocal(clip, std::nullopt);
  ASSERT_TRUE(free.summary.IsUsable());
  ASSERT_TRUE(free.summary.focal_fit);
  const FocalFit joined =
      JoinFocalFits({&*free.summary.focal_fit, 1}, FocalPrior::ForImage(camera.width, camera.height));
  EXPECT_NEAR(std::log(free.summary.focal_px), joined.log_px, 1e-3);
  EXPECT_EQ(free.summary.focal_log_sigma, joined.log_sigma);
  // The distance is as uncertain as the focal length.
  const double z = free.track.joints[30](0, 2);
  EXPECT_GT(free.track.root_sigma[30], 0.9 * joined.log_sigma * z / std::sqrt(3));

  // Of a lens that is known well, little else is left; the person is where it says.
  const double lens_mm = 35, sigma = 0.01;
  const FocalPrior lens = FocalPrior::ForLens(camera.width, camera.height, lens_mm, sigma);
  const TrackSequenceResult held = TrackUnknownFocal(clip, lens);
  ASSERT_TRUE(held.summary.IsUsable());
  EXPECT_NEAR(std::log(held.summary.focal_px), lens.log_mean, 2 * sigma);
  EXPECT_LT(held.summary.focal_log_sigma, 1.01 * sigma);
  EXPECT_NEAR(held.track.joints[30](0, 2) / z, held.summary.focal_px / free.summary.focal_px, 0.03);
  EXPECT_LT(held.summary.reprojection_median_px, 1.1 * free.summary.reprojection_median_px);
}

TEST(FocalLength, APriorThatIsNoneIsRefused) {
  const SynthClip clip = SeenClip(10, 20);
  for (const FocalPrior& prior : {FocalPrior{7, 0}, FocalPrior{7, -1}, FocalPrior{std::nan(""), 0.1}}) {
    EXPECT_THROW(TrackUnknownFocal(clip, prior), std::invalid_argument);
  }
}

}  // namespace
}  // namespace bodyloom::focal_length_test
