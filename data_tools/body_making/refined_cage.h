// SPDX-License-Identifier: Apache-2.0
/// The cage of the built-in body (cage.h) after its two Catmull–Clark levels: connectivity, symmetry, and the operators
/// from cage to vertices.
#pragma once

#include <vector>

#include "data_tools/body_making/cage.h"
#include "data_tools/body_making/left_half_arrays.h"
#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

inline constexpr int kQuadsPerCageQuad = 16;  ///< quad i lies in cage quad i / 16

struct RefinedCage {
  std::vector<Quad> quads;
  std::vector<int> mirror;         ///< V: index of the mirror image, itself on the plane
  SparseRows fine_from_cage;       ///< V×N: S2 S1 of the subdivision
  SparseRows bilinear_from_cage;   ///< V×N: the same vertices by halving edges and quads, for values given at the cage
  std::vector<int> left_vertices;  ///< of quads of the left half, increasing
  int num_left_quads = 0;
};

/// Throws std::invalid_argument when the cage cannot be subdivided or is not symmetric.
RefinedCage RefineCage(const Cage& cage);

/// Sets the skinning weights of both halves from those of the left vertices, in the order of `left_vertices`;
/// `joint_mirror` has an entry for each of the body's joints.
void FillWeights(const RefinedCage& refined, const std::vector<int>& joint_mirror,
                 const std::vector<WeightedIndices>& left_weights, BodyModelData* body);

}  // namespace bodyloom
