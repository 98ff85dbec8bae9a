// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/rig_track_evaluation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "data_tools/evaluation/metrics.h"
#include "data_tools/evaluation/metrics_image.h"
#include "data_tools/evaluation/room_errors.h"
#include "data_tools/evaluation/truth_evaluation.h"
#include "data_tools/evaluation/world_drift.h"
#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/base/units.h"
#include "geometry/body/hand_skeleton.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/time_bracket.h"
#include "geometry/scene/track_edits.h"

namespace bodyloom {
namespace {

constexpr double kLongestTruthGap_s = 0.1;
constexpr double kSameMoment_s = 1e-6;       // times that differ by less are one moment, told in different clocks
constexpr double kSameIntrinsics = 1e-3;     // relative
constexpr double kRotationTolerance = 1e-6;  // of a rig's poses
constexpr int kRigFramesHeld = 64;           // whose vertices are held at a time

void CheckStillPinhole(const Track& track, const char* which) {
  BODYLOOM_CHECK(!track.HasMovingCamera(), "the ", which, " is of a moving camera, a rig's cameras stand still");
  BODYLOOM_CHECK(track.camera.model == CameraModel::kPinhole, "the ", which,
                 " is of weak perspective, which does not tell where in the room a person is; expected a pinhole "
                 "camera's");
  BODYLOOM_CHECK(track.num_frames() > 0 && track.motion.timestamps.size() == size_t(track.num_frames()), "the ", which,
                 " has ", track.num_frames(), " frames and ", track.motion.timestamps.size(), " timestamps");
}

std::string NamesOf(const std::vector<RigCamera>& rig) {
  std::string names;
  for (const RigCamera& camera : rig) names += (names.empty() ? "" : ", ") + camera.name;
  return names;
}

/// Index of the camera `view`, of a rig that is what it should be.
size_t CheckRig(const std::vector<RigCamera>& rig, const std::string& view, const Camera& first, bool equal_clocks) {
  BODYLOOM_CHECK(!rig.empty(), "the rig has no cameras");
  for (const RigCamera& camera : rig) {
    BODYLOOM_CHECK(camera.camera.model == CameraModel::kPinhole && camera.camera.width > 0 && camera.camera.height > 0,
                   "the rig's camera '", camera.name, "': expected a pinhole camera with the size of its images");
    BODYLOOM_CHECK(IsRotation(camera.camera_from_rig.camera_from_world_rotation, kRotationTolerance) &&
                       camera.camera_from_rig.camera_from_world_translation.allFinite(),
                   "the rig's camera '", camera.name, "': expected a pose of a rotation and metres");
    BODYLOOM_CHECK(!camera.HasClock() || (std::isfinite(camera.offset_s) && std::isfinite(camera.middle_s) &&
                                          std::isfinite(camera.rate) && camera.rate > -1),
                   "the rig's camera '", camera.name, "': expected a clock of finite seconds and a rate above -1");
  }
  const Camera& own = rig[0].camera;
  BODYLOOM_CHECK(own.width == first.width && own.height == first.height &&
                     std::abs(own.fx - first.fx) < kSameIntrinsics * first.fx,
                 "the rig's first camera '", rig[0].name, "' has ", own.width, "x", own.height,
                 " pixels and a focal length of ", own.fx, ", the truth's camera ", first.width, "x", first.height,
                 " and ", first.fx, "; expected the rig that was written with the truth");
  const auto found = std::find_if(rig.begin(), rig.end(), [&](const RigCamera& one) { return one.name == view; });
  BODYLOOM_CHECK(view.empty() || found != rig.end(), "the rig has no camera '", view, "', expected one of ",
                 NamesOf(rig));
  const size_t index = view.empty() ? 0 : size_t(found - rig.begin());
  BODYLOOM_CHECK(rig[index].HasClock() || equal_clocks, "the clock of the rig's camera '", rig[index].name,
                 "' is not known; if all cameras ran on one, say that clocks are equal");
  return index;
}

/// Times of the first camera's clock at the track's frames.
std::vector<double> FirstTimes(const Track& track, const RigCamera& camera) {
  std::vector<double> times = track.motion.timestamps;
  if (!camera.HasClock()) return times;
  for (double& time : times) time = camera.FirstTimeAt(time);
  return times;
}

/// Errors of projected vertices in one camera, or in several.
struct ViewErrors {
  std::vector<double> frame_px, frame_percent;  ///< means of frames: pixels, and of the person's height there
  void Add(const ViewErrors& other) {
    frame_px.insert(frame_px.end(), other.frame_px.begin(), other.frame_px.end());
    frame_percent.insert(frame_percent.end(), other.frame_percent.begin(), other.frame_percent.end());
  }
};

void AddFrame(const MatrixX2d& pixels, const MatrixX2d& true_pixels, ViewErrors* errors) {
  const Eigen::VectorXd distances = (pixels - true_pixels).rowwise().norm();
  double sum = 0;
  int count = 0;
  for (const double distance : distances) {
    if (!std::isfinite(distance)) continue;
    sum += distance;
    ++count;
  }
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& pixel : true_pixels.rowwise()) {
    if (!pixel.allFinite()) continue;
    low = low.min(pixel.transpose().array());
    high = high.max(pixel.transpose().array());
  }
  const double mean = count > 0 ? sum / count : kNotMeasured;
  errors->frame_px.push_back(mean);
  errors->frame_percent.push_back(count > 0 ? 100 * mean / (high - low).maxCoeff() : kNotMeasured);
}

/// Errors in every camera of a rig.
struct RigErrors {
  std::vector<ViewErrors> views;
  std::vector<ViewErrors> placed;  ///< of the body in its true size and with its pelvis in its true place
};

/// Both tracks are in the frame of camera `own`; `scale`: true size / the track's.
RigErrors MeasureViews(const Track& track, const std::vector<int>& source, const Track& truth,
                       const std::vector<RigCamera>& rig, size_t own, double scale, const BodyModel& body,
                       const VertexErrorOptions& options) {
  BODYLOOM_CHECK(options.vertex_step >= 1, "vertex_step ", options.vertex_step, " must be positive");
  SkinnerOptions skinning;
  skinning.num_threads = options.num_threads;
  for (int v = 0; v < body.num_vertices(); v += options.vertex_step) skinning.vertices.push_back(v);
  const Skinner skinner(body, skinning);
  const ShapedBody shaped = skinner.Shape(track.motion.betas), true_shaped = skinner.Shape(truth.motion.betas);
  const CameraPose rig_from_own = Inverse(rig[own].camera_from_rig);
  std::vector<CameraPose> from_own;
  for (const RigCamera& camera : rig) from_own.push_back(Compose(camera.camera_from_rig, rig_from_own));
  const auto pose_of = [&](const Motion& motion, int t) {
    return PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
  };
  RigErrors errors{std::vector<ViewErrors>(rig.size()), std::vector<ViewErrors>(rig.size())};
  const size_t size = 3 * static_cast<size_t>(skinner.num_vertices());
  const int T = truth.num_frames();
  for (int begin = 0; begin < T; begin += kRigFramesHeld) {
    std::vector<BodyPose> poses, true_poses;
    for (int t = begin; t < std::min(T, begin + kRigFramesHeld); ++t) {
      poses.push_back(pose_of(track.motion, source[size_t(t)]));
      true_poses.push_back(pose_of(truth.motion, t));
    }
    std::vector<double> vertices(size * poses.size()), true_vertices(vertices.size());
    skinner.Skin(shaped, poses, vertices);
    skinner.Skin(true_shaped, true_poses, true_vertices);
    for (size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Map<const MatrixX3d> points(&vertices[size * i], skinner.num_vertices(), 3);
      const Eigen::Map<const MatrixX3d> true_points(&true_vertices[size * i], skinner.num_vertices(), 3);
      const auto pelvis = [&](const ShapedBody& shape, const BodyPose& pose) -> Eigen::RowVector3d {
        return shape.rest_joints.row(0) + pose.trans.transpose();
      };
      const MatrixX3d placed =
          (scale * (points.rowwise() - pelvis(shaped, poses[i]))).rowwise() + pelvis(true_shaped, true_poses[i]);
      for (size_t v = 0; v < rig.size(); ++v) {
        const MatrixX2d true_pixels = ProjectPoints(rig[v].camera, MovedPoints(from_own[v], true_points));
        AddFrame(ProjectPoints(rig[v].camera, MovedPoints(from_own[v], points)), true_pixels, &errors.views[v]);
        AddFrame(ProjectPoints(rig[v].camera, MovedPoints(from_own[v], placed)), true_pixels, &errors.placed[v]);
      }
    }
  }
  return errors;
}

void AddViewValues(const std::string& prefix, const ViewErrors& errors, const std::string& where, Evaluation* result) {
  const ErrorStatistics px = Summarize(errors.frame_px);
  result->Add(prefix + "_mean_px", px.mean, "per-vertex projection error in " + where + ", pixels of its images");
  result->Add(prefix + "_median_px", px.median, "median of frames' means");
  result->Add(prefix + "_p95_px", px.p95, "95th percentile of frames' means");
  result->Add(prefix + "_height_percent", Summarize(errors.frame_percent).mean, "of the person's height there");
}

void AddViews(const RigErrors& errors, const std::vector<RigCamera>& rig, size_t own, Evaluation* result) {
  AddViewValues("own_view", errors.views[own], "the track's view by the rig's camera", result);
  ViewErrors others, placed;
  EvaluationBreakdown mean{"view_mean_px", {}, {}}, median{"view_median_px", {}, {}}, p95{"view_p95_px", {}, {}},
      height{"view_height_percent", {}, {}};
  for (size_t v = 0; v < rig.size(); ++v) {
    if (v != own) {
      others.Add(errors.views[v]);
      placed.Add(errors.placed[v]);
    }
    const ErrorStatistics px = Summarize(errors.views[v].frame_px);
    const auto add = [&](EvaluationBreakdown* breakdown, double value) {
      breakdown->labels.push_back(rig[v].name);
      breakdown->values.push_back(value);
    };
    add(&mean, px.mean);
    add(&median, px.median);
    add(&p95, px.p95);
    add(&height, Summarize(errors.views[v].frame_percent).mean);
  }
  AddViewValues("other_views", others, "the other cameras", result);
  AddViewValues("other_views_placed", placed, "the other cameras after one scale and pelvis onto pelvis", result);
  for (EvaluationBreakdown* breakdown : {&mean, &median, &p95, &height}) {
    result->breakdowns.push_back(std::move(*breakdown));
  }
}

/// Joints of each frame; empty for a frame without a result.
std::vector<MatrixX3d> JointsOf(const Motion& motion, const BodyModel& body) {
  const MatrixX3d rest = body.RestJoints(motion.betas);
  std::vector<MatrixX3d> joints;
  for (int t = 0; t < motion.num_frames(); ++t) {
    joints.emplace_back(MatrixX3d::Constant(body.num_joints(), 3, kNotMeasured));
    if (!motion.HasPose(t)) continue;
    const BodyPose pose = PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
    joints.back() = PoseSkeleton(body, rest, pose).joints;
  }
  return joints;
}

std::vector<MatrixX3d> CocoLandmarksOf(const Motion& motion, const BodyModel& body) {
  std::vector<MatrixX3d> landmarks;
  for (int t = 0; t < motion.num_frames(); ++t) {
    landmarks.emplace_back(MatrixX3d::Constant(17, 3, kNotMeasured));
    if (!motion.HasPose(t)) continue;
    const BodyPose pose = PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
    landmarks.back() = PoseLandmarks(body, motion.betas, pose, CocoNames());
  }
  return landmarks;
}

/// `up_in_view`: the vertical by the truth, where it was observed.
void AddRoom(Track track, const Track& truth, const std::vector<int>& source,
             const std::optional<Eigen::Vector3d>& up_in_view, const BodyModel& body, Evaluation* result) {
  const std::vector<MatrixX3d> joints = JointsOf(track.motion, body), true_joints = JointsOf(truth.motion, body);
  std::vector<MatrixX3d> scored;
  for (const int t : source) scored.push_back(joints[size_t(t)]);
  result->Add("joint_err_mm", MeanPositionError(scored, true_joints).mean * kMmPerMetre,
              "joint error, nothing aligned");
  const WorldDrift drift = MeasureWorldDrift(track, truth, body);
  result->Add("w_mpjpe_mm", drift.w_mpjpe_m * kMmPerMetre, "the same, aligned on the first second by a rigid motion");
  result->Add("wa_mpjpe_mm", drift.wa_mpjpe_m * kMmPerMetre, "the same, aligned on the whole clip");
  result->Add("root_drift_percent", 100 * drift.root_drift, "pelvis error after the latter / the way it went");
  const bool has_coco = std::all_of(CocoNames().begin(), CocoNames().end(),
                                    [&](const std::string& name) { return body.FindLandmark(name) >= 0; });
  if (!has_coco) return;
  track.coco17 = CocoLandmarksOf(track.motion, body);
  const std::vector<MatrixX3d> true_landmarks = CocoLandmarksOf(truth.motion, body);
  for (size_t t = 0; t < source.size(); ++t) scored[t] = track.coco17[size_t(source[t])];
  result->Add("landmark_pa_mpjpe_mm", ProcrustesPositionError(scored, true_landmarks).mean * kMmPerMetre,
              "error of COCO's landmarks after one similarity a frame, the pa_mpjpe_mm of recordings");
  if (up_in_view) AddRoomErrors(track, true_landmarks, *up_in_view, truth.motion.timestamps, result);
}

struct JointGroup {
  const char* name;
  std::array<const char*, 3> joints;
};
constexpr JointGroup kJointGroups[] = {{"hips", {"l_hip", "r_hip"}},
                                       {"knees", {"l_knee", "r_knee"}},
                                       {"ankles", {"l_ankle", "r_ankle"}},
                                       {"spine", {"spine1", "spine2", "spine3"}},
                                       {"neck and head", {"neck", "head"}},
                                       {"collars", {"l_collar", "r_collar"}},
                                       {"shoulders", {"l_shoulder", "r_shoulder"}},
                                       {"elbows", {"l_elbow", "r_elbow"}},
                                       {"wrists", {"l_wrist", "r_wrist"}}};

/// Mean of the breakdown's values of these joints; not measured where the body has none of them.
double MeanOfJoints(const EvaluationBreakdown& of_joints, std::span<const char* const> joints) {
  double sum = 0;
  int count = 0;
  for (size_t j = 0; j < of_joints.labels.size(); ++j) {
    const bool is_one = std::any_of(joints.begin(), joints.end(),
                                    [&](const char* name) { return name != nullptr && of_joints.labels[j] == name; });
    if (!is_one) continue;
    sum += of_joints.values[j];
    ++count;
  }
  return count > 0 ? sum / count : kNotMeasured;
}

void AddJointGroups(Evaluation* result) {
  const auto angles = std::find_if(result->breakdowns.begin(), result->breakdowns.end(),
                                   [](const EvaluationBreakdown& one) { return one.name == "joint_angle_err_deg"; });
  if (angles == result->breakdowns.end()) return;
  constexpr std::array<const char*, 8> kLimbs = {"l_hip",      "r_hip",      "l_knee",  "r_knee",
                                                 "l_shoulder", "r_shoulder", "l_elbow", "r_elbow"};
  result->Add("limb_angle_err_deg", MeanOfJoints(*angles, kLimbs), "rotation error of hips, knees, shoulders, elbows");
  EvaluationBreakdown groups{"joint_angle_group_err_deg", {}, {}};
  for (const JointGroup& group : kJointGroups) {
    groups.labels.emplace_back(group.name);
    groups.values.push_back(MeanOfJoints(*angles, group.joints));
  }
  result->breakdowns.push_back(std::move(groups));
}

void AddTruthSigmas(const Track& truth, const RigCamera& view, Evaluation* result) {
  const std::span<const double> joints(truth.joint_sigma.data(), size_t(truth.joint_sigma.size()));
  const std::span<const double> roots(truth.root_sigma.data(), size_t(truth.root_sigma.size()));
  const double sigma = Percentile(joints, 50);
  const double mean_distance = 2 * std::sqrt(2 / std::numbers::pi);  // of a Gaussian error in space, in σ
  result->Add("truth_joint_sigma_mm", sigma * kMmPerMetre, "the truth's own standard deviation of joints, one axis");
  result->Add("truth_joint_err_mm", mean_distance * sigma * kMmPerMetre,
              "error of the truth's joints that it means: smaller errors of the track say nothing");
  result->Add("truth_root_sigma_mm", Percentile(roots, 50) * kMmPerMetre, "the same standard deviation of the mid-hip");
  result->Add("view_rotation_sigma_deg", view.rotation_sigma_rad / kDegree, "of the direction of the view's camera");
  result->Add("view_translation_sigma_mm", view.translation_sigma_m * kMmPerMetre, "of its place");
}

}  // namespace

