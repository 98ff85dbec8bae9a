// SPDX-License-Identifier: Apache-2.0
/// The cost of one frame: everything that depends on one frame's pose and on the clip's shape and focal length.
///
///   ½ Σ ρ(‖W_k (π(x_k) − y_k)‖²)      2D joints and dense keypoints (L_f of paper A), Geman–McClure; W_k = I/σ_k, or
///                                    the inverse root of the keypoint's covariance (residuals/dense_whitening.h)
/// + ½ λ_r Σ ρ(‖r_uv‖²)                dense keypoints in UV (L_r of paper A, residuals/rendered_uv_term.h)
/// + ½ Σ w ρ(‖r‖²)                     outlines and part labels (residuals/part_label_term.h)
/// + ½ w_prior (energy of the nearest mixture component)
/// + ½ Σ (excess over joint limits / σ)²
/// + ½ w ρ((n·u)² / σ²)               u: the root's up axis in the camera frame, n: horizontal, towards the scene; how
///                                    far the trunk leans towards or away from the camera, which a camera barely sees
///                                    (cos is flat): people are mostly upright. Saturates, so bending and lying stay
///                                    free
/// + ½ λ_d (‖log(R̄ᵀR)‖²/σ_R² + ‖t − t̄‖²/σ_t²)  initialiser (L_d of paper A)
/// + ½ λ_d Σ ρ(‖W (x − x_hips − y)‖²)         the lifter as initialiser (residuals/lifted_pose.h)
/// + ½ Σ ρ(‖W (x − a)‖²)              feet that stand (residuals/ground_contact.h)
///
/// Rotations are differentiated by right increments. Points that cannot be projected cost the kernel's saturation c²
/// with a zero derivative, and are counted.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/camera.h"
#include "bodyloom/geometry/observations.h"
#include "bodyloom/geometry/track.h"
#include "bodyloom/tracking/body_points.h"
#include "bodyloom/tracking/joint_limits.h"
#include "bodyloom/tracking/mixture_prior.h"
#include "bodyloom/tracking/residuals/dense_points.h"
#include "bodyloom/tracking/residuals/ground_contact.h"
#include "bodyloom/tracking/residuals/visible_surface.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {

struct FrameState {
  std::vector<Eigen::Matrix3d> rotations;  ///< J
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

/// Which unknowns a frame has and in which column of its Jacobian they stand; shared by all frames of a clip.
struct FrameLayout {
  const BodyModel* model = nullptr;
  CameraKnowledge knowledge = CameraKnowledge::kKnown;
  Camera camera;                     ///< intrinsics; the focal length is replaced by exp(log_focal) when estimated
  std::vector<int> active_joints;    ///< joints whose rotation is estimated, in column order (3 columns each)
  std::vector<int> column_of_joint;  ///< J; −1: held
  int translation_column = 0;        ///< 3 columns: translation, or (log scale, tx, ty) for weak perspective
  int beta_column = 0, num_betas = 0;
  int focal_column = -1;  ///< −1: known
  int num_columns = 0;

