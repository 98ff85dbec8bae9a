// SPDX-License-Identifier: Apache-2.0
/// Reads and checks the arrays of the built-in body's .npz file, which are those of the left half only.
#pragma once

#include <string>
#include <vector>

#include "data_tools/body_making/body_charts.h"
#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

/// One entry of a sparse row.
struct WeightedIndex {
  int index = 0;
  double weight = 0;
};
using WeightedIndices = std::vector<WeightedIndex>;

inline constexpr double kCorrectiveUnit_m = 5e-5;  ///< correctives are multiples of it

/// A pose corrective of one vertex: metres for each of the nine entries of R_joint − I (3×9, row-major).
struct CorrectiveBlock {
  int joint = 0;
  std::array<float, 27> values{};
};

/// The corrective that gives the mirrored vertex the mirrored offset when the pose is mirrored: with S = diag(−1,1,1)
/// the mirrored rotation is S R S, so entry (c; a,b) takes the sign s_c s_a s_b.
CorrectiveBlock MirrorCorrective(const CorrectiveBlock& block, int mirrored_joint);

struct LeftHalfArrays {
  Eigen::MatrixXd cage_shape;                             ///< L_cage × 3B: x y z of component 0, of component 1, …
  std::vector<WeightedIndices> weights;                   ///< by left vertex: joints
  std::vector<WeightedIndices> regressor;                 ///< by joint on or left of the middle: vertices of the body
  std::vector<std::vector<CorrectiveBlock>> correctives;  ///< by left vertex
  std::vector<std::string> landmark_names;                ///< of the middle and left ("left_…") ones
  std::vector<WeightedIndices> landmarks;                 ///< vertices of the body
  std::vector<ChartCoordinates> charts;                   ///< in the order of ChartKinds()
  std::vector<Eigen::Matrix<double, 2, 3>> atlas_from_chart;
};

/// Sizes that the arrays must match.
struct LeftHalfSizes {
  int cage_vertices = 0;  ///< of the left half
  int left_vertices = 0;  ///< of the subdivided left half
  int vertices = 0;       ///< of the whole body
  int joints = 0;
  int left_joints = 0;  ///< joints on or left of the middle
};

/// Throws std::runtime_error with `where`, the array, what it holds and what was expected.
LeftHalfArrays ReadLeftHalfArrays(const std::string& npz_bytes, const std::string& where, const LeftHalfSizes& sizes);

}  // namespace bodyloom
