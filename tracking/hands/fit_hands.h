// SPDX-License-Identifier: Apache-2.0
/// Bends the fingers of a track whose body was fitted without them, by the 21 points of each hand.
///
/// Each hand is a problem of its own (hand_problem.h), which Ceres solves after the body. Rotations of elbows change by
/// a twist about the forearm, those of wrists and finger joints freely; with them finger joints' places and σ, and the
/// wrists and elbows among coco17. Everything else in the track stays as it is, byte for byte. A hand that is not seen
/// in a frame rests: its fingers are those of the prior, its wrist the body's.
#pragma once

#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/track.h"
#include "tracking/hands/hand_problem.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// Puts the track of a 24-joint body onto `body`, whose first 22 joints are the same and which has fingers in place of
/// hand joints: at rest, as the hand prior's mean, with the σ of their wrists. Everything else stays, byte for byte.
/// Throws std::invalid_argument for other numbers of joints.
void GiveFingers(const BodyModel& body, Track* track);

/// True if a hand is seen in any frame.
bool ShowsHand(const HandsAndFaceSequence& seen);

/// The reason why the hands of this body cannot be fitted to these observations, which may be null; "": they can.
std::string WhyNoHands(const BodyModel& body, const HandsAndFaceSequence* seen);

/// Fits both hands and changes the track; summaries of the left and the right one. A hand for which WhyNoHands() has a
/// reason, or that Ceres cannot solve, is left as it was. σ of a finger joint: of the wrist's place and of the joint's
/// place about it, as independent ones. Same bytes for any number of threads. Throws std::invalid_argument for another
/// number of frames.
std::vector<PartFitSummary> FitHands(const BodyModel& body, const HandsAndFaceSequence& seen,
                                     const std::vector<char>& cut_before, const HandFitOptions& options,
                                     int num_threads, Track* track);

/// Lines of the plan for hands and head; none without hands and faces in the input of a body that has no fingers.
std::vector<PlanEntry> PlanHandsAndHead(const TrackSequenceInput& input);

/// Puts these lines in place of those that the plan has of them.
void ReplanHandsAndHead(const std::vector<PlanEntry>& lines, std::vector<PlanEntry>* plan);

/// Says in the plan's lines of PlanHandsAndHead(), if it has any, that neither runs, and why.
void SkipHandsAndHead(const std::string& why, std::vector<PlanEntry>* plan);

/// The stage after a solve: fits the hands and turns the head of its track (turn_head.h) by input.hands_and_face, and
/// adds to the summary, whose plan gets the lines of PlanHandsAndHead(). Does nothing without them, or when the track
/// is not usable.
void FitHandsAndHead(const TrackSequenceInput& input, int num_threads, TrackSequenceResult* result);

}  // namespace bodyloom
