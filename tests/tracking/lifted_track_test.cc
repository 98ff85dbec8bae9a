// SPDX-License-Identifier: Apache-2.0
// The tracker with the built-in lifter, on synthetic clips with known truth and on clips that show too little.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom::lifted_track_test {
namespace {

SynthClip Clip(int frames, double fps, double elevation_deg = 8) {
  SynthClipOptions options;
  options.dense_per_frame = 0;
  options.camera.elevation_deg = elevation_deg;
  return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), frames, fps), options);
}

TrackSequenceResult TrackWithLifter(const KeypointSequence& keypoints, const Camera& camera,
                                    CameraKnowledge knowledge = CameraKnowledge::kKnown, int threads = 2,
                                    const GroundOptions& ground = {}) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &keypoints;
  input.prior = &BuiltinPosePrior();
  input.lifter = &BuiltinLifter();
  input.camera = camera;
  TrackSequenceOptions options;
  options.camera_knowledge = knowledge;
  options.num_threads = threads;
  options.ground = ground;
  return FitClip(input, options);
}

double PaMpjpe(const TrackSequenceResult& result, const SynthClip& clip) {
  return 1000 * ProcrustesPositionError(result.track.joints, clip.truth.joints).frames.mean;
}

bool Ran(const TrackSequenceResult& result, const std::string& what) {
  for (const PlanEntry& entry : result.summary.plan) {
    if (entry.what == what) return entry.runs;
  }
  ADD_FAILURE() << "the plan does not speak of " << what;
  return false;
}

/// Every frame has finite poses, or says that it has none.
void ExpectHonest(const TrackSequenceResult& result) {
  if (!result.summary.IsUsable()) {
    EXPECT_FALSE(result.summary.message.empty());
    return;
  }
  for (int t = 0; t < result.track.num_frames(); ++t) {
    if (!result.track.HasResult(t)) {
      EXPECT_EQ(result.track.frame_status[t], FrameStatus::kLost) << t;
      continue;
    }
    EXPECT_TRUE(result.track.joints[t].allFinite()) << t;
  }
}

TEST(LiftedTrack, FindsThePoseInEveryCamera) {
  const SynthClip clip = Clip(60, 20);
  for (const CameraKnowledge knowledge :
       {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    const TrackSequenceResult result = TrackWithLifter(clip.keypoints, clip.truth.camera, knowledge);
    ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
    EXPECT_TRUE(Ran(result, "lifter"));
    EXPECT_TRUE(Ran(result, "initialiser term (L_d)"));
    EXPECT_FALSE(Ran(result, "hypotheses over the clip"));
    EXPECT_LT(PaMpjpe(result, clip), 70) << static_cast<int>(knowledge);
    EXPECT_LT(result.summary.reprojection_median_px, 12);
  }
}

TrackSequenceResult TrackDenseAlone(const SynthClip& clip, CameraKnowledge knowledge) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.dense = &clip.dense;
  input.prior = &BuiltinPosePrior();
  input.lifter = &BuiltinLifter();
  input.camera = clip.truth.camera;
  TrackSequenceOptions options;
  options.camera_knowledge = knowledge;
  options.num_threads = 2;
  return FitClip(input, options);
}

TEST(LiftedTrack, ReadsJointsAmongDenseKeypointsWhereThereAreNoOthers) {
  SynthClipOptions synth;
  synth.dense_per_frame = 200;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 60, 20), synth);
  for (const CameraKnowledge knowledge :
       {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    const TrackSequenceResult result = TrackDenseAlone(clip, knowledge);
    ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
    EXPECT_TRUE(Ran(result, "lifter"));
    EXPECT_TRUE(Ran(result, "vertical"));
    EXPECT_FALSE(Ran(result, "2D joints (L_f)"));
    // Weak perspective is not how the clip was seen, and the pose makes up for it.
    EXPECT_LT(PaMpjpe(result, clip), knowledge == CameraKnowledge::kWeak ? 70 : 5) << static_cast<int>(knowledge);
  }
}

TEST(LiftedTrack, DenseKeypointsAloneTellACut) {
  Motion motion = DemoMotion(BuiltinBody(), 40, 20);
  motion.trans.block(20, 0, 20, 1).array() += 1.5;  // from one frame to the next
  SynthClipOptions synth;
  synth.dense_per_frame = 200;
  const SynthClip clip = MakeSynthClip(BuiltinBody(), motion, synth);
  const TrackSequenceResult result = TrackDenseAlone(clip, CameraKnowledge::kKnown);
  ASSERT_TRUE(result.summary.IsUsable());
  for (const int t : {19, 20}) {
    const double off = (result.track.joints[t].row(0) - clip.truth.joints[t].row(0)).head<2>().norm();
    EXPECT_LT(off, 0.02) << "metres, frame " << t;
  }
}

