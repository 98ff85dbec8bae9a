// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/track_result.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/percentile.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/tracking/ground_terms.h"
#include "bodyloom/tracking/image_terms.h"
#include "bodyloom/tracking/initialise/initial_states.h"
#include "bodyloom/tracking/kinematics.h"

namespace bodyloom {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Fewer 2D joints than this and the frame is called weak: the torso alone gives four, a limb two more.
constexpr int kFewLandmarks = 6;
constexpr int kFewDense = 20;

bool IsFinite(const FrameState& state) {
  return state.translation.allFinite() && std::all_of(state.rotations.begin(), state.rotations.end(),
                                                      [](const Eigen::Matrix3d& R) { return R.allFinite(); });
}

}  // namespace

TermSummary SummarizeTerm(const std::string& term, const std::vector<double>& px, int unmatched) {
  TermSummary summary{term, static_cast<int>(px.size()), unmatched, 0, 0};
  if (px.empty()) return summary;
  const std::vector<double> sorted = SortedFinite(px);
  summary.median_px = SortedPercentile(sorted, 50), summary.p95_px = SortedPercentile(sorted, 95);
  return summary;
}

FrameStatus StatusOf(const FrameData& frame) {
  const size_t dense = frame.dense != nullptr ? frame.dense->size() : 0;
  if (frame.part_labels != nullptr && frame.part_labels->num_person_pixels() > 0) return FrameStatus::kTracked;
  if (frame.landmarks.empty() && dense == 0) return FrameStatus::kInterpolated;
  if (frame.landmarks.size() < kFewLandmarks && dense < kFewDense) return FrameStatus::kWeak;
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

    const Camera camera = track.CameraAt(t);
    Vector2d pixel;
    for (size_t i = 0; i < landmarks.names.size(); ++i) {
      const Keypoint& seen = input.keypoints->at(t, landmarks.keypoint_column[i]);
      if (!(seen.confidence > 0.3F)) continue;
      if (camera.Project(points.Evaluate(kinematics, landmarks.points[i], false), &pixel)) {
        landmark_errors.push_back((pixel - Vector2d(seen.x, seen.y)).norm());
      }
    }
    if (frame.dense != nullptr) {
      vertices.NewFrame(kinematics);
      for (const DenseKeypoint& point : *frame.dense) {
        const Vector3d barycentric = point.barycentric.cast<double>();
        const Vector3d x = points.Evaluate(kinematics, model.data().faces.row(point.face).data(), barycentric.data(),
                                           &vertices, false);
        if (camera.Project(x, &pixel)) dense_errors.push_back((pixel - point.pixel.cast<double>()).norm());
      }
    }
  }
  const TermSummary joints = SummarizeTerm("2D joints", landmark_errors);
  const TermSummary dense = SummarizeTerm("dense keypoints", dense_errors);
  summary.reprojection_median_px = joints.median_px, summary.reprojection_p95_px = joints.p95_px;
  summary.dense_median_px = dense.median_px;
  if (input.keypoints != nullptr) summary.terms.push_back(joints);
  if (input.dense != nullptr) summary.terms.push_back(dense);
}

std::vector<PlanEntry> PlanTrackSequence(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  std::vector<PlanEntry> plan;
  const BodyModel& model = *input.body;
  const bool dense = input.dense != nullptr;
  const ObservedLandmarks landmarks = FindObservedLandmarks(model, input.keypoints, 0);
  const bool labels = input.part_labels != nullptr;
  const size_t active = FindActiveJoints(model, landmarks, dense || labels, options.skip_unneeded).size();
  const auto add = [&](const std::string& what, bool runs, const std::string& why) {
    plan.push_back({what, runs, why});
  };
  const std::string no_lifter = WhyNoLifter(input, options);
  add("lifter", no_lifter.empty(),
      !no_lifter.empty()           ? no_lifter
      : input.keypoints != nullptr ? "starts from 2D joints"
                                   : "starts from joints among the dense keypoints");
  add("hypotheses over the clip", input.initialiser == nullptr && !no_lifter.empty(),
      input.initialiser != nullptr ? "the initialiser gives the start"
      : no_lifter.empty()          ? "the lifter gives the start"
                                   : "no initialiser and no lifter");
  add("2D joints (L_f)", input.keypoints != nullptr,
      input.keypoints != nullptr ? std::to_string(landmarks.names.size()) + " landmarks" : "no 2D joints in the input");
  add("dense keypoints (L_f)", dense, dense ? "in the input" : "no dense keypoints in the input");
  const auto add_unless = [&](const std::string& what, const std::string& why_not, const std::string& why) {
    add(what, why_not.empty(), why_not.empty() ? why : why_not);
  };
  add_unless("rendered UV (L_r)", WhyNoRenderedUv(input, options),
             "weight " + std::to_string(options.rendered_uv.weight));
  add_unless("silhouette", WhyNoSilhouette(input, options), "of all labelled parts");
  add_unless("part labels", WhyNoParts(input, options), "outline and pixels of each part");
  const bool stays = input.initialiser != nullptr ? options.initialiser_weight > 0 : no_lifter.empty();
  add("initialiser term (L_d)", stays,
      stays ? Concatenate("weight ", input.initialiser != nullptr ? options.initialiser_weight : options.lifter_weight,
                          input.initialiser != nullptr ? "" : ", of the lifter")
            : "no initialiser and no lifter");
  add_unless("vertical", WhyNoUp(input, options), "the trunk's lean is measured against it");
  add_unless("ground", WhyNoGround(input, options), "looked for; standing feet are held to it when there is one");
  add("pose prior", input.prior != nullptr, input.prior != nullptr ? "learned mixture" : "none was given");
  const std::string joints = std::to_string(active) + " of " + std::to_string(model.num_joints());
  add("joint rotations", true, joints + " joints are estimated");
  if (active < static_cast<size_t>(model.num_joints())) {
    add("remaining joints", false, "no observed landmark depends on them; held at rest");
  }
  add("surface vertices", dense || labels,
      dense || labels ? "of dense keypoints and outlines; all of them only to see what is visible"
                      : "2D joints are compiled to their bones");
  add("shape", options.estimate_shape, options.estimate_shape ? "one for the clip" : "switched off");
  add("focal length", options.camera_knowledge == CameraKnowledge::kUnknownFocal,
      options.camera_knowledge == CameraKnowledge::kKnown  ? "known"
      : options.camera_knowledge == CameraKnowledge::kWeak ? "weak perspective has none"
                                                           : "estimated with the clip");
  add("uncertainty", options.estimate_uncertainty, options.estimate_uncertainty ? "per joint" : "switched off");
  return plan;
}

std::string TrackSequenceSummary::BriefReport() const {
  std::ostringstream out;
  out << ToString(status) << " after " << iterations << " iterations, cost " << initial_cost << " -> " << final_cost;
  if (!frames_by_status.empty()) {
    out << "\nframes:";
    for (const auto& [name, count] : frames_by_status) {
      if (count > 0) out << ' ' << count << ' ' << name;
    }
  }
  if (reprojection_median_px > 0) {
    out << "\n2D joints: median " << reprojection_median_px << " px, 95 % below " << reprojection_p95_px << " px";
  }
  if (dense_median_px > 0) out << "\ndense keypoints: median " << dense_median_px << " px";
  for (const TermSummary& term : terms) {
    if (term.term == "2D joints" || term.term == "dense keypoints") continue;
    out << '\n'
        << term.term << ": median " << term.median_px << " px, 95 % below " << term.p95_px << " px, "
        << term.observations << " matched, " << term.unmatched << " not";
  }
  return out.str();
}

}  // namespace bodyloom
