// SPDX-License-Identifier: Apache-2.0
/// bodyloom_bench_moving_camera: synthetic clips of a camera that moves, tracked with its path and without.
///
///   bodyloom_bench_moving_camera [--motions demo,FILE,…] [--frames 180] [--seeds 3]
///                                [--cameras still,turning,hand-held,walking,orbit]
///                                [--background points|furnished|blank|crowd] [--hide ankle,toe,heel]
///                                [--write FOLDER] [--json F]
///
/// The first frames of each motion at 30 a second before a synthetic camera of known focal length
/// (data_tools/synthesis/clips/synth_camera.h), with a detector's noise, toes and heels included. What the tracker
/// is told of the camera:
///   path        where it was
///   scale       the same without a length: translations divided by 3.7
///   noisy       where it was, off by smooth drifts of 0.5 degrees and 3 cm about each axis (time constant 1 s)
///   rotations   how it was turned, from where the first frame was seen
///   found       what is found from background points (tracking/camera_motion/camera_motion.h): with --background
///               points 3 to 9 m from the first camera, followed with 0.3 pixels of noise, of which 15 % move by
///               themselves; otherwise followed in the pixels of a rendered room (rendered_room.h), bodies masked,
///               whose video --write keeps; the path of a camera that goes somewhere has no length, as for `scale`
///   none        nothing: it is taken to stand still
/// Camera "turning" is the hand-held one without its translations. --hide: parts of names of landmarks that nothing
/// detects.
/// pa: PA-MPJPE of all joints, mm. w, wa, drift, slide: data_tools/evaluation/world_drift.h. ratio: scale found / true,
/// 0: the tracker found none; ratio_z: its logarithm in σ of the scale. path: distance of the camera from where it was,
/// root mean square after one rigid motion, in percent of its way.
/// within 1, 2: share of the found centres' coordinates within one and two σ (CameraMotion::sigma_place) of the truth,
/// of a path without a length, before anybody is tracked; the first camera and the farthest one's distance from it are
/// held, as for σ.
/// roll: mean velocity along the camera's way of the point of the true feet (ankles, toes, heels) that moves least over
/// a tenth of a second, m/s, weighted by the camera's speed: so fast feet go along with it that should stand.
/// standing: GroundSummary::standing_speed_mps, of what the tracker itself sees of standing feet.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/rendered_room.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/world_drift.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/smooth_curve.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "data_tools/video/video_writer.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/tracking/camera_motion/synthetic_background.h"
#include "tracking/camera_motion/camera_motion.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/detection/background_tracker.h"

