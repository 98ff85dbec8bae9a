// SPDX-License-Identifier: Apache-2.0
/// What the fits of several people, each made alone, say together of the scene: focal length, vertical and ground.
///
/// Focal length: the fits' answers joined with the prior (focal_length.h). One person alone keeps their fit's answer.
/// Vertical: mean of the people's verticals, weighted by the frames of each and 1/(spread + 2°)².
/// Ground and sizes: common_ground.h. Of one person who stands, the plane that their own fit found.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/geometry/world_frame.h"
#include "bodyloom/tracking/focal_length.h"
#include "bodyloom/tracking/people/common_ground.h"
#include "bodyloom/tracking/terms/ground_contact/ground_options.h"
#include "bodyloom/tracking/track_summary.h"

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

}  // namespace bodyloom
