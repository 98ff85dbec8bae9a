// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/fit_hands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "tracking/hands/put_parts.h"
#include "tracking/hands/turn_head.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/solvers/solve_sequence.h"

namespace bodyloom {
namespace {

constexpr const char* kHands = "hands";  // lines of the plan
constexpr const char* kHead = "head by the face";

/// Frames begin ≤ t < end, fitted together with others.
struct HandWindow {
  int begin = 0, end = 0;
  std::vector<char> used;  ///< T flags, or empty: all
};

struct FittedHand {
  HandSkeleton skeleton;
  std::unique_ptr<HandProblem> problem = nullptr;  ///< null: not fitted in this window
  HandProblem::Sigma sigma = {};
};

/// Values from which a hand's summary is made.
struct HandFits {
  std::vector<double> lengths_px, errors_px;
  std::string failed;
  int iterations = 0, windows = 0;
  std::optional<double> log_size;  ///< of a long clip, from its stretches
  double last_log_size = 0;
};

std::vector<HandWindow> HandWindowsOf(const std::vector<double>& times, const HandFitOptions& options) {
  const int T = static_cast<int>(times.size());
  if (T <= options.max_frames) return {{0, T, {}}};
  std::vector<HandWindow> windows;
  for (int begin = 0; begin < T; begin += options.window_frames) {
    HandWindow window{begin, std::min(T, begin + options.window_frames), std::vector<char>(size_t(T), 0)};
    const double from = times[size_t(begin)] - options.context_s,
                 to = times[size_t(window.end - 1)] + options.context_s;
    for (size_t t = 0; t < times.size(); ++t) window.used[t] = times[t] >= from && times[t] <= to ? 1 : 0;
    windows.push_back(std::move(window));
  }
  return windows;
}

void PutHand(const BodyModel& body, const FittedHand& hand, const HandWindow& window, Track* track) {
  const MatrixX3d rest = body.RestJoints(track->motion.betas);
  const PartOfTrack part = PartOfHand(body, hand.skeleton, *track);
  for (int t = window.begin; t < window.end; ++t) {
    if (!track->HasResult(t)) continue;
    BodyPose pose = PoseFromAxisAngle(body, track->motion.poses.row(t), track->motion.trans.row(t));
    hand.problem->SetPose(t, &pose);
    PutPart(body, rest, pose, part, t, track);
    for (int j = 0; track->joint_sigma.rows() > 0 && j < kHandJoints; ++j) {
      track->joint_sigma(t, hand.skeleton.joint[size_t(j)]) =
          std::hypot(track->joint_sigma(t, hand.skeleton.wrist), hand.sigma.joints_m(t, j));
    }
  }
}

}  // namespace

void GiveFingers(const BodyModel& body, Track* track) {
  constexpr int kBodyJoints = 22, kSmplJoints = 24;
  BODYLOOM_CHECK(HasFingers(body) && body.num_joints() == kBodyJoints + 2 * kHandJoints, body.name(),
                 ": expected a body of ", kBodyJoints + 2 * kHandJoints, " joints with fingers");
  BODYLOOM_CHECK(track->motion.poses.cols() == 3 * kSmplJoints, "a track of ", track->motion.poses.cols() / 3,
                 " joints, expected ", kSmplJoints);
  const int T = track->num_frames(), J = body.num_joints();
  const Eigen::VectorXd& betas = track->motion.betas;
  BodyPose fingers;
  fingers.rotations.assign(size_t(J), Eigen::Matrix3d::Identity());
  std::vector<int> wrist_of(size_t(J), -1);
  for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
    const HandSkeleton hand = FindHand(body, side).value();
    const HandAngleVector angles = HandKinematics(body, hand, betas).Angles(FingerCoordinates::Zero());
    for (int j = 0; j < kHandJoints; ++j) {
      const auto joint = size_t(hand.joint[size_t(j)]);
      fingers.rotations[joint] = HandRotation(hand, j, angles.segment<3>(Eigen::Index{3} * j));
      wrist_of[joint] = hand.wrist;
    }
  }
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  RowMatrixXd poses = RowMatrixXd::Constant(T, Eigen::Index{3} * J, kNan);
  poses.leftCols(3 * kBodyJoints) = track->motion.poses.leftCols(3 * kBodyJoints);
  const Eigen::VectorXd at_rest = AxisAngleFromPose(body, fingers).tail(Eigen::Index{3} * (J - kBodyJoints));
  const MatrixX3d rest = body.RestJoints(betas);
  const bool has_sigma = track->joint_sigma.rows() > 0;
  RowMatrixXd sigma(has_sigma ? T : 0, J);
  for (int t = 0; t < T; ++t) {
    MatrixX3d joints = MatrixX3d::Constant(J, 3, kNan);
    joints.topRows(kBodyJoints) = track->joints[size_t(t)].topRows(kBodyJoints);
    if (track->HasResult(t)) {
      poses.row(t).tail(at_rest.size()) = at_rest.transpose();
      const BodyPose pose = PoseFromAxisAngle(body, poses.row(t), track->motion.trans.row(t));
      joints.bottomRows(J - kBodyJoints) = PoseSkeleton(body, rest, pose).joints.bottomRows(J - kBodyJoints);
    }
    track->joints[size_t(t)] = std::move(joints);
    for (int j = 0; has_sigma && j < J; ++j) {
      sigma(t, j) = track->joint_sigma(t, j < kBodyJoints ? j : wrist_of[size_t(j)]);
    }
  }
  track->motion.body = body.name();
  track->motion.poses = std::move(poses);
  track->joint_sigma = std::move(sigma);
}

