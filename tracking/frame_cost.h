// SPDX-License-Identifier: Apache-2.0
/// The cost of one frame: everything that depends on one frame's pose and on the clip's shape and focal length. It is a
/// sum over the terms of FrameData (frame_data.h), each of which has its law in its own header:
///
///   ½ Σ ρ(‖W_k (π(x_k) − y_k)‖²)      2D joints and dense keypoints (L_f of paper A), Geman–McClure; W_k = I/σ_k, or
///                                    the inverse root of the keypoint's covariance (terms/dense/dense_whitening.h)
/// + ½ λ_r Σ ρ(‖r_uv‖²)                dense keypoints in UV (L_r of paper A, terms/rendered_uv/rendered_uv_term.h)
/// + ½ Σ w ρ(‖r‖²)                     contours and part labels (terms/part_labels/part_label_term.h)
/// + ½ w_prior (energy of the nearest mixture component)
/// + ½ Σ (excess over joint limits / σ)²
/// + ½ w ρ((n·u)² / σ²)               u: the root's up axis in the camera frame, n: horizontal, towards the scene; how
///                                    far the trunk leans towards or away from the camera, which a camera barely sees
///                                    (cos is flat): people are mostly upright. Saturates, so bending and lying stay
///                                    free
/// + ½ w² Σ ρ(θ²)                    flexion of the knees (terms/straight_knees.h)
/// + ½ λ_d (‖log(R̄ᵀR)‖²/σ_R² + ‖t − t̄‖²/σ_t²)  initialiser (L_d of paper A)
/// + ½ λ_d Σ ρ(‖W (x − x_hips − y)‖²)         the lifter as initialiser (terms/lifted/lifted_pose.h)
/// + ½ Σ ρ(‖W (x − a)‖²)              feet that stand (terms/ground_contact/ground_contact.h)
/// + ½ Σ ρ(‖r‖²)                      a user's own cost functions (terms/own/own_term.h)
///
/// Where the camera moves, the state is in the scene and every term takes it in the camera frame of its frame; the sums
/// are taken back to the scene at the end (moving_camera.h).
///
/// Rotations are differentiated by right increments. Points that cannot be projected cost the kernel's saturation c²
/// with a zero derivative, and are counted.
#pragma once

#include <Eigen/Core>

#include "bodyloom/tracking/frame_accumulator.h"
#include "bodyloom/tracking/frame_data.h"
#include "bodyloom/tracking/frame_layout.h"

namespace bodyloom {

/// Evaluates frames; holds scratch memory, one instance a thread.
class FrameEvaluator {
 public:
  /// From now on at most about this many dense keypoints of a frame, evenly chosen and weighted to stand for all of
  /// them; 0: all. Frames with rendered UV always use all.
  void LimitDense(int max_points) { sums_.max_dense = max_points; }
  /// Cost only when `derivatives` is false. `residuals` is filled when given (appended to).
  void Evaluate(const FrameLayout& layout, const FrameData& data, const FrameState& state, const Eigen::VectorXd& betas,
                double log_focal, bool derivatives, FrameSystem* system, FrameResiduals* residuals = nullptr);

 private:
  FrameAccumulator sums_;
  FrameState in_camera_;  ///< of a camera that moves
};

}  // namespace bodyloom
