// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace bodyloom {

/// A projected vertex, not rounded; lens distortion left out.
struct ProjectedVertex {
  double x_px, y_px;
  double nearness;  ///< 1/z, or −z for weak perspective; NaN: behind the near plane, outside the lens or guard band
  double spare;     ///< makes it half a cache line
};

}  // namespace bodyloom
