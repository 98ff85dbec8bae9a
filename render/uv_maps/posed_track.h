// SPDX-License-Identifier: Apache-2.0
/// A track's body, frame by frame, as the camera sees it or as one would that stands beside.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/skinning.h"
#include "geometry/scene/track.h"
#include "render/view/person_window.h"

namespace bodyloom {

/// Keeps references to body and track. May be shared by threads.
class PosedTrack {
 public:
  /// `yaw_deg`, by frame: turns the view about the vertical (the camera's y) through the body's root; empty: the
  /// track's own view. Throws std::invalid_argument for another number of angles than of frames.
  PosedTrack(const BodyModel& body, const Track& track, std::vector<double> yaw_deg = {});

  /// How frame t's view is turned: vectors in the turned camera from vectors in the track's.
  [[nodiscard]] Eigen::Matrix3d Turn(int t) const;
  [[nodiscard]] bool turned() const { return !yaw_deg_.empty(); }
  /// The root joint, metres, camera frame.
  [[nodiscard]] Eigen::Vector3d Root(int t) const;
  /// V×3 in the (turned) camera frame.
  [[nodiscard]] MatrixX3d Vertices(int t) const;
  /// The landmarks of these names, n×3, likewise. Throws std::invalid_argument when the body lacks one.
  [[nodiscard]] MatrixX3d Landmarks(int t, const std::vector<std::string>& names) const;
  /// Points of frame t (n×3, the track's camera frame) as the turned camera sees them.
  [[nodiscard]] MatrixX3d Turned(int t, MatrixX3d points) const;
  /// What the body spans in the picture of every frame; empty where it has no result or does not show.
  [[nodiscard]] std::vector<PersonExtent> Extents(int num_threads) const;

 private:
  const BodyModel& body_;
  const Track& track_;
  Skinner skinner_;
  ShapedBody shape_;
  std::vector<double> yaw_deg_;
};

/// Pixels of the track's picture a metre at the body's root, median over the frames; 0 when no frame has a result.
double PixelsPerMetre(const BodyModel& body, const Track& track);

/// By how much a picture of `own` pixels a metre is shrunk or enlarged to show a person at `wanted`: their ratio, but 1
/// within 2 % of it. The median of a clip differs by that much between clips of one camera, and a size that is 2 % off
/// is nothing to a network, while a picture that was resampled for it has lost its sharpness. Both above 0.
double ScaleToSize(double wanted, double own);

}  // namespace bodyloom
