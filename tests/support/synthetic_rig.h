// SPDX-License-Identifier: Apache-2.0
// Synthetic rigs of known truth: the built-in body in motion, seen by cameras with clocks of their own, and how the
// stated standard deviations compare with the errors.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/sigma_reliability.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/hash_random.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/rig/track_views.h"

namespace bodyloom {

/// A camera around the person whose clock shows offset_s + (1 + drift) t at time t.
struct SyntheticCamera {
  double yaw_deg = 0, elevation_deg = 8;
  double fps = 30, begin_s = 1, length_s = 2.5, offset_s = 0, drift = 0;
  double focal_px = 0;     ///< 0: as of SynthCameraOptions
  bool backwards = false;  ///< another motion: this one from its end to its begin
  SynthCameraMotion motion = SynthCameraMotion::kStill;
};

struct RigNoise {
  double white_px = 3;
  double detector = 0;  ///< DetectionNoiseOptions::noise: slow errors, white ones and an offset of each view
  /// σ of each axis of where a landmark lies on the body, in all views and frames alike: a detector's shoulder is not
  /// the model's.
  double bias_m = 0;
  bool feet = true;  ///< toes and heels, which most detectors lack
};

/// Frames a second of motions that cameras sample.
inline constexpr double kRigMotionRate = 600;

/// The demo motion; at 600 frames a second.
inline Motion DemoRigMotion(double seconds = kDemoMotionSeconds) {
  return DemoMotion(BuiltinBody(), static_cast<int>(seconds * kRigMotionRate), kRigMotionRate);
}

/// The demo motion with a heading, a shape (of the mean body's stature) and limbs of its own: shoulders, elbows, hips,
/// knees and the spine turn by up to 25 degrees more in waves of 0.1 to 0.9 Hz.
inline Motion RandomRigMotion(uint64_t seed, double seconds) {
  const BodyModel& body = BuiltinBody();
  Motion motion = DemoRigMotion(seconds);
  HashRandom random(seed, {11});
  Eigen::VectorXd stature;
  StatureOfMeanShape(body, std::min(10, body.num_betas()), &stature);
  motion.betas.resize(stature.size());
  for (double& beta : motion.betas) beta = 0.7 * random.Normal();
  motion.betas -= stature * stature.dot(motion.betas) / stature.squaredNorm();
  const double heading = random.Uniform(-M_PI, M_PI);
  const Eigen::Vector3d pelvis = body.RestJoints(Eigen::VectorXd::Zero(stature.size())).row(0).transpose();
  const Eigen::Matrix3d turn = RotationFromAxisAngle({0, heading, 0});
  struct Wave {
    double size, frequency, phase;
  };
  std::vector<std::pair<int, std::array<Wave, 3>>> waves;
  for (const char* name :
       {"l_shoulder", "r_shoulder", "l_elbow", "r_elbow", "l_hip", "r_hip", "l_knee", "r_knee", "spine1", "spine2"}) {
    const int joint = body.FindJoint(name);
    if (joint < 0) continue;
    std::array<Wave, 3> of_joint{};
    const bool is_spine = name[0] == 's';
    for (Wave& wave : of_joint) {
      const double size = random.Uniform(0.1, is_spine ? 0.2 : 0.44), frequency = random.Uniform(0.1, 0.9);
      wave = {size, frequency, random.Uniform(0, 2 * M_PI)};
    }
    waves.emplace_back(joint, of_joint);
  }
  for (int t = 0; t < motion.num_frames(); ++t) {
    for (const auto& [joint, of_joint] : waves) {
      Eigen::Vector3d added;
      for (int axis = 0; axis < 3; ++axis) {
        const Wave& wave = of_joint[axis];
        added[axis] = wave.size * std::sin(2 * M_PI * wave.frequency * motion.timestamps[t] + wave.phase);
      }
      const Eigen::Vector3d rotation = motion.poses.row(t).segment<3>(3 * joint).transpose();
      motion.poses.row(t).segment<3>(3 * joint) =
          AxisAngleFromRotation(RotationFromAxisAngle(rotation) * RotationFromAxisAngle(added)).transpose();
    }
    const Eigen::Vector3d root = motion.poses.row(t).head<3>().transpose();
    motion.poses.row(t).head<3>() = AxisAngleFromRotation(turn * RotationFromAxisAngle(root)).transpose();
    const Eigen::Vector3d place = motion.trans.row(t).transpose();
    motion.trans.row(t) = (turn * (pelvis + place) - pelvis).transpose();
  }
  return motion;
}

/// Cameras around a person with clocks of their own, evenly but for up to 20 degrees; two are 40 to 140 degrees apart.
inline std::vector<SyntheticCamera> RandomRigCameras(uint64_t seed, int num_views, double length_s) {
  std::vector<SyntheticCamera> cameras;
  HashRandom random(seed, {12});
  const double first = random.Uniform(0, 360), second = random.Uniform(40, 140);
  for (int v = 0; v < num_views; ++v) {
    SyntheticCamera& camera = cameras.emplace_back();
    camera.yaw_deg = num_views == 2 ? first + v * second : first + 360.0 * v / num_views + random.Uniform(-20, 20);
    camera.elevation_deg = random.Uniform(-5, 25);
    camera.fps = random.Uniform() < 0.5 ? 25 : 30;
    camera.begin_s = random.Uniform(0, 0.5);
    camera.length_s = length_s - random.Uniform(0, 0.1) * length_s;
    camera.focal_px = random.Uniform(800, 1300);
    if (v == 0) continue;
    camera.offset_s = random.Uniform(-3, 3);
    camera.drift = 3e-5 * random.Normal();
  }
  return cameras;
}

/// Clips of all cameras and their truth.
class SyntheticRig {
 public:
  std::vector<SyntheticCamera> cameras;
  std::vector<SynthClip> clips;

