// SPDX-License-Identifier: Apache-2.0
/// Rotations, focal length and zoom of a camera that turns in place, from background points (BackgroundTracks).
///
/// A camera that only turns maps pixels by the infinite homography H = K_t R_t R_kᵀ K_k⁻¹ whatever the scene's depth
/// (Hartley and Zisserman, Multiple View Geometry, 8.4): K = diag(f, f, 1) about the picture's centre. The minimum of
///   Σ ρ(‖q − H p‖² / σ²) + ((log f − m) / s)²      ρ: Cauchy, c = 2;  σ = 0.3 pixels of a picture 640 pixels long
/// over R of the key frames and f is sought by Ceres: p are the points of an anchor, q their places in a later frame.
/// Key frames are the anchors and up to 80 frames in which points are farthest from where they were in their anchor.
/// Start: f of least cost on a grid, R from two points at a time (random sample consensus) and reweighting. All other
/// frames are turned against their anchor, and frames without a sight are interpolated.
#pragma once

#include <ceres/sized_cost_function.h>
#include <Eigen/Core>
#include <vector>

#include "geometry/scene/background_tracks.h"
#include "tracking/problem/camera_knowledge.h"

namespace bodyloom {

/// Residual of a point under the infinite homography, in units of `sigma_px`:
///   r = (c + f_t π(R_t R_kᵀ ((p − c)/f_k, 1)) − q) / σ,   π(x) = (x/z, y/z),   R = exp(w),   f = exp(s + zoom)
/// Parameters: w_k (3), w_t (3), s (1), zoom_k (1), zoom_t (1). Not valid (false) for points behind the camera.
class TurnedPointCost : public ceres::SizedCostFunction<2, 3, 3, 1, 1, 1> {
 public:
  /// `from_centre` and `to_centre`: p − c and q − c, pixels.
  TurnedPointCost(const Eigen::Vector2d& from_centre, const Eigen::Vector2d& to_centre, double sigma_px)
      : from_(from_centre), to_(to_centre), sigma_px_(sigma_px) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  Eigen::Vector2d from_, to_;
  double sigma_px_;
};

/// (log f − m) / s.
class FocalPriorCost : public ceres::SizedCostFunction<1, 1> {
 public:
  explicit FocalPriorCost(const FocalPrior& prior) : prior_(prior) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  FocalPrior prior_;
};

struct TurningCameraOptions {
  FocalPrior focal;          ///< of the picture
  bool focal_known = false;  ///< held at exp(focal.log_mean)
  bool zooms = false;        ///< the focal length is another one in every frame
  int num_threads = 1;
};

struct TurningCamera {
  bool solved = false;
  std::vector<int> frames;                         ///< with a sight of the background, rising
  std::vector<Eigen::Matrix3d> camera_from_first;  ///< rotation of each of them
  std::vector<double> sigma_rad;                   ///< of each, standard deviation about an axis
  std::vector<double> zoom;                        ///< log of its focal length over that of the first
  double log_focal = 0, log_focal_sigma = 0;       ///< of the first frame
  double median_px = 0;                            ///< of the points' distances from where they should be
  double explained = 0;                            ///< share of the points within 1.5 pixels of a picture of 640
};

/// Anchors that begin after a break are left out with all that follows: `frames` then end before it. Not solved if no
/// frame has 12 points or Ceres fails.
TurningCamera SolveTurningCamera(const BackgroundTracks& tracks, const TurningCameraOptions& options);

/// Pixels of the clip's frames a pixel of a picture 640 pixels long.
double SmallPixel(const BackgroundTracks& tracks);

}  // namespace bodyloom