Track TrackAtTimes(const BodyModel& body, const Track& track, const std::vector<double>& times_s) {
  CheckStillPinhole(track, "track");
  const std::vector<double>& known = track.motion.timestamps;
  for (size_t t = 0; t < known.size(); ++t) {
    BODYLOOM_CHECK(std::isfinite(known[t]) && (t == 0 || known[t] > known[t - 1]), "timestamp ", t, " is ", known[t],
                   ", expected finite seconds that ascend");
  }
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Track sampled;
  sampled.camera = track.camera;
  sampled.world = track.world;
  sampled.motion.body = track.motion.body;
  sampled.motion.up = track.motion.up;
  sampled.motion.betas = track.motion.betas;
  sampled.motion.timestamps = times_s;
  // SMPL's 24 joints are written as those of a body with fingers, which have no joints for the whole hand.
  const Eigen::Index columns = HasFingers(body) ? Eigen::Index{3} * body.num_joints() : track.motion.poses.cols();
  sampled.motion.poses = RowMatrixXd::Constant(Eigen::Index(times_s.size()), columns, kNaN);
  sampled.motion.trans = MatrixX3d::Constant(Eigen::Index(times_s.size()), 3, kNaN);
  sampled.frame_status.assign(times_s.size(), FrameStatus::kLost);
  sampled.level_m = Eigen::VectorXd::Zero(track.level_m.size() > 0 ? Eigen::Index(times_s.size()) : 0);
  const auto observed = [&](int t) {
    return track.HasResult(t) &&
           (track.frame_status.size() <= size_t(t) || track.frame_status[size_t(t)] != FrameStatus::kInterpolated);
  };
  const auto pose_at = [&](int t) {
    return PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
  };
  for (size_t i = 0; i < times_s.size(); ++i) {
    if (!std::isfinite(times_s[i])) continue;
    const double time = std::abs(times_s[i] - known.front()) < kSameMoment_s ? known.front() : times_s[i];
    std::optional<TimeBracket> at = FindTimeBracket(known, time, kSameMoment_s);
    if (!at) continue;
    // On a frame the other one does not matter.
    if (at->s * at->gap_s < kSameMoment_s) at->after = at->before;
    if ((1 - at->s) * at->gap_s < kSameMoment_s) at->before = at->after;
    if (!observed(at->before) || !observed(at->after)) continue;
    const auto row = static_cast<Eigen::Index>(i);
    sampled.frame_status[i] = FrameStatus::kTracked;
    if (sampled.level_m.size() > 0) sampled.level_m[row] = track.level_m[at->s < 0.5 ? at->before : at->after];
    if (at->before == at->after) {
      if (columns == track.motion.poses.cols()) {
        sampled.motion.poses.row(row) = track.motion.poses.row(at->before);
      } else {
        sampled.motion.poses.row(row) = AxisAngleFromPose(body, pose_at(at->before)).transpose();
      }
      sampled.motion.trans.row(row) = track.motion.trans.row(at->before);
      continue;
    }
    if (at->gap_s > kLongestTruthGap_s) {
      sampled.frame_status[i] = FrameStatus::kLost;
      continue;
    }
    BodyPose pose = pose_at(at->before);
    const BodyPose next = pose_at(at->after);
    for (size_t j = 0; j < pose.rotations.size(); ++j) {
      pose.rotations[j] = InterpolateRotation(pose.rotations[j], next.rotations[j], at->s);
    }
    sampled.motion.poses.row(row) = AxisAngleFromPose(body, pose).head(columns).transpose();
    sampled.motion.trans.row(row) = ((1 - at->s) * pose.trans + at->s * next.trans).transpose();
  }
  return sampled;
}