  explicit SyntheticRig(std::vector<SyntheticCamera> given) : SyntheticRig(std::move(given), DemoRigMotion(), {}, 0) {}
  /// `whole`: at kRigMotionRate, in the world.
  SyntheticRig(std::vector<SyntheticCamera> given, const Motion& whole, const RigNoise& noise, uint64_t seed)
      : cameras(std::move(given)) {
    const Motion spanned = Sampled(whole, cameras[0]);
    std::map<std::string, Eigen::Vector3d> bias;
    HashRandom of_bias(seed, {8});
    for (const std::string& name : CocoNames()) {
      const double x = of_bias.Normal(), y = of_bias.Normal(), z = of_bias.Normal();
      bias[name] = noise.bias_m * Eigen::Vector3d(x, y, z);
    }
    for (size_t v = 0; v < cameras.size(); ++v) {
      SynthClipOptions options;
      options.seed = 100 * seed + v + 1;
      options.dense_per_frame = 0;
      options.detection.noise = noise.detector;
      options.detection.swap_probability = 0;
      options.camera.yaw_deg = cameras[v].yaw_deg;
      options.camera.elevation_deg = cameras[v].elevation_deg;
      options.camera.focal_px = cameras[v].focal_px;
      options.camera_path.motion = cameras[v].motion;
      const Motion seen = Sampled(whole, cameras[v]);
      const bool moves = cameras[v].motion != SynthCameraMotion::kStill;
      SynthClip& clip =
          clips.emplace_back(moves ? MakeSynthClip(BuiltinBody(), seen, options)
                                   : MakeSynthClip(BuiltinBody(), seen,
                                                   PlaceSynthCamera(BuiltinBody(), spanned, options.camera), options));
      if (noise.bias_m > 0) MoveOnBody(bias, &clip);
      if (!noise.feet) LeaveOutFeet(&clip.keypoints);
      HashRandom random(100 * seed + v, {7});
      for (Keypoint& point : clip.keypoints.points) {
        point.x += static_cast<float>(noise.white_px * random.Normal());
        point.y += static_cast<float>(noise.white_px * random.Normal());
      }
    }
  }

  enum class Known { kNothing, kIntrinsics, kAll };
  [[nodiscard]] std::vector<ObservedView> Views(Known known) const {
    std::vector<ObservedView> views;
    for (size_t v = 0; v < clips.size(); ++v) {
      ObservedView& view = views.emplace_back();
      view.keypoints = &clips[v].keypoints;
      if (cameras[v].motion != SynthCameraMotion::kStill) view.camera_from_own = &clips[v].truth.camera_from_scene;
      if (known == Known::kNothing) continue;
      view.knowledge = CameraKnowledge::kKnown;
      view.camera = clips[v].truth.camera;
      if (known == Known::kIntrinsics) continue;
      view.camera_from_rig = clips[v].camera_from_world;
      view.offset_s = cameras[v].offset_s - cameras[0].offset_s;
    }
    return views;
  }

  /// With chain alone and without standard deviations: fast.
  static TrackSequenceOptions Options(int threads) {
    TrackSequenceOptions options;
    options.num_threads = threads;
    options.solver = SequenceSolver::kChain;
    options.estimate_uncertainty = false;
    return options;
  }
  static TrackViewsResult Track(const std::vector<ObservedView>& views,
                                const TrackSequenceOptions& options = Options(2)) {
    TrackSequenceInput common;
    common.body = &BuiltinBody();
    common.prior = &BuiltinPosePrior();
    common.lifter = &BuiltinLifter();
    return TrackViews(views, common, options);
  }
  [[nodiscard]] TrackViewsResult Track(Known known, int threads = 2) const {
    return Track(Views(known), Options(threads));
  }

