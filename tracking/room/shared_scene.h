// SPDX-License-Identifier: Apache-2.0
/// Joins the separate fits of several people to a common scene: focal length, vertical and ground.
///
/// Focal length: the fits' estimates joined with the prior (camera_knowledge.h). A single person keeps the estimate of
/// their fit. Vertical: mean of the people's verticals, weighted by the frames of each and 1/(spread + 2°)².
/// Ground and sizes: common_ground.h. If only one person stands, the plane of their own fit.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/world_frame.h"
#include "tracking/problem/camera_knowledge.h"
#include "tracking/problem/frame_cost.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/room/common_ground.h"

namespace bodyloom {

struct SharedScene {
  /// 0: nobody was tracked with a pinhole camera, or nobody's focal length has a spread
  /// (TrackSequenceOptions::estimate_uncertainty).
  double focal_px = 0;
  double focal_log_sigma = 0;  ///< of log focal_px; 0 when the focal length was known
  bool has_up = false;
  KnownGround ground;                              ///< valid when has_up
  std::string why;                                 ///< the evidence for the ground, or the reason why none was found
  WorldSource source = WorldSource::kLevelCamera;  ///< how the vertical and the ground were found
  /// Size of each person relative to the assumption of their fit; 1 if not estimated, or if it was known.
  std::vector<double> size;
};

/// `prior`: that of the fits. People whose fit failed are ignored; so are, for the focal length, those whose
/// focal_log_sigma is not a positive number, except 0: then the focal length was known to all fits.
SharedScene JoinScenes(const std::vector<TrackSequenceSummary>& people, const FocalPrior& prior,
                       const CommonGroundOptions& options = {});

/// The world frame of a clip from the vertical and the ground of one person's fit. If no plane was found the ground
/// lies under the lowest of `joints` (frames of J×3, camera frame; no rows for unknown frames), and if no vertical was
/// found either, the camera is assumed to be level.
WorldFrame WorldOfGround(const GroundSummary& ground, const std::vector<MatrixX3d>& joints);

/// Track::level_m of a fit with this ground: the levels of its frames over it. Frames of other shots, which have a
/// vertical of their own, are on it.
Eigen::VectorXd LevelsOverGround(const std::vector<FrameData>& frames, const GroundSummary& ground);

/// The world for several people in one view, with the `joints` of all of them.
WorldFrame WorldOfScene(const SharedScene& scene, const std::vector<MatrixX3d>& joints);
/// Gives this world to all usable tracks, and the levels of each over its ground: a level of their fit less than
/// kApartM (initialise/support_levels.h) from the common ground, in the median of the places where they are on it, is
/// that ground.
void ShareWorld(const SharedScene& scene, std::vector<TrackSequenceResult>* people);

}  // namespace bodyloom