  static FrameLayout Make(const BodyModel& model, CameraKnowledge knowledge, const Camera& camera,
                          std::vector<int> active_joints, int num_betas);
  [[nodiscard]] int num_frame_columns() const { return translation_column + 3; }
  /// Intrinsics at a frame's state; for weak perspective with its scale and offset.
  [[nodiscard]] Camera CameraAt(const FrameState& state, double log_focal) const;
  /// Translation of the body: zero for weak perspective, where the camera has it.
  [[nodiscard]] Eigen::Vector3d BodyTranslation(const FrameState& state) const;
  /// Where the body's origin is in the camera frame, metres. For weak perspective: (tx, ty, fx/s), as far away as a
  /// pinhole of the layout's focal length would have to be.
  [[nodiscard]] Eigen::Vector3d BodyPlace(const FrameState& state) const;
};

/// A 2D joint: the compiled landmark, where it was seen, and how well.
struct LandmarkObservation {
  const CompiledPoint* point = nullptr;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1;
};

/// How a dense keypoint's error lies in the image (residuals/dense_whitening.h).
struct DenseWhitening {
  Eigen::Matrix2d whitening;    ///< W, 1/px
  Eigen::Matrix2d pixel_by_uv;  ///< M = ∂pixel/∂(u, v) at the label, pixels a chart; zero where there is none
};

class RenderedUvTerm;
class PartLabelTerm;
struct LiftedPose;

/// Everything known about one frame. Borrowed pointers outlive the cost.
struct FrameData {
  std::vector<LandmarkObservation> landmarks;
  const std::vector<DenseKeypoint>* dense = nullptr;
  std::vector<DenseWhitening> dense_whitening;  ///< one a dense keypoint, or empty: I/sigma_px
  RenderedUvTerm* rendered_uv = nullptr;        ///< takes its keypoints away from `dense`
  const PartLabelTerm* part_labels = nullptr;
  const LiftedPose* lifted = nullptr;
  double lifted_weight = 0, lifted_kernel = 3;
  double landmark_kernel = 8, dense_kernel = 4;  ///< c of the robust kernel, in sigmas
  const MixturePrior* prior = nullptr;
  double prior_weight = 0;
  const JointLimits* limits = nullptr;
  double limit_sigma = 0.05;                                  ///< radians
  double upright_weight = 0;                                  ///< of the trunk's lean along the view
  Eigen::Vector3d upright_normal = Eigen::Vector3d::UnitZ();  ///< n: the direction in which it should not lean
  std::vector<GroundContact> contacts;
  std::vector<Eigen::Matrix3d> initial_rotations;  ///< J, or empty: no initialiser
  Eigen::Vector3d initial_translation = Eigen::Vector3d::Zero();
  double initialiser_weight = 0, initialiser_sigma = 0.2, initialiser_translation_sigma = 0.3;  ///< radians, metres
};

inline constexpr double kUprightSigma = 0.25, kUprightKernel = 1.5;

/// From a (s = 0) to b (s = 1): rotations along geodesics, translation linearly.
FrameState InterpolateStates(const FrameState& a, const FrameState& b, double s);

/// Gauss–Newton system of a frame: cost = ½ Σ ρ, gradient = Jᵀ r and H = Jᵀ J of the weighted residuals.
struct FrameSystem {
  double cost = 0;
  Eigen::MatrixXd H;  ///< lower triangle
  Eigen::VectorXd gradient;
  int num_invalid = 0;  ///< observations that could not be projected
};

/// How far the newer image terms are off in one frame, in pixels, before weights and kernels.
struct FrameResiduals {
  std::vector<double> rendered_uv_px, silhouette_px, part_px;
  int rendered_uv_unmatched = 0, silhouette_unmatched = 0, part_unmatched = 0;
};

/// Evaluates frames; holds scratch memory, one instance a thread.
class FrameEvaluator {
 public:
  /// From now on at most about this many dense keypoints of a frame, evenly chosen and weighted to stand for all of
  /// them; 0: all. Frames with rendered UV always use all.
  void LimitDense(int max_points) { max_dense_ = max_points; }
  /// Cost only when `derivatives` is false. `residuals` is filled when given (appended to).
  void Evaluate(const FrameLayout& layout, const FrameData& data, const FrameState& state, const Eigen::VectorXd& betas,
                double log_focal, bool derivatives, FrameSystem* system, FrameResiduals* residuals = nullptr);

 private:
  /// A surface point that was evaluated last in points_, and where it appears.
  struct Projected {
    Eigen::Vector3d x;
    Eigen::Vector2d pixel;
    Matrix2x3d d_pixel_d_x;
  };
  bool Project(const Eigen::Vector3d& x, bool derivatives, Projected* projected);
  /// ½ w ρ(‖residual‖²) with ∂residual/∂θ = B ∂pixel/∂θ of the point evaluated last; N rows.
  template <int N>
  void AddImageRows(const FrameLayout& layout, const Projected& at, const Eigen::Matrix<double, N, 1>& residual,
                    const Eigen::Matrix<double, N, 2>& B, double kernel, double weight, bool derivatives);
  void AddPixel(const FrameLayout& layout, const Eigen::Vector3d& x, const Eigen::Vector2d& pixel,
                const Eigen::Matrix2d& whitening, double kernel, double weight, bool derivatives);
  void AddSaturated(double kernel, double weight);
  void AddDense(const FrameLayout& layout, const FrameData& data, bool derivatives);
  void AddRenderedUv(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                     const Eigen::VectorXd& betas, bool derivatives, FrameResiduals* residuals);
  void AddPartLabels(const FrameLayout& layout, const FrameData& data, bool derivatives, FrameResiduals* residuals);
  void AddLifted(const FrameLayout& layout, const FrameData& data, bool derivatives);
  void AddContacts(const FrameLayout& layout, const FrameData& data, const FrameState& state, bool derivatives);
  /// 3×columns: derivative of the point evaluated last, without translation.
  void FillPointRows(const FrameLayout& layout, Eigen::Ref<RowMatrixXd> rows);
  void ReserveRows(int rows, int columns);
  /// Adds J'J and J'r of a term that depends on one joint (or on the translation): three columns.
  void AddSquares(int column, const Eigen::Matrix3d& JtJ, const Eigen::Vector3d& Jtr);
  void AddPrior(const FrameLayout& layout, const FrameData& data, const FrameState& state, bool derivatives);

  Kinematics kinematics_;
  PointEvaluator points_;
  PointEvaluator::VertexCache vertices_;
  VisibleSurface surface_;
  Camera camera_;
  DensePoints dense_points_;
  std::vector<DensePoints::Row> dense_rows_;
  std::vector<char> has_dense_row_;
  RowMatrixXd J_, hip_rows_;  ///< rows of the terms that are not added directly; columns padded with zeros
  Eigen::VectorXd r_;
  RowMatrixXd H_;  ///< upper triangle; columns padded
  Eigen::VectorXd gradient_;
  int row_ = 0, max_dense_ = 0;
  double cost_ = 0;
  int num_invalid_ = 0;
};

}  // namespace bodyloom