/// Mean speed of ankles, m/s, in frames in which the true ones stand.
double SlidingOfFeet(const TrackSequenceResult& result, const SynthClip& clip) {
  double sum = 0;
  int count = 0;
  for (const char* name : {"l_ankle", "r_ankle"}) {
    const int ankle = BuiltinBody().FindJoint(name);
    for (int t = 1; t + 1 < result.track.num_frames(); ++t) {
      const double seconds = clip.keypoints.timestamps[t + 1] - clip.keypoints.timestamps[t - 1];
      const auto speed = [&](const std::vector<MatrixX3d>& joints) {
        return (joints[t + 1].row(ankle) - joints[t - 1].row(ankle)).norm() / seconds;
      };
      if (speed(clip.truth.joints) > 0.1) continue;
      sum += speed(result.track.joints);
      ++count;
    }
  }
  return sum / std::max(1, count);
}

TEST(LiftedTrack, FindsVerticalAndGroundUnderTiltedCameras) {
  for (const double elevation : {0.0, 20.0, 35.0}) {
    const SynthClip clip = Clip(120, 20, elevation);
    const TrackSequenceResult with = TrackWithLifter(clip.keypoints, clip.truth.camera),
                              without = TrackWithLifter(clip.keypoints, clip.truth.camera, CameraKnowledge::kKnown, 2,
                                                        GroundOptions::Off());
    const GroundSummary& ground = with.summary.ground;
    ASSERT_TRUE(ground.has_up) << elevation;
    EXPECT_LT(std::acos(std::min(1.0, ground.up.dot(clip.up_in_camera))) * 180 / M_PI, 8) << elevation;
    ASSERT_TRUE(ground.has_plane) << elevation << ": " << ground.why;
    // Metric scale is the mean body's, so heights are within a tenth or so.
    const double height_m = -clip.camera_from_world.camera_from_world_translation.dot(clip.up_in_camera);
    EXPECT_NEAR(ground.camera_height_m, height_m, 0.15 * height_m + 0.15) << elevation;
    EXPECT_GT(ground.contact_frames, 40) << elevation;
    EXPECT_LT(SlidingOfFeet(with, clip), 0.6 * SlidingOfFeet(without, clip)) << elevation;
    EXPECT_LT(PaMpjpe(with, clip), PaMpjpe(without, clip) + 2) << elevation;
    EXPECT_FALSE(without.summary.ground.has_plane);
    EXPECT_FALSE(without.summary.ground.why.empty());
  }
}

