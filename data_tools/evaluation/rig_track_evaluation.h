// SPDX-License-Identifier: Apache-2.0
/// Evaluates a track made from one camera against a track made from several: pseudo-ground-truth of clips of which
/// there is no other.
#pragma once

#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "data_tools/evaluation/vertex_errors.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/rig.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct RigTrackOptions {
  bool equal_clocks = false;  ///< a camera whose clock is not known is taken to show the first camera's time
  VertexErrorOptions vertices;
};

/// The track at other moments, seconds of its clock: rotations along geodesics, translations along lines between the
/// frames before and after, its camera, shape and world; joints, landmarks and standard deviations are empty. Moments
/// outside its time, in a gap of more than 0.1 s, and beside a frame that is lost or interpolated (in which nothing was
/// observed) are lost: NaN. Throws std::invalid_argument for a moving or weak-perspective camera, for timestamps that
/// are not one a frame and ascending, and when a pose does not fit the body.
Track TrackAtTimes(const BodyModel& body, const Track& track, const std::vector<double>& times_s);

/// Protocol "rig-track". `track`: fitted to the camera `view` of the rig (empty: its first), in that camera's frame and
/// with timestamps of that camera's clock. `truth`: fitted to all cameras, in the frame and with the clock of the first
/// one. The truth is sampled at RigCamera::FirstTimeAt() of each of the track's timestamps (TrackAtTimes()), and frames
/// without truth are left out.
///
/// With V the camera `view`, X the track's points in V's frame, G the truth's there, and π_c a point's pixel in camera
/// c by the rig's intrinsics and poses:
///   everything of "known-truth" (truth_evaluation.h)   X against G in V's frame; the track's own camera where it
///                              projects, the rig's for the truth
///   own_view_mean_px           ‖π_V(x) − π_V(g)‖ of all vertices, pixels of the camera's image: mean over vertices and
///                              frames; _median_px, _p95_px: of the frames' means; _height_percent: mean of (frame's
///                              mean / longer side of the box around the true vertices' pixels)
///   other_views_…              the same in the rig's other cameras, which see the errors in depth; frames of all of
///                              them in one
///   other_views_placed_…       the same of s (x − pelvis X) + pelvis G, s: clip_scale. Errors in size and place, which
///                              the truth shares if its cameras' poses were not known, are left out
///   view_…_px, view_height_percent (breakdowns)   the same by camera
///   joint_err_mm               ‖X − G‖ of the joints, nothing aligned
///   w_mpjpe_mm, wa_mpjpe_mm, root_drift_percent   world_drift.h: after one rigid motion, by the first second or all
///   landmark_pa_mpjpe_mm       COCO's landmarks after one similarity a frame, as held_out_views.h has pa_mpjpe_mm; not
///                              where the body lacks them
///   room_…, tilt_deg, …        room_errors.h on them, against the vertical that the truth states; not where that was
///                              assumed, or where the track states no world
///   limb_angle_err_deg         hips, knees, shoulders and elbows; joint_angle_group_err_deg (breakdown): by pairs of
///                              joints, spine, neck and head
///   truth_joint_sigma_mm       median of the truth's joint_sigma: one axis, about the mid-hip
///   truth_joint_err_mm         mean error of the truth's own joints that it means, 2 √(2/π) σ: smaller errors of a
///                              track say nothing
///   truth_root_sigma_mm        median of its root_sigma
///   view_rotation_sigma_deg, view_translation_sigma_mm   of V's pose in the rig
///   frames_without_truth       left out
/// Distances are metres of the truth: the track's own scale counts as an error, except in pa_mpjpe_mm, mpjpe_scaled_mm
/// and room_…. A frame of the track without a result is scored with the nearest frame that has one.
///
/// Throws std::invalid_argument, in words for whoever chose the files, for a rig without cameras, without this name or
/// with a pose that is no rotation; a clock that is not known; a first camera that is not the truth's; tracks of
/// different bodies, of moving or weak-perspective cameras; no frame with a truth.
Evaluation EvaluateAgainstRig(const Track& track, const Track& truth, const std::vector<RigCamera>& rig,
                              const std::string& view, const BodyModel& body, const RigTrackOptions& options = {});

}  // namespace bodyloom
