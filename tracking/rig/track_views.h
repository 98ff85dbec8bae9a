// SPDX-License-Identifier: Apache-2.0
/// Follows a person through several cameras at once, of which nothing need be known.
///
/// Every view is first fitted alone, coarsely. From these motions come the rotation and place of each camera relative
/// to the first and the offset between their clocks (align_motions.h), along the tree of those pairs of views that
/// agree best; what is known is kept. The poses of all views, turned into the first view's frame, are averaged, and the
/// whole clip is fitted from there with all observations at once: one body, and each camera's pose, focal length and
/// clock (problem/view_terms.h). Of a camera that moves the path must be given; then its place and direction are those
/// of the path's scene, and a scale that the path lacks is that of the view's own fit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/rig/align_motions.h"

namespace bodyloom {

/// The observations of one camera, with what is known of it.
struct ObservedView {
  const KeypointSequence* keypoints = nullptr;                 ///< required; with timestamps of its own clock
  CameraKnowledge knowledge = CameraKnowledge::kUnknownFocal;  ///< kKnown or kUnknownFocal
  Camera camera;                                               ///< as of TrackSequenceInput
  std::optional<FocalPrior> focal_prior;
  double focal_ratio_log_sigma = 0;                   ///< as of ViewInput; of the first view it is not used
  std::optional<CameraPose> camera_from_rig;          ///< where known; of every view in the same frame, or of none
  std::optional<double> offset_s;                     ///< its clock minus the first view's, where known
  const PictureVertical* picture_vertical = nullptr;  ///< as of TrackSequenceInput
  /// Of a camera that moves: poses of each of its frames in a scene of its own, and metres per unit, as of
  /// TrackSequenceInput. camera_from_rig then leads to that scene.
  const std::vector<CameraPose>* camera_from_own = nullptr;
  double camera_scale_m = 1;
};

/// Standard deviation of a clock's offset beyond which the motion says nothing about it: a fit takes the velocities of
/// the detector's errors for the person's.
inline constexpr double kUntoldClock_s = 0.3;

/// Standard deviation of the logarithm of the ratio of two focal lengths of cameras of one kind that are not zoomed: a
/// lens set to another distance is longer by a percent or two.
inline constexpr double kSameLensLogSigma = 0.02;

struct TrackViewsSummary {
  std::vector<MotionAlignment> alignment;  ///< of each view with its neighbour in the tree; the first has none
  std::vector<int> neighbour;              ///< of each view; −1: the first, and views that are not used
  std::vector<char> used;                  ///< of each view: 0 where it does not show the same motion
  double seconds_alone = 0, seconds = 0;
};

struct TrackViewsResult {
  /// In the first view's camera frame, or its scene; summary.views are the others that were used.
  TrackSequenceResult joint;
  std::vector<TrackSequenceResult> alone;
  TrackViewsSummary summary;
};

/// The input of a view by itself, with the body and the models of `common`.
TrackSequenceInput InputOfView(const ObservedView& view, const TrackSequenceInput& common);
/// The fit of a view by itself, which gives a start; usable or not.
TrackSequenceResult FitViewAlone(const ObservedView& view, const TrackSequenceInput& common,
                                 const TrackSequenceOptions& options);
/// That of every view, several at a time, with options of each.
std::vector<TrackSequenceResult> FitViewsAlone(const std::vector<ObservedView>& views, const TrackSequenceInput& common,
                                               const std::vector<TrackSequenceOptions>& options);
/// Its motion: COCO's landmarks from the shoulders down, where the person is seen. Empty if the fit is not usable.
ViewMotion MotionOf(const TrackSequenceResult& alone);
/// The rest of TrackViews(), from those fits.
TrackViewsResult FitViewsTogether(const std::vector<ObservedView>& views, std::vector<TrackSequenceResult> alone,
                                  const TrackSequenceInput& common, const TrackSequenceOptions& options);

/// `common`: body, prior, lifter, stature and ground (in the first view's frame) for all views; its observations and
/// camera are not used. Throws std::invalid_argument as TrackSequence() and with fewer than two views. The joint result
/// has status kFailure, with the reason, when the first view shows nobody, or no other view shows the same motion. The
/// offset_sigma_s of a view whose clock the motion does not tell, as of a person who stands still, is that of its
/// alignment, seconds.
TrackViewsResult TrackViews(const std::vector<ObservedView>& views, const TrackSequenceInput& common,
                            const TrackSequenceOptions& options);

}  // namespace bodyloom
