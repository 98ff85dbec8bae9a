// SPDX-License-Identifier: Apache-2.0
/// bodyloom_bench_motions: motion that the split keeps for testing, by class, through the tracker, with and without the
/// clip's own vertical and ground.
///
///   bodyloom_bench_motions --motions FOLDER[,FOLDER…] [--frames 240] [--elevation 8,30] [--ground with,without]
///                          [--lifter built-in|none|FILE] [--worst 0] [--json F]
///
/// --ground: with (all that the tracker does), without, without-contacts (neither surface contacts nor balance),
/// without-balance. Every test clip (its first frames at 30 a second) in front of a synthetic camera of known focal
/// length, with a detector's noise (data_tools/synthesis/clips/detection_noise.h), its toes and heels left out. pa:
/// PA-MPJPE, mpjpe: mid-hip aligned, both of COCO-17 in mm. pa_over_120: frames in which pa is above 120 mm, of all the
/// class' frames. --worst N names the N clips whose worst frame is the worst. slide: mean speed of the ankles, m/s, in
/// frames in which the true ones stand (below 0.1 m/s). ground: clips in which one was found. The other columns are of
/// the room that the track states (data_tools/evaluation/room_errors.h, room_physics.h), the first four of every clip
/// with a vertical, the rest of clips with a ground. Means over clips; the body's stature is the true one.
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/dense_clips.h"
#include "benchmarks/accuracy/lifter_oracle.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/room_errors.h"
#include "data_tools/evaluation/room_physics.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/motion_library.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/check.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom {
namespace {

constexpr double kFps = 30, kStandingSpeed = 0.1;

/// Values of the room, in the order of the table's columns.
const std::vector<std::string> kRoomValues = {"room_g_mpjpe_mm",
                                              "tilt_deg",
                                              "knee_bias_deg",
                                              "trunk_err_deg",
                                              "ankle_height_err_mm",
                                              "lowest_point_mm",
                                              "hover_unexplained_percent",
                                              "ground_penetration_p95_mm"};
constexpr size_t kOfAnyWorld = 4;  ///< so many of them need no ground

class Mean {
 public:
  void Add(double value) {
    if (!std::isfinite(value)) return;
    sum_ += value;
    ++count_;
  }
  [[nodiscard]] double value() const { return count_ > 0 ? sum_ / count_ : kNotMeasured; }

