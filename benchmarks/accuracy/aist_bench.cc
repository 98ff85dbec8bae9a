// SPDX-License-Identifier: Apache-2.0
/// Tracks AIST++ clips from one camera's 2D joints and scores them in the other eight (data_tools/evaluation/
/// aist_evaluation.h): error and time, file to file.
///
///   bodyloom_bench_aist --data AISTPP [--sequences A,B] [--views c01,c03] [--focal known,unknown] [--threads 2]
///                       [--frames 0] [--ground yes|no] [--oracle none|truth|torso|lean|best|arms|legs[,…]] [--json F]
///
/// Seconds: `file_s` from detections file to written track (body and prior included), `track_s` the tracker alone.
/// `--oracle` tells what the error comes from: what the lifter predicts is replaced, in part, by the truth before the
/// solve. truth: all landmarks; torso, lean: the body is turned so that shoulders and hips lie as they do in truth
/// (lean: only about the camera's x axis); best: of each limb the hypothesis nearest to the truth; arms, legs: those
/// landmarks.
/// The group "limits" scores what no tracker of these detections can beat, and the body itself:
///   reference      keypoints3d_optim, made from all nine cameras (the detections' noise floor)
///   true angles    the body posed with the data set's own joint rotations, mean shape (what the difference between
///                  COCO's landmarks of that body and this one costs)
/// Columns from room_g_mpjpe_mm to balance_outside_percent are of the room that the track states
/// (data_tools/evaluation/room_errors.h, room_physics.h); shank_ratio is the mean of both shanks' bone_ratio. Limits
/// state no room.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/dense_clips.h"
#include "benchmarks/accuracy/lifter_oracle.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/aist_evaluation.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/room_physics.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/load_detections.h"
#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/paths.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom {
namespace {

const std::vector<std::string> kEvaluated = {"pa_mpjpe_mm",        "pa_over_120_percent",   "mpjpe_scaled_mm",
                                             "mpjpe_mm",           "accel_err_ms2",         "heldout_median_px",
                                             "heldout_p95_px",     "fitview_own_median_px", "fitview_own_p95_px",
                                             "limb_angle_err_deg", "root_rotation_err_deg", "root_depth_err_mm",
                                             "jitter_ms3",         "gt_jitter_ms3"};

const std::vector<std::string> kEvaluatedRoom = {
    "room_g_mpjpe_mm",     "room_w_mpjpe_mm",      "room_wa_mpjpe_mm",       "tilt_deg",
    "ankle_height_err_mm", "ankle_height_bias_mm", "knee_bias_deg",          "shank_ratio",
    "lowest_point_mm",     "hover_percent",        "balance_outside_percent"};

/// Adds the mean ratio of the shanks' lengths to the true ones, where the room was measured.
void AddShankRatio(Evaluation* evaluation) {
  for (const EvaluationBreakdown& breakdown : evaluation->breakdowns) {
    if (breakdown.name != "bone_ratio") continue;
    double sum = 0;
    for (size_t i = 0; i < breakdown.labels.size(); ++i) {
      if (breakdown.labels[i].ends_with(" shank")) sum += breakdown.values[i];
    }
    evaluation->Add("shank_ratio", sum / 2, "length of the shanks / true length, limbs scaled to the truth's sum");
    return;
  }
}

std::vector<double> Evaluated(const Evaluation& evaluation) {
  std::vector<double> values;
  values.reserve(kEvaluated.size() + kEvaluatedRoom.size());
  for (const std::string& name : kEvaluated) {
    values.push_back(evaluation.values.empty() ? kNotMeasured : evaluation.Value(name));
  }
  for (const std::string& name : kEvaluatedRoom) {
    const auto found = std::find_if(evaluation.values.begin(), evaluation.values.end(),
                                    [&](const EvaluationValue& value) { return value.name == name; });
    values.push_back(found == evaluation.values.end() ? kNotMeasured : found->value);
  }
  return values;
}

CameraKnowledge KnowledgeOf(const std::string& focal) {
  if (focal == "known") return CameraKnowledge::kKnown;
  if (focal == "unknown") return CameraKnowledge::kUnknownFocal;
  BODYLOOM_CHECK(focal == "weak", "--focal is '", focal, "', expected known, unknown or weak");
  return CameraKnowledge::kWeak;
}

struct Setting {
  std::string data, sequence, view;
  CameraKnowledge knowledge = CameraKnowledge::kKnown;
  int threads = 2, frames = 0;
  const LifterWeights* lifter = nullptr;  ///< null: joint hypotheses
  double lifter_weight = 0.12;
  std::string solver = "chain";
  bool ground = true;
  std::string oracle;
};

/// The 3D joints of a clip in the axes of one of its cameras.
std::vector<MatrixX3d> TruthInCamera(const MultiViewClip& clip, const std::string& view) {
  std::vector<MatrixX3d> truth;
  for (const RigView& rig_view : clip.views) {
    if (rig_view.name != view) continue;
    for (const MatrixX3d& joints : clip.coco17_in_world) {
      truth.push_back(MovedPoints(rig_view.pose, joints));
    }
  }
  return truth;
}

std::vector<std::pair<std::string, std::string>> Pairs(const std::vector<std::string>& a,
                                                       const std::vector<std::string>& b) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string& x : a) {
    for (const std::string& y : b) pairs.emplace_back(x, y);
  }
  return pairs;
}

