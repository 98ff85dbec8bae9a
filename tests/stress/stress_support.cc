// SPDX-License-Identifier: Apache-2.0
#include "tests/stress/stress_support.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

#include "data_tools/evaluation/metrics.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "geometry/math/rotation.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define BODYLOOM_ADDRESS_SANITIZER 1
#include <sanitizer/allocator_interface.h>
#endif
#endif

namespace bodyloom::stress {
namespace {

Eigen::Matrix3d Root(const Track& track, int t) {
  return RotationFromAxisAngle(track.motion.poses.row(t).head<3>().transpose());
}

}  // namespace

SynthClip ClipOf(const BodyModel& body, const Motion& motion, int dense, const SynthClipOptions& options) {
  SynthClipOptions mine = options;
  mine.dense_per_frame = dense;
  mine.num_threads = 1;
  return MakeSynthClip(body, motion, mine);
}

SynthClip DemoClip(const BodyModel& body, int frames, double fps, int dense, const SynthClipOptions& options) {
  return ClipOf(body, DemoMotion(body, frames, fps), dense, options);
}

TrackSequenceInput InputOf(const BodyModel& body, const SynthClip& clip) {
  TrackSequenceInput input;
  input.body = &body;
  input.keypoints = &clip.keypoints;
  const bool dense =
      std::any_of(clip.dense.frames.begin(), clip.dense.frames.end(), [](const auto& frame) { return !frame.empty(); });
  if (dense) input.dense = &clip.dense;
  input.prior = &BuiltinPosePrior();
  input.lifter = &BuiltinLifter();
  input.camera = clip.truth.camera;
  return input;
}

TrackSequenceOptions OptionsOf(const std::string& engine) {
  TrackSequenceOptions options;
  options.solver = SequenceSolverFromString(engine);
  options.num_threads = 1;
  options.estimate_uncertainty = false;
  return options;
}

void ExpectSound(const TrackSequenceResult& result, int frames) {
  const Track& track = result.track;
  const TrackSequenceSummary& summary = result.summary;
  if (!summary.IsUsable()) {
    EXPECT_FALSE(summary.message.empty()) << "a failure must say why";
    if (track.num_frames() == 0) return;
  }
  ASSERT_EQ(track.num_frames(), frames);
  ASSERT_EQ(track.frame_status.size(), static_cast<size_t>(frames));
  ASSERT_EQ(track.joints.size(), static_cast<size_t>(frames));
  int counted = 0;
  for (const auto& [name, count] : summary.frames_by_status) counted += count;
  EXPECT_EQ(counted, frames);
  for (int t = 0; t < frames; ++t) {
    if (track.frame_status[t] == FrameStatus::kLost) {
      EXPECT_FALSE(track.HasResult(t)) << "frame " << t << " says it is lost";
      continue;
    }
    ASSERT_TRUE(track.HasResult(t) && track.joints[t].allFinite() && track.coco17[t].allFinite())
        << "frame " << t << " is " << ToString(track.frame_status[t]);
  }
  EXPECT_TRUE(track.motion.betas.allFinite());
  EXPECT_TRUE(std::isfinite(summary.focal_px) && summary.focal_px > 0) << summary.focal_px;
  EXPECT_TRUE(std::isfinite(summary.reprojection_median_px) && std::isfinite(summary.reprojection_p95_px));
  EXPECT_TRUE(std::isfinite(summary.dense_median_px));
  if (!summary.IsUsable()) return;
  EXPECT_TRUE(std::isfinite(summary.final_cost)) << summary.final_cost;
  EXPECT_GE(summary.final_cost, 0);
}

TrackSequenceResult Fit(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  TrackSequenceResult result = FitClip(input, options);
  ExpectSound(result, input.keypoints != nullptr ? input.keypoints->num_frames() : input.dense->num_frames());
  return result;
}

double ErrorMm(const TrackSequenceResult& result, const SynthClip& clip, int t) {
  return 1000 * ProcrustesPositionError({&result.track.joints[t], 1}, {&clip.truth.joints[t], 1}).mean;
}

double ErrorMm(const TrackSequenceResult& result, const SynthClip& clip) {
  return 1000 * ProcrustesPositionError(result.track.joints, clip.truth.joints).mean;
}

double LargestDifference(const Track& a, const Track& b, const std::vector<int>& frames) {
  double largest = 0;
  for (const int t : frames) {
    const double difference = (a.joints[t] - b.joints[t]).rowwise().norm().maxCoeff();
    if (!(difference <= largest)) largest = difference;  // a NaN stays
  }
  return largest;
}

double LargestDifference(const Track& a, const Track& b) {
  std::vector<int> frames(a.num_frames());
  std::iota(frames.begin(), frames.end(), 0);
  return LargestDifference(a, b, frames);
}

double LargestStep(const Track& track) {
  double largest = 0;
  for (int t = 1; t < track.num_frames(); ++t) {
    largest = std::max(largest, AxisAngleFromRotation(Root(track, t - 1).transpose() * Root(track, t)).norm());
  }
  return largest;
}

double RootErrorRad(const TrackSequenceResult& result, const SynthClip& clip, int t) {
  return AxisAngleFromRotation(Root(result.track, t).transpose() * Root(clip.truth, t)).norm();
}

size_t BytesHeld() {
#ifdef BODYLOOM_ADDRESS_SANITIZER
  return __sanitizer_get_current_allocated_bytes();
#else
  malloc_trim(0);
  std::ifstream file("/proc/self/statm");
  size_t pages = 0, resident = 0;
  file >> pages >> resident;
  return resident * static_cast<size_t>(sysconf(_SC_PAGESIZE));
#endif
}

}  // namespace bodyloom::stress