  /// Mean joint error after Procrustes, mm.
  [[nodiscard]] double Joint(const TrackViewsResult& result) const { return Error(result.joint.track, 0); }
  [[nodiscard]] double Alone(const TrackViewsResult& result, int v) const { return Error(result.alone[v].track, v); }

  /// From the first view's camera frame to that of view v; their scenes where they move.
  [[nodiscard]] CameraPose TruePose(int v) const {
    return Compose(clips[v].camera_from_world, Inverse(clips[0].camera_from_world));
  }
  /// Of view v's clock at the middle of the first view's clip, as ViewInput's.
  [[nodiscard]] double TrueOffset(int v) const {
    const std::vector<double>& times = clips[0].keypoints.timestamps;
    const double middle = 0.5 * (times.front() + times.back());
    return cameras[v].offset_s + (1 + TrueRate(v)) * (middle - cameras[0].offset_s) - middle;
  }
  [[nodiscard]] double TrueRate(int v) const { return (1 + cameras[v].drift) / (1 + cameras[0].drift) - 1; }

  [[nodiscard]] double RotationErrorDeg(const ViewSummary& found, int v) const {
    return RotationAngleBetween(found.camera_from_scene.camera_from_world_rotation,
                                TruePose(v).camera_from_world_rotation) *
           180 / M_PI;
  }
  [[nodiscard]] double ClockErrorFrames(const ViewSummary& found, int v) const {
    return std::abs(found.offset_s - TrueOffset(v)) * cameras[v].fps;
  }

 private:
  /// The motion at the true times of a camera's frames.
  static Motion Sampled(const Motion& whole, const SyntheticCamera& camera) {
    Motion motion = whole;
    const int frames = static_cast<int>(std::lround(camera.length_s * camera.fps));
    motion.poses.resize(frames, whole.poses.cols());
    motion.trans.resize(frames, 3);
    motion.timestamps.resize(frames);
    for (int t = 0; t < frames; ++t) {
      const double time = camera.begin_s + t / camera.fps;
      auto row = std::min(static_cast<Eigen::Index>(std::lround(time * kRigMotionRate)), whole.poses.rows() - 1);
      if (camera.backwards) row = whole.poses.rows() - 1 - row;
      motion.poses.row(t) = whole.poses.row(row);
      motion.trans.row(t) = whole.trans.row(row);
      motion.timestamps[t] = camera.offset_s + (1 + camera.drift) * time;
    }
    return motion;
  }
  /// Moves each landmark by a constant vector in the axes of its joint; those of the face in the head's.
  static void MoveOnBody(const std::map<std::string, Eigen::Vector3d>& bias, SynthClip* clip) {
    const BodyModel& body = BuiltinBody();
    const int head = body.FindJoint("head");
    const std::vector<std::string>& names = CocoNames();
    std::vector<int> column, joint;
    for (const std::string& name : names) {
      const auto& seen = clip->keypoints.names;
      column.push_back(static_cast<int>(std::find(seen.begin(), seen.end(), name) - seen.begin()));
      const size_t split = name.find('_');
      const int own = split == std::string::npos ? -1 : body.FindJoint(name.substr(0, 1) + name.substr(split));
      joint.push_back(own >= 0 ? own : head);
    }
    std::vector<Eigen::Matrix3d> global(body.num_joints());
    for (int t = 0; t < clip->truth.num_frames(); ++t) {
      const BodyPose pose = PoseFromAxisAngle(body, clip->truth.motion.poses.row(t).transpose(),
                                              clip->truth.motion.trans.row(t).transpose());
      for (int j = 0; j < body.num_joints(); ++j) {
        const int parent = body.parents()[j];
        global[j] = parent < 0 ? pose.rotations[j] : Eigen::Matrix3d(global[parent] * pose.rotations[j]);
      }
      for (size_t k = 0; k < names.size(); ++k) {
        const Eigen::Vector3d x = clip->truth.coco17[t].row(static_cast<Eigen::Index>(k)).transpose();
        Eigen::Vector2d model, seen;
        if (!clip->truth.camera.Project(x, &model) ||
            !clip->truth.camera.Project(x + global[joint[k]] * bias.at(names[k]), &seen)) {
          continue;
        }
        Keypoint& point = clip->keypoints.at(t, column[k]);
        point.x += static_cast<float>(seen.x() - model.x());
        point.y += static_cast<float>(seen.y() - model.y());
      }
    }
  }
  static void LeaveOutFeet(KeypointSequence* keypoints) {
    for (int k = 0; k < keypoints->num_points(); ++k) {
      if (std::count(CocoNames().begin(), CocoNames().end(), keypoints->names[k]) > 0) continue;
      for (int t = 0; t < keypoints->num_frames(); ++t) keypoints->at(t, k).confidence = 0;
    }
  }
  [[nodiscard]] double Error(const bodyloom::Track& track, int v) const {
    return 1000 * ProcrustesPositionError(track.joints, clips[v].truth.joints).frames.mean;
  }
};

/// Errors of what rigs state, one axis each, with their standard deviations.
class RigErrors {
 public:
  struct Of {
    std::vector<JudgedSigma> pairs;  ///< metres, radians, seconds or ratios
    /// Share of the errors within so many σ; of Gaussian ones 0.683 and 0.954.
    [[nodiscard]] double Within(double sigmas) const {
      const auto inside = std::count_if(pairs.begin(), pairs.end(),
                                        [&](const JudgedSigma& p) { return p.error_m <= sigmas * p.sigma_m; });
      return static_cast<double>(inside) / static_cast<double>(pairs.size());
    }
    [[nodiscard]] double RmsOfSigma() const {
      double sum = 0;
      for (const JudgedSigma& p : pairs) sum += p.error_m * p.error_m / (p.sigma_m * p.sigma_m);
      return std::sqrt(sum / static_cast<double>(pairs.size()));
    }
    [[nodiscard]] double MedianError() const { return Median(&JudgedSigma::error_m); }
    [[nodiscard]] double MedianSigma() const { return Median(&JudgedSigma::sigma_m); }