bool ShowsHand(const HandsAndFaceSequence& seen) {
  return std::any_of(seen.frames.begin(), seen.frames.end(), [](const auto& frame) {
    return frame != nullptr && (frame->hands[HandsAndFace::kLeft] || frame->hands[HandsAndFace::kRight]);
  });
}

std::string WhyNoHands(const BodyModel& body, const HandsAndFaceSequence* seen) {
  if (seen == nullptr) return "no hands in the input";
  if (!ShowsHand(*seen)) return "no hand is seen";
  return HasFingers(body) ? "" : "the body has no finger joints";
}

std::vector<PartFitSummary> FitHands(const BodyModel& body, const HandsAndFaceSequence& seen,
                                     const std::vector<char>& cut_before, const HandFitOptions& options,
                                     int num_threads, Track* track) {
  BODYLOOM_CHECK(seen.num_frames() == track->num_frames(), "hands of ", seen.num_frames(), " frames, a track of ",
                 track->num_frames());
  const std::string why_not = WhyNoHands(body, &seen);
  std::array<HandFits, 2> fits;
  const auto skeleton = [&](int side) {
    return FindHand(body, side == HandsAndFace::kLeft ? HandSide::kLeft : HandSide::kRight).value();
  };
  const auto fit_size = [&](int side) {
    HandProblem sample(body, skeleton(side), *track, seen, cut_before, options,
                       StretchesOf(track->num_frames(), options.max_frames / 2));
    if (sample.Solve(options.max_iterations).empty()) fits[size_t(side)].log_size = *sample.log_size();
  };
  const auto fit = [&](int side, const HandWindow& window) {
    HandFits& all = fits[size_t(side)];
    FittedHand hand{.skeleton = skeleton(side)};
    hand.problem = std::make_unique<HandProblem>(body, hand.skeleton, *track, seen, cut_before, options, window.used);
    const std::vector<double> lengths = hand.problem->LengthsPx(window.begin, window.end);
    all.lengths_px.insert(all.lengths_px.end(), lengths.begin(), lengths.end());
    double* size = hand.problem->log_size();
    if (all.log_size) {
      *size = *all.log_size;
      hand.problem->problem().SetParameterBlockConstant(size);
    }
    int iterations = 0;
    const std::string failed = hand.problem->Solve(options.max_iterations, &iterations);
    all.iterations += iterations;
    if (!failed.empty()) {
      all.failed = failed;
      hand.problem.reset();
      return hand;
    }
    if (all.log_size) hand.problem->problem().SetParameterBlockVariable(size);
    hand.sigma = hand.problem->FindSigma();
    const std::vector<double> errors = hand.problem->ErrorsPx(window.begin, window.end);
    all.errors_px.insert(all.errors_px.end(), errors.begin(), errors.end());
    all.last_log_size = *size;
    ++all.windows;
    return hand;
  };
  const auto put = [&](const std::vector<FittedHand>& hands, const HandWindow& window) {
    for (const FittedHand& hand : hands) {
      if (hand.problem != nullptr) PutHand(body, hand, window, track);
    }
  };
  if (why_not.empty()) {
    const std::vector<HandWindow> windows = HandWindowsOf(track->motion.timestamps, options);
    if (windows.size() > 1) ParallelFor(2, num_threads, fit_size);
    std::vector<FittedHand> before;
    for (size_t w = 0; w < windows.size(); ++w) {
      std::vector<FittedHand> hands(2);
      ParallelFor(2, num_threads, [&](int side) { hands[size_t(side)] = fit(side, windows[w]); });
      // A window begins from the body's own track, also in the frames of its context.
      if (w > 0) put(before, windows[w - 1]);
      before = std::move(hands);
    }
    put(before, windows.back());
  }
  std::vector<PartFitSummary> summaries;
  for (const HandFits& all : fits) {
    PartFitSummary& summary = summaries.emplace_back();
    summary.why = why_not;
    if (!why_not.empty()) continue;
    summary.iterations = all.iterations;
    summary.frames_seen = static_cast<int>(all.lengths_px.size());
    summary.ran = all.windows > 0;
    if (!summary.ran) {
      summary.why = all.failed;
      continue;
    }
    summary.why = summary.frames_seen > 0
                      ? Concatenate("seen in ", summary.frames_seen, " of ", track->num_frames(), " frames, ",
                                    std::lround(Percentile(all.lengths_px, 50)), " px long")
                      : "not seen, or too small; rests";
    summary.median_px = all.errors_px.empty() ? 0 : Percentile(all.errors_px, 50);
    summary.size = std::exp(all.last_log_size);
  }
  return summaries;
}

