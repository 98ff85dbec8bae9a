// SPDX-License-Identifier: Apache-2.0
/// The covariance of a dense keypoint's error in the image. Detectors err on the surface: with noise s_uv of the label
/// (chart units) and s_px of the pixel
///   S = s_px² I + s_uv² M Mᵀ,     M = ∂pixel/∂(u, v) at the labelled surface point
/// and the whitened residual is W (π(x) − y), W = S^(−1/2). M is that of a given state and stays fixed during a solve:
/// it is refreshed between rounds. Without s_uv (0) S = sigma_px² I.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/observations.h"
#include "tracking/frame_cost.h"

namespace bodyloom {

/// ∂pixel/∂(u, v) of a face with posed corners `corners` (rows of its triangle) at a point whose ∂pixel/∂x is
/// `d_pixel_d_x`; zero where the face covers no area of its chart.
Eigen::Matrix2d PixelByChart(const Eigen::Matrix3d& corners, const Matrix2x3d& d_pixel_d_x,
                             const Eigen::Matrix<double, 3, 2>& corner_uv);

/// Chart coordinates of a face's corners, one a row. The body must have them.
Eigen::Matrix<double, 3, 2> CornerUv(const BodyModel& model, int face);

/// One entry a keypoint, at the given state. A point that does not project keeps S = sigma_px² I and M = 0. s_px below
/// 0.3 px counts as 0.3 px. For a body without chart coordinates M = 0 everywhere.
std::vector<DenseWhitening> WhitenDense(const FrameLayout& layout, const FrameState& state,
                                        const Eigen::VectorXd& betas, double log_focal,
                                        const std::vector<DenseKeypoint>& keypoints, double uv_sigma,
                                        double pixel_sigma_px);

}  // namespace bodyloom