 private:
  double sum_ = 0;
  int count_ = 0;
};

struct Sums {
  Mean pa, mpjpe, slide, seconds;
  std::vector<Mean> room = std::vector<Mean>(kRoomValues.size());
  int clips = 0, grounds = 0;
  std::vector<double> pa_of_frame;  ///< of all clips, metres
};

/// A clip's worst frame.
struct Worst {
  double pa_m = 0;
  std::string where;
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

void AddRoom(const Track& track, const SynthClip& clip, bool has_ground, Sums* sums) {
  Evaluation evaluation;
  AddRoomErrors(track, clip.truth.coco17, clip.up_in_camera, track.motion.timestamps, &evaluation);
  AddRoomPhysics(RoomPhysicsOnGround(track, BuiltinBody()), &evaluation);
  for (size_t i = 0; i < kRoomValues.size(); ++i) {
    if (i < kOfAnyWorld || has_ground) sums->room[i].Add(evaluation.Value(kRoomValues[i]));
  }
}

/// Returns the clip's PA-MPJPE frame by frame, metres; none when nothing could be tracked.
std::vector<double> TrackAndAdd(const SynthClip& clip, const LifterWeights* lifter, const std::string& ground,
                                Sums* sums) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.prior = &BuiltinPosePrior();
  input.lifter = lifter;
  input.keypoints = &clip.keypoints;
  input.camera = clip.truth.camera;
  TrackSequenceOptions options;
  options.estimate_uncertainty = false;
  if (ground == "without") options.ground = GroundOptions::Off();
  if (ground == "without-contacts") options.ground.surface_weight = options.ground.balance_weight = 0;
  if (ground == "without-balance") options.ground.balance_weight = 0;
  const TrackSequenceResult result = FitClip(input, options);
  if (!result.summary.IsUsable()) return {};
  const std::vector<int> hips = {11, 12};
  const auto &found = result.track.coco17, &truth = clip.truth.coco17;
  ++sums->clips;
  const PositionError pa = ProcrustesPositionError(found, truth);
  sums->pa.Add(1e3 * pa.mean);
  sums->pa_of_frame.insert(sums->pa_of_frame.end(), pa.of_frame.begin(), pa.of_frame.end());
  sums->mpjpe.Add(1e3 * MeanPositionError(RelativeTo(found, RootPositions(found, hips)),
                                          RelativeTo(truth, RootPositions(truth, hips)))
                            .mean);
  sums->slide.Add(Slide(result.track, clip.truth));
  const bool has_ground = result.summary.ground.has_plane;
  sums->grounds += has_ground ? 1 : 0;
  if (ground != "without" && result.track.world.has_value()) AddRoom(result.track, clip, has_ground, sums);
  double seconds = 0;
  for (const auto& [stage, of_stage] : result.summary.seconds) seconds += of_stage;
  sums->seconds.Add(seconds);
  return pa.of_frame;
}

/// "floor HDM_bd_03, camera 8 degrees from above: 187 mm at 3.40 s of 8.0".
Worst WorstOf(const std::vector<double>& pa_of_frame, const std::string& clip, const std::string& elevation) {
  const auto frame = std::max_element(pa_of_frame.begin(), pa_of_frame.end());
  const auto seconds = [](auto frames) { return static_cast<double>(frames) / kFps; };
  char text[80];
  std::snprintf(text, sizeof(text), "%.0f mm at %.2f s of %.1f", 1e3 * *frame, seconds(frame - pa_of_frame.begin()),
                seconds(pa_of_frame.size()));
  return {*frame, Concatenate(clip, ", camera ", elevation, " degrees from above: ", text)};
}

void CheckGround(const std::string& ground) {
  const bool known =
      ground == "with" || ground == "without" || ground == "without-contacts" || ground == "without-balance";
  BODYLOOM_CHECK(known, "--ground is '", ground, "', expected with, without, without-contacts or without-balance");
}

void Run(const BenchArguments& arguments, const std::string& command) {
  for (const std::string& ground : arguments.List("ground")) CheckGround(ground);
  std::map<std::pair<std::string, std::string>, std::map<std::string, Sums>> groups;  // by (camera, --ground), by class
  std::vector<Worst> worst;
  const LifterWeights* lifter = LifterOf(arguments.Text("lifter"));
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
      for (const std::string& ground : arguments.List("ground")) {
        const std::vector<double> pa_of_frame =
            TrackAndAdd(synthetic, lifter, ground, &groups[{elevation, ground}][clip.motion_class]);
        if (ground == "with" && !pa_of_frame.empty()) {
          worst.push_back(WorstOf(pa_of_frame, clip.motion_class + " " + clip.name, elevation));
        }
      }
    }
    std::fprintf(stderr, "%s %s\n", clip.motion_class.c_str(), clip.name.c_str());
  });
  BenchReport report;
  report.title = "Motion kept for testing through the tracker, synthetic detections";
  report.command = command;
  report.label_columns = {"class", "clips"};
  report.value_columns = {"pa_mpjpe_mm", "pa_over_120_percent", "mpjpe_mm", "slide_ms", "ground", "s"};
  report.value_columns.insert(report.value_columns.end(), kRoomValues.begin(), kRoomValues.end());
  for (const auto& [key, classes] : groups) {
    for (const auto& [name, sums] : classes) {
      BenchRow row;
      row.group = Concatenate("camera ", key.first, " degrees from above, ground: ", key.second);
      row.labels = {name, std::to_string(sums.clips)};
      row.values = {sums.pa.value(),      PercentAbove(sums.pa_of_frame, kAnotherPose_m),
                    sums.mpjpe.value(),   sums.slide.value(),
                    double(sums.grounds), sums.seconds.value()};
      for (const Mean& mean : sums.room) row.values.push_back(mean.value());
      report.rows.push_back(row);
    }
  }
  std::sort(worst.begin(), worst.end(), [](const Worst& a, const Worst& b) { return a.pa_m > b.pa_m; });
  worst.resize(std::min(worst.size(), static_cast<size_t>(std::max(0, arguments.Integer("worst")))));
  for (const Worst& clip : worst) report.notes.push_back(clip.where);
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_motions", argc, argv,
                             {{"motions", bodyloom::SharedMotions()},
                              {"frames", "240"},
                              {"elevation", "8,30"},
                              {"ground", "with,without"},
                              {"lifter", "built-in"},
                              {"worst", "0"},
                              {"json", ""}},
                             bodyloom::Run);
}