std::vector<PlanEntry> PlanHandsAndHead(const TrackSequenceInput& input) {
  if (input.hands_and_face == nullptr && !HasFingers(*input.body)) return {};
  const std::string no_hands = WhyNoHands(*input.body, input.hands_and_face);
  const std::string no_head = WhyNoHead(*input.body, input.hands_and_face);
  return {{kHands, no_hands.empty(), no_hands.empty() ? "fingers, wrists and forearms, after the body" : no_hands},
          {kHead, no_head.empty(), no_head.empty() ? "after the body" : no_head}};
}

void ReplanHandsAndHead(const std::vector<PlanEntry>& lines, std::vector<PlanEntry>* plan) {
  std::erase_if(*plan, [](const PlanEntry& entry) { return entry.what == kHands || entry.what == kHead; });
  plan->insert(plan->end(), lines.begin(), lines.end());
}

void SkipHandsAndHead(const std::string& why, std::vector<PlanEntry>* plan) {
  for (PlanEntry& entry : *plan) {
    if (entry.what == kHands || entry.what == kHead) entry = {entry.what, false, why};
  }
}

void FitHandsAndHead(const TrackSequenceInput& input, int num_threads, TrackSequenceResult* result) {
  if (input.hands_and_face == nullptr || !result->summary.IsUsable()) return;
  ReplanHandsAndHead(PlanHandsAndHead(input), &result->summary.plan);
  const std::vector<char> cuts = input.keypoints != nullptr ? FindCuts(*input.keypoints) : std::vector<char>();
  result->summary.hands = FitHands(*input.body, *input.hands_and_face, cuts, {}, num_threads, &result->track);
  result->summary.head = TurnHead(*input.body, *input.hands_and_face, cuts, {}, &result->track);
}

}  // namespace bodyloom
