// SPDX-License-Identifier: Apache-2.0
/// Tracks AIST++ clips from several cameras' 2D joints at once (tracking/rig/track_views.h): error and time against
/// those of each camera alone.
///
///   bodyloom_bench_views --data AISTPP [--sequences A,B] [--rigs pairs|c01+c03,c01+c04+c07]
///                        [--known none,intrinsics,cameras] [--shift-frames 0] [--drop-every 0] [--overlap 1]
///                        [--focal-ratio 0] [--repeat 1] [--threads 2] [--solver chain+ceres] [--json F]
///
/// `pairs`: all pairs of the nine cameras. --known: nothing; the intrinsics; intrinsics and poses. Before they are
/// tracked, every view's clock but the first one's is moved by --shift-frames, with every nth of its frames left out
/// (--drop-every). --focal-ratio: σ of the logarithm of the ratio of two focal lengths, where it is known. --overlap:
/// the share of each clip that the others show, too; the first gives up its end, the others their beginning. With
/// --repeat everything is tracked several times and times are medians; stages go to stderr. Columns: `axes_deg`, the
/// angle between the first two cameras' axes (folded to 90°: opposite cameras see the same outline); PA-MPJPE jointly,
/// of the first view alone and the mean of all alone; the room of the joint track; error of the rotation from the first
/// view to the others, of the focal lengths and of the clocks (mean over views); seconds of an ordinary track of the
/// first view by itself and of several views, by the clock and of the processor (its threads in sum, whoever else uses
/// it), with those of the fits alone; the process's peak memory so far.
///
///   bodyloom_bench_views --synthetic 20 [--rigs 2,3,4,6,8,opposite,still,drift] [--seconds 8] [--noise detector|white]
///                        [--bias-mm 25] [--ground on|off] [--known none,intrinsics] [--threads 2]
///                        [--solver chain+ceres] [--json F]
///
/// So many rigs of known truth of each kind (tests/support/synthetic_rig.h): 2 to 8 cameras around a person who moves
/// at random; two opposite ones; two before a person who stands still; two of which one's clock drifts by 100 ppm.
/// `detector`: the errors of data_tools/synthesis/clips/detection_noise.h and landmarks that lie --bias-mm (σ, each
/// axis) elsewhere on the body than the model's; `white`: 3 px a frame, at the model's landmarks.
/// A row for each standard deviation that is stated: share of the errors, one axis each, within one and two σ (68.3 and
/// 95.4 % of Gaussian ones), root mean square of error over σ, medians of error and σ in mm, degrees, %, ms and ppm.
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <utility>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/lifter_oracle.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/aist_evaluation.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/learned/pose_prior_io.h"
#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/paths.h"
#include "tests/support/synthetic_rig.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/rig/track_views.h"