BenchRow TrackAndScore(const Setting& setting, const MultiViewClip& clip, const std::string& track_path) {
  const Stopwatch watch;
  const NamedCamera camera =
      FindCamera(LoadCameras(setting.data + "/cameras", setting.sequence), setting.view, setting.data + "/cameras");
  LoadDetectionsOptions load;
  load.view = setting.view;
  load.image_width = camera.camera.width;
  load.image_height = camera.camera.height;
  const KeypointSequence keypoints =
      FirstFrames(LoadDetections(setting.data + "/keypoints2d/" + setting.sequence + ".pkl", load), setting.frames);
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.prior = &BuiltinPosePrior();
  input.lifter = setting.lifter;
  input.keypoints = &keypoints;
  if (setting.knowledge == CameraKnowledge::kKnown) {
    input.camera = camera.camera;
  } else {
    input.camera.width = camera.camera.width;
    input.camera.height = camera.camera.height;
  }
  TrackSequenceOptions options;
  options.camera_knowledge = setting.knowledge;
  options.num_threads = setting.threads;
  options.lifter_weight = setting.lifter_weight;
  options.solver = SequenceSolverFromString(setting.solver);
  if (!setting.ground) options.ground = GroundOptions::Off();
  std::vector<LiftedFrame> lifted;
  if (setting.oracle != "none") {
    BODYLOOM_CHECK(setting.lifter != nullptr, "--oracle corrects the lifter: --lifter none leaves nothing to correct");
    lifted = LiftWithOracle(keypoints, setting.knowledge, camera.camera, *setting.lifter,
                            TruthInCamera(clip, setting.view), setting.oracle);
    input.lifted = &lifted;
  }
  const Stopwatch track_watch;
  const TrackSequenceResult result = FitClip(input, options);
  const double track_s = track_watch.seconds();
  WriteTrack(track_path, result.track);
  const double file_s = watch.seconds();

  const Track written = ReadTrack(track_path);
  Evaluation evaluation = EvaluateAist(written, clip, setting.view);
  AddShankRatio(&evaluation);
  if (written.world) AddRoomPhysics(MeasureRoomPhysics(written, BuiltinBody(), setting.threads), &evaluation);
  BenchRow row;
  row.group = setting.knowledge == CameraKnowledge::kKnown          ? "known focal length"
              : setting.knowledge == CameraKnowledge::kUnknownFocal ? "unknown focal length"
                                                                    : "weak perspective";
  if (setting.oracle != "none") row.group += ", oracle " + setting.oracle;
  row.labels = {setting.sequence.substr(0, 3), setting.view};
  row.values = Evaluated(evaluation);
  row.values.insert(row.values.end(),
                    {100 * (result.summary.focal_px / camera.camera.fx - 1), double(result.summary.iterations),
                     double(evaluation.frames_without_result), track_s, file_s});
  return row;
}