   private:
    [[nodiscard]] double Median(double JudgedSigma::*member) const {
      std::vector<double> values;
      for (const JudgedSigma& p : pairs) values.push_back(p.*member);
      std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
      return values[values.size() / 2];
    }
  };

  /// "rotation", "place", "focal length", "focal length of the first", "clock offset", "clock rate", "joints" (about
  /// the mid-hip) and "mid-hip".
  std::map<std::string, Of> of;

  /// Of a usable result; views that were not used are left out.
  void Add(const SyntheticRig& rig, const TrackViewsResult& result) {
    const TrackSequenceSummary& summary = result.joint.summary;
    size_t i = 0;
    for (size_t v = 1; v < rig.clips.size(); ++v) {
      if (result.summary.used[v] == 0) continue;
      const ViewSummary& view = summary.views[i++];
      const int at = static_cast<int>(v);
      const CameraPose truth = rig.TruePose(at);
      const Eigen::Vector3d turn = AxisAngleFromRotation(truth.camera_from_world_rotation.transpose() *
                                                         view.camera_from_scene.camera_from_world_rotation);
      const Eigen::Vector3d move =
          view.camera_from_scene.camera_from_world_translation - truth.camera_from_world_translation;
      for (int axis = 0; axis < 3; ++axis) {
        Take("rotation", turn[axis], view.rotation_sigma_rad);
        Take("place", move[axis], view.translation_sigma_m);
      }
      Take("focal length", std::log(view.camera.fx / rig.clips[v].truth.camera.fx), view.focal_log_sigma);
      Take("clock offset", view.offset_s - rig.TrueOffset(at), view.offset_sigma_s);
      Take("clock rate", view.rate - rig.TrueRate(at), view.rate_sigma);
    }
    const Track &track = result.joint.track, &truth = rig.clips[0].truth;
    Take("focal length of the first", std::log(track.camera.fx / truth.camera.fx), summary.focal_log_sigma);
    std::vector<int> source;
    std::vector<MatrixX3d> found, expected;
    for (int t = 2; t < track.num_frames(); t += 5) {
      source.push_back(t);
      found.push_back(track.coco17[t]);
      expected.push_back(truth.coco17[t]);
    }
    const std::vector<int> hips = {11, 12};
    const MatrixX3d root = RootPositions(found, hips), true_root = RootPositions(expected, hips);
    found = RelativeTo(found, root);
    expected = RelativeTo(expected, true_root);
    for (int axis = 0; axis < 3; ++axis) {
      const auto alone = [&](std::vector<MatrixX3d> points) {
        for (MatrixX3d& p : points) {
          const Eigen::VectorXd kept = p.col(axis);
          p.setZero();
          p.col(axis) = kept;
        }
        return points;
      };
      for (const JudgedSigma& pair : JudgedLandmarks(track, source, alone(found), alone(expected))) {
        of["joints"].pairs.push_back(pair);
      }
      for (size_t n = 0; n < source.size(); ++n) {
        const auto row = static_cast<Eigen::Index>(n);
        Take("mid-hip", root(row, axis) - true_root(row, axis), track.root_sigma[source[n]]);
      }
    }
  }

 private:
  void Take(const std::string& name, double error, double sigma) { of[name].pairs.push_back({std::abs(error), sigma}); }
};

}  // namespace bodyloom
