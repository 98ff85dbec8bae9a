// SPDX-License-Identifier: Apache-2.0
/// The principal components of hand poses that SMPL-H's and SMPL-X's files hold:
///   pose (45) = coefficients (K) · components (first K rows) + mean
/// axis-angle of a hand's 15 joints in SMPL-H's order. Keys hands_componentsl and hands_componentsr (K×45, rows by
/// falling variance), hands_meanl and hands_meanr (45). Source: smplx body_models.py.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "geometry/math/arrays.h"

namespace bodyloom {

struct HandComponents {
  Eigen::VectorXd mean;    ///< 45
  RowMatrixXd components;  ///< K×45, 1 ≤ K ≤ 45

  /// 45 values. `coefficients`: at most K; the others are zero. `flat_hand_mean` leaves the mean out, as of bodies that
  /// were loaded so (LoadBodyOptions), or whose pose_mean holds it. Throws std::invalid_argument for more than K.
  [[nodiscard]] Eigen::VectorXd Pose(const Eigen::VectorXd& coefficients, bool flat_hand_mean = false) const;

  /// The first `count` coefficients of the nearest pose (least squares); the inverse of Pose() for poses in their span.
  [[nodiscard]] Eigen::VectorXd Coefficients(const Eigen::VectorXd& pose, int count, bool flat_hand_mean = false) const;
};

/// Left and right hand of a body file as LoadBody() reads it; nothing for files without components, such as SMPL's, the
/// compact form and the built-in body's. Throws std::runtime_error "path: …" for arrays of other sizes or not finite.
std::optional<std::array<HandComponents, 2>> LoadHandComponents(const std::string& path);

}  // namespace bodyloom
