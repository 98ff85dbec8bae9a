// SPDX-License-Identifier: Apache-2.0
/// bodyloom_bench_motions: motion that the split keeps for testing, by class, through the tracker, with and without the
/// clip's own vertical and ground.
///
///   bodyloom_bench_motions --motions FOLDER[,FOLDER…] [--frames 240] [--elevation 8,30] [--json F]
///
/// Every test clip (its first frames at 30 a second) in front of a synthetic camera of known focal length, with a
/// detector's noise (data_tools/synthesis/clips/detection_noise.h), its toes and heels left out. pa: PA-MPJPE, mpjpe:
/// mid-hip aligned, both of COCO-17 in mm. slide: mean speed of the ankles, m/s, in frames in which the true ones stand
/// (below 0.1 m/s). ground: clips in which one was found. Means over clips; the body's stature is the true one.
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/dense_clips.h"
#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/evaluation/metrics.h"
#include "bodyloom/data_tools/learned/lifter_weights_io.h"
#include "bodyloom/data_tools/learned/pose_prior_io.h"
#include "bodyloom/data_tools/motion/motion_library.h"
#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {
namespace {

constexpr double kFps = 30, kStandingSpeed = 0.1;

struct Sums {
  double pa = 0, mpjpe = 0, slide = 0, seconds = 0;
  int clips = 0, sliding_clips = 0, grounds = 0;
};

/// Mean speed of the estimate's ankles where the true ones stand; NaN when they never do.
double Slide(const Track& track, const Track& truth) {
  double sum = 0;
  int count = 0;
  for (int t = 1; t + 1 < truth.num_frames(); ++t) {
    for (const int ankle : {15, 16}) {
      const auto speed = [&](const Track& of) {
        return 0.5 * kFps * (of.coco17[t + 1].row(ankle) - of.coco17[t - 1].row(ankle)).norm();
      };
      if (!(speed(truth) < kStandingSpeed)) continue;
      sum += speed(track);
      ++count;
    }
  }
  return count > 0 ? sum / count : kNotMeasured;
}

void TrackAndAdd(const SynthClip& clip, bool ground, Sums* sums) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.prior = &BuiltinPosePrior();
  input.lifter = &BuiltinLifter();
  input.keypoints = &clip.keypoints;
  input.camera = clip.truth.camera;
  TrackSequenceOptions options;
  options.estimate_uncertainty = false;
  if (!ground) options.ground = GroundOptions::Off();
  const TrackSequenceResult result = TrackSequence(input, options);
  if (!result.summary.IsUsable()) return;
  const std::vector<int> hips = {11, 12};
  const auto &found = result.track.coco17, &truth = clip.truth.coco17;
  ++sums->clips;
  sums->pa += 1e3 * ProcrustesPositionError(found, truth).mean;
  sums->mpjpe += 1e3 * MeanPositionError(RelativeTo(found, RootPositions(found, hips)),
                                         RelativeTo(truth, RootPositions(truth, hips)))
                           .mean;
  const double slide = Slide(result.track, clip.truth);
  if (std::isfinite(slide)) {
    sums->slide += slide;
    ++sums->sliding_clips;
  }
  sums->grounds += result.summary.ground.has_plane ? 1 : 0;
  for (const auto& [stage, seconds] : result.summary.seconds) sums->seconds += seconds;
}

void Run(const BenchArguments& arguments, const std::string& command) {
  std::map<std::pair<std::string, std::string>, std::map<std::string, Sums>> groups;  // by (camera, ground), by class
  MotionLibraryOptions library;
  library.visit_train = false;
  VisitMotionLibrary(arguments.List("motions"), library, [&](LibraryClip&& clip) {
    Motion motion = ResampleMotion(clip.motion, kFps);
    motion = TakeFrames(motion, 0, std::min(arguments.Integer("frames"), motion.num_frames()));
    for (const std::string& elevation : arguments.List("elevation")) {
      SynthClipOptions options;
      options.dense_per_frame = 0;
      options.camera.elevation_deg = std::stod(elevation);
      options.camera.yaw_deg = 30;
      SynthClip synthetic = MakeSynthClip(BuiltinBody(), motion, options);
      LeaveOutFeet(&synthetic.keypoints);
      for (const bool ground : {true, false}) {
        TrackAndAdd(synthetic, ground,
                    &groups[{elevation, ground ? "vertical and ground" : "neither"}][clip.motion_class]);
      }
    }
    std::fprintf(stderr, "%s %s\n", clip.motion_class.c_str(), clip.name.c_str());
  });
  BenchReport report;
  report.title = "Motion kept for testing through the tracker, synthetic detections";
  report.command = command;
  report.label_columns = {"class", "clips"};
  report.value_columns = {"pa_mpjpe_mm", "mpjpe_mm", "slide_ms", "ground", "s"};
  for (const auto& [key, classes] : groups) {
    for (const auto& [name, sums] : classes) {
      const double n = std::max(1, sums.clips);
      BenchRow row;
      row.group = Concatenate("camera ", key.first, " degrees from above, ", key.second);
      row.labels = {name, std::to_string(sums.clips)};
      row.values = {sums.pa / n, sums.mpjpe / n,
                    sums.sliding_clips > 0 ? sums.slide / sums.sliding_clips : kNotMeasured, double(sums.grounds),
                    sums.seconds / n};
      report.rows.push_back(row);
    }
  }
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain(
      "bodyloom_bench_motions", argc, argv,
      {{"motions", bodyloom::SharedMotions()}, {"frames", "240"}, {"elevation", "8,30"}, {"json", ""}}, bodyloom::Run);
}
