// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_start.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/body/posed_body.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/initialise/inverse_kinematics.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/terms/initialiser.h"

namespace bodyloom {

std::vector<FrameState> FindLiveStates(const LiveSetup& setup, int count, LiveWindow* window) {
  const auto first = window->records().end() - count, end = window->records().end();
  const bool given = std::all_of(first, end, [](const LiveRecord& r) { return r.initialiser.has_value(); });
  std::vector<FrameState> states;
  if (given) {
    for (auto it = first; it != end; ++it) states.push_back({it->initialiser->rotations, it->initialiser->trans});
    if (setup.layout.knowledge != CameraKnowledge::kWeak) return states;
  }
  TrackSequenceInput input;
  input.body = setup.input.body;
  input.prior = setup.input.prior;
  input.lifter = setup.input.lifter;
  input.camera = setup.layout.camera;
  const KeypointSequence keypoints = window->history().Recent(count, 1);
  if (window->history().NewestIsSeen()) input.keypoints = &keypoints;
  DenseSequence dense;
  for (auto it = first; it != end; ++it) {
    dense.frames.push_back(it->dense);
    dense.timestamps.push_back(it->timestamp);
  }
  if (input.keypoints == nullptr) input.dense = &dense;
  Motion motion;
  if (given) {
    motion.poses.resize(count, 3 * setup.input.body->num_joints());
    motion.trans.resize(count, 3);
    for (int i = 0; i < count; ++i) {
      const BodyPose pose{states[i].rotations, states[i].translation};
      motion.poses.row(i) = AxisAngleFromPose(*setup.input.body, pose).transpose();
      motion.trans.row(i) = pose.trans.transpose();
    }
    input.initialiser = &motion;
  }
  FrameLayout layout = setup.layout;
  const double focal = std::exp(window->problem().log_focal);
  if (layout.focal_column >= 0) layout.camera.fx = layout.camera.fy = focal;
  LiftedStart lifted;
  TrackSequenceOptions options = setup.options.solve;
  options.num_threads = 1;
  KeypointSequence from_dense;
  states = FindInitialStates(input, JointsToStartFrom(input, &from_dense), layout, options, &lifted).states;
  for (size_t i = 0; i < lifted.frames.size(); ++i) {
    LiveRecord& record = *(first + static_cast<std::ptrdiff_t>(i));
    record.lifted =
        MakeLiftedPose(lifted.frames[i], setup.lifted_landmarks, lifted.metres, setup.options.solve.lifter_min_sigma_m);
  }
  return std::all_of(states.begin(), states.end(), IsFinite) ? states : std::vector<FrameState>();
}

bool StartShot(const LiveSetup& setup, LiveWindow* window) {
  std::deque<LiveRecord>& records = window->records();
  int open = window->NumOpen();
  while (!(records.end() - open)->seen) --open;  // frames before the first observation stay lost
  const std::vector<FrameState> states = FindLiveStates(setup, open, window);
  if (states.empty()) return false;
  for (int i = 0; i < open; ++i) {
    LiveRecord& record = *(records.end() - open + i);
    record.cut_before = i == 0 && record.index > window->first_index();
    if (record.in_window)
      window->Replace(&record, states[i], i == 0);
    else
      window->Add(&record, states[i], i == 0);
  }
  window->tracking = true;
  RestartShot(setup, 0, window);
  return true;
}

void RestartShot(const LiveSetup& setup, int count, LiveWindow* window) {
  FixedLag& lag = window->lag();
  SequenceProblem& problem = lag.problem();
  const int T = lag.num_frames();
  if (count > 0) {
    const std::vector<FrameState> states = FindLiveStates(setup, count, window);
    for (size_t i = 0; i < states.size(); ++i) {
      const int slot = T - count + static_cast<int>(i);
      problem.states[slot] = states[i];
      problem.frames[slot] = window->Observe(states[i], &window->RecordAt(slot));
      lag.Touch(slot);
    }
  }
  // First near the start, then free.
  const int first = T - window->NumOfShotInWindow();
  std::vector<FrameData> observed(problem.frames.begin() + first, problem.frames.end());
  for (int slot = first; slot < T; ++slot) {
    FrameData& frame = problem.frames[slot];
    frame.Get<InitialiserTerm>().rotations = problem.states[slot].rotations;
    frame.Get<InitialiserTerm>().translation = problem.states[slot].translation;
    frame.Get<InitialiserTerm>().weight = setup.options.solve.start_pull;
    frame.Get<LandmarkTerm>().kernel = 8;
    lag.Touch(slot);
  }
  if (!window->Solve(setup.options.start_iterations)) return;
  for (int slot = first; slot < T; ++slot) {
    problem.frames[slot] = std::move(observed[slot - first]);
    lag.Touch(slot);
  }
  window->Solve(setup.options.start_iterations);
}

void LiveShape::Refine(const LiveSetup& setup, LiveWindow* window) {
  const int num_betas = setup.layout.num_betas;
  const KeypointSequence& sample = window->history().Sample();
  if (num_betas == 0 || sample.num_frames() == 0 || window->frames_of_clip() < next_frames_) return;
  next_frames_ *= 2;
  window->lag().problem().shape_prior.mean =
      EstimateShape(sample, window->PinholeNow(), *setup.input.body, num_betas, setup.options.solve.hypotheses);
}

}  // namespace bodyloom
