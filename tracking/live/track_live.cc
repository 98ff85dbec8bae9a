// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/track_live.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/posed_body.h"
#include "tracking/clip/track_plan.h"
#include "tracking/clip/track_result.h"
#include "tracking/hands/fit_hands.h"
#include "tracking/problem/input_checks.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/observability.h"

namespace bodyloom {

using Eigen::VectorXd;
namespace {

const std::vector<double>& TimesOf(const TrackSequenceInput& input) {
  return input.keypoints != nullptr ? input.keypoints->timestamps : input.dense->timestamps;
}

/// Results of the tracker, collected frame by frame.
struct Taken {
  SequenceProblem problem;
  RowMatrixXd joint_sigma;
  Eigen::VectorXd root_sigma;
  std::vector<FrameStatus> status;
};

void Take(LiveFrame&& frame, bool weak, Taken* taken) {
  SequenceProblem* problem = &taken->problem;
  taken->joint_sigma.row(frame.index) = frame.joint_sigma.transpose();
  taken->root_sigma[frame.index] = frame.root_sigma;
  taken->status[frame.index] = frame.status;
  FrameState& state = problem->states[frame.index];
  state = std::move(frame.state);
  if (weak && frame.status != FrameStatus::kLost) {
    state.translation = {std::log(frame.camera.scale), frame.camera.tx, frame.camera.ty};
  }
  problem->cut_before[frame.index] = frame.cut_before ? 1 : 0;
}

}  // namespace

LiveObservations ObservationsAt(const TrackSequenceInput& input, int t) {
  LiveObservations frame;
  frame.timestamp = TimesOf(input)[t];
  if (input.keypoints != nullptr) {
    const auto K = static_cast<std::ptrdiff_t>(input.keypoints->names.size());
    frame.keypoints.assign(input.keypoints->points.begin() + t * K, input.keypoints->points.begin() + (t + 1) * K);
  }
  if (input.dense != nullptr) frame.dense = input.dense->frames[t];
  if (input.initialiser != nullptr && input.initialiser->HasPose(t)) {
    frame.initialiser = PoseFromAxisAngle(*input.body, input.initialiser->poses.row(t).transpose(),
                                          input.initialiser->trans.row(t).transpose());
  }
  return frame;
}

LiveTrackerInput LiveInputFor(const TrackSequenceInput& input) {
  LiveTrackerInput live;
  live.body = input.body;
  live.prior = input.prior;
  live.lifter = input.lifter;
  live.camera = input.camera;
  live.focal_prior = input.focal_prior;
  const auto take_size = [&](const auto* observations) {
    if (observations == nullptr || live.camera.width > 0) return;
    live.camera.width = observations->image_width;
    live.camera.height = observations->image_height;
  };
  take_size(input.keypoints);
  take_size(input.dense);
  if (input.keypoints != nullptr) live.landmarks = input.keypoints->names;
  live.dense = input.dense != nullptr;
  return live;
}

std::vector<PlanEntry> PlanTrackLive(const TrackSequenceInput& input, const LiveTrackerOptions& options) {
  TrackSequenceInput seen = input;
  seen.part_labels = nullptr;
  if (input.initialiser != nullptr) seen.lifter = nullptr;  // nor is it lifted for the ground
  TrackSequenceOptions solve = options.solve;
  solve.rendered_uv.weight = 0;
  std::vector<PlanEntry> plan = PlanTrackSequence(seen, solve);
  plan.insert(plan.begin(), {"live", true,
                             Concatenate("each frame is fitted when the ", options.lag,
                                         " after it have come, in a window of ", options.lag + options.context)});
  if (input.part_labels != nullptr) plan.push_back({"part labels", false, "not in live mode"});
  SkipHandsAndHead("not in live mode", &plan);
  return plan;
}

TrackSequenceResult TrackLive(const TrackSequenceInput& input, const LiveTrackerOptions& options) {
  BODYLOOM_CHECK(input.body != nullptr, "live: no body");
  BODYLOOM_CHECK(input.keypoints != nullptr || input.dense != nullptr,
                 "live: neither 2D joints nor dense keypoints; give at least one");
  CheckNumbers(input, options.solve);
  const int T = static_cast<int>(TimesOf(input).size());
  BODYLOOM_CHECK(T > 0, "live: the detections hold no frames");
  BODYLOOM_CHECK(input.keypoints == nullptr || input.dense == nullptr || input.dense->num_frames() == T, "live: ", T,
                 " frames of 2D joints but ", input.dense != nullptr ? input.dense->num_frames() : 0,
                 " of dense keypoints");
  BODYLOOM_CHECK(input.initialiser == nullptr || input.initialiser->num_frames() == T, "live: the initialiser has ",
                 input.initialiser != nullptr ? input.initialiser->num_frames() : 0, " frames, the detections ", T);
  BODYLOOM_CHECK(input.camera_from_scene == nullptr,
                 "live: the camera must stand still; track the whole clip to give its path");
  const Stopwatch watch;
  LiveTracker tracker(LiveInputFor(input), options);
  TrackSequenceResult result;
  TrackSequenceSummary& summary = result.summary;
  summary.plan = PlanTrackLive(input, options);
  summary.solver = "chain, live";
  Taken taken;
  SequenceProblem& problem = taken.problem;
  problem.layout = tracker.layout();
  problem.states.resize(T);
  problem.frames.resize(T);
  problem.cut_before.assign(T, 0);
  problem.timestamps = TimesOf(input);
  const bool weak = problem.layout.knowledge == CameraKnowledge::kWeak;
  taken.joint_sigma.resize(T, input.body->num_joints());
  taken.root_sigma.resize(T);
  taken.status.assign(T, FrameStatus::kLost);
  summary.status = SolveStatus::kConverged;
  int pushed = 0;
  for (int t = 0; t < T && summary.status == SolveStatus::kConverged; ++t, ++pushed) {
    if (std::optional<LiveFrame> frame = tracker.Push(ObservationsAt(input, t))) Take(std::move(*frame), weak, &taken);
    if (options.solve.progress && t % 16 == 0 && !options.solve.progress({"live", double(t) / T, 0})) {
      summary.status = SolveStatus::kStopped;
      summary.message = "stopped by the caller";
    }
  }
  problem.betas = tracker.betas();
  problem.log_focal = tracker.log_focal();
  summary.num_swaps_repaired = tracker.num_swaps_repaired();
  for (LiveFrame& frame : tracker.Finish()) Take(std::move(frame), weak, &taken);
  summary.iterations = static_cast<int>(tracker.num_iterations());
  if (summary.status == SolveStatus::kStopped) return result;
  if (tracker.num_frames_left_out() > 0) {
    summary.plan.push_back({"2D joints of impossible frames", false,
                            Concatenate(tracker.num_frames_left_out(), " frames jump away from the person and back")});
  }

  VectorXd gradient;
  const double stature = StatureOfMeanShape(*input.body, problem.layout.num_betas, &gradient);
  const ObservedLandmarks landmarks = FindObservedLandmarks(*input.body, input.keypoints, problem.layout.num_betas);
  int found = 0;
  for (int t = 0; t < T; ++t) {
    const FrameState& state = problem.states[t];
    if (!state.translation.allFinite()) continue;
    ++found;
    if (taken.status[t] == FrameStatus::kInterpolated) continue;  // it may have been left out: nothing of it was used
    if (input.keypoints != nullptr) {
      problem.frames[t].Get<LandmarkTerm>().seen =
          ObserveLandmarks(landmarks, *input.keypoints, t, UprightHeightPx(problem.layout, state, stature));
    }
    if (input.dense != nullptr) problem.frames[t].Get<DenseTerm>().points = &input.dense->frames[t];
    summary.num_observations += static_cast<int>(problem.frames[t].Get<LandmarkTerm>().seen.size()) +
                                (input.dense != nullptr ? static_cast<int>(input.dense->frames[t].size()) : 0);
  }
  if (found == 0) {
    summary.status = SolveStatus::kFailure;
    summary.message =
        "no frame shows enough of the body to start from: a shoulder and a hip are needed, with some confidence";
    return result;
  }
  summary.num_parameters =
      found * problem.layout.num_frame_columns() + problem.layout.num_columns - problem.layout.beta_column;
  summary.seconds.emplace_back("live", watch.seconds());
  FillTrack(input, problem, landmarks, &result);
  result.track.joint_sigma = std::move(taken.joint_sigma);
  result.track.root_sigma = std::move(taken.root_sigma);
  return result;
}

}  // namespace bodyloom
