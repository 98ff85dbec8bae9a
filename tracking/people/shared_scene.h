// SPDX-License-Identifier: Apache-2.0
/// What the fits of several people, each made alone, say together of the scene: focal length, vertical and ground.
///
/// Focal length: a fit's answer log f_i with standard deviation s_i is a Gaussian posterior of the prior (m, s), so its
/// clip measured x_i with variance v_i: 1/v_i = 1/s_i² − 1/s², x_i/v_i = log f_i/s_i² − m/s². The fits' covariances
/// leave out that neither the body's proportions nor its landmarks are the person's and the detector's, which errs alike
/// for everybody who is seen from the same side: b = kFocalFitLogSigma, not averaged away:
///   w_i = 1/(v_i + b²),   x = Σ w_i x_i / Σ w_i,   v = b² + Σ w_i² v_i / (Σ w_i)²,
///   1/S² = 1/s² + 1/v,    log f = S² (m/s² + x/v).
/// One person alone keeps their fit's answer, with S² = s_i² + b².
/// Vertical: mean of the people's verticals, weighted by the frames of each and 1/(spread + 2°)².
/// Ground and sizes: common_ground.h. Of one person who stands, the plane that their own fit found.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/geometry/world_frame.h"
#include "bodyloom/tracking/camera_knowledge.h"
#include "bodyloom/tracking/people/common_ground.h"
#include "bodyloom/tracking/terms/ground_contact/ground_options.h"
#include "bodyloom/tracking/track_summary.h"

namespace bodyloom {

/// b: the root mean square of log(f_fit / f_true) over both clips and all nine cameras of AIST++ in shared/data, each
/// camera's detections fitted alone with an unknown focal length (docs/lab/two_people.md).
inline constexpr double kFocalFitLogSigma = 0.34;

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
