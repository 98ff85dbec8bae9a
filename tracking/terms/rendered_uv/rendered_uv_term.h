// SPDX-License-Identifier: Apache-2.0
/// L_r of paper A for one frame: difference between the chart coordinates of the fitted body at a detected pixel and
/// the detected ones.
///
///   r = W M₀ (uv(p; θ) − uv_detected(p))        when the pixel p shows the chart that the detector predicts
/// uv(p; θ) is at the intersection, in double, of the ray through p with the face that the visibility buffer found at
/// the nearest whole pixel. W and M₀ = ∂pixel/∂(u, v) are those of the label at the round's start
/// (terms/dense/dense_whitening.h): W M₀ converts chart units, which differ in size from chart to chart, to standard
/// deviations; for a correct label it is the inverse root of s_uv² I + s_px² M₀⁻¹ M₀⁻ᵀ, the covariance of the UV error.
/// Derivative with the visible face held: ∂uv/∂θ = −G (I − d nᵀ/(n·d)) ∂x/∂θ, x the surface point at p, d the ray, n
/// the normal, G the gradient of (u, v) on the face; since G (I − d nᵀ/(n·d)) = M⁻¹ ∂pixel/∂x, the rows are −W M₀ M⁻¹
/// ∂π(x)/∂θ for every camera model and parameter, M that of the visible face at this state.
///
/// A pixel is unmatched when it shows the background, another chart, or a face with |cos(n, d)| below min_cosine. It
/// costs the reprojection error of its label, W (π(x_label) − p), which still has a gradient, and the cost is nearly
/// continuous when a pixel becomes unmatched (to first order both residuals are the same up to sign); or, with
/// unmatched_reproject off, the kernel's saturation with a zero derivative.
///
/// The frame is rasterised once for each new state, for any number of pixels and calls.
/// Source: Yoon et al., "Learning motion-dependent appearance", appendix A; fixed-visibility derivative after DenseRaC.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "geometry/body/skinning.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/frame_term.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/visible_surface.h"
#include "tracking/terms/dense/dense.h"

namespace bodyloom {

/// M⁻¹ = ∂(u, v)/∂pixel on a face, at a point whose ∂pixel/∂x is given.
Eigen::Matrix2d UvByPixel(const Eigen::Matrix3d& corners, const Matrix2x3d& d_pixel_d_x,
                          const Eigen::Matrix<double, 3, 2>& corner_uv);

class RenderedUvPixels {
 public:
  struct Pixel {
    int keypoint = 0;  ///< index into the frame's dense keypoints
    int part = 0;      ///< chart that the detector predicts
    Eigen::Vector2d pixel, uv;
    Eigen::Matrix2d residual_by_uv = Eigen::Matrix2d::Zero();  ///< W M₀
    Eigen::Matrix2d pixel_by_uv = Eigen::Matrix2d::Zero();     ///< M₀
    Eigen::Matrix2d whitening = Eigen::Matrix2d::Zero();       ///< W
  };

  /// Uses up to options.max_points of the frame's keypoints, which are borrowed. The body must have charts with
  /// coordinates.
  RenderedUvPixels(const BodyModel& model, std::shared_ptr<const Skinner> skinner,
                   const std::vector<DenseKeypoint>& keypoints, const RenderedUvOptions& options);

  /// To be called before the first evaluation and between rounds. Keypoints without M₀ stay in the dense term.
  void SetWhitening(const std::vector<DenseWhitening>& whitening);

  /// The face visible at each of pixels() (−1: none), at this state. `translation` and `camera` are those of the state.
  const std::vector<int>& VisibleFaces(const BodyModel& model, const FrameState& state, const Eigen::VectorXd& betas,
                                       const Eigen::Vector3d& translation, const Camera& camera,
                                       VisibleSurface* surface);

  /// While true the visible faces are fixed at any state, for checking derivatives.
  void HoldVisibility(bool hold) { hold_ = hold; }

  [[nodiscard]] const std::vector<Pixel>& pixels() const { return pixels_; }
  /// By keypoint: not 0 if its residual is in UV.
  [[nodiscard]] const std::vector<char>& taken() const { return taken_; }
  [[nodiscard]] const std::vector<DenseKeypoint>& keypoints() const { return keypoints_; }
  [[nodiscard]] double weight() const { return options_.weight; }
  [[nodiscard]] double min_cosine() const { return options_.min_cosine; }
  [[nodiscard]] bool unmatched_reproject() const { return options_.unmatched_reproject; }
  [[nodiscard]] int num_rasterised() const { return num_rasterised_; }

 private:
  const std::vector<DenseKeypoint>& keypoints_;
  std::shared_ptr<const Skinner> skinner_;
  RenderedUvOptions options_;
  std::vector<Pixel> chosen_;  ///< all candidates
  std::vector<Pixel> pixels_;  ///< those with M₀
  std::vector<char> taken_;    ///< by keypoint
  // The state that `faces_` belongs to.
  FrameState state_;
  Eigen::VectorXd betas_;
  double fx_ = 0;
  std::vector<int> faces_;
  bool valid_ = false, hold_ = false;
  int num_rasterised_ = 0;
};

class RenderedUvTerm : public CopyableTerm<RenderedUvTerm> {
 public:
  RenderedUvPixels* term = nullptr;  ///< borrowed; null: none. It keeps the visible faces of the state seen last
  double kernel = 4;                 ///< c of Geman–McClure, in σ

  [[nodiscard]] std::string name() const override { return "rendered UV"; }
  [[nodiscard]] int num_rows() const override {
    return term == nullptr ? 0 : static_cast<int>(2 * term->keypoints().size());
  }
  [[nodiscard]] bool is_compressed() const override { return true; }
  void Add(FrameAccumulator* sums) const override;
};

/// Selects up to max_points indices into `keypoints`, ascending: every part has an equal share, if it has that many,
/// and within a part they are evenly spaced in the order of the keypoints. All of them if there are no more.
std::vector<int> StratifiedKeypoints(const BodyModel& model, const std::vector<DenseKeypoint>& keypoints,
                                     int max_points);

}  // namespace bodyloom
