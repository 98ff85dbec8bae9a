// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/track_result.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/base/percentile.h"
#include "geometry/body/posed_body.h"
#include "tracking/problem/body_points.h"
#include "tracking/problem/frame_cost.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/problem/user_cost.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/initialiser.h"
#include "tracking/terms/part_labels/part_label_term.h"
#include "tracking/terms/rendered_uv/rendered_uv_term.h"

namespace bodyloom {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Fewer 2D joints than this and the frame is called weak: the torso alone gives four, a limb two more.
constexpr int kFewLandmarks = 6;
constexpr int kFewDense = 20;

void Lose(int t, Track* track) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  track->frame_status[t] = FrameStatus::kLost;
  track->motion.poses.row(t).setConstant(kNaN);
  track->motion.trans.row(t).setConstant(kNaN);
  if (track->weak_camera.rows() > 0) track->weak_camera.row(t).setConstant(kNaN);
  track->joints[t].setConstant(kNaN);
  track->coco17[t].setConstant(kNaN);
}

}  // namespace

FrameStatus StatusOf(const FrameData& frame) {
  const size_t dense = frame.Get<DenseTerm>().size(), joints = frame.Get<LandmarkTerm>().seen.size();
  const PartLabelSource* labels = frame.Get<PartLabelTerm>().matches;
  if (labels != nullptr && labels->num_person_pixels() > 0) return FrameStatus::kTracked;
  if (joints == 0 && dense == 0) return FrameStatus::kInterpolated;
  if (joints < kFewLandmarks && dense < kFewDense) return FrameStatus::kWeak;
  return FrameStatus::kTracked;
}

void FillTrack(const TrackSequenceInput& input, const SequenceProblem& problem, const ObservedLandmarks& landmarks,
               TrackSequenceResult* result) {
  const BodyModel& model = *input.body;
  const int T = static_cast<int>(problem.states.size()), J = model.num_joints();
  Track& track = result->track;
  TrackSequenceSummary& summary = result->summary;
  track.motion.body = model.name();
  track.motion.up = Motion::Up::kCamera;
  track.motion.timestamps = problem.timestamps;
  track.motion.betas = problem.betas;
  track.motion.poses.resize(T, 3 * J);
  track.motion.trans.resize(T, 3);
  track.camera = problem.layout.camera;
  if (problem.layout.focal_column >= 0) track.camera.fx = track.camera.fy = std::exp(problem.log_focal);
  const bool weak = problem.layout.knowledge == CameraKnowledge::kWeak;
  track.weak_camera.resize(weak ? T : 0, 3);
  track.joint_sigma.setConstant(T, J, std::numeric_limits<double>::quiet_NaN());
  track.root_sigma.setConstant(T, std::numeric_limits<double>::quiet_NaN());
  summary.focal_px = track.camera.fx;
  for (FrameStatus status :
       {FrameStatus::kTracked, FrameStatus::kWeak, FrameStatus::kInterpolated, FrameStatus::kLost}) {
    summary.frames_by_status[ToString(status)] = 0;
  }

  std::vector<CompiledPoint> coco;
  for (const std::string& name : CocoNames()) {
    const int index = model.FindLandmark(name);
    if (index < 0) break;
    const Landmark& landmark = model.data().landmarks[index];
    coco.push_back(CompilePoint(model, landmark.vertices, landmark.weights, static_cast<int>(problem.betas.size())));
  }
  Kinematics kinematics;
  PointEvaluator points;
  PointEvaluator::VertexCache vertices;
  std::vector<double> landmark_errors, dense_errors;
  for (int t = 0; t < T; ++t) {
    const FrameState& state = problem.states[t];
    const FrameData& frame = problem.frames[t];
    Vector3d trans = state.translation;
    if (weak) {
      track.weak_camera.row(t) << std::exp(state.translation[0]), state.translation[1], state.translation[2];
      trans.setZero();
    }
    track.motion.poses.row(t) = AxisAngleFromPose(model, BodyPose{state.rotations, trans}).transpose();
    track.motion.trans.row(t) = trans.transpose();
    kinematics.Set(model, problem.betas, state.rotations, trans, false);
    MatrixX3d joints(J, 3);
    for (int j = 0; j < J; ++j) joints.row(j) = kinematics.p[j].transpose();
    track.joints.push_back(joints);
    MatrixX3d coco17(static_cast<Eigen::Index>(coco.size()), 3);
    for (size_t k = 0; k < coco.size(); ++k) coco17.row(k) = points.Evaluate(kinematics, coco[k], false).transpose();
    track.coco17.push_back(coco17);
    const FrameStatus status = IsFinite(state) ? StatusOf(frame) : FrameStatus::kLost;
    track.frame_status.push_back(status);
    ++summary.frames_by_status[ToString(status)];

    if (frame.camera_from_scene != nullptr) {
      track.camera_from_scene.push_back(*frame.camera_from_scene);
      const FrameState seen = StateInCamera(problem, t);
      kinematics.Set(model, problem.betas, seen.rotations, seen.translation, false);
    }
    const Camera camera = track.CameraAt(t);
    if (input.keypoints != nullptr) {
      const size_t before = landmark_errors.size();
      AppendLandmarkErrors(landmarks, *input.keypoints, t, camera, kinematics, &landmark_errors);
      summary.frame_px.push_back(Percentile(std::span(landmark_errors).subspan(before), 50));
    }
    if (const auto* dense = frame.Get<DenseTerm>().points; dense != nullptr) {
      vertices.NewFrame(kinematics);
      AppendDenseErrors(*dense, camera, kinematics, &vertices, &dense_errors);
    }
  }
  const TermSummary joints = SummarizeTerm("2D joints", landmark_errors);
  const TermSummary dense = SummarizeTerm("dense keypoints", dense_errors);
  summary.reprojection_median_px = joints.median_px, summary.reprojection_p95_px = joints.p95_px;
  summary.dense_median_px = dense.median_px;
  if (input.keypoints != nullptr) summary.terms.push_back(joints);
  if (input.dense != nullptr) summary.terms.push_back(dense);
}

