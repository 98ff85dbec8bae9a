// SPDX-License-Identifier: Apache-2.0
/// One frame of `bodyloom live` as every output takes it, and its JSON.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/world_frame.h"
#include "tracking/live/live_options.h"

namespace bodyloom {

struct LiveState {
  std::shared_ptr<const BodyModel> body;
  LiveFrame frame;        ///< its index and time are of the frames that were detected in
  BodyPose pose;          ///< camera frame; empty when the frame is lost
  MatrixX3d rest_joints;  ///< J×3 of the frame's shape
  MatrixX3d joints;       ///< J×3, camera frame; no rows when the frame is lost
  WorldFrame world;
  double delay_ms = 0;  ///< from the frame's arrival to its pose
  int64_t dropped = 0;  ///< frames passed over so far, for whatever reason
  [[nodiscard]] bool HasPose() const { return joints.rows() > 0; }
};

/// The state as one line of JSON without a line break (docs/live.md, "JSON lines"). Numbers are rounded to 10⁻⁵; what
/// is not known is null.
std::string LiveJson(const LiveState& state);

}  // namespace bodyloom
