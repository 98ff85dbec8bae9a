// SPDX-License-Identifier: Apache-2.0
/// The posed body of a track, frame by frame, in the camera frame or that of a virtual camera rotated about the person.
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
  /// `yaw_deg`, per frame: rotates the view about the vertical (the camera's y) through the body's root; empty: the
  /// track's own view. Throws std::invalid_argument unless there are as many angles as frames.
  PosedTrack(const BodyModel& body, const Track& track, std::vector<double> yaw_deg = {});

  /// Rotation of frame t's view, from the track's camera frame to the rotated one.
  [[nodiscard]] Eigen::Matrix3d Turn(int t) const;
  [[nodiscard]] bool turned() const { return !yaw_deg_.empty(); }
  /// The root joint, metres, camera frame.
  [[nodiscard]] Eigen::Vector3d Root(int t) const;
  /// V×3 in the (rotated) camera frame.
  [[nodiscard]] MatrixX3d Vertices(int t) const;
  /// The landmarks of these names, n×3, in the same frame. Throws std::invalid_argument when the body lacks one.
  [[nodiscard]] MatrixX3d Landmarks(int t, const std::vector<std::string>& names) const;
  /// Transforms points of frame t (n×3, the track's camera frame) to the rotated camera frame.
  [[nodiscard]] MatrixX3d Turned(int t, MatrixX3d points) const;
  /// Extent of the body in the image of every frame; empty for frames without a result or without the body in view.
  [[nodiscard]] std::vector<PersonExtent> Extents(int num_threads) const;

 private:
  const BodyModel& body_;
  const Track& track_;
  Skinner skinner_;
  ShapedBody shape_;
  std::vector<double> yaw_deg_;
};

/// Image pixels per metre at the body's root, median over the track's frames; 0 when no frame has a result.
double PixelsPerMetre(const BodyModel& body, const Track& track);

/// Factor that scales an image from `own` to `wanted` pixels per metre: their ratio, but 1 if it is within 2 % of 1.
/// The median of a clip differs by that much between clips of one camera; networks tolerate 2 %, whereas resampling
/// blurs the image. Both above 0.
double ScaleToSize(double wanted, double own);

}  // namespace bodyloom
