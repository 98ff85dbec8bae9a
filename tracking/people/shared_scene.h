// SPDX-License-Identifier: Apache-2.0
/// What the fits of several people, each made alone, say together of the scene: focal length, vertical and ground.
///
/// Focal length: the fits' answers log f_i with standard deviations s_i are Gaussian posteriors that share one prior
/// (m, s), which must count once:
///   1/S² = Σ 1/s_i² − (n − 1)/s²,   log f = S² (Σ log f_i/s_i² − (n − 1) m/s²).
/// Vertical: mean of the people's verticals, weighted by the frames of each and 1/(spread + 2°)².
/// Ground: camera heights h_i above the people's own planes; they differ as far as the bodies' sizes are wrong (a
/// single view does not show size), or as people stand on different things. The weighted median, with the frames in
/// which feet were held as weights, is the ground when it has the majority of them within 15 % of itself.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/tracking/camera_knowledge.h"
#include "bodyloom/tracking/terms/ground_contact/ground_options.h"
#include "bodyloom/tracking/track_summary.h"

namespace bodyloom {

struct SharedScene {
  /// 0: nobody was tracked with a pinhole camera, or nobody's focal length has a spread
  /// (TrackSequenceOptions::estimate_uncertainty).
  double focal_px = 0;
  double focal_log_sigma = 0;  ///< of log focal_px; 0 when the focal length was known
  bool has_up = false;
  KnownGround ground;  ///< valid when has_up
  std::string why;     ///< what was found of the ground, or why nothing
};

/// `prior`: that of the fits. People whose fit failed are left out; so is, of the focal length, whoever has a
/// focal_log_sigma that is not a positive number, unless it is 0: then the focal length was known to everybody.
SharedScene JoinScenes(const std::vector<TrackSequenceSummary>& people, const FocalPrior& prior);

}  // namespace bodyloom
