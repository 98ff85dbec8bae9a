// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bodyloom/data_tools/descriptors/surface_motion.h"
#include "bodyloom/geometry/normals.h"
#include "bodyloom/geometry/uv_texels.h"

namespace bodyloom {

/// Options of a frame's descriptor: what it holds.
struct DescriptorOptions : SurfaceMotion {
  UvTexelOptions texels;
  int past = 10;        ///< velocity maps a frame, its own included; 0 to 1000
  bool normals = true;  ///< the three channels of N
  NormalWeighting weighting = NormalWeighting::kArea;
  bool seen_only = false;  ///< texels that the frame's camera does not see are zero
  int num_threads = 1;     ///< 1 to 1024; the same values for any number
  /// False with the reason when a field is out of range.
  [[nodiscard]] bool IsValid(std::string* why) const;
  /// 3·normals + 3·past.
  [[nodiscard]] int channels() const { return 3 * (normals ? 1 : 0) + 3 * past; }
};

}  // namespace bodyloom