Evaluation EvaluateAgainstRig(const Track& track, const Track& truth, const std::vector<RigCamera>& rig,
                              const std::string& view, const BodyModel& body, const RigTrackOptions& options) {
  CheckStillPinhole(track, "track");
  CheckStillPinhole(truth, "truth");
  BODYLOOM_CHECK(track.motion.body == truth.motion.body && track.motion.poses.cols() == truth.motion.poses.cols(),
                 "the track is of the body '", track.motion.body, "' with ", track.motion.poses.cols() / 3,
                 " joints, the truth of '", truth.motion.body, "' with ", truth.motion.poses.cols() / 3);
  const size_t own = CheckRig(rig, view, truth.camera, options.equal_clocks);
  const CameraPose& own_from_rig = rig[own].camera_from_rig;
  const std::vector<double> times = FirstTimes(track, rig[own]);
  const Track at_times = TrackAtTimes(body, truth, times);
  std::vector<int> frames;
  for (int t = 0; t < track.num_frames(); ++t) {
    if (at_times.HasResult(t)) frames.push_back(t);
  }
  const std::vector<double>& known = truth.motion.timestamps;
  BODYLOOM_CHECK(!frames.empty(), "the truth has none of the track's frames: these are from ", times.front(), " to ",
                 times.back(), " s of the first camera's clock, the truth's from ", known.front(), " to ",
                 known.back());

  const Track compared = SelectFrames(track, frames);
  Track compared_truth = SelectFrames(at_times, frames);
  compared_truth.motion = MovedMotion(body, compared_truth.motion, {&own_from_rig, 1});
  compared_truth.motion.timestamps = compared.motion.timestamps;
  compared_truth.camera = rig[own].camera;

  Evaluation result = EvaluateAgainstTruth(compared, compared_truth, body, options.vertices);
  result.protocol = "rig-track";
  result.description =
      "A track of one camera against one of several cameras, which takes the place of a truth and has errors of its "
      "own (truth_..._mm). Truth at the track's moments by the cameras' clocks, both in the frame of the track's "
      "camera. own_view, other_views: distance of corresponding vertices in pixels, both by the rig's cameras. " +
      result.description;
  result.subject = {{"view", rig[own].name}, {"cameras", NamesOf(rig)}};
  result.Add("frames_without_truth", track.num_frames() - compared.num_frames(), "frames left out");
  AddTruthSigmas(truth, rig[own], &result);
  const std::vector<int> source = NearestFramesWithResult(HasResults(compared, compared.num_frames()));
  if (source.empty()) return result;
  const double scale = result.Value("clip_scale");
  AddViews(MeasureViews(compared, source, compared_truth, rig, own, scale, body, options.vertices), rig, own, &result);
  std::optional<Eigen::Vector3d> up;
  if (truth.world && truth.world->source != WorldSource::kLevelCamera) {
    up = own_from_rig.camera_from_world_rotation * truth.world->up_in_camera();
  }
  AddRoom(compared, compared_truth, source, up, body, &result);
  AddJointGroups(&result);
  return result;
}

}  // namespace bodyloom
