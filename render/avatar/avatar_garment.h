// SPDX-License-Identifier: Apache-2.0
/// The skirt, dress or coat that a person of Gaussians wears, as it is stored: how to cut it, and the nodes that the
/// Gaussians of cloth hang on.
#pragma once

#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/cloth/loose_garment.h"

namespace bodyloom {

struct AvatarGarment {
  /// Of the body's shape in T-pose, with what offsets_m adds; only waist, length, fullness and spacing are stored.
  LooseGarmentOptions cut;
  std::vector<float> offsets_m;  ///< V: how far clothes close to the skin stand off along the normal
  double node_spacing_m = 0.05;  ///< geometry/cloth/cloth_nodes.h
  MatrixX3f nodes;               ///< K×3: places of the nodes as sewn, rest space
  [[nodiscard]] int num_nodes() const { return static_cast<int>(nodes.rows()); }
};

}  // namespace bodyloom
