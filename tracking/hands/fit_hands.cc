// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/fit_hands.h"

#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "tracking/hands/put_parts.h"
#include "tracking/hands/turn_head.h"
#include "tracking/initialise/swap_repair.h"

namespace bodyloom {
namespace {

struct FittedHand {
  HandSkeleton skeleton;
  std::unique_ptr<HandProblem> problem;
  HandProblem::Sigma sigma;
  PartFitSummary summary;
};

void PutHands(const BodyModel& body, const std::vector<FittedHand>& hands, Track* track) {
  const MatrixX3d rest = body.RestJoints(track->motion.betas);
  PartOfTrack part;
  part.landmarks = CocoRowsNamed(body, *track, {"_wrist", "_elbow"});
  for (const FittedHand& hand : hands) {
    if (!hand.summary.ran) continue;
    part.placed.insert(part.placed.end(), hand.skeleton.joint.begin(), hand.skeleton.joint.end());
    part.turned.push_back(hand.skeleton.wrist);
    part.turned.push_back(body.parents()[size_t(hand.skeleton.wrist)]);
  }
  part.turned.insert(part.turned.end(), part.placed.begin(), part.placed.end());
  for (int t = 0; t < track->num_frames(); ++t) {
    if (!track->HasResult(t)) continue;
    BodyPose pose = PoseFromAxisAngle(body, track->motion.poses.row(t), track->motion.trans.row(t));
    for (const FittedHand& hand : hands) {
      if (hand.summary.ran) hand.problem->SetPose(t, &pose);
    }
    PutPart(body, rest, pose, part, t, track);
    for (const FittedHand& hand : hands) {
      for (int j = 0; hand.summary.ran && track->joint_sigma.rows() > 0 && j < kHandJoints; ++j) {
        track->joint_sigma(t, hand.skeleton.joint[size_t(j)]) =
            std::hypot(track->joint_sigma(t, hand.skeleton.wrist), hand.sigma.joints_m(t, j));
      }
    }
  }
}

}  // namespace

std::string WhyNoHands(const BodyModel& body, const HandsAndFaceSequence* seen) {
  if (seen == nullptr) return "no hands in the input";
  if (!HasFingers(body)) return "the body has no finger joints";
  for (const auto& frame : seen->frames) {
    if (frame != nullptr && (frame->hands[HandsAndFace::kLeft] || frame->hands[HandsAndFace::kRight])) return "";
  }
  return "no hand is seen";
}

std::vector<PartFitSummary> FitHands(const BodyModel& body, const HandsAndFaceSequence& seen,
                                     const std::vector<char>& cut_before, const HandFitOptions& options,
                                     int num_threads, Track* track) {
  BODYLOOM_CHECK(seen.num_frames() == track->num_frames(), "hands of ", seen.num_frames(), " frames, a track of ",
                 track->num_frames());
  std::vector<FittedHand> hands(2);
  const std::string why_not = WhyNoHands(body, &seen);
  const auto fit = [&](int side) {
    FittedHand& hand = hands[size_t(side)];
    hand.summary.why = why_not;
    if (!why_not.empty()) return;
    hand.skeleton = FindHand(body, side == HandsAndFace::kLeft ? HandSide::kLeft : HandSide::kRight).value();
    hand.problem = std::make_unique<HandProblem>(body, hand.skeleton, *track, seen, cut_before, options);
    hand.summary.frames_seen = hand.problem->frames_seen();
    hand.summary.why = hand.summary.frames_seen > 0
                           ? Concatenate("seen in ", hand.summary.frames_seen, " of ", track->num_frames(), " frames, ",
                                         std::lround(hand.problem->median_length_px()), " px long")
                           : "not seen, or too small; rests";
    const std::string failed = hand.problem->Solve(options.max_iterations, &hand.summary.iterations);
    hand.summary.ran = failed.empty();
    if (!hand.summary.ran) {
      hand.summary.why = failed;
      return;
    }
    hand.sigma = hand.problem->FindSigma();
    hand.summary.median_px = hand.problem->MedianPx();
    hand.summary.size = std::exp(*hand.problem->log_size());
  };
  ParallelFor(2, num_threads, fit);
  if (hands[0].summary.ran || hands[1].summary.ran) PutHands(body, hands, track);
  return {hands[0].summary, hands[1].summary};
}

std::vector<PlanEntry> PlanHandsAndHead(const TrackSequenceInput& input) {
  if (input.hands_and_face == nullptr && !HasFingers(*input.body)) return {};
  const std::string no_hands = WhyNoHands(*input.body, input.hands_and_face);
  const std::string no_head = WhyNoHead(*input.body, input.hands_and_face);
  return {{"hands", no_hands.empty(), no_hands.empty() ? "fingers, wrists and forearms, after the body" : no_hands},
          {"head by the face", no_head.empty(), no_head.empty() ? "after the body" : no_head}};
}

void FitHandsAndHead(const TrackSequenceInput& input, int num_threads, TrackSequenceResult* result) {
  if (input.hands_and_face == nullptr || !result->summary.IsUsable()) return;
  const std::vector<char> cuts = input.keypoints != nullptr ? FindCuts(*input.keypoints) : std::vector<char>();
  result->summary.hands = FitHands(*input.body, *input.hands_and_face, cuts, {}, num_threads, &result->track);
  result->summary.head = TurnHead(*input.body, *input.hands_and_face, cuts, {}, &result->track);
}

}  // namespace bodyloom
