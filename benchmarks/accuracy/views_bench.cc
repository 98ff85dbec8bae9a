// SPDX-License-Identifier: Apache-2.0
/// Tracks AIST++ clips from several cameras' 2D joints at once
/// (tracking/rig/track_views.h): error and time against those of each camera
/// alone.
///
///   bodyloom_bench_views --data AISTPP [--sequences A,B] [--rigs
///   pairs|c01+c03,c01+c04+c07] [--known none,intrinsics,cameras]
///                        [--shift-frames 0] [--drop-every 0] [--threads 2]
///                        [--solver chain+ceres] [--json F]
///
/// `pairs`: all pairs of the nine cameras. --known: nothing; the intrinsics;
/// intrinsics and poses. Before they are tracked, every view's clock but the
/// first one's is moved by --shift-frames, with every nth of its frames left
/// out
/// (--drop-every).
/// Columns: `axes_deg`, the angle between the first two cameras' axes (folded
/// to 90°: opposite cameras see the same outline); PA-MPJPE jointly, of the
/// first view alone and the mean of all alone; the room of the joint track;
/// error of the rotation from the first view to the others, of the focal
/// lengths and of the clocks (mean over views); seconds of all fits alone and
/// of all.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/lifter_oracle.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/aist_evaluation.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/learned/pose_prior_io.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/paths.h"
#include "tracking/rig/track_views.h"

