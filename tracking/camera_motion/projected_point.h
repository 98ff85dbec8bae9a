// SPDX-License-Identifier: Apache-2.0
/// A point of the background in a camera that moves: its projection with derivatives for Ceres, the camera's place from
/// points that are known, a point's place from cameras that are known.
///
/// Pixels are from the picture's centre, c; the lens is a pinhole of focal length f:
///   x_camera = R (x − o),  R = exp(w);   pixel = f (x/z, y/z)
#pragma once

#include <ceres/sized_cost_function.h>
#include <Eigen/Core>
#include <optional>
#include <span>

namespace bodyloom {

/// Rotation and centre of a camera.
struct CameraPlace {
  Eigen::Vector3d w = Eigen::Vector3d::Zero();  ///< camera from scene, axis and angle
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

/// Residual (f π(R (x − o)) − q) / σ with f = exp(s). Parameters: w (3), o (3), x (3), s (1). Not valid (false) for
/// points behind the camera.
class ProjectedPointCost : public ceres::SizedCostFunction<2, 3, 3, 3, 1> {
 public:
  ProjectedPointCost(const Eigen::Vector2d& pixel, double sigma_px) : pixel_(pixel), sigma_px_(sigma_px) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  Eigen::Vector2d pixel_;
  double sigma_px_;
};

/// A point in a camera's picture.
struct PointInPicture {
  Eigen::Vector3d point;
  Eigen::Vector2d pixel;
};

/// Distance of a point's projection from its pixel; infinite behind the camera.
double ProjectionDistance(const CameraPlace& camera, double focal, const PointInPicture& seen);

/// Sampson's distance² of a pair of points from the epipolar geometry xᵀ_to F x_from = 0, in the points' unit.
double EpipolarDistance2(const Eigen::Matrix3d& F, const Eigen::Vector2d& from, const Eigen::Vector2d& to);

struct FittedPlace {
  CameraPlace place;
  /// Of the increments of w and the centre, for pixels with the deviation that the good ones have.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int num_good = 0;  ///< points within three σ
};
/// Place of the camera that sees the points, from `start`: Σ ρ(‖r‖²) with Cauchy's ρ, whose scale falls from the
/// median residual at the start, or 24 σ, to 2 σ (Gauss and Newton). None: fewer than six good points.
std::optional<FittedPlace> FitCameraPlace(std::span<const PointInPicture> seen, double focal, double sigma_px,
                                          const CameraPlace& start);

/// A camera with the pixel in which it sees a point.
struct PixelOfCamera {
  CameraPlace camera;
  Eigen::Vector2d pixel;
};
struct FittedPoint {
  Eigen::Vector3d point;
  double angle = 0;  ///< largest between two of its rays, rad
};
/// Place of a point from two pixels or more: nearest to the rays, then of least squared residuals under Cauchy's ρ.
/// A point that the rays place farther than `farthest` from the first camera is put there. None: the rays do not meet
/// in front of the cameras, or fewer than two, or than two thirds of the pixels, are within `good_px` of it.
std::optional<FittedPoint> FitPoint(std::span<const PixelOfCamera> seen, double focal, double sigma_px, double good_px,
                                    double farthest);

}  // namespace bodyloom
