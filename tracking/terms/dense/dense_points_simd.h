// SPDX-License-Identifier: Apache-2.0
/// Inner loops of dense_points.h: poses surface points, and computes their derivatives by the few joints that move
/// them. Plain arrays of double without Eigen, because this is compiled once per instruction set and the best one is
/// selected at run time. 3×3 matrices are column-major, as in Eigen.
#pragma once

#include <cstdint>

namespace bodyloom::dense_internal {

/// Arrays of the body model, by vertex and by joint.
struct Body {
  const int* influence_begin = nullptr;
  const int* influence_joint = nullptr;
  const double* influence_weight = nullptr;
  const int* corrective_begin = nullptr;  ///< null: no correctives
  const int* corrective_joint = nullptr;
  const float* corrective_block = nullptr;  ///< 3×9 row by row
  const float* shapedirs = nullptr;         ///< row 3v + c
  const double* v_template = nullptr;
  int shape_stride = 0, num_joints = 0;
};

/// The kinematic tree of one frame (body_points.h), in rows of four values for vector loads.
struct Frame {
  int num_betas = 0, dt_stride = 0;
  const double* betas = nullptr;
  const double* transform = nullptr;  ///< J × 4 × 4: the columns of G with a 0 each, then t and 1
  const double* feature = nullptr;    ///< J × 9
  // Derivatives only:
  const double* rotation = nullptr;          ///< J × 3 × 4: the rows of G with a 0 each
  const double* joint = nullptr;             ///< J × 4: p and 1
  const double* feature_jacobian = nullptr;  ///< J × 9 × 4: its rows with a 0 each
  const double* dt = nullptr;                ///< J × 3 × dt_stride, zeros from num_betas on
};

/// Vertices, 3 values each: `shaped` belongs to a shape, `rest` (with correctives) and `posed` to a frame. A stamp that
/// is not the current one means that the vertex has not been computed yet.
struct Vertices {
  int* shaped_stamp = nullptr;
  int* posed_stamp = nullptr;
  double* shaped = nullptr;
  double* rest = nullptr;
  double* posed = nullptr;
  int shape = 0, frame = 0;
};

struct Point {
  int vertex[3];
  double weight[3];  ///< sum to 1
};

/// Computes posed positions, n × 3.
void PosePoints(const Body& body, const Frame& frame, const Vertices& vertices, const Point* points, int n, double* x);

/// Joints that move the points of a group, ascending, with all their ancestors (and the joints of correctives).
struct Group {
  int num_joints = 0;
  const int* joints = nullptr;
  const int* parent = nullptr;    ///< index into `joints`, −1: none
  const int* column = nullptr;    ///< first of its 3 columns in a row, ascending; −1: held
  const int* of_joint = nullptr;  ///< J: index into `joints`
  int beta_column = 0;            ///< first of num_betas columns
};

inline constexpr int kMaxGroupJoints = 256;

/// Fills two rows for each point that PosePoints has posed in this frame: A ∂x/∂δ_j and A ∂x/∂β, A the point's 2×3
/// matrix, row-major. The column after the last joint's is overwritten; other columns are not changed.
void FillRows(const Body& body, const Frame& frame, const Vertices& vertices, const Group& group, const Point* points,
              const int* chosen, int n, const double* A, double* rows, int64_t stride);

}  // namespace bodyloom::dense_internal
