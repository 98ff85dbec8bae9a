// SPDX-License-Identifier: Apache-2.0
/// How a person's Gaussians are posed (render/avatar/pose_gaussians.h).
#pragma once

#include <array>
#include <string>

namespace bodyloom {

struct PoseGaussiansOptions {
  /// Rotation, row-major, from the frame of the posed Gaussians to the light's, for instance that of the camera that the
  /// light was learned in.
  std::array<float, 9> light_from_frame = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  int num_threads = 1;  ///< 1 to 1024
  [[nodiscard]] bool IsValid(std::string* why) const;
};

}  // namespace bodyloom
