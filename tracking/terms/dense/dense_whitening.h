// SPDX-License-Identifier: Apache-2.0
/// The covariance of a dense keypoint's error in the image. Errors of detectors are on the surface: with noise s_uv of
/// the label (chart units) and s_px of the pixel
///   S = s_px² I + s_uv² M Mᵀ,     M = ∂pixel/∂(u, v)
/// and the whitened residual is W (π(x) − y), W = S^(−1/2). M is computed at a given state and fixed during a solve; it
/// is updated between rounds. Without s_uv (0) S = sigma_px² I. M is evaluated at the surface point visible at the
/// pixel if that is on the label's chart: at the label itself M would depend on the label's error, and errors towards
/// the camera would have a larger weight than errors away from it. Otherwise it is evaluated at the label.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/scene/observations.h"
#include "render/raster/visibility_buffer.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/terms/dense/dense.h"

namespace bodyloom {

/// ∂pixel/∂(u, v) of a face with posed corners `corners` (rows of its triangle) at a point whose ∂pixel/∂x is
/// `d_pixel_d_x`; zero where the face covers no area of its chart.
Eigen::Matrix2d PixelByChart(const Eigen::Matrix3d& corners, const Matrix2x3d& d_pixel_d_x,
                             const Eigen::Matrix<double, 3, 2>& corner_uv);

/// Chart coordinates of a face's corners, one a row. The body must have them.
Eigen::Matrix<double, 3, 2> CornerUv(const BodyModel& model, int face);

/// Intersection of the ray through a pixel with the plane of a face.
struct SeenUv {
  Eigen::Vector3d barycentric;  ///< not clamped: linear beyond the edges, by less than a pixel
  Eigen::Vector2d uv;
};

/// Computes the intersection. Returns false if the face is seen at |cos| below min_cosine, or the pixel has no ray.
/// Corners are rows.
bool SeeUv(const Camera& camera, const Eigen::Matrix3d& corners, const Eigen::Matrix<double, 3, 2>& corner_uv,
           const Eigen::Vector2d& pixel, double min_cosine, SeenUv* seen);

/// Returns one entry a keypoint, at the given state, of which `seen` is the visibility buffer (null: M is evaluated at
/// the labels). A point that does not project keeps S = sigma_px² I and M = 0. s_px below 0.3 px counts as 0.3 px. For
/// a body without chart coordinates M = 0 everywhere.
std::vector<DenseWhitening> WhitenDense(const FrameLayout& layout, const FrameState& state,
                                        const Eigen::VectorXd& betas, double log_focal,
                                        const std::vector<DenseKeypoint>& keypoints, double uv_sigma,
                                        double pixel_sigma_px, const VisibilityBuffer* seen = nullptr);

}  // namespace bodyloom
