// SPDX-License-Identifier: Apache-2.0
/// What the fits of several people, each made alone, say together of the scene: focal length, vertical and ground.
///
/// Focal length: the fits' answers joined with the prior (camera_knowledge.h). One person alone keeps their fit's
/// answer. Vertical: mean of the people's verticals, weighted by the frames of each and 1/(spread + 2°)².
/// Ground and sizes: common_ground.h. Of one person who stands, the plane that their own fit found.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/world_frame.h"
#include "tracking/problem/camera_knowledge.h"
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
  std::string why;                                 ///< what was found of the ground, or why nothing
  WorldSource source = WorldSource::kLevelCamera;  ///< how the vertical and the ground were found
  /// Of each person, relative to what their fit assumed; 1 where nothing was seen of it, and where it was known.
  std::vector<double> size;
};

/// `prior`: that of the fits. People whose fit failed are left out; so is, of the focal length, whoever has a
/// focal_log_sigma that is not a positive number, unless it is 0: then the focal length was known to everybody.
SharedScene JoinScenes(const std::vector<TrackSequenceSummary>& people, const FocalPrior& prior,
                       const CommonGroundOptions& options = {});

// The world of a clip from what its fits found of the vertical and of the ground.

/// Of one person. Where no plane was found the ground lies under the lowest of `joints` (frames of J×3, camera frame;
/// no rows where a frame is unknown), and where no vertical was found either the camera is taken for level.
WorldFrame WorldOfGround(const GroundSummary& ground, const std::vector<MatrixX3d>& joints);

/// Of several people in one view, `joints` of all of them.
WorldFrame WorldOfScene(const SharedScene& scene, const std::vector<MatrixX3d>& joints);

}  // namespace bodyloom