void LoseUnseenFrames(const SequenceProblem& problem, TrackSequenceResult* result) {
  Track& track = result->track;
  TrackSequenceSummary& summary = result->summary;
  const std::vector<int> shots = ShotOfFrames(problem.cut_before);
  const auto is_held = [&](int t) {
    const FrameData& frame = problem.frames[t];
    return track.frame_status[t] == FrameStatus::kTracked || track.frame_status[t] == FrameStatus::kWeak ||
           frame.Get<InitialiserTerm>().num_rows() > 0 || !frame.Get<UserCostTerm>().is_empty();
  };
  const int T = track.num_frames();
  for (int begin = 0, end = 0; begin < T; begin = end) {  // runs of unseen frames, and frames between them
    end = begin + 1;
    if (is_held(begin)) continue;
    while (end < T && shots[end] == shots[begin] && !is_held(end)) ++end;
    const bool is_hole =
        begin > 0 && end < T && shots[begin - 1] == shots[begin] && shots[end] == shots[begin];  // seen on both sides
    if (is_hole && problem.timestamps[end] - problem.timestamps[begin - 1] <= kLongestHole_s) continue;
    for (int t = begin; t < end; ++t) {
      if (track.frame_status[t] == FrameStatus::kLost) continue;
      --summary.frames_by_status[ToString(track.frame_status[t])];
      ++summary.frames_by_status[ToString(FrameStatus::kLost)];
      summary.lost_in_holes += is_hole ? 1 : 0;
      Lose(t, &track);
    }
  }
}

void SummariseImageTerms(const SequenceProblem& problem, const FrameResiduals& residuals,
                         TrackSequenceSummary* summary) {
  for (const FrameData& frame : problem.frames) {
    summary->num_observations += frame.Get<SilhouetteTerm>().num_rows() + frame.Get<PartLabelTerm>().num_rows();
  }
  for (const char* term : {"rendered UV", "silhouette", "part labels"}) {
    const auto at = residuals.find(term);
    if (at != residuals.end()) summary->terms.push_back(SummarizeTerm(term, at->second.px, at->second.unmatched));
  }
}

}  // namespace bodyloom
