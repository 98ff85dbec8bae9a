// SPDX-License-Identifier: Apache-2.0
/// Options of the vertical and of the ground.
#pragma once

#include <Eigen/Core>
#include <limits>

namespace bodyloom {

/// A vertical, and a ground, that is known before a clip is fitted: from a calibration, or from somebody else in the
/// same view (tracking/people).
struct KnownGround {
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< camera axes, unit
  bool has_plane = false;
  double camera_height_m = 0;  ///< of the camera above the plane
  /// Standard deviations of both (geometry/world_frame.h); NaN: whoever gives them does not say.
  double up_sigma_deg = std::numeric_limits<double>::quiet_NaN();
  double height_sigma_m = std::numeric_limits<double>::quiet_NaN();
};

/// Which way is up, and the ground that feet stand on, read off the clip (initialise/ground_plane.h). Needs the lifter.
struct GroundOptions {
  /// The trunk's lean is measured against the clip's own vertical; false: against the image plane, as if every camera
  /// were level.
  bool use_up = true;
  double contact_weight = 1;     ///< of feet that stand, on the ground that was found; 0: no ground is looked for
  double sigma_height_m = 0.03;  ///< of a standing ankle's height
  double sigma_slide_m = 0.03;   ///< of its place on the ground while the foot stands
  /// Neither the vertical nor the ground.
  static GroundOptions Off() {
    GroundOptions options;
    options.use_up = false;
    options.contact_weight = 0;
    return options;
  }
};

}  // namespace bodyloom
