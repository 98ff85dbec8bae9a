// SPDX-License-Identifier: Apache-2.0
/// Pose correctives of a compact body file: blocks on a grid, predicted from the same joint's blocks at neighbouring
/// vertices. Layout and error bound in body_compact.h.
#pragma once

#include <cstdint>
#include <string>

#include "bodyloom/data_tools/body/body_codec.h"
#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

struct PackedPoseCorrectives {
  NdArray count;  ///< blocks of each vertex
  NdArray joint;  ///< joint of each block, as the difference to the vertex's block before it
  NdArray block;  ///< 27 residuals of each block
};

/// The step that the blocks are stored in: a decimal one on which they lie exactly, else a power of two
/// (body_compact.h).
double PoseGrid(const PoseCorrectives& posedirs);

PackedPoseCorrectives PackPoseCorrectives(const PoseCorrectives& posedirs, const MeshPredictor& predictor, double step);

/// The inverse for V vertices and J joints. Throws std::runtime_error "where: …".
PoseCorrectives UnpackPoseCorrectives(const PackedPoseCorrectives& packed, const MeshPredictor& predictor, int64_t V,
                                      int64_t J, double step, const std::string& where);

}  // namespace bodyloom
