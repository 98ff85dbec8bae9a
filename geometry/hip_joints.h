// SPDX-License-Identifier: Apache-2.0
/// The joints whose middle is a body's mid-hip, about which errors and uncertainties of poses are stated.
#pragma once

#include <array>

#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

/// l_hip and r_hip; the root twice where the body lacks one of them.
inline std::array<int, 2> HipJoints(const BodyModel& body) {
  const std::array<int, 2> hips = {body.FindJoint("l_hip"), body.FindJoint("r_hip")};
  return hips[0] < 0 || hips[1] < 0 ? std::array<int, 2>{0, 0} : hips;
}

}  // namespace bodyloom