/// The clip's own joints, or the body posed by the clip's own rotations, as if a tracker had found them.
BenchRow Limit(const MultiViewClip& clip, const std::string& view, bool body_with_true_angles) {
  const BodyModel& body = BuiltinBody();
  Track track;
  for (const RigView& rig_view : clip.views) {
    if (rig_view.name != view) continue;
    const Eigen::Matrix3d& R = rig_view.pose.camera_from_world_rotation;
    const Eigen::Vector3d& t = rig_view.pose.camera_from_world_translation;
    track.camera = rig_view.camera;
    track.motion = clip.motion;
    for (int frame = 0; frame < clip.motion.num_frames(); ++frame) {
      auto pose = track.motion.poses.row(frame);
      pose.head<3>() = AxisAngleFromRotation(R * RotationFromAxisAngle(pose.head<3>().transpose())).transpose();
      if (body_with_true_angles) {
        const BodyPose posed = PoseFromAxisAngle(body, pose.transpose(), Eigen::Vector3d::Zero());
        MatrixX3d points = PoseLandmarks(body, Eigen::VectorXd(), posed, CocoNames());
        const Eigen::RowVector3d hip = points.middleRows(11, 2).colwise().mean();
        const Eigen::Vector3d true_hip = clip.coco17_in_world[frame].middleRows(11, 2).colwise().mean().transpose();
        points.rowwise() += (R * true_hip + t).transpose() - hip;
        track.coco17.push_back(points);
      } else {
        track.coco17.push_back(MovedPoints(rig_view.pose, clip.coco17_in_world[frame]));
      }
    }
  }
  BenchRow row;
  row.group = body_with_true_angles ? "limits: body with true angles" : "limits: reference from nine cameras";
  row.labels = {clip.name.substr(0, 3), view};
  row.values = Evaluated(EvaluateAist(track, clip, view));
  row.values.resize(row.values.size() + 5, kNotMeasured);
  return row;
}

void Run(const BenchArguments& arguments, const std::string& command) {
  BenchReport report;
  report.title = "AIST++: one camera's COCO-17 detections, scored in the other eight";
  report.command = command;
  report.label_columns = {"clip", "camera"};
  report.value_columns = kEvaluated;
  report.value_columns.insert(report.value_columns.end(), kEvaluatedRoom.begin(), kEvaluatedRoom.end());
  for (const char* name : {"focal_err_percent", "iterations", "frames_without_result", "track_s", "file_s"}) {
    report.value_columns.emplace_back(name);
  }
  report.notes = {"accuracy: protocol aist-held-out (docs/evaluation.md); std over clips and cameras",
                  Concatenate("threads: ", arguments.Integer("threads"))};
  const std::filesystem::path track_path =
      std::filesystem::temp_directory_path() / Concatenate("bodyloom_bench_aist_", ::getpid(), ".npz");
  BuiltinBody();  // built once a process; its time is reported apart
  std::vector<MultiViewClip> clips;
  for (const std::string& sequence : arguments.List("sequences")) {
    clips.push_back(ReadAistClip(arguments.Text("data"), arguments.Text("data") + "/cameras", sequence));
  }
  for (const auto& [focal, oracle] : Pairs(arguments.List("focal"), arguments.List("oracle"))) {
    for (const MultiViewClip& clip : clips) {
      for (const std::string& view : arguments.List("views")) {
        Setting setting{arguments.Text("data"),
                        clip.name,
                        view,
                        KnowledgeOf(focal),
                        arguments.Integer("threads"),
                        arguments.Integer("frames"),
                        LifterOf(arguments.Text("lifter")),
                        std::stod(arguments.Text("lifter_weight")),
                        arguments.Text("solver"),
                        arguments.Text("ground") != "no",
                        oracle};
        report.rows.push_back(TrackAndScore(setting, clip, track_path.string()));
        std::fprintf(stderr, "%s %s %s: PA-MPJPE %.1f mm, held out %.1f px, %.2f s\n", focal.c_str(), clip.name.c_str(),
                     view.c_str(), report.rows.back().values[0], report.rows.back().values[5],
                     report.rows.back().values.back());
      }
    }
  }
  std::filesystem::remove(track_path);
  for (bool true_angles : {false, true}) {
    for (const MultiViewClip& clip : clips) {
      for (const std::string& view : arguments.List("views")) report.rows.push_back(Limit(clip, view, true_angles));
    }
  }
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_aist", argc, argv,
                             {{"data", bodyloom::SharedDir() + "/data/aistpp"},
                              {"sequences", "gBR_sBM_cAll_d06_mBR2_ch06,gJS_sBM_cAll_d03_mJS2_ch07"},
                              {"views", "c01,c03,c05,c07,c08"},
                              {"focal", "known,unknown"},
                              {"lifter", "built-in"},
                              {"lifter_weight", "0.12"},
                              {"solver", "chain"},
                              {"ground", "yes"},
                              {"oracle", "none"},
                              {"threads", "2"},
                              {"frames", "0"},
                              {"json", ""}},
                             bodyloom::Run);
}
