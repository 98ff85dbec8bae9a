// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/hands_in_views.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

#include "tracking/hands/fit_hands.h"
#include "tracking/hands/put_parts.h"
#include "tracking/hands/turn_head.h"

namespace bodyloom {
namespace {

constexpr int kHeadPart = 2, kParts = 3;  ///< after HandsAndFace::Side

bool Shows(const HandsAndFace* frame, int part) {
  if (frame == nullptr) return false;
  return part == kHeadPart ? frame->face.has_value() : frame->hands[size_t(part)].has_value();
}

/// Of each part the view that shows it in most frames; −1: none.
std::array<int, kParts> BestViews(const std::vector<HandsOfView>& views) {
  std::array<int, kParts> best = {-1, -1, -1};
  for (int part = 0; part < kParts; ++part) {
    int64_t most = 0;
    for (size_t v = 0; v < views.size(); ++v) {
      const auto& frames = views[v].seen.frames;
      const int64_t count =
          std::count_if(frames.begin(), frames.end(), [&](const auto& frame) { return Shows(frame.get(), part); });
      if (count > most) most = count, best[size_t(part)] = static_cast<int>(v);
    }
  }
  return best;
}

/// The parts of a view for which it is the best one.
HandsAndFaceSequence PartsOfView(const std::vector<HandsOfView>& views, int v, const std::array<int, kParts>& best) {
  HandsAndFaceSequence parts = views[size_t(v)].seen;
  for (auto& frame : parts.frames) {
    if (frame == nullptr) continue;
    auto kept = std::make_shared<HandsAndFace>(*frame);
    for (int side = 0; side < kHeadPart; ++side) {
      if (best[size_t(side)] != v) kept->hands[size_t(side)].reset();
    }
    if (best[kHeadPart] != v) kept->face.reset();
    frame = std::move(kept);
  }
  return parts;
}

/// Copies a part's rotations, and the σ of its joints, from the track of another camera's frame.
void TakePart(const BodyModel& body, const Track& from, const PartOfTrack& part, Track* track) {
  const MatrixX3d rest = body.RestJoints(track->motion.betas);
  for (int t = 0; t < track->num_frames(); ++t) {
    if (!track->HasResult(t)) continue;
    BodyPose pose = PoseFromAxisAngle(body, track->motion.poses.row(t), track->motion.trans.row(t));
    const BodyPose other = PoseFromAxisAngle(body, from.motion.poses.row(t), from.motion.trans.row(t));
    for (const int joint : part.turned) pose.rotations[size_t(joint)] = other.rotations[size_t(joint)];
    PutPart(body, rest, pose, part, t, track);
    for (const int joint : part.placed) {
      if (track->joint_sigma.rows() > 0) track->joint_sigma(t, joint) = from.joint_sigma(t, joint);
    }
  }
}

}  // namespace

std::vector<PlanEntry> PlanHandsInViews(const BodyModel& body, const std::vector<HandsOfView>& views) {
  std::vector<PlanEntry> plan;
  for (const HandsOfView& view : views) {
    TrackSequenceInput input;
    input.body = &body;
    input.hands_and_face = view.seen.empty() ? nullptr : &view.seen;
    const std::vector<PlanEntry> own = PlanHandsAndHead(input);
    if (plan.size() < own.size()) {
      plan = own;
      continue;
    }
    for (size_t i = 0; i < own.size(); ++i) {
      if (own[i].runs && !plan[i].runs) plan[i] = own[i];
    }
  }
  for (PlanEntry& entry : plan) {
    if (entry.runs) entry.why += ", each by the view that shows it most";
  }
  return plan;
}

void FitHandsInViews(const BodyModel& body, const std::vector<HandsOfView>& given, const std::vector<char>& cut_before,
                     int num_threads, TrackSequenceResult* result) {
  if (!result->summary.IsUsable()) return;
  Track& track = result->track;
  std::vector<HandsOfView> views = given;
  if (track.HasMovingCamera() && views.size() > 1) views.resize(1);
  const std::array<int, kParts> best = BestViews(views);
  ReplanHandsAndHead(PlanHandsInViews(body, views), &result->summary.plan);
  result->summary.hands.assign(2, {});
  for (int side = 0; side < kHeadPart; ++side) {
    if (best[size_t(side)] < 0) result->summary.hands[size_t(side)].why = "no hand is seen";
  }
  PartFitSummary& head = result->summary.head.emplace();
  if (best[kHeadPart] < 0) head.why = "no face is seen";
  const Track before = track;
  for (int v = 0; v < static_cast<int>(views.size()); ++v) {
    if (std::find(best.begin(), best.end(), v) == best.end()) continue;
    const HandsAndFaceSequence parts = PartsOfView(views, v, best);
    Track own = v == 0 ? before : TrackSeenBy(views[size_t(v)].camera, body, before);
    const auto name = [&](PartFitSummary summary) {
      if (summary.ran && v > 0) summary.why = views[size_t(v)].camera.name + ": " + summary.why;
      return summary;
    };
    const std::vector<PartFitSummary> hands = FitHands(body, parts, cut_before, {}, num_threads, &own);
    for (int side = 0; side < kHeadPart; ++side) {
      if (best[size_t(side)] != v) continue;
      result->summary.hands[size_t(side)] = name(hands[size_t(side)]);
      if (!hands[size_t(side)].ran) continue;
      const HandSide of_body = side == HandsAndFace::kLeft ? HandSide::kLeft : HandSide::kRight;
      TakePart(body, own, PartOfHand(body, FindHand(body, of_body).value(), track), &track);
    }
    if (best[kHeadPart] != v) continue;
    head = name(TurnHead(body, parts, cut_before, {}, &own));
    if (head.ran) TakePart(body, own, PartOfHead(body, track), &track);
  }
}

}  // namespace bodyloom