namespace bodyloom {
namespace {

constexpr double kFps = 30, kUnit = 3.7;
constexpr double kNoiseDegrees = 0.5, kNoiseMetres = 0.03, kNoiseTimeConstant = 1;

std::vector<CameraPose> Noisy(const std::vector<CameraPose>& path, const std::vector<double>& times, uint64_t seed) {
  std::array<std::vector<double>, 6> drift;
  for (size_t k = 0; k < 6; ++k)
    drift[k] = SmoothDrift(times, kNoiseTimeConstant, HashRandom(seed, {900, uint64_t{k}}));
  std::vector<CameraPose> noisy;
  for (size_t t = 0; t < path.size(); ++t) {
    const CameraPose off{
        RotationFromAxisAngle(kNoiseDegrees * kDegree * Eigen::Vector3d(drift[0][t], drift[1][t], drift[2][t])),
        kNoiseMetres * Eigen::Vector3d(drift[3][t], drift[4][t], drift[5][t])};
    noisy.push_back(Compose(off, path[t]));
  }
  return noisy;
}

Motion MotionNamed(const std::string& name, int frames) {
  if (name == "demo") return DemoMotion(BuiltinBody(), frames, kFps);
  const Motion motion = ResampleMotion(LoadMotion(name), kFps);
  return TakeFrames(motion, 0, std::min(frames, motion.num_frames()));
}

void Hide(const std::string& part, KeypointSequence* keypoints) {
  for (size_t k = 0; k < keypoints->names.size(); ++k) {
    if (keypoints->names[k].find(part) == std::string::npos) continue;
    for (int t = 0; t < keypoints->num_frames(); ++t) keypoints->at(t, static_cast<int>(k)).confidence = 0;
  }
}

Eigen::Matrix3Xd Centres(const std::vector<CameraPose>& path) {
  Eigen::Matrix3Xd centres(3, Eigen::Index(path.size()));
  for (size_t t = 0; t < path.size(); ++t) centres.col(Eigen::Index(t)) = CentreOf(path[t]);
  return centres;
}

/// Distance of the camera's places from the true ones, root mean square after one rigid motion, in percent of the true
/// path's length.
double PathError(const std::vector<CameraPose>& found, const std::vector<CameraPose>& truth) {
  if (found.empty() || truth.empty()) return kNotMeasured;
  const Eigen::Matrix3Xd places = Centres(found), true_places = Centres(truth);
  const Eigen::Matrix4d moved = Eigen::umeyama(places, true_places, false);
  const Eigen::Matrix3Xd off =
      ((moved.topLeftCorner<3, 3>() * places).colwise() + moved.col(3).head<3>()) - true_places;
  const auto steps = true_places.cols() - 1;
  const double length = (true_places.rightCols(steps) - true_places.leftCols(steps)).colwise().norm().sum();
  return 100 * std::sqrt(off.colwise().squaredNorm().mean()) / length;
}

/// One row: the clip tracked with this path (or none). `unit_m`: metres a unit of a path of unknown scale.
std::vector<double> TrackAndMeasure(const SynthClip& clip, const std::vector<CameraPose>* path, double scale_m,
                                    double unit_m, const std::vector<Eigen::Vector3d>* points) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.prior = &BuiltinPosePrior();
  input.lifter = &BuiltinLifter();
  input.keypoints = &clip.keypoints;
  input.camera = clip.truth.camera;
  input.camera_from_scene = path;
  input.camera_scale_m = scale_m;
  input.background_points = points;
  TrackSequenceOptions options;
  options.estimate_uncertainty = false;
  const TrackSequenceResult result = FitClip(input, options);
  if (!result.summary.IsUsable()) return std::vector<double>(11, kNotMeasured);
  const WorldDrift drift = MeasureWorldDrift(result.track, clip.truth, BuiltinBody());
  const CameraPathSummary& metre = result.summary.camera_path;
  const double ratio = scale_m == 0 ? metre.scale_m / unit_m : kNotMeasured;
  double seconds = 0;
  for (const auto& [stage, stage_seconds] : result.summary.seconds) seconds += stage_seconds;
  return {1e3 * ProcrustesPositionError(result.track.joints, clip.truth.joints).mean,
          1e3 * drift.w_mpjpe_m,
          1e3 * drift.wa_mpjpe_m,
          100 * drift.root_drift,
          drift.foot_slide_mps,
          ratio,
          ratio > 0 ? std::log(ratio) * metre.scale_m / metre.sigma_m : kNotMeasured,
          PathError(result.track.camera_from_scene, clip.truth.camera_from_scene),
          result.summary.ground.standing_speed_mps,
          result.summary.ground.up_spread_deg,
          seconds};
}

/// Points of a synthetic background.
BackgroundTracks BackgroundPoints(const SynthClip& clip, uint64_t seed) {
  SyntheticBackground background;
  const Camera& camera = clip.truth.camera;
  background.width = camera.width;
  background.height = camera.height;
  background.frames = clip.truth.num_frames();
  background.fps = kFps;
  background.focal_px = camera.fx;
  background.noise_px = 0.3;
  background.wanderers = 0.15;
  background.frames_of_anchor = 20;
  background.nearest_m = 3;
  background.farthest_m = 9;
  background.seed = seed;
  const std::vector<CameraPose>& path = clip.truth.camera_from_scene;
  background.pose = [&path](double t) {
    return path.empty() ? CameraPose() : path[static_cast<size_t>(std::lround(t * kFps))];
  };
  return TracksOf(background);
}

/// Points followed in pixels of a rendered room, bodies masked; its video is written to `video`, if given.
BackgroundTracks RoomPoints(const SynthClip& clip, RoomKind kind, uint64_t seed, const std::string& video) {
  RenderedRoom room(BuiltinBody(), clip, kind, seed);
  const Camera& camera = clip.truth.camera;
  std::optional<VideoWriter> writer;
  if (!video.empty()) writer.emplace(video, camera.width, camera.height, kFps);
  BackgroundTracker tracker;
  for (int t = 0; t < clip.truth.num_frames(); ++t) {
    Image image;
    CoveredRegion people;
    room.Draw(t, &image, &people.mask);
    tracker.Push(image, clip.truth.motion.timestamps[size_t(t)], {&people, 1});
    if (writer) writer->Write(image);
  }
  if (writer) writer->Finish();
  return tracker.Finish();
}

/// The path found from points of the background, empty if none is; metres a unit, 0: it turns in place.
struct FoundPath {
  std::vector<CameraPose> poses;
  double unit_m = 0;
  std::vector<Eigen::Vector3d> points = {};
  double within_1 = kNotMeasured, within_2 = kNotMeasured;  ///< shares of the header
};

/// Column roll_mps of the header, m/s.
double RollSpeed(const SynthClip& clip) {
  const std::vector<CameraPose>& path = clip.truth.camera_from_scene;
  const std::vector<std::string> names = {"left_ankle",    "right_ankle", "left_big_toe",
                                          "right_big_toe", "left_heel",   "right_heel"};
  constexpr int kStep = 3;
  std::vector<MatrixX3d> points;
  const Motion& motion = clip.truth.motion;
  for (int t = 0; t < motion.num_frames(); ++t) {
    const BodyPose pose =
        PoseFromAxisAngle(BuiltinBody(), motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
    points.push_back(PoseLandmarks(BuiltinBody(), motion.betas, pose, names));
  }
  double along = 0, way = 0;
  for (size_t t = kStep; t < path.size(); ++t) {
    const Eigen::Vector3d camera = CentreOf(path[t]) - CentreOf(path[t - kStep]);
    const MatrixX3d moved = points[t] - points[t - kStep];
    Eigen::Index slowest = 0;
    moved.rowwise().squaredNorm().minCoeff(&slowest);
    along += moved.row(slowest).dot(camera) * kFps / kStep;
    way += camera.norm();
  }
  return way > 0 ? along / way : kNotMeasured;
}

/// Fills within_1 and within_2.
void MeasureCoverage(const CameraMotion& motion, const std::vector<CameraPose>& truth, FoundPath* found) {
  std::vector<CameraPose> true_poses;
  for (const double t : motion.path.timestamps)
    true_poses.push_back(truth.at(static_cast<size_t>(std::lround(t * kFps))));
  const Eigen::Matrix3Xd places = Centres(motion.path.poses), true_places = Centres(true_poses);
  const Eigen::Matrix3Xd from_first = places.colwise() - places.col(0),
                         true_from_first = true_places.colwise() - true_places.col(0);
  Eigen::Index farthest = 0;
  from_first.colwise().squaredNorm().maxCoeff(&farthest);
  const double metres = true_from_first.col(farthest).norm() / from_first.col(farthest).norm();
  const Eigen::Matrix3d turned =
      true_poses[0].camera_from_world_rotation.transpose() * motion.path.poses[0].camera_from_world_rotation;
  double count = 0, in_1 = 0, in_2 = 0;
  for (Eigen::Index k = 0; k < places.cols(); ++k) {
    const double sigma_m = metres * motion.sigma_place[size_t(k)];
    if (!(sigma_m > 0)) continue;  // the first camera
    const Eigen::Array3d off = (metres * turned * from_first.col(k) - true_from_first.col(k)).array().abs() / sigma_m;
    count += 3;
    in_1 += double((off < 1).count());
    in_2 += double((off < 2).count());
  }
  if (count == 0) return;
  found->within_1 = in_1 / count;
  found->within_2 = in_2 / count;
}

FoundPath FindPath(const SynthClip& clip, const BackgroundTracks& background) {
  const Camera& camera = clip.truth.camera;
  CameraMotionOptions options;
  options.focal = {.log_mean = std::log(camera.fx)};
  options.focal_known = true;
  const CameraMotion motion = FindCameraMotion(background, options);
  std::fprintf(stderr, "%s: %s\n", ToString(motion.kind).c_str(), motion.why.c_str());
  if (!motion.has_path() || motion.zoom > 1) return {};
  FoundPath found{SampleCameraPath(motion.path, clip.truth.motion.timestamps).camera_from_scene, 0, motion.points};
  const std::vector<CameraPose>& path = clip.truth.camera_from_scene;
  if (motion.kind == CameraMotionKind::kMoving && !path.empty()) {
    found.unit_m = Eigen::umeyama(Centres(found.poses), Centres(path), true).col(0).head<3>().norm();
    MeasureCoverage(motion, path, &found);
  }
  return found;
}

void Run(const BenchArguments& arguments, const std::string& command) {
  BenchReport report;
  report.title = "A camera that moves, synthetic detections";
  report.command = command;
  report.label_columns = {"motion", "seed"};
  report.value_columns = {"pa_mpjpe_mm", "w_mpjpe_mm", "wa_mpjpe_mm",  "drift_percent", "slide_mps",
                          "ratio",       "ratio_z",    "path_percent", "standing",      "up_spread_deg",
                          "s",           "within_1",   "within_2",     "roll_mps"};
  for (const std::string& camera : arguments.List("cameras")) {
    for (const std::string& name : arguments.List("motions")) {
      const Motion motion = MotionNamed(name, arguments.Integer("frames"));
      for (int seed = 1; seed <= arguments.Integer("seeds"); ++seed) {
        SynthClipOptions options;
        options.seed = static_cast<uint64_t>(seed);
        options.dense_per_frame = 0;
        const bool turns = camera == "turning";
        options.camera_path.motion = SynthCameraMotionFromString(turns ? "hand-held" : camera);
        if (turns) options.camera_path.shake_m = 0;
        SynthClip clip = MakeSynthClip(BuiltinBody(), motion, options);
        for (const std::string& part : arguments.List("hide")) Hide(part, &clip.keypoints);
        const std::vector<CameraPose>& path = clip.truth.camera_from_scene;
        const double roll_mps = RollSpeed(clip);
        const auto add = [&](const std::string& told, const std::vector<CameraPose>* given, double scale_m,
                             double unit_m = kUnit, const FoundPath* found = nullptr) {
          std::vector<double> values =
              TrackAndMeasure(clip, given, scale_m, unit_m, found != nullptr ? &found->points : nullptr);
          values.push_back(found != nullptr ? found->within_1 : kNotMeasured);
          values.push_back(found != nullptr ? found->within_2 : kNotMeasured);
          values.push_back(roll_mps);
          report.rows.push_back({camera + ", " + told, {name, std::to_string(seed)}, std::move(values)});
          std::fprintf(stderr, "%s %s %d %s\n", camera.c_str(), name.c_str(), seed, told.c_str());
        };
        add("none", nullptr, 1);
        const std::string& room = arguments.Text("background");
        std::string video;
        if (!arguments.Text("write").empty()) {
          std::filesystem::create_directories(arguments.Text("write"));
          video = arguments.Text("write") + "/" + room + "_" + camera + "_" +
                  std::filesystem::path(name).stem().string() + "_" + std::to_string(seed) + ".mp4";
        }
        const FoundPath found =
            FindPath(clip, room == "points" ? BackgroundPoints(clip, options.seed)
                                            : RoomPoints(clip, RoomKindFromString(room), options.seed, video));
        add("found", found.poses.empty() ? nullptr : &found.poses, found.unit_m > 0 ? 0 : 1, found.unit_m,
            found.unit_m > 0 ? &found : nullptr);
        if (path.empty()) continue;
        add("path", &path, 1);
        const std::vector<CameraPose> unit = ScaledPath(path, 1 / kUnit), turned = ScaledPath(path, 0),
                                      noisy = Noisy(path, motion.timestamps, options.seed);
        add("scale", &unit, 0);
        add("noisy", &noisy, 1);
        add("rotations", &turned, 1);
      }
    }
  }
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_moving_camera", argc, argv,
                             {{"motions", "demo"},
                              {"frames", "180"},
                              {"seeds", "3"},
                              {"cameras", "still,turning,hand-held,walking,orbit"},
                              {"background", "points"},
                              {"hide", ""},
                              {"write", ""},
                              {"json", ""}},
                             bodyloom::Run);
}