TEST(LiftedTrack, GroundForEveryCamera) {
  const SynthClip clip = Clip(80, 20, 15);
  for (const CameraKnowledge knowledge : {CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    const TrackSequenceResult result = TrackWithLifter(clip.keypoints, clip.truth.camera, knowledge);
    ASSERT_TRUE(result.summary.IsUsable());
    EXPECT_TRUE(result.summary.ground.has_plane) << static_cast<int>(knowledge);
    EXPECT_LT(PaMpjpe(result, clip), 70) << static_cast<int>(knowledge);
  }
}

TEST(LiftedTrack, NoGroundWhereOnlyTheUpperBodyIsSeen) {
  SynthClip clip = Clip(60, 20);
  for (int k = 0; k < clip.keypoints.num_points(); ++k) {
    for (const char* part : {"hip", "knee", "ankle", "toe", "heel"}) {
      if (clip.keypoints.names[k].find(part) == std::string::npos || std::string(part) == "hip") continue;
      for (int t = 0; t < 60; ++t) clip.keypoints.at(t, k).confidence = 0;
    }
  }
  const TrackSequenceResult result = TrackWithLifter(clip.keypoints, clip.truth.camera);
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_FALSE(result.summary.ground.has_plane);
  EXPECT_EQ(result.summary.ground.contact_frames, 0);
  EXPECT_FALSE(result.summary.ground.why.empty());
}

TEST(LiftedTrack, AnyFrameRate) {
  for (const double fps : {5.0, 25.0, 60.0, 240.0}) {
    const SynthClip clip = Clip(static_cast<int>(2 * fps) + 1, fps);
    const TrackSequenceResult result = TrackWithLifter(clip.keypoints, clip.truth.camera);
    ASSERT_TRUE(result.summary.IsUsable()) << fps;
    ExpectHonest(result);
    EXPECT_LT(PaMpjpe(result, clip), 90) << fps;
  }
}

TEST(LiftedTrack, SameBytesForAnyNumberOfThreads) {
  const SynthClip clip = Clip(40, 60);
  const TrackSequenceResult one = TrackWithLifter(clip.keypoints, clip.truth.camera, CameraKnowledge::kKnown, 1),
                            four = TrackWithLifter(clip.keypoints, clip.truth.camera, CameraKnowledge::kKnown, 4);
  ASSERT_TRUE(one.summary.IsUsable());
  EXPECT_EQ(one.track.motion.poses, four.track.motion.poses);
  EXPECT_EQ(one.track.motion.trans, four.track.motion.trans);
}

TEST(LiftedTrack, HalfTheBodyMissingForSecondsIsBridged) {
  SynthClip clip = Clip(120, 20);
  for (int t = 40; t < 90; ++t) {
    for (int k = 0; k < clip.keypoints.num_points(); ++k) {
      const std::string& name = clip.keypoints.names[k];
      const bool lower = name.find("hip") != std::string::npos || name.find("knee") != std::string::npos ||
                         name.find("ankle") != std::string::npos || name.find("toe") != std::string::npos ||
                         name.find("heel") != std::string::npos;
      if (lower) clip.keypoints.at(t, k).confidence = 0;
    }
  }
  const TrackSequenceResult result = TrackWithLifter(clip.keypoints, clip.truth.camera);
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  ExpectHonest(result);
  // Unobserved joints have larger uncertainty: the ankles, half way through the gap, against a frame that shows them.
  const int ankle = BuiltinBody().FindJoint("l_ankle");
  ASSERT_GE(ankle, 0);
  EXPECT_GT(result.track.joint_sigma(65, ankle), 1.5 * result.track.joint_sigma(20, ankle));
}

TEST(LiftedTrack, ClipsThatShowAlmostNothing) {
  const SynthClip clip = Clip(30, 20);
  KeypointSequence one_joint = clip.keypoints, nothing = clip.keypoints, loud = clip.keypoints;
  for (Keypoint& point : nothing.points) point.confidence = 0;
  for (Keypoint& point : loud.points) point.confidence *= 40;
  for (int t = 0; t < 30; ++t) {
    for (int k = 1; k < one_joint.num_points(); ++k) one_joint.at(t, k).confidence = 0;
  }
  ExpectHonest(TrackWithLifter(one_joint, clip.truth.camera));
  EXPECT_FALSE(TrackWithLifter(nothing, clip.truth.camera).summary.IsUsable());
  const TrackSequenceResult result = TrackWithLifter(loud, clip.truth.camera);
  ExpectHonest(result);
  EXPECT_LT(PaMpjpe(result, clip), 90);
  for (const int frames : {1, 2}) ExpectHonest(TrackWithLifter(Clip(frames, 20).keypoints, clip.truth.camera));
}

TEST(LiftedTrack, AMirroredVideoGivesTheMirroredPerson) {
  const SynthClip clip = Clip(40, 20);
  const Camera camera = MakePinhole(clip.truth.camera.width, clip.truth.camera.height, clip.truth.camera.fx);
  KeypointSequence mirrored = clip.keypoints;
  const auto partner = [&](const std::string& name) {
    if (name.starts_with("left_")) return "right_" + name.substr(5);
    if (name.starts_with("right_")) return "left_" + name.substr(6);
    return name;
  };
  for (int k = 0; k < mirrored.num_points(); ++k) {
    const auto from = std::find(mirrored.names.begin(), mirrored.names.end(), partner(mirrored.names[k]));
    ASSERT_NE(from, mirrored.names.end());
    for (int t = 0; t < 40; ++t) {
      mirrored.at(t, k) = clip.keypoints.at(t, static_cast<int>(from - mirrored.names.begin()));
      mirrored.at(t, k).x = static_cast<float>(camera.width - 1) - mirrored.at(t, k).x;
    }
  }
  const TrackSequenceResult a = TrackWithLifter(clip.keypoints, camera), b = TrackWithLifter(mirrored, camera);
  ASSERT_TRUE(a.summary.IsUsable() && b.summary.IsUsable());
  double off = 0;
  for (int t = 0; t < 40; ++t) {
    for (int k = 0; k < 17; ++k) {
      const int from = k == 0 ? 0 : ((k - 1) ^ 1) + 1;
      const Eigen::RowVector3d expected = a.track.coco17[t].row(from).cwiseProduct(Eigen::RowVector3d(-1, 1, 1));
      off = std::max(off, (b.track.coco17[t].row(k) - expected).norm());
    }
  }
  EXPECT_LT(off, 0.02) << "metres, of the joint that differs most; the built-in body is symmetric";
}

}  // namespace
}  // namespace bodyloom::lifted_track_test
