// SPDX-License-Identifier: Apache-2.0
/// Estimates the vertical and the ground while a live tracker runs, from the frames that it returns.
///
/// The last seconds are one shot of a camera that stands still: EstimateUp() of the lifter's verticals, and
/// EstimateGroundPlane() of the ankles' places (initialise/ground_plane.h), twice a second. Until a plane is found the
/// ground lies under the lowest joint of these seconds; without the lifter the camera is assumed level. The world moves
/// towards each estimate with a time constant of a second, so that nothing that stands on it jumps. Memory is bounded.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/world_frame.h"
#include "tracking/initialise/ground_plane.h"
#include "tracking/live/live_options.h"

namespace bodyloom {

class LiveGround {
 public:
  /// `body` is borrowed. Frames older than `seconds` are forgotten. Throws std::invalid_argument unless it is above 0.
  explicit LiveGround(const BodyModel& body, double seconds = 12);

  /// Adds the tracker's next frame with its joints (J×3, camera frame; not read when the frame is lost), and returns
  /// the world as known. Times must not decrease.
  const WorldFrame& Add(const LiveFrame& frame, const MatrixX3d& joints_in_camera);
  [[nodiscard]] const WorldFrame& world() const { return world_; }

 private:
  struct Seen {
    double timestamp = 0;
    MatrixX3d lowest;  ///< ankles and feet, where the body has them, else all joints
    LiftedFrame lifted;
    std::array<FootPlace, 2> feet;
  };
  [[nodiscard]] WorldFrame Estimate() const;
  void MoveTowards(const WorldFrame& estimate, double seconds);

  std::array<int, 2> ankles_;
  std::vector<int> lowest_joints_;
  double seconds_;
  std::deque<Seen> seen_;
  WorldFrame world_;
  std::optional<WorldFrame> estimate_;
  double estimated_at_ = 0, moved_at_ = 0;
};

}  // namespace bodyloom
