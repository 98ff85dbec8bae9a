// SPDX-License-Identifier: Apache-2.0
/// The posed surfaces of the frames that are being described: those that two neighbouring chunks need are posed once.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/geometry/skinning.h"

namespace bodyloom::describe_internal {

class PosedFrames {
 public:
  /// Borrows the skinner, the shape and the poses (empty: a frame without a fit). Memory for `room` frames is reserved.
  PosedFrames(const Skinner& skinner, const ShapedBody& shape, const std::vector<std::optional<BodyPose>>& poses,
              int num_vertices, int room);

  /// Poses the frames that are not there yet, releases those not in `needed` (ascending). Returns how many it posed.
  int Need(std::span<const int> needed);

  /// V×3, relative to the root, of a frame in the last Need.
  [[nodiscard]] std::span<const float> Vertices(int t) const {
    return {vertices_.data() + stride_ * place_of_frame_[t], stride_};
  }
  /// Roots of all frames that were ever posed, by frame.
  [[nodiscard]] std::span<const Eigen::Vector3d> roots() const { return roots_; }

 private:
  const Skinner& skinner_;
  const ShapedBody& shape_;
  const std::vector<std::optional<BodyPose>>& poses_;
  size_t stride_;
  std::vector<Eigen::Vector3d> roots_;
  std::vector<int> place_of_frame_, placed_frames_;
  std::vector<float> vertices_;  ///< of placed_frames_
};

}  // namespace bodyloom::describe_internal