namespace bodyloom {
namespace {

const std::vector<std::string> kColumns = {
    "axes_deg", "pa_mpjpe_mm",      "pa_first_alone_mm", "pa_alone_mm",      "room_g_mpjpe_mm", "room_wa_mpjpe_mm",
    "tilt_deg", "rotation_err_deg", "focal_err_percent", "clock_err_frames", "seen_px",         "one_s",
    "all_s",    "one_cpu_s",        "alone_cpu_s",       "all_cpu_s",        "peak_mb"};

const RigView& FindView(const MultiViewClip& clip, const std::string& name) {
  const auto at =
      std::find_if(clip.views.begin(), clip.views.end(), [&](const RigView& view) { return view.name == name; });
  BODYLOOM_CHECK(at != clip.views.end(), "the clip ", clip.name, " has no camera '", name, "'");
  return *at;
}

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

KeypointSequence OtherClock(const KeypointSequence& given, double shift_s, int drop_every) {
  KeypointSequence result = given;
  result.points.clear();
  result.timestamps.clear();
  for (int t = 0; t < given.num_frames(); ++t) {
    if (drop_every > 0 && t % drop_every == drop_every - 1) continue;
    result.timestamps.push_back(given.timestamps[t] + shift_s);
    for (int k = 0; k < given.num_points(); ++k) result.points.push_back(given.at(t, k));
  }
  return result;
}

/// The frames from this share of the clip on, for this share of it.
KeypointSequence PartOf(const KeypointSequence& given, double begin, double length) {
  KeypointSequence result = given;
  const int first = static_cast<int>(std::lround(begin * given.num_frames()));
  const int count = std::min(static_cast<int>(std::lround(length * given.num_frames())), given.num_frames() - first);
  const auto from = given.points.begin() + static_cast<std::ptrdiff_t>(first) * given.num_points();
  result.points.assign(from, from + static_cast<std::ptrdiff_t>(count) * given.num_points());
  result.timestamps.assign(given.timestamps.begin() + first, given.timestamps.begin() + first + count);
  return result;
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double PeakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Seconds of this process's threads so far.
double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Tracks the views as often as asked for: the last result, with the medians of the times.
struct TimedTrack {
  TrackViewsResult result;
  double one_s = 0, all_s = 0, one_cpu_s = 0, alone_cpu_s = 0, all_cpu_s = 0;

  TimedTrack(const std::vector<ObservedView>& views, const TrackSequenceInput& common,
             const TrackSequenceOptions& options, int repeat) {
    std::map<std::string, std::vector<double>> of_stage;
    std::array<std::vector<double>, 5> times;
    for (int i = 0; i < repeat; ++i) {
      TrackSequenceOptions of_one = options;
      of_one.camera_knowledge = views[0].knowledge;
      Stopwatch watch;
      double cpu = CpuSeconds();
      FitClip(InputOfView(views[0], common), of_one);
      times[0].push_back(watch.Lap());
      times[1].push_back(CpuSeconds() - cpu);
      cpu = CpuSeconds();
      std::vector<TrackSequenceResult> alone =
          FitViewsAlone(views, common, std::vector<TrackSequenceOptions>(views.size(), options));
      times[2].push_back(CpuSeconds() - cpu);
      result = FitViewsTogether(views, std::move(alone), common, options);
      times[3].push_back(watch.Lap());
      times[4].push_back(CpuSeconds() - cpu);
      for (const auto& [stage, seconds] : result.joint.summary.seconds) of_stage[stage].push_back(seconds);
    }
    one_s = Median(times[0]), one_cpu_s = Median(times[1]), alone_cpu_s = Median(times[2]);
    all_s = Median(times[3]), all_cpu_s = Median(times[4]);
    for (const auto& [stage, seconds] : result.joint.summary.seconds) {
      std::fprintf(stderr, "  %s %.2f s", stage.c_str(), Median(of_stage[stage]));
    }
    std::fprintf(stderr, "\n");
  }
};

double ValueOf(const Evaluation& evaluation, const std::string& name) {
  const auto found = std::find_if(evaluation.values.begin(), evaluation.values.end(),
                                  [&](const EvaluationValue& value) { return value.name == name; });
  return found == evaluation.values.end() ? kNotMeasured : found->value;
}

BenchRow Measure(const BenchArguments& arguments, const MultiViewClip& clip, const std::string& rig,
                 const std::string& known) {
  const std::vector<std::string> names = Split(rig, '+');
  const double shift_s = std::stod(arguments.Text("shift-frames")) / clip.fps;
  std::vector<KeypointSequence> seen;
  for (size_t v = 0; v < names.size(); ++v) {
    const KeypointSequence& detections = FindView(clip, names[v]).detections;
    seen.push_back(OtherClock(detections, v == 0 ? 0 : shift_s, v == 0 ? 0 : arguments.Integer("drop-every")));
    const double overlap = std::stod(arguments.Text("overlap"));
    if (overlap < 1) seen.back() = PartOf(seen.back(), v == 0 ? 0 : (1 - overlap) / (2 - overlap), 1 / (2 - overlap));
    seen.back().image_width = FindView(clip, names[v]).camera.width;
    seen.back().image_height = FindView(clip, names[v]).camera.height;
  }
  std::vector<ObservedView> views;
  for (size_t v = 0; v < names.size(); ++v) {
    const RigView& truth = FindView(clip, names[v]);
    ObservedView& view = views.emplace_back();
    view.keypoints = &seen[v];
    if (known == "none") {
      view.camera.width = truth.camera.width;
      view.camera.height = truth.camera.height;
    } else {
      view.knowledge = CameraKnowledge::kKnown;
      view.camera = truth.camera;
    }
    if (known == "cameras") view.camera_from_rig = truth.pose;
    view.focal_ratio_log_sigma = std::stod(arguments.Text("focal-ratio"));
  }
  TrackSequenceInput common;
  common.body = &BuiltinBody();
  common.prior = &BuiltinPosePrior();
  common.lifter = LifterOf("built-in");
  TrackSequenceOptions options;
  options.num_threads = arguments.Integer("threads");
  options.solver = SequenceSolverFromString(arguments.Text("solver"));
  const TimedTrack timed(views, common, options, arguments.Integer("repeat"));
  const TrackViewsResult& result = timed.result;

  BenchRow row;
  row.group = known == "none" ? "nothing known" : known == "cameras" ? "cameras known" : "intrinsics known";
  row.labels = {clip.name.substr(0, 3), rig};
  row.values.assign(kColumns.size(), kNotMeasured);
  const auto set = [&](const std::string& column, double value) {
    row.values[std::find(kColumns.begin(), kColumns.end(), column) - kColumns.begin()] = value;
  };
  const CameraPose first = FindView(clip, names[0]).pose;
  const Eigen::Vector3d axis = Compose(FindView(clip, names[1]).pose, Inverse(first)).camera_from_world_rotation.col(2);
  set("axes_deg", std::acos(std::clamp(std::abs(axis.z()), 0.0, 1.0)) * 180 / M_PI);
  double alone = 0;
  for (size_t v = 0; v < names.size(); ++v) {
    const double pa = ValueOf(EvaluateAist(result.alone[v].track, clip, names[0]), "pa_mpjpe_mm");
    if (v == 0) set("pa_first_alone_mm", pa);
    alone += pa / static_cast<double>(names.size());
  }
  set("pa_alone_mm", alone);
  set("one_s", timed.one_s);
  set("all_s", timed.all_s);
  set("one_cpu_s", timed.one_cpu_s);
  set("alone_cpu_s", timed.alone_cpu_s);
  set("all_cpu_s", timed.all_cpu_s);
  set("peak_mb", PeakMegabytes());
  if (!result.joint.summary.IsUsable()) {
    std::fprintf(stderr, "%s %s: %s\n", row.labels[0].c_str(), rig.c_str(), result.joint.summary.message.c_str());
    return row;
  }
  for (const ViewSummary& view : result.joint.summary.views) {
    if (std::isfinite(view.repeat_s)) std::fprintf(stderr, "  repeats after %.2f s\n", view.repeat_s);
  }
  const Evaluation evaluation = EvaluateAist(result.joint.track, clip, names[0]);
  for (const char* column : {"pa_mpjpe_mm", "room_g_mpjpe_mm", "room_wa_mpjpe_mm", "tilt_deg"}) {
    set(column, ValueOf(evaluation, column));
  }
  double rotation = 0, clock = 0, pixels = 0;
  double focal = std::abs(result.joint.track.camera.fx / FindView(clip, names[0]).camera.fx - 1);
  size_t i = 0;
  for (size_t v = 1; v < names.size(); ++v) {
    if (result.summary.used[v] == 0) continue;
    const ViewSummary& view = result.joint.summary.views[i++];
    const CameraPose truth = Compose(FindView(clip, names[v]).pose, Inverse(first));
    rotation +=
        RotationAngleBetween(view.camera_from_scene.camera_from_world_rotation, truth.camera_from_world_rotation);
    clock += std::abs(view.offset_s - shift_s);
    focal += std::abs(view.camera.fx / FindView(clip, names[v]).camera.fx - 1);
    pixels += view.reprojection_median_px;
  }
  const auto others = static_cast<double>(i);
  set("rotation_err_deg", rotation / others * 180 / M_PI);
  set("clock_err_frames", clock / others * clip.fps);
  set("focal_err_percent", 100 * focal / (others + 1));
  set("seen_px", pixels / others);
  return row;
}

/// Rigs of one kind and what is known of them.
void MeasureSynthetic(const BenchArguments& arguments, const std::string& kind, const std::string& known,
                      BenchReport* report) {
  const bool still = kind == "still", opposite = kind == "opposite", drift = kind == "drift";
  const int num_views = still || opposite || drift ? 2 : std::stoi(kind);
  const double seconds = std::stod(arguments.Text("seconds"));
  RigNoise noise{.feet = false};
  if (arguments.Text("noise") == "detector") {
    noise = {.white_px = 0, .detector = 1, .bias_m = std::stod(arguments.Text("bias-mm")) / 1000, .feet = false};
  }
  RigErrors errors;
  int refused = 0;
  std::vector<double> error_mm;
  for (int i = 0; i < arguments.Integer("synthetic"); ++i) {
    const auto seed = static_cast<uint64_t>(1 + i);
    std::vector<SyntheticCamera> cameras = RandomRigCameras(seed, num_views, seconds);
    if (opposite) cameras[1].yaw_deg = cameras[0].yaw_deg + 180 + HashRandom(seed, {13}).Uniform(-10, 10);
    if (drift) cameras[1].drift = 1e-4;
    Motion motion = RandomRigMotion(seed, seconds + 1);
    for (Eigen::Index t = 1; still && t < motion.poses.rows(); ++t) {
      motion.poses.row(t) = motion.poses.row(0);
      motion.trans.row(t) = motion.trans.row(0);
    }
    const SyntheticRig rig(cameras, motion, noise, seed);
    TrackSequenceOptions options;
    options.num_threads = arguments.Integer("threads");
    options.solver = SequenceSolverFromString(arguments.Text("solver"));
    if (arguments.Text("ground") == "off") {
      options.ground.contact_weight = options.ground.surface_weight = options.ground.balance_weight = 0;
    }
    using Known = SyntheticRig::Known;
    const TrackViewsResult result =
        SyntheticRig::Track(rig.Views(known == "none" ? Known::kNothing : Known::kIntrinsics), options);
    if (!result.joint.summary.IsUsable()) {
      ++refused;
      std::fprintf(stderr, "%s %d: %s\n", kind.c_str(), i, result.joint.summary.message.c_str());
      continue;
    }
    errors.Add(rig, result);
    error_mm.push_back(rig.Joint(result));
    std::fprintf(
        stderr, "%s %d: joints %.1f mm, rotation %.2f deg, clock %.1f ms, focal lengths %.1f and %.1f %%, %.2f s\n",
        kind.c_str(), i, error_mm.back(), rig.RotationErrorDeg(result.joint.summary.views[0], 1),
        1e3 * (result.joint.summary.views[0].offset_s - rig.TrueOffset(1)),
        100 * (result.joint.track.camera.fx / rig.clips[0].truth.camera.fx - 1),
        100 * (result.joint.summary.views[0].camera.fx / rig.clips[1].truth.camera.fx - 1), result.summary.seconds);
  }
  const std::map<std::string, double> units = {
      {"rotation", 180 / M_PI}, {"focal length", 100}, {"focal length of the first", 100}, {"clock rate", 1e6}};
  for (const auto& [name, of] : errors.of) {
    const auto unit = units.find(name);
    const double scale = unit == units.end() ? 1000 : unit->second;
    BenchRow& row = report->rows.emplace_back();
    row.group = Concatenate(kind, " views, ", known, " known, ", error_mm.size(), " rigs tracked, ", refused,
                            " refused; joints after Procrustes ", BenchNumber(Median(error_mm)), " mm (median)");
    row.labels = {name, std::to_string(of.pairs.size())};
    row.values = {100 * of.Within(1), 100 * of.Within(2), of.RmsOfSigma(), scale * of.MedianError(),
                  scale * of.MedianSigma()};
  }
}

void RunSynthetic(const BenchArguments& arguments, const std::string& command) {
  BenchReport report;
  report.title = "Synthetic rigs: stated standard deviations and errors";
  report.command = command;
  report.label_columns = {"of", "errors"};
  report.value_columns = {"within_1_percent", "within_2_percent", "rms_of_sigma", "median_error", "median_sigma"};
  report.notes = {"Gaussian errors: 68.3 and 95.4 %, 1", "degrees, %, ms, ppm and mm"};
  report.summarise = false;
  const std::string noise = arguments.Text("noise");
  BODYLOOM_CHECK(noise == "detector" || noise == "white", "--noise is '", noise, "', expected detector or white");
  std::vector<std::string> kinds = arguments.List("rigs");
  if (kinds == std::vector<std::string>{"pairs"}) kinds = {"2", "3", "4", "6", "8", "opposite", "still", "drift"};
  for (const std::string& known : arguments.List("known")) {
    for (const std::string& kind : kinds) MeasureSynthetic(arguments, kind, known, &report);
  }
  HandOver(report, arguments.Text("json"));
}

void Run(const BenchArguments& arguments, const std::string& command) {
  if (arguments.Integer("synthetic") > 0) {
    RunSynthetic(arguments, command);
    return;
  }
  BenchReport report;
  report.title = "AIST++: several cameras' COCO-17 detections, one body";
  report.command = command;
  report.label_columns = {"clip", "cameras"};
  report.value_columns = kColumns;
  report.notes = {"accuracy: protocol aist-held-out (docs/evaluation.md), the room by the joint track's own statement",
                  Concatenate("threads: ", arguments.Integer("threads"))};
  BuiltinBody();  // built once a process
  std::vector<MultiViewClip> clips;
  for (const std::string& sequence : arguments.List("sequences")) {
    clips.push_back(ReadAistClip(arguments.Text("data"), arguments.Text("data") + "/cameras", sequence));
  }
  for (const std::string& known : arguments.List("known")) {
    BODYLOOM_CHECK(known == "none" || known == "intrinsics" || known == "cameras", "--known is '", known,
                   "', expected none, intrinsics or cameras");
    for (const MultiViewClip& clip : clips) {
      std::vector<std::string> rigs = arguments.List("rigs");
      if (rigs == std::vector<std::string>{"pairs"}) {
        rigs.clear();
        for (size_t a = 0; a < clip.views.size(); ++a) {
          for (size_t b = a + 1; b < clip.views.size(); ++b) {
            rigs.push_back(clip.views[a].name + "+" + clip.views[b].name);
          }
        }
      }
      for (const std::string& rig : rigs) {
        report.rows.push_back(Measure(arguments, clip, rig, known));
        const std::vector<double>& values = report.rows.back().values;
        std::fprintf(stderr, "%s %s %s: axes %.0f deg, PA-MPJPE %.1f mm (alone %.1f), rotation %.1f deg, %.2f s\n",
                     known.c_str(), clip.name.substr(0, 3).c_str(), rig.c_str(), values[0], values[1], values[3],
                     values[7], values[12]);
      }
    }
  }
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_views", argc, argv,
                             {{"data", bodyloom::SharedDir() + "/data/aistpp"},
                              {"sequences", "gBR_sBM_cAll_d06_mBR2_ch06,gJS_sBM_cAll_d03_mJS2_ch07"},
                              {"rigs", "pairs"},
                              {"known", "none"},
                              {"shift-frames", "0"},
                              {"drop-every", "0"},
                              {"focal-ratio", "0"},
                              {"overlap", "1"},
                              {"repeat", "1"},
                              {"synthetic", "0"},
                              {"seconds", "8"},
                              {"ground", "on"},
                              {"noise", "detector"},
                              {"bias-mm", "25"},
                              {"solver", "chain+ceres"},
                              {"threads", "2"},
                              {"json", ""}},
                             bodyloom::Run);
}
