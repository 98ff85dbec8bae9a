// SPDX-License-Identifier: Apache-2.0
/// The cost of one frame: everything that depends on one frame's pose and on the clip's shape and focal length.
///
///   ½ Σ ρ(‖(π(x_k) − y_k)/σ_k‖²)      2D joints and dense keypoints (L_f of paper A), Geman–McClure
/// + ½ w_prior (energy of the nearest mixture component)
/// + ½ Σ (excess over joint limits / σ)²
/// + ½ w ρ(u_z² / σ²)                 u: the root's up axis in the camera frame; how far the trunk leans towards or
/// away
///                                    from the camera, which a camera barely sees (cos is flat): people are mostly
///                                    upright and cameras mostly level. Saturates, so bending and lying stay free
/// + ½ λ_d (‖log(R̄ᵀR)‖²/σ_R² + ‖t − t̄‖²/σ_t²)  initialiser (L_d of paper A)
///
/// Rotations are differentiated by right increments. Points that cannot be projected cost the kernel's saturation c²
/// with a zero derivative, and are counted.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/body_model.h"
#include "geometry/camera.h"
#include "geometry/observations.h"
#include "geometry/track.h"
#include "tracking/body_points.h"
#include "tracking/joint_limits.h"
#include "tracking/mixture_prior.h"
#include "tracking/track_sequence.h"

namespace bodyloom {

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
};

/// A 2D joint: the compiled landmark, where it was seen, and how well.
struct LandmarkObservation {
  const CompiledPoint* point = nullptr;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1;
};

/// Everything known about one frame. Borrowed pointers outlive the cost.
struct FrameData {
  std::vector<LandmarkObservation> landmarks;
  const std::vector<DenseKeypoint>* dense = nullptr;
  double landmark_kernel = 8, dense_kernel = 4;  ///< c of the robust kernel, in sigmas
  const MixturePrior* prior = nullptr;
  double prior_weight = 0;
  const JointLimits* limits = nullptr;
  double limit_sigma = 0.05;                       ///< radians
  double upright_weight = 0;                       ///< of the spine's tilt out of the image plane
  std::vector<Eigen::Matrix3d> initial_rotations;  ///< J, or empty: no initialiser
  Eigen::Vector3d initial_translation = Eigen::Vector3d::Zero();
  double initialiser_weight = 0, initialiser_sigma = 0.2, initialiser_translation_sigma = 0.3;  ///< radians, metres
};

inline constexpr double kUprightSigma = 0.25, kUprightKernel = 1.5;

struct FrameState {
  std::vector<Eigen::Matrix3d> rotations;  ///< J
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

/// From a (s = 0) to b (s = 1): rotations along geodesics, translation linearly.
FrameState InterpolateStates(const FrameState& a, const FrameState& b, double s);

/// Gauss–Newton system of a frame: cost = ½ Σ ρ, gradient = Jᵀ r and H = Jᵀ J of the weighted residuals.
struct FrameSystem {
  double cost = 0;
  Eigen::MatrixXd H;  ///< lower triangle
  Eigen::VectorXd gradient;
  int num_invalid = 0;  ///< observations that could not be projected
};

/// Evaluates frames; holds scratch memory, one instance a thread.
class FrameEvaluator {
 public:
  /// Cost only when `derivatives` is false.
  void Evaluate(const FrameLayout& layout, const FrameData& data, const FrameState& state, const Eigen::VectorXd& betas,
                double log_focal, bool derivatives, FrameSystem* system);

 private:
  void AddPixel(const FrameLayout& layout, const Eigen::Vector3d& x, const Eigen::Vector2d& pixel, double sigma_px,
                double kernel, const FrameState& state, bool derivatives);
  void ReserveRows(int rows, int columns);

  Kinematics kinematics_;
  PointEvaluator points_;
  PointEvaluator::VertexCache vertices_;
  Camera camera_;
  RowMatrixXd J_;
  Eigen::VectorXd r_;
  int row_ = 0;
  double cost_ = 0;
  int num_invalid_ = 0;
};

}  // namespace bodyloom
