// SPDX-License-Identifier: Apache-2.0
// Tracks against sequences in the form of EMDB's and 3DPW's: the numbers are those against the same motion as a track.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "pipelines/score/evaluate_track.h"
#include "tests/data_tools/datasets/video_truth_files.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom::evaluate_video_truth_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A person filmed by a camera that moves, 30 frames a second.
Track Truth() {
  Track track = ShortTrack(30, SynthCameraMotion::kWalking);
  track.joints.clear();
  track.coco17.clear();
  track.joint_sigma.resize(0, 0);
  track.motion.betas = Eigen::VectorXd::Zero(10);
  return track;
}

/// The same with errors of pose and place.
Track Estimate() {
  Track track = Truth();
  for (int t = 0; t < track.num_frames(); ++t) {
    track.motion.poses(t, 12) += 0.2;
    track.motion.trans(t, 0) += 0.05 + 0.002 * t;
  }
  track.motion.betas[0] += 0.5;
  return track;
}

class EvaluateVideoTruth : public ::testing::Test {
 protected:
  EvaluateVideoTruth() {
    request_.track = folder_ / "track.npz";
    WriteTrack(request_.track, Estimate());
  }

  Evaluation Against(const std::string& name, const std::string& bytes) {
    request_.truth = folder_ / name;
    WriteFileAtomically(request_.truth, bytes);
    PipelineCallbacks callbacks;
    callbacks.message = [this](const std::string& text) { said_.push_back(text); };
    return EvaluateTrack(request_, callbacks);
  }

  Evaluation AgainstTrack(const Track& truth) {
    request_.truth = folder_ / "truth.npz";
    WriteTrack(request_.truth, truth);
    return EvaluateTrack(request_);
  }

  const ScratchFolder folder_;
  EvaluateTrackRequest request_;
  std::vector<std::string> said_;
};

TEST_F(EvaluateVideoTruth, EmdbGivesTheNumbersOfTheSameTrack) {
  const Track truth = Truth();
  const std::vector<uint8_t> all(size_t(truth.num_frames()), 1);
  const Evaluation emdb = Against("P0_data.pkl", EmdbPickle(truth, all, "neutral"));
  EXPECT_EQ(emdb.protocol, "emdb");
  EXPECT_GT(emdb.Value("pa_mpjpe_mm"), 5);
  EXPECT_EQ(emdb.frames, truth.num_frames());
  EXPECT_TRUE(std::isnan(emdb.Value("w_mpjpe_100_mm"))) << "no 100 frames";
  EXPECT_GT(emdb.Value("rte_percent"), 1);
  EXPECT_TRUE(said_.empty());
  const Evaluation track = AgainstTrack(truth);
  for (const char* name : {"pa_mpjpe_mm", "mpjpe_mm", "pve_mm", "accel_err_ms2", "rte_percent", "projection_mean_px"}) {
    EXPECT_NEAR(emdb.Value(name), track.Value(name), 1e-9 * (1 + std::abs(track.Value(name)))) << name;
  }
}

TEST_F(EvaluateVideoTruth, FramesThatAreNotGoodAreLeftOut) {
  const Track truth = Truth();
  std::vector<uint8_t> good(size_t(truth.num_frames()), 1);
  good[7] = good[8] = 0;
  const Evaluation some = Against("P0_data.pkl", EmdbPickle(truth, good, "male"));
  EXPECT_EQ(some.frames, truth.num_frames() - 2);
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_THAT(said_[0], HasSubstr("of SMPL's male body"));
}

TEST_F(EvaluateVideoTruth, ThePersonOfThreeDpwAndABodyOfItsOwn) {
  const Track truth = Truth();
  Track other = truth;
  other.motion.trans.array() += 3;
  const std::vector<uint8_t> all(size_t(truth.num_frames()), 1);
  const std::string bytes = ThreeDpwPickle({other, truth}, {all, all});
  request_.true_person = 1;
  const Evaluation second = Against("seq.pkl", bytes);
  EXPECT_EQ(second.protocol, "3dpw");
  request_.true_person = 0;
  EXPECT_GT(Against("seq.pkl", bytes).Value("root_err_mm"), 1000 + second.Value("root_err_mm"));
  // On its own body the truth is as on the track's, if they are the same.
  request_.true_person = 1;
  request_.true_body = folder_ / "body.npz";
  WriteFileAtomically(request_.true_body, "no body");
  EXPECT_THAT([&] { Against("seq.pkl", bytes); }, ThrowsMessage<std::runtime_error>(HasSubstr("body.npz")));
}

TEST_F(EvaluateVideoTruth, OptionsOfOthersAreRefused) {
  request_.truth = folder_ / "truth.npz";
  WriteTrack(request_.truth, Truth());
  request_.true_person = 1;
  EXPECT_THAT([&] { EvaluateTrack(request_); }, ThrowsMessage<RequestError>(HasSubstr("give --truth FILE.pkl")));
}

}  // namespace
}  // namespace bodyloom::evaluate_video_truth_test