namespace bodyloom {
namespace {

const std::vector<std::string> kColumns = {"axes_deg",
                                           "pa_mpjpe_mm",
                                           "pa_first_alone_mm",
                                           "pa_alone_mm",
                                           "room_g_mpjpe_mm",
                                           "room_wa_mpjpe_mm",
                                           "tilt_deg",
                                           "rotation_err_deg",
                                           "focal_err_percent",
                                           "clock_err_frames",
                                           "seen_px",
                                           "alone_s",
                                           "all_s"};

const RigView &FindView(const MultiViewClip &clip, const std::string &name) {
  const auto at =
      std::find_if(clip.views.begin(), clip.views.end(),
                   [&](const RigView &view) { return view.name == name; });
  BODYLOOM_CHECK(at != clip.views.end(), "the clip ", clip.name,
                 " has no camera '", name, "'");
  return *at;
}

std::vector<std::string> Split(const std::string &text, char separator) {
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

KeypointSequence OtherClock(const KeypointSequence &given, double shift_s,
                            int drop_every) {
  KeypointSequence result = given;
  result.points.clear();
  result.timestamps.clear();
  for (int t = 0; t < given.num_frames(); ++t) {
    if (drop_every > 0 && t % drop_every == drop_every - 1)
      continue;
    result.timestamps.push_back(given.timestamps[t] + shift_s);
    for (int k = 0; k < given.num_points(); ++k)
      result.points.push_back(given.at(t, k));
  }
  return result;
}

double ValueOf(const Evaluation &evaluation, const std::string &name) {
  const auto found = std::find_if(
      evaluation.values.begin(), evaluation.values.end(),
      [&](const EvaluationValue &value) { return value.name == name; });
  return found == evaluation.values.end() ? kNotMeasured : found->value;
}

BenchRow Measure(const BenchArguments &arguments, const MultiViewClip &clip,
                 const std::string &rig, const std::string &known) {
  const std::vector<std::string> names = Split(rig, '+');
  const double shift_s = std::stod(arguments.Text("shift-frames")) / clip.fps;
  std::vector<KeypointSequence> seen;
  for (size_t v = 0; v < names.size(); ++v) {
    const KeypointSequence &detections = FindView(clip, names[v]).detections;
    seen.push_back(v == 0 ? detections
                          : OtherClock(detections, shift_s,
                                       arguments.Integer("drop-every")));
    seen.back().image_width = FindView(clip, names[v]).camera.width;
    seen.back().image_height = FindView(clip, names[v]).camera.height;
  }
  std::vector<ObservedView> views;
  for (size_t v = 0; v < names.size(); ++v) {
    const RigView &truth = FindView(clip, names[v]);
    ObservedView &view = views.emplace_back();
    view.keypoints = &seen[v];
    if (known == "none") {
      view.camera.width = truth.camera.width;
      view.camera.height = truth.camera.height;
    } else {
      view.knowledge = CameraKnowledge::kKnown;
      view.camera = truth.camera;
    }
    if (known == "cameras")
      view.camera_from_rig = truth.pose;
  }
  TrackSequenceInput common;
  common.body = &BuiltinBody();
  common.prior = &BuiltinPosePrior();
  common.lifter = LifterOf("built-in");
  TrackSequenceOptions options;
  options.num_threads = arguments.Integer("threads");
  options.solver = SequenceSolverFromString(arguments.Text("solver"));
  const TrackViewsResult result = TrackViews(views, common, options);

  BenchRow row;
  row.group = known == "none"      ? "nothing known"
              : known == "cameras" ? "cameras known"
                                   : "intrinsics known";
  row.labels = {clip.name.substr(0, 3), rig};
  row.values.assign(kColumns.size(), kNotMeasured);
  const auto set = [&](const std::string &column, double value) {
    row.values[std::find(kColumns.begin(), kColumns.end(), column) -
               kColumns.begin()] = value;
  };
  const CameraPose first = FindView(clip, names[0]).pose;
  const Eigen::Vector3d axis =
      Compose(FindView(clip, names[1]).pose, Inverse(first))
          .camera_from_world_rotation.col(2);
  set("axes_deg",
      std::acos(std::clamp(std::abs(axis.z()), 0.0, 1.0)) * 180 / M_PI);
  double alone = 0;
  for (size_t v = 0; v < names.size(); ++v) {
    const double pa = ValueOf(
        EvaluateAist(result.alone[v].track, clip, names[0]), "pa_mpjpe_mm");
    if (v == 0)
      set("pa_first_alone_mm", pa);
    alone += pa / static_cast<double>(names.size());
  }
  set("pa_alone_mm", alone);
  set("alone_s", result.summary.seconds_alone);
  set("all_s", result.summary.seconds);
  if (!result.joint.summary.IsUsable()) {
    std::fprintf(stderr, "%s %s: %s\n", row.labels[0].c_str(), rig.c_str(),
                 result.joint.summary.message.c_str());
    return row;
  }
  const Evaluation evaluation =
      EvaluateAist(result.joint.track, clip, names[0]);
  for (const char *column :
       {"pa_mpjpe_mm", "room_g_mpjpe_mm", "room_wa_mpjpe_mm", "tilt_deg"}) {
    set(column, ValueOf(evaluation, column));
  }
  double rotation = 0, clock = 0, pixels = 0;
  double focal = std::abs(
      result.joint.track.camera.fx / FindView(clip, names[0]).camera.fx - 1);
  size_t i = 0;
  for (size_t v = 1; v < names.size(); ++v) {
    if (result.summary.used[v] == 0)
      continue;
    const ViewSummary &view = result.joint.summary.views[i++];
    const CameraPose truth =
        Compose(FindView(clip, names[v]).pose, Inverse(first));
    rotation +=
        RotationAngleBetween(view.camera_from_scene.camera_from_world_rotation,
                             truth.camera_from_world_rotation);
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

void Run(const BenchArguments &arguments, const std::string &command) {
  BenchReport report;
  report.title = "AIST++: several cameras' COCO-17 detections, one body";
  report.command = command;
  report.label_columns = {"clip", "cameras"};
  report.value_columns = kColumns;
  report.notes = {"accuracy: protocol aist-held-out (docs/evaluation.md), the "
                  "room by the joint track's own statement",
                  Concatenate("threads: ", arguments.Integer("threads"))};
  BuiltinBody(); // built once a process
  std::vector<MultiViewClip> clips;
  for (const std::string &sequence : arguments.List("sequences")) {
    clips.push_back(ReadAistClip(
        arguments.Text("data"), arguments.Text("data") + "/cameras", sequence));
  }
  for (const std::string &known : arguments.List("known")) {
    BODYLOOM_CHECK(
        known == "none" || known == "intrinsics" || known == "cameras",
        "--known is '", known, "', expected none, intrinsics or cameras");
    for (const MultiViewClip &clip : clips) {
      std::vector<std::string> rigs = arguments.List("rigs");
      if (rigs == std::vector<std::string>{"pairs"}) {
        rigs.clear();
        for (size_t a = 0; a < clip.views.size(); ++a) {
          for (size_t b = a + 1; b < clip.views.size(); ++b) {
            rigs.push_back(clip.views[a].name + "+" + clip.views[b].name);
          }
        }
      }
      for (const std::string &rig : rigs) {
        report.rows.push_back(Measure(arguments, clip, rig, known));
        const std::vector<double> &values = report.rows.back().values;
        std::fprintf(stderr,
                     "%s %s %s: axes %.0f deg, PA-MPJPE %.1f mm (alone %.1f), "
                     "rotation %.1f deg, %.2f s\n",
                     known.c_str(), clip.name.substr(0, 3).c_str(), rig.c_str(),
                     values[0], values[1], values[3], values[7], values.back());
      }
    }
  }
  HandOver(report, arguments.Text("json"));
}

} // namespace
} // namespace bodyloom

int main(int argc, char **argv) {
  return bodyloom::BenchMain(
      "bodyloom_bench_views", argc, argv,
      {{"data", bodyloom::SharedDir() + "/data/aistpp"},
       {"sequences", "gBR_sBM_cAll_d06_mBR2_ch06,gJS_sBM_cAll_d03_mJS2_ch07"},
       {"rigs", "pairs"},
       {"known", "none"},
       {"shift-frames", "0"},
       {"drop-every", "0"},
       {"solver", "chain+ceres"},
       {"threads", "2"},
       {"json", ""}},
      bodyloom::Run);
}
