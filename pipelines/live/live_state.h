// SPDX-License-Identifier: Apache-2.0
/// One frame of `bodyloom live` as every output takes it, its JSON, and how late frames are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

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

// Delays of live tracking: counts by the millisecond, in bounded memory, and their percentiles.

/// Percentiles of a delay, ms, to a millisecond.
struct DelayPercentiles {
  double median = 0, p95 = 0, p99 = 0, most = 0;
};

/// "34 ms in half of the frames, 41 in 95 %, 60 in 99 %, 112 at most".
std::string ToText(const DelayPercentiles& delay);

class DelayCounts {
 public:
  /// Delays below 0 count as 0, those from 20 s on as 20 s.
  void Add(double milliseconds);
  /// Middles of the milliseconds that hold these shares, and the largest delay; NaN and 0 before the first.
  [[nodiscard]] DelayPercentiles Percentiles() const { return {At(0.5), At(0.95), At(0.99), most_}; }

 private:
  [[nodiscard]] double At(double share) const;

  std::vector<int64_t> counts_ = std::vector<int64_t>(20'000);
  int64_t total_ = 0;
  double most_ = 0;
};

}  // namespace bodyloom
