// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/track_plan.h"

#include <string>
#include <utility>

#include "tracking/clip/term_kinds.h"
#include "tracking/hands/fit_hands.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/room/picture_vertical.h"
#include "tracking/terms/observability.h"

namespace bodyloom {
namespace {

std::string WhyNoPictureVertical(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (!options.ground.use_up) return "no vertical is looked for";
  if (input.ground != nullptr) return "the vertical is given";
  if (input.picture_vertical == nullptr) return "no video";
  return input.picture_vertical->found ? "" : input.picture_vertical->why;
}

}  // namespace

std::vector<PlanEntry> PlanTrackSequence(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  std::vector<PlanEntry> plan;
  const BodyModel& model = *input.body;
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
  for (const TermKind& kind : TermKinds()) {
    for (PlanEntry& entry : kind.plan(input, options)) plan.push_back(std::move(entry));
  }
  if (options.velocity_weight > 0) add("velocities", true, "cost something (paper A's L_t), beside accelerations");
  const bool surface = input.dense != nullptr || input.part_labels != nullptr;
  const ObservedLandmarks landmarks = FindObservedLandmarks(model, input.keypoints, 0);
  const size_t active = FindActiveJoints(model, landmarks, surface, options.skip_unneeded,
                                         SeeksContacts(input, options), options.user_terms)
                            .size();
  const std::string joints = std::to_string(active) + " of " + std::to_string(model.num_joints());
  add("joint rotations", true, joints + " joints are estimated");
  if (active < static_cast<size_t>(model.num_joints())) {
    add("remaining joints", false, "no observed landmark depends on them; held at rest");
  }
  add("surface vertices", surface,
      surface ? "of dense keypoints and outlines; all of them only to see what is visible"
              : "2D joints are compiled to their bones");
  add("shape", options.estimate_shape, options.estimate_shape ? "one for the clip" : "switched off");
  add("focal length", options.camera_knowledge == CameraKnowledge::kUnknownFocal,
      options.camera_knowledge == CameraKnowledge::kKnown  ? "known"
      : options.camera_knowledge == CameraKnowledge::kWeak ? "weak perspective has none"
      : input.picture_vertical != nullptr && input.picture_vertical->has_focal
          ? "estimated with the clip, near that of the lines"
      : input.focal_prior ? "estimated with the clip, near that of its lens"
                          : "estimated with the clip");
  const std::string no_lines = WhyNoPictureVertical(input, options);
  add("vertical from lines", no_lines.empty(), no_lines.empty() ? input.picture_vertical->BriefReport() : no_lines);
  for (PlanEntry& entry : PlanHandsAndHead(input)) plan.push_back(std::move(entry));
  add("uncertainty", options.estimate_uncertainty, options.estimate_uncertainty ? "per joint" : "switched off");
  return plan;
}

}  // namespace bodyloom
