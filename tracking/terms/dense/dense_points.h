// SPDX-License-Identifier: Apache-2.0
/// Poses many surface points of one frame, and adds their residuals to the normal equations.
///
/// A point moves with few joints (six on average on the built-in body, of 24), so points are grouped by the set of
/// joints that move them; each set's rows have columns only for its joints, translation, shape and focal length, and
/// JᵀJ of these narrow rows is added to the frame's matrix once a set. This is exact: all other columns are zero.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/observations.h"
#include "tracking/problem/body_points.h"
#include "tracking/terms/dense/dense_points_simd.h"

namespace bodyloom {

/// Scratch memory that is reused between frames; one instance a thread.
class DensePoints {
 public:
  /// A point's residual, weighted: A = scale · W ∂pixel/∂x, and the columns that do not come from the body.
  struct Row {
    Eigen::Matrix<double, 2, 3, Eigen::RowMajor> A;  ///< by the point's position
    Eigen::Matrix<double, 2, 3> translation;
    Eigen::Vector2d focal, residual;
  };
  /// Columns of the unknowns in the frame's matrix.
  struct Columns {
    const std::vector<int>* of_joint = nullptr;  ///< J, −1: held
    int translation = 0, beta = 0, focal = -1;
  };

  /// Poses keypoints 0, step, 2 step, … which become points 0, 1, 2, … With `derivatives`, `kinematics` has them and
  /// Accumulate() may follow.
  void Pose(const Kinematics& kinematics, const std::vector<DenseKeypoint>& keypoints, size_t step, bool derivatives);
  [[nodiscard]] Eigen::Vector3d position(size_t i) const {
    return Eigen::Map<const Eigen::Vector3d>(&positions_[3 * i]);
  }
  /// Adds Σ JᵀJ to `H` (upper triangle, row-major with this stride) and Σ Jᵀ residual to `gradient` for the points
  /// with has_row[i]; rows belong to the points posed last.
  void Accumulate(const Columns& columns, const std::vector<Row>& rows, const std::vector<char>& has_row, double* H,
                  int64_t stride, double* gradient);

 private:
  struct Group {
    uint64_t joints = 0;
    std::vector<int> points;
  };
  void SetBody(const Kinematics& kinematics);
  void SetDerivatives(const Kinematics& kinematics);
  void FlushGroup(const Columns& columns, const Group& group, const std::vector<Row>& rows, double* H, int64_t stride,
                  double* gradient);

  const BodyModel* model_ = nullptr;
  Eigen::VectorXd betas_;
  dense_internal::Body body_;
  dense_internal::Frame frame_;
  dense_internal::Vertices vertices_;
  std::vector<uint64_t> joints_of_vertex_;  ///< bit j: joint j moves it; empty for bodies of more than 64 joints
  std::vector<int> shaped_stamp_, posed_stamp_;
  std::vector<double> shaped_, rest_, posed_, transform_, rotation_, joint_, feature_jacobian_, dt_, positions_, A_,
      buffer_, products_;
  std::vector<dense_internal::Point> points_;
  std::vector<Group> groups_;
};

}  // namespace bodyloom
