// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_limbs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tracking/initialise/joint_hypotheses.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/solvers/solve_sequence.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr double kOffLimb_m = 0.25;
constexpr int kReadingsBetweenTries = 5;
constexpr int kTryIterations = 5;
constexpr double kTryGain = 0.5;  ///< required decrease of the cost per frame; less does not justify a jump
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
  // The prior from earlier frames is for the rejected pose, so the first of these frames begins a shot for the solver.
  for (int t = 0; t < count; ++t) {
    problem.states[T - count + t] = best.states[t];
    lag.Touch(T - count + t);
  }
  lag.Cut(T - count);
}

namespace {

constexpr int kLifterReach = 36;      ///< samples behind the oldest that is read; a little more than the network's own
constexpr size_t kEnoughDense = 100;  ///< keypoints of a frame beside which it is not run

}  // namespace

LiveReading LiveLifter::Ask(const LiveSetup& setup, LiveWindow* window) {
  const LiveRecord& newest = window->records().back();
  if (setup.input.lifter == nullptr || setup.input.landmarks.empty() || setup.options.solve.lifter_weight == 0 ||
      !setup.lifted_landmarks.IsUsable() || newest.initialiser || newest.dense.size() >= kEnoughDense) {
    return {};
  }
  // At the network's own rate, in one phase that ends with the newest frame.
  const double step = window->history().TimeStep();
  LiveReading reading;
  reading.stride = step > 0 ? std::clamp(static_cast<int>(std::lround(1 / (kLifterRate * step))), 1, 20) : 1;
  const int stride = reading.stride;
  if (++since_last_ < stride) return {};
  since_last_ = 0;
  // The newest frame, and again those not returned yet.
  const int num_read = (setup.options.lag + stride - 1) / stride + 1;
  const KeypointSequence seen = window->history().Recent(kLifterReach + num_read, stride);
  const int samples = seen.num_frames();
  LiftOptions options;
  options.all_phases = false;
  options.last_samples = num_read;
  const std::vector<LiftedFrame> read = LiftKeypoints(
      seen, window->PinholeNow(), setup.layout.knowledge == CameraKnowledge::kKnown, {}, *setup.input.lifter, options);
  if (read.empty()) return {};
  const int first = std::max(0, samples - num_read);
  reading.metres = LifterMetres(*setup.input.body, window->problem().betas);
  FixedLag& lag = window->lag();
  const int T = lag.num_frames(), shot = window->NumOfShotInWindow();
  for (int back = 0; back < shot && back <= (samples - 1 - first) * stride; ++back) {
    const int later = samples - 1 - back / stride;
    const LiftedFrame frame = back % stride == 0 ? read[later]
                                                 : InterpolateLifted(read[later], read[later - 1],
                                                                     static_cast<double>(back % stride) / stride);
    const int slot = T - 1 - back;
    LiveRecord& record = window->RecordAt(slot);
    record.lifted =
        MakeLiftedPose(frame, setup.lifted_landmarks, reading.metres, setup.options.solve.lifter_min_sigma_m);
    record.standing = {frame.up, frame.up_sigma, frame.contact};
    LiftedPoseTerm& term = lag.problem().frames[slot].Get<LiftedPoseTerm>();
    term.pose = &record.lifted;
    term.weight = setup.options.solve.lifter_weight;
    lag.Touch(slot);
  }
  reading.frames.assign(read.begin() + first, read.end());
  return reading;
}

}  // namespace bodyloom
