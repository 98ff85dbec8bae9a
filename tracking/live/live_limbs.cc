// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/live/live_limbs.h"

#include <algorithm>
#include <utility>

#include "bodyloom/tracking/initialise/lifted_start.h"
#include "bodyloom/tracking/initialise/lifter_input.h"
#include "bodyloom/tracking/solve_sequence.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr double kOffLimb_m = 0.25;
constexpr int kReadingsBetweenTries = 5;
constexpr int kTryIterations = 5;
constexpr double kTryGain = 0.5;  ///< of the cost of each frame: less does not pay for a jump
constexpr const char* kLimbJoints[4][2] = {
    {"l_shoulder", "l_elbow"}, {"r_shoulder", "r_elbow"}, {"l_hip", "l_knee"}, {"r_hip", "r_knee"}};

}  // namespace

unsigned LiveLimbs::LimbsOff(const LiveSetup& setup, const Eigen::VectorXd& betas, const FrameState& state,
                             const LiftedFrame& lifted, double metres) {
  const LiftedLandmarks& landmarks = setup.lifted_landmarks;
  kinematics_.Set(*setup.input.body, betas, state.rotations, Vector3d::Zero(), false);
  const auto at = [&](int k) { return points_.Evaluate(kinematics_, landmarks.points[k], false); };
  const Vector3d hips = 0.5 * (at(kLifterLeftHip) + at(kLifterLeftHip + 1));
  unsigned off = 0;
  for (int limb = 0; limb < 4; ++limb) {
    for (int i = 1; i < 3; ++i) {  // elbow and wrist, knee and ankle
      const int k = kLimbs[limb][i];
      if (!landmarks.known[k]) continue;
      const Vector3d away = at(k) - hips - metres * lifted.points.row(k).transpose();
      if (away.norm() > kOffLimb_m) off |= 1U << limb;
    }
  }
  return off;
}

void LiveLimbs::Try(const LiveSetup& setup, const LiveReading& reading, LiveWindow* window) {
  if (reading.frames.empty()) return;
  if (until_next_ > 0) --until_next_;
  const std::vector<LiftedFrame>& lifted = reading.frames;
  const int stride = reading.stride;
  FixedLag& lag = window->lag();
  const int T = lag.num_frames(), samples = static_cast<int>(lifted.size());
  const int count = (samples - 1) * stride + 1;  // the last frames of the window, which the samples span
  // Dense keypoints distinguish limbs by themselves.
  if (until_next_ > 0 || samples < 2 || count > window->NumOfShotInWindow() ||
      !window->records().back().dense.empty() || setup.layout.knowledge == CameraKnowledge::kWeak) {
    return;
  }
  SequenceProblem& problem = lag.problem();
  unsigned off = 0xF;
  for (int i = 0; i < samples; ++i) {
    off &= LimbsOff(setup, problem.betas, problem.states[T - count + i * stride], lifted[i], reading.metres);
    if (off == 0) return;
  }
  until_next_ = kReadingsBetweenTries;
  const KeypointSequence seen = window->history().Recent(samples, stride);
  const std::vector<FrameState> poses =
      PosesFromLifted(lifted, seen, window->PinholeNow(), *setup.input.body, problem.betas, reading.metres);
  if (poses.empty()) return;
  std::vector<int> last;
  for (int t = T - count; t < T; ++t) last.push_back(t);
  const SequenceProblem now = SelectFrames(problem, last);
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  options.shape_constant = options.focal_constant = true;
  options.num_threads = setup.threads;
  options.max_iterations = 0;
  SequenceProblem best = now;
  double best_cost = SolveSequence(&best, options).final_cost;
  options.max_iterations = kTryIterations;
  best_cost = std::min(best_cost, SolveSequence(&best, options).final_cost) - kTryGain * count;
  bool found = false;
  for (const bool whole : {false, true}) {
    SequenceProblem other = now;
    for (int t = 0; t < count; ++t) {
      const int i = std::min(t / stride, samples - 2);
      const FrameState pose = InterpolateStates(poses[i], poses[i + 1], static_cast<double>(t - i * stride) / stride);
      if (whole) {
        other.states[t] = pose;
        continue;
      }
      for (int limb = 0; limb < 4; ++limb) {
        if ((off >> limb & 1U) == 0) continue;
        for (const char* name : kLimbJoints[limb]) {
          const int j = setup.input.body->FindJoint(name);
          other.states[t].rotations[j] = pose.rotations[j];
        }
      }
    }
    const SolveReport report = SolveSequence(&other, options);
    if (report.status == SolveStatus::kFailure || !(report.final_cost < best_cost)) continue;
    best_cost = report.final_cost;
    best = std::move(other);
    found = true;
  }
  if (!found) return;
  // What the frames before imply about the pose belongs to another one: the first of these begins a shot for the
  // solver.
  for (int t = 0; t < count; ++t) {
    problem.states[T - count + t] = best.states[t];
    lag.Touch(T - count + t);
  }
  lag.Cut(T - count);
}

}  // namespace bodyloom
